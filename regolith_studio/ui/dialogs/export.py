"""Dialog of the export of a dataset: content and folder, then its progress."""

import contextlib
import os
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
from regolith_studio.dataset.folder_io import DOCUMENT
from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.jobs.dataset_jobs import DatasetOptions
from regolith_studio.session.choices import Choices
from regolith_studio.session.tasks import Task
from regolith_studio.ui.dialogs.folder import FolderDialog
from regolith_studio.ui.translation import Markup, number_text, rich, tr
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
            target = Markup(f"{rich(target)}<br>{rich(choices.selected)}: {rich(cost)}")
    size = count * (84 + 50 * (4 * choices.facet_count - 12)) / 1024
    files = tr("{count}, as unit-volume STL files, {size:,.0f} KiB in all", count=count, size=size)
    if choices.stop_at == "error":
        files = tr("{count}, as unit-volume STL files", count=count)
    method = tr("{method}, seed {seed}", method=tr(METHODS[choices.method].label), seed=choices.seed)
    return [
        (tr("Particles"), files),
        (tr("Polyhedra"), facet_limit_text(choices)),
        (tr("Target"), target),
        (tr("Method"), method),
        (tr("Weights"), (weights or tr("none")) + f" ({rich(preset)})"),
        (tr("Additional files"), tr("weights, size distribution, descriptors, provenance (JSON)")),
    ]


def folder_problem(folder: Path, overwrite: bool) -> str:
    """Why a dataset cannot be written there, as one sentence, or nothing.

    Parameters
    ----------
    overwrite
        Whether a dataset that is there may be replaced.
    """
    try:
        place = next(each for each in (folder, *folder.parents) if each.exists())
    except OSError:  # a name that is too long
        place = Path()
    if not folder.is_absolute() or not place.is_absolute():
        return tr("Enter the full path of a new or empty folder.")
    if not place.is_dir():
        return tr("{path} is a file: enter a new or empty folder.", path=place)
    if not os.access(place, os.R_OK | os.W_OK | os.X_OK):
        return tr("Nothing can be written into {path}: choose another folder.", path=place)
    if place != folder or not any(folder.iterdir()):
        return ""
    if not (folder / DOCUMENT).is_file():
        return tr("The folder is not empty and contains no dataset: choose another one.")
    if not overwrite:
        return tr("The folder holds a dataset: choose another one, or tick that it is replaced.")
    return ""


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
        self.name.setPlaceholderText(tr("name of the folder"))
        self.overwrite = QCheckBox(tr("Replace the dataset that is there"))
        self.overwrite.setObjectName("export_overwrite")
        self.state = remark()
        self.bar = QProgressBar()
        self.bar.setAccessibleName(tr("Progress of the export"))
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel, parent=self)
        self.cancel = buttons.button(QDialogButtonBox.StandardButton.Cancel)
        self.go = buttons.addButton(tr("Export"), QDialogButtonBox.ButtonRole.AcceptRole)
        self.go.setObjectName("export_go")
        layout = self._arrange(summary(count, choices, cost), buttons)
        self.go.setDefault(True)
        buttons.accepted.connect(self._start)
        buttons.rejected.connect(self.reject)
        self.browse.clicked.connect(self._browse)
        self.folder.textChanged.connect(self._judge)
        self.overwrite.toggled.connect(self._judge)
        self._judge()
        self.resize(self.minimumWidth(), layout.heightForWidth(self.minimumWidth()))

    def value(self) -> ExportRequest:
        """Folder and options."""
        options = DatasetOptions(name=self.name.text().strip(), overwrite=self.overwrite.isChecked())
        folder = Path(self.folder.text().strip())
        with contextlib.suppress(RuntimeError):  # there is no such user
            folder = folder.expanduser()
        return ExportRequest(folder, options)

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

    def _arrange(self, rows: list[tuple[str, str]], buttons: QDialogButtonBox) -> QVBoxLayout:
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
        return layout

    def _judge(self) -> None:
        folder = self.value().folder
        sentence = folder_problem(folder, self.overwrite.isChecked())
        self.overwrite.setVisible(folder_problem(folder, True) != folder_problem(folder, False))
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
