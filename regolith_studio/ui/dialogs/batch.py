"""Dialog of a batch run, on this machine or on a cluster: outputs, folder, workers; then its progress."""

import html
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QCheckBox, QFormLayout, QGridLayout, QLabel, QWidget

from regolith_studio.errors import InputError
from regolith_studio.jobs.executor import ExecutorSettings
from regolith_studio.messages import N_
from regolith_studio.session.batch_job import ExecutorReady, is_unfinished
from regolith_studio.session.recipe import Outputs
from regolith_studio.ui.dialogs.batch_fields import SourceField, WorkersField
from regolith_studio.ui.dialogs.run_dialog import RunDialog
from regolith_studio.ui.translation import tr, tr_count
from regolith_studio.ui.translation.plain_text import Markup
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


class BatchDialog(RunDialog):
    """Edits a :class:`BatchRequest`.

    Parameters
    ----------
    count, unsaved
        Open particles, and those of them that came from no file.
    folder
        Suggested for the results.
    """

    def __init__(self, count: int, unsaved: int, folder: Path, parent: QWidget | None = None) -> None:
        super().__init__("batch", tr("Run as a batch"), folder, "summary.html", parent)
        self.source = SourceField(count, unsaved)
        self.results = {key: QCheckBox(tr(label)) for key, label in RESULTS.items()}
        for key, box in self.results.items():
            box.setObjectName(f"batch_{key}")
            box.setChecked(getattr(Outputs(), key))
        self.resume = QCheckBox(tr("Resume the unfinished run"))
        self.resume.setObjectName("batch_resume")
        self.resume.setChecked(True)
        self.workers = WorkersField()
        self.dashboard = QLabel()
        self.dashboard.setObjectName("batch_dashboard")
        self.dashboard.setOpenExternalLinks(True)
        self.dashboard.setTextInteractionFlags(Qt.TextInteractionFlag.TextBrowserInteraction)
        self.dashboard.hide()
        self._place()
        for changed in (self.source.changed, self.workers.changed):
            changed.connect(self.judge)
        for box in (*self.results.values(), self.resume):
            box.toggled.connect(self.judge)
        self.started.connect(self.dashboard.hide)
        self.judge()

    def value(self) -> BatchRequest:
        """The request.

        Raises
        ------
        InputError
            If it cannot be given yet, saying why.
        """
        folder = self.folder.value()
        if folder is None or folder.is_file():
            raise InputError(tr("Enter a folder for the results."))
        outputs = Outputs(**{key: box.isChecked() for key, box in self.results.items()})
        if self.source.value() is None and not any(box.isChecked() for box in self.results.values()):
            raise InputError(tr("Select at least one result to write."))
        source, workers = self.source.checked(), self.workers.value()
        resume = is_unfinished(folder) and self.resume.isChecked()
        if is_unfinished(folder) and not resume:
            raise InputError(
                tr("The folder contains an unfinished run: resume it, or choose another folder.")
            )
        return BatchRequest(source, folder, resume, outputs, workers)

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

    def show_partial(self, value: object) -> None:
        """Say who works, and where that can be watched."""
        if not isinstance(value, ExecutorReady):
            return
        who = tr_count(N_("1 worker"), N_("{count} workers"), value.workers)
        address = html.escape(value.dashboard)
        link = Markup(f'<a href="{address}">{address}</a>')
        self.dashboard.setText(
            tr("{who}, dashboard at {link}", who=who, link=link) if value.dashboard else who
        )
        self.dashboard.show()

    def finish(self, sentence: str, done: bool = False) -> None:
        """The batch has ended, in whichever way."""
        self.dashboard.hide()
        super().finish(sentence, done)

    def judge(self) -> None:
        """Offer what suits folder and source, and say what is missing."""
        if not self._running:
            folder = self.folder.value()
            self.resume.setVisible(folder is not None and is_unfinished(folder))
            for box in self.results.values():
                box.setEnabled(self.source.value() is None)
        super().judge()

    def _place(self) -> None:
        grid = QGridLayout()
        for at, box in enumerate(self.results.values()):
            grid.addWidget(box, at // 3, at % 3)
        form = QFormLayout()
        form.addRow(tr("Recipe:"), self.source)
        form.addRow(tr("Write:"), grid)
        form.addRow(tr("Folder:"), self.folder)
        form.addRow("", self.resume)
        form.addRow(tr("Run on:"), self.workers)
        promise = tr(
            "The results do not depend on the number of processes, and a stopped run can be resumed."
        )
        fields = (self.source, self.resume, self.workers, *self.results.values())
        self.arrange(form, remark(promise), self.dashboard, fields=fields)
