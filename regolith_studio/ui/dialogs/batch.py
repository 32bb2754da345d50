"""Dialog of a batch run, on this machine or on a cluster: outputs, folder, workers; then its progress."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt, QUrl, Signal
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QGridLayout,
    QLabel,
    QProgressBar,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.errors import InputError
from regolith_studio.jobs.executor import ExecutorSettings
from regolith_studio.messages import N_
from regolith_studio.session.batch_job import ExecutorReady, is_unfinished
from regolith_studio.session.recipe import Outputs
from regolith_studio.session.tasks import Task
from regolith_studio.ui.dialogs.batch_fields import PathField, SourceField, WorkersField
from regolith_studio.ui.translation import tr, tr_count
from regolith_studio.ui.widgets.labels import remark

RESULTS = {
    "descriptors": N_("Descriptors"),
    "fits": N_("Fits"),
    "meshes": N_("Polyhedra (STL)"),
    "dataset": N_("Dataset"),
    "lmax_study": N_("Study of the degree"),
    "coarsening_study": N_("Study of the coarsening"),
    "summary": N_("Report (HTML)"),
}


@dataclass(frozen=True)
class BatchRequest:
    """The settings of the dialog.

    Parameters
    ----------
    recipe
        File; ``None`` for the open particles and the present choices.
    folder
        Where the results go.
    resume
        Whether to go on with the run that has not ended there.
    outputs
        What is written; a recipe file says that itself.
    executor
        Who works.
    """

    recipe: Path | None
    folder: Path
    resume: bool
    outputs: Outputs
    executor: ExecutorSettings


class BatchDialog(QDialog):
    """Asks, then shows the progress; closing it stops nothing.

    Emits ``started`` with the order, and ``stopped``.
    """

    started = Signal(object)
    stopped = Signal()

    def __init__(self, count: int, unsaved: int, folder: Path, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Run as a batch"))
        self.setObjectName("batch_dialog")
        self.setMinimumWidth(600)
        self._running = False
        self.source = SourceField(count, unsaved)
        self.folder = PathField("batch_folder", tr("Folder of the results"), folder=True)
        self.folder.setValue(folder)
        self.results = {key: QCheckBox(tr(label)) for key, label in RESULTS.items()}
        for key, box in self.results.items():
            box.setObjectName(f"batch_{key}")
            box.setChecked(getattr(Outputs(), key))
        self.resume = QCheckBox(tr("Resume the unfinished run"))
        self.resume.setObjectName("batch_resume")
        self.resume.setChecked(True)
        self.workers = WorkersField()
        self.state, self.dashboard = remark(), QLabel()
        self.state.setObjectName("batch_state")
        self.dashboard.setObjectName("batch_dashboard")
        self.dashboard.setOpenExternalLinks(True)
        self.dashboard.setTextInteractionFlags(Qt.TextInteractionFlag.TextBrowserInteraction)
        self.bar = QProgressBar()
        self.bar.setAccessibleName(tr("Progress of the batch"))
        self._buttons()
        self._arrange()
        for changed in (self.source.changed, self.folder.changed, self.workers.changed):
            changed.connect(self._judge)
        for box in (*self.results.values(), self.resume):
            box.toggled.connect(self._judge)
        self._judge()

    def value(self) -> BatchRequest:
        """The order.

        Raises
        ------
        InputError
            If it cannot be given yet, saying why.
        """
        folder = self.folder.value()
        if folder is None or folder.is_file():
            raise InputError(tr("Name a folder for the results."))
        outputs = Outputs(**{key: box.isChecked() for key, box in self.results.items()})
        if self.source.value() is None and not any(box.isChecked() for box in self.results.values()):
            raise InputError(tr("Choose what is to be written."))
        resume = is_unfinished(folder) and self.resume.isChecked()
        return BatchRequest(self.source.checked(), folder, resume, outputs, self.workers.value())

    def field_values(self) -> dict[str, Any]:
        """What the next dialog may suggest, as plain JSON."""
        results = [key for key, box in self.results.items() if box.isChecked()]
        return {"results": results, "workers": self.workers.field_values()}

    def restore_fields(self, values: Mapping[str, Any]) -> None:
        """Suggest what was given before; what is not understood is left out."""
        if isinstance(results := values.get("results"), list):
            for key, box in self.results.items():
                box.setChecked(key in results)
        if isinstance(workers := values.get("workers"), dict):
            self.workers.restore_fields(workers)

    def show_task(self, task: Task) -> None:
        """Show how far the work is."""
        self.bar.setRange(0, task.total)
        self.bar.setValue(task.done)
        count = tr("{at:,} of {total:,}", at=task.done, total=task.total) if task.total else ""
        self.state.setText(", ".join(filter(None, [f"{tr(task.title)} {count}".strip(), task.message])))

    def show_executor(self, executor: ExecutorReady) -> None:
        """Say who works, and where that can be watched."""
        who = tr_count(N_("1 worker"), N_("{count} workers"), executor.workers)
        link = f'<a href="{executor.dashboard}">{executor.dashboard}</a>'
        self.dashboard.setText(
            tr("{who}, dashboard at {link}", who=who, link=link) if executor.dashboard else who
        )
        self.dashboard.show()

    def finish(self, sentence: str, report: bool = False) -> None:
        """The work has ended, in whichever way; the fields can be edited again."""
        self._set_running(False)
        self.dashboard.hide()
        self._judge()
        self.state.setText(sentence)
        self.report.setVisible(report)

    def _buttons(self) -> None:
        self.box = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, parent=self)
        self.go = self.box.addButton(tr("Run"), QDialogButtonBox.ButtonRole.ActionRole)
        self.halt = self.box.addButton(tr("Stop"), QDialogButtonBox.ButtonRole.ActionRole)
        self.report = self.box.addButton(tr("Open the results"), QDialogButtonBox.ButtonRole.ActionRole)
        for name, button in (("go", self.go), ("stop", self.halt), ("results", self.report)):
            button.setObjectName(f"batch_{name}")
        self.go.setDefault(True)
        self.go.clicked.connect(self._start)
        self.halt.clicked.connect(self.stopped.emit)
        self.report.clicked.connect(self._open_results)
        self.box.rejected.connect(self.close)

    def _arrange(self) -> None:
        grid = QGridLayout()
        for at, box in enumerate(self.results.values()):
            grid.addWidget(box, at // 3, at % 3)
        form = QFormLayout()
        form.setVerticalSpacing(7)
        form.addRow(tr("Recipe:"), self.source)
        form.addRow(tr("Write:"), grid)
        form.addRow(tr("Into:"), self.folder)
        form.addRow("", self.resume)
        form.addRow(tr("Run on:"), self.workers)
        layout = QVBoxLayout(self)
        layout.addLayout(form)
        promise = tr(
            "The results do not depend on the number of processes, and a stopped run can be resumed."
        )
        layout.addWidget(remark(promise))
        layout.addStretch(1)
        for widget in (self.state, self.dashboard, self.bar, self.box):
            layout.addWidget(widget)
        for hidden in (self.bar, self.dashboard, self.halt, self.report):
            hidden.hide()

    def _judge(self) -> None:
        if self._running:
            return
        folder = self.folder.value()
        self.resume.setVisible(folder is not None and is_unfinished(folder))
        for box in self.results.values():
            box.setEnabled(self.source.value() is None)
        self.report.hide()
        try:
            request = self.value()
        except InputError as error:
            sentence = str(error)
        else:
            blocked = is_unfinished(request.folder) and not request.resume
            begun = tr("The folder contains an unfinished run: resume it, or choose another folder.")
            sentence = begun if blocked else ""
        self.state.setText(sentence)
        self.go.setEnabled(not sentence)

    def _set_running(self, running: bool) -> None:
        self._running = running
        fields = (self.source, self.folder, self.resume, self.workers, self.go, *self.results.values())
        for widget in fields:
            widget.setEnabled(not running)
        self.halt.setVisible(running)
        self.bar.setVisible(running)

    def _start(self) -> None:
        request = self.value()
        self._set_running(True)
        self.report.hide()
        self.dashboard.hide()
        self.bar.setRange(0, 0)
        self.state.setText(tr("Starting …"))
        self.started.emit(request)

    def _open_results(self) -> None:
        folder = self.folder.value()
        if folder is not None:
            page = folder / "summary.html"
            QDesktopServices.openUrl(QUrl.fromLocalFile(str(page if page.is_file() else folder)))
