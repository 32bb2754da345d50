"""Dialog of the export of a dataset: content and folder, then its progress."""

from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QProgressBar,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.coarsening.methods import METHODS
from regolith_studio.coarsening.weights import JACCARD, presets
from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.jobs.dataset_jobs import DatasetOptions
from regolith_studio.session.choices import Choices
from regolith_studio.session.tasks import Task
from regolith_studio.ui.dialogs.folder import FolderDialog
from regolith_studio.ui.translation import tr
from regolith_studio.ui.translation.numbers import number_text
from regolith_studio.ui.widgets.labels import remark, rich_symbol


@dataclass(frozen=True)
class ExportRequest:
    """The settings of the dialog."""

    folder: Path
    options: DatasetOptions


def summary(count: int, choices: Choices, cost: str = "") -> list[tuple[str, str]]:
    """What will be written, as pairs of a word and rich text.

    Parameters
    ----------
    cost
        What imitating the fit costs the particle on screen, as a sentence.
    """
    weights = ", ".join(
        f"{'Jaccard' if key == JACCARD else rich_symbol(CATALOGUE[key].symbol)}&nbsp;"
        + number_text(value, "g")
        for key, value in choices.weights.items()
        if value
    )
    preset = tr(presets()[choices.preset].label)
    if choices.preset_modified:
        preset = tr("{preset}, modified", preset=preset)
    target = tr("the particle itself")
    if choices.target == "fit":
        target = tr(
            "the surface of the spherical-harmonics fit at l<sub>max</sub>&nbsp;=&nbsp;{l_max}",
            l_max=choices.l_max,
        )
        if cost:
            target += f"<br>{choices.selected}: {cost}"
    size = count * (84 + 50 * (4 * choices.facet_count - 12)) / 1024
    files = tr("{count}, as unit-volume STL files, {size:,.0f} KiB in all", count=count, size=size)
    if choices.stop_at == "error":
        files = tr("{count}, as unit-volume STL files", count=count)
    method = tr("{method}, seed {seed}", method=tr(METHODS[choices.method].label), seed=choices.seed)
    return [
        (tr("Particles"), files),
        (tr("Size of each"), facet_limit_text(choices)),
        (tr("Target"), target),
        (tr("Method"), method),
        (tr("Weights"), (weights or tr("none")) + f" ({preset})"),
        (tr("Additional files"), tr("weights, size distribution, descriptors, provenance (JSON)")),
    ]


class ExportDialog(QDialog):
    """Edits a request, then shows the progress; ``started`` carries it, ``stopped`` asks to cancel."""

    started = Signal(object)
    stopped = Signal()

    def __init__(
        self, count: int, choices: Choices, folder: Path, parent: QWidget | None = None, cost: str = ""
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Export dataset"))
        self.setObjectName("export_dialog")
        self.setMinimumWidth(520)
        self._running = False
        self.folder = QLineEdit(str(folder))
        self.folder.setObjectName("export_folder")
        self.folder.setAccessibleName(tr("Folder of the dataset"))
        self.browse = QPushButton(tr("Browse …"))
        self.name = QLineEdit()
        self.name.setObjectName("export_name")
        self.name.setAccessibleName(tr("Name of the dataset"))
        self.name.setPlaceholderText(tr("as the folder"))
        self.overwrite = QCheckBox(tr("Replace the dataset that is there"))
        self.overwrite.setObjectName("export_overwrite")
        self.state = remark()
        self.bar = QProgressBar()
        self.bar.setAccessibleName(tr("Progress of the export"))
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel, parent=self)
        self.cancel = buttons.button(QDialogButtonBox.StandardButton.Cancel)
        self.go = buttons.addButton(tr("Export"), QDialogButtonBox.ButtonRole.AcceptRole)
        self.go.setObjectName("export_go")
        self._arrange(summary(count, choices, cost), buttons)
        self.go.setDefault(True)
        buttons.accepted.connect(self._start)
        buttons.rejected.connect(self.reject)
        self.browse.clicked.connect(self._browse)
        self.folder.textChanged.connect(self._judge)
        self.overwrite.toggled.connect(self._judge)
        self._judge()

    def value(self) -> ExportRequest:
        """Folder and options."""
        options = DatasetOptions(name=self.name.text().strip(), overwrite=self.overwrite.isChecked())
        return ExportRequest(Path(self.folder.text().strip()).expanduser(), options)

    def show_task(self, task: Task) -> None:
        """Show how far the work is."""
        self.bar.setRange(0, task.total)
        self.bar.setValue(task.done)
        steps = tr("{at} of {total}", at=task.done, total=task.total)
        self.state.setText(f"{tr(task.title)}: {steps} {task.message}".strip())

    def finish(self) -> None:
        """The dataset is written, or the work has ended otherwise."""
        self._running = False
        self.accept()

    def reject(self) -> None:
        """Stop the work, and close."""
        if self._running:
            self._running = False
            self.stopped.emit()
        super().reject()

    def _arrange(self, rows: list[tuple[str, str]], buttons: QDialogButtonBox) -> None:
        where = QHBoxLayout()
        where.addWidget(self.folder, 1)
        where.addWidget(self.browse)
        form = QFormLayout()
        form.setVerticalSpacing(7)
        for word, text in rows:
            label = QLabel(text)
            label.setWordWrap(True)
            form.addRow(f"{word}:", label)
        form.addRow(tr("Folder:"), where)
        form.addRow(tr("Name:"), self.name)
        form.addRow("", self.overwrite)
        layout = QVBoxLayout(self)
        layout.addLayout(form)
        layout.addWidget(self.state)
        layout.addWidget(self.bar)
        layout.addWidget(buttons)
        self.bar.hide()

    def _judge(self) -> None:
        folder = self.value().folder
        text = self.folder.text().strip()
        used = bool(text) and folder.is_dir() and any(folder.iterdir())
        blocked = folder.is_file() or not text
        self.overwrite.setVisible(used)
        sentence = ""
        if blocked:
            sentence = tr("Enter a new or empty folder.")
        elif used and not self.overwrite.isChecked():
            sentence = tr("The folder is not empty: choose another one, or replace the dataset in it.")
        self.state.setText(sentence)
        self.go.setEnabled(not sentence)

    def _browse(self) -> None:
        chosen = FolderDialog.ask(self, tr("Folder of the dataset"), self.folder.text())
        if chosen:
            self.folder.setText(chosen)

    def _start(self) -> None:
        self._running = True
        for widget in (self.folder, self.browse, self.name, self.overwrite, self.go):
            widget.setEnabled(False)
        self.bar.setRange(0, 0)
        self.bar.show()
        self.state.setText(tr("Starting …"))
        self.started.emit(self.value())


def facet_limit_text(choices: Choices) -> str:
    """What each polyhedron will have, to be put behind a heading."""
    if choices.stop_at == "error":
        limit = number_text(100 * choices.largest_error, "g")
        return tr("the fewest facets with all errors below {limit} %", limit=limit)
    faces = choices.facet_count
    return tr("at most {faces} facets, {triangles} triangles", faces=faces, triangles=4 * faces - 12)
