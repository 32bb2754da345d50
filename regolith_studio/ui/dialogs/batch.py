"""Dialogs of runs of their own: their fields and progress; those of a batch and of a report."""

import dataclasses
import html
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

from PySide6.QtCore import QSize, Qt, QUrl, Signal
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import (
    QCheckBox,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QGridLayout,
    QLabel,
    QLineEdit,
    QProgressBar,
    QPushButton,
    QWidget,
)

from regolith_studio.coarsening.methods import METHODS
from regolith_studio.coarsening.weights import presets
from regolith_studio.errors import InputError
from regolith_studio.jobs.executor import TLS_NAMES, ExecutorSettings
from regolith_studio.jobs.runners.dask_cluster import parsed_address
from regolith_studio.jobs.runners.process_pool import cores
from regolith_studio.messages import N_
from regolith_studio.session.batch_job import ExecutorReady, is_unfinished
from regolith_studio.session.choices import Choices
from regolith_studio.session.recipe import Outputs
from regolith_studio.session.report.settings import PAGE, ReportSettings, SectionBegun
from regolith_studio.session.tasks import Task
from regolith_studio.ui.dialogs.files import FolderDialog
from regolith_studio.ui.layout import STRETCH, GrowingDialog, hbox, named, vbox
from regolith_studio.ui.translation import Markup, tr, tr_count
from regolith_studio.ui.widgets.fields import choice, show_whole, whole_field
from regolith_studio.ui.widgets.forms import SettingsForm
from regolith_studio.ui.widgets.labels import hint_label

PLACES = {
    "processes": N_("Processes of this machine"),
    "local": N_("A Dask cluster started on this machine"),
    "address": N_("A Dask cluster at an address"),
}


class PathField(QWidget):
    """A path with a button that asks for it."""

    changed = Signal()

    def __init__(self, name: str, title: str, *, folder: bool, filter: str = "") -> None:
        super().__init__()
        self._title, self._folder, self._filter = title, folder, filter
        self.text = named(QLineEdit(), name, title)
        self.browse = QPushButton(tr("Browse …"))
        hbox((self.text, 1), self.browse, parent=self)
        self.browse.clicked.connect(self._ask)
        self.text.textChanged.connect(self.changed)

    def value(self) -> Path | None:
        """The path; ``None`` where there is none."""
        text = self.text.text().strip()
        return Path(text).expanduser() if text else None

    def setValue(self, path: Path | None) -> None:
        self.text.setText("" if path is None else str(path))

    def _ask(self) -> None:
        if self._folder:
            name = FolderDialog.ask(self, self._title, self.text.text())
        else:
            name, _ = QFileDialog.getOpenFileName(self, self._title, self.text.text(), self._filter)
        if name:
            self.text.setText(name)


class SourceField(QWidget):
    """The open particles with the present choices, or a recipe file."""

    changed = Signal()

    def __init__(self, count: int, unsaved: int) -> None:
        super().__init__()
        self._count = count - unsaved
        ours = tr("The files of the {count} open particles, as chosen now", count=self._count)
        self.kind = choice("batch_source", tr("Recipe"), {"open": ours, "file": N_("A recipe file")})
        kinds = tr("Recipes (*.json)")
        self.file = PathField("batch_recipe", tr("Recipe"), folder=False, filter=kinds)
        left_out = tr(
            "{count} of the open particles come from no file and cannot be part of a batch.", count=unsaved
        )
        self.missing = hint_label(left_out, "warning")
        vbox(self.kind, self.file, self.missing, parent=self)
        self.kind.currentIndexChanged.connect(self._changed)
        self.file.changed.connect(self._changed)
        self.kind.setCurrentIndex(0 if self._count else 1)
        self._unsaved = unsaved
        self._changed()

    def value(self) -> Path | None:
        """The file; ``None`` for the open particles."""
        return (self.file.value() or Path()) if self.kind.value() == "file" else None

    def checked(self) -> Path | None:
        """As :meth:`value`."""
        path = self.value()
        if path is None and self._count < 1:
            raise InputError(tr("No open particle comes from a file: open some, or choose a recipe file."))
        if path is not None and not path.is_file():
            raise InputError(tr("Choose a recipe file."))
        return path

    def _changed(self) -> None:
        ours = self.kind.value() == "open"
        self.file.setVisible(not ours)
        self.missing.setVisible(ours and self._unsaved > 0)
        self.changed.emit()


class WorkersField(QWidget):
    """Edits :class:`ExecutorSettings`."""

    changed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.executor = choice("batch_place", tr("Run on"), PLACES)
        self.count = whole_field("batch_workers", tr("Number of processes"), 1, 1024, cores())
        self.address = named(QLineEdit(), "batch_address", tr("Address of the scheduler"))
        self.address.setPlaceholderText(tr("tcp://HOST:8786 or tls://HOST:8786"))
        names = ", ".join(TLS_NAMES)
        self.tls = PathField("batch_tls", tr("Folder with {names}", names=names), folder=True)
        self.tls.text.setPlaceholderText(tr("folder with {names}", names=names))
        self._form = QFormLayout(self)
        self._form.setContentsMargins(0, 0, 0, 0)
        self._form.addRow(self.executor)
        self._form.addRow(tr("Processes"), self.count)
        self._form.addRow(tr("Scheduler"), self.address)
        self._form.addRow(tr("Certificates"), self.tls)
        self.executor.currentIndexChanged.connect(self._changed)
        self.count.valueChanged.connect(self._changed)
        self.address.textChanged.connect(self._changed)
        self.tls.changed.connect(self._changed)
        self._changed()

    def value(self) -> ExecutorSettings:
        executor = self.executor.value()
        if executor == "processes":
            return ExecutorSettings("processes", self.count.value())
        if executor == "local":
            return ExecutorSettings("dask", self.count.value())
        address = parsed_address(self.address.text())
        encrypted = address.startswith("tls:")
        tls = self.tls.value() if encrypted else None
        missing = [name for name in TLS_NAMES if tls and not (tls / name).is_file()]
        if encrypted and (tls is None or missing):
            names = ", ".join(TLS_NAMES)
            raise InputError(tr("An encrypted cluster needs a folder with {names}.", names=names))
        return ExecutorSettings("dask", 0, address, tls)

    def field_values(self) -> dict[str, str]:
        """For the next start."""
        tls = self.tls.text.text()
        return {"place": self.executor.value(), "address": self.address.text(), "tls": tls}

    def restore_fields(self, values: Mapping[str, Any]) -> None:
        self.executor.choose(values.get("place"))
        self.address.setText(str(values.get("address", "")))
        self.tls.text.setText(str(values.get("tls", "")))

    def _changed(self) -> None:
        remote = self.executor.value() == "address"
        encrypted = self.address.text().strip().startswith("tls://")
        self._form.setRowVisible(self.count, not remote)
        self._form.setRowVisible(self.address, remote)
        self._form.setRowVisible(self.tls, remote and encrypted)
        self.changed.emit()


class RunDialog(GrowingDialog):
    """Asks, then shows the progress; closing it stops nothing.

    Emits ``started`` with the request, and ``stopped``. A dialog calls :meth:`evaluate` where its value may
    have changed.

    - ``name``: begins the names of its widgets.
    - ``folder``: suggested for the results.
    - ``page``: of the results, which the last button opens.
    """

    started = Signal(object)
    stopped = Signal()

    def __init__(self, name: str, title: str, folder: Path, page: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(title)
        self.setObjectName(f"{name}_dialog")
        self._page, self._running = page, False
        self._fields: tuple[QWidget, ...] = ()
        self.folder = PathField(f"{name}_folder", tr("Folder of the results"), folder=True)
        self.folder.setValue(folder)
        self.folder.changed.connect(self.evaluate)
        self.state = hint_label()
        self.state.setObjectName(f"{name}_state")
        self.bar = named(QProgressBar(), spoken=tr("Progress"))
        self.box = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, parent=self)
        role = QDialogButtonBox.ButtonRole.ActionRole
        self.go = self.box.addButton(tr("Run"), role)
        self.halt = self.box.addButton(tr("Stop"), role)
        self.results_button = self.box.addButton(tr("Open the results"), role)
        for part, button in (("go", self.go), ("stop", self.halt), ("results", self.results_button)):
            button.setObjectName(f"{name}_{part}")
        self.go.setDefault(True)
        self.go.clicked.connect(self._start)
        self.halt.clicked.connect(self.stopped.emit)
        self.results_button.clicked.connect(self._open_results)
        self.box.rejected.connect(self.close)

    def sizeHint(self) -> QSize:
        """No narrower than this: a minimum width would take the place of that of the fields."""
        return super().sizeHint().expandedTo(QSize(600, 0))

    def value(self) -> Any:
        raise NotImplementedError

    def field_values(self) -> dict[str, Any]:
        """What the next dialog may suggest, as plain JSON."""
        raise NotImplementedError

    def restore_fields(self, values: Mapping[str, Any]) -> None:
        """Suggest what was given before; what is not understood is left out."""
        raise NotImplementedError

    def show_task(self, task: Task) -> None:
        self.bar.setRange(0, task.total)
        self.bar.setValue(task.done)
        count = tr("{at:,} of {total:,}", at=task.done, total=task.total) if task.total else ""
        self.state.setText(", ".join(filter(None, [f"{tr(task.title)} {count}".strip(), task.message])))

    def show_partial(self, value: object) -> None:
        """Show a partial result of the work."""

    def finish(self, sentence: str, done: bool = False) -> None:
        """The work has ended, in whichever way; the fields can be edited again."""
        self._set_running(False)
        self.evaluate()
        self.state.setText(sentence)
        self.results_button.setVisible(done)

    def arrange(self, form: QFormLayout, *below: QWidget, fields: tuple[QWidget, ...]) -> None:
        """Place the form, what stands below it, and the progress; `fields` are disabled while it runs."""
        self._fields = fields
        form.setVerticalSpacing(7)
        vbox(form, *below, STRETCH, self.state, self.bar, self.box, parent=self, margins=None)
        show_whole(self)
        for hidden in (self.bar, self.halt, self.results_button):
            hidden.hide()

    def evaluate(self) -> None:
        """Say what is missing, and allow to run where nothing is."""
        if self._running:
            return
        self.results_button.hide()
        try:
            self.value()
        except InputError as error:
            sentence = str(error)
        else:
            sentence = ""
        self.state.setText(sentence)
        self.go.setEnabled(not sentence)

    def _set_running(self, running: bool) -> None:
        self._running = running
        for widget in (self.folder, *self._fields, self.go):
            widget.setEnabled(not running)
        self.halt.setVisible(running)
        self.bar.setVisible(running)

    def _start(self) -> None:
        request = self.value()
        self._set_running(True)
        self.results_button.hide()
        self.bar.setRange(0, 0)
        self.state.setText(tr("Starting …"))
        self.started.emit(request)

    def _open_results(self) -> None:
        folder = self.folder.value()
        if folder is not None:
            page = folder / self._page
            QDesktopServices.openUrl(QUrl.fromLocalFile(str(page if page.is_file() else folder)))


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

    - ``recipe``: file; ``None`` for the open particles and the present choices.
    - ``folder``: where the results go.
    - ``resume``: whether to go on with the run that has not ended there.
    - ``outputs``: what is written; a recipe file says that itself.
    - ``executor``: who works.
    """

    recipe: Path | None
    folder: Path
    resume: bool
    outputs: Outputs
    executor: ExecutorSettings


class BatchDialog(RunDialog):
    """Edits a :class:`BatchRequest`.

    ``count``, ``unsaved``: open particles, and those of them that came from no file. ``folder``: suggested
    for the results.
    """

    def __init__(self, count: int, unsaved: int, folder: Path, parent: QWidget | None = None) -> None:
        super().__init__("batch", tr("Run as a batch"), folder, "summary.html", parent)
        self.source = SourceField(count, unsaved)
        self.results = {key: QCheckBox(tr(label)) for key, label in RESULTS.items()}
        for key, box in self.results.items():
            box.setObjectName(f"batch_{key}")
            box.setChecked(getattr(Outputs(), key))
        self.resume = named(QCheckBox(tr("Resume the unfinished run")), "batch_resume")
        self.resume.setChecked(True)
        self.workers = WorkersField()
        self.dashboard = named(QLabel(), "batch_dashboard")
        self.dashboard.setOpenExternalLinks(True)
        self.dashboard.setTextInteractionFlags(Qt.TextInteractionFlag.TextBrowserInteraction)
        self.dashboard.hide()
        self._place()
        for changed in (self.source.changed, self.workers.changed):
            changed.connect(self.evaluate)
        for box in (*self.results.values(), self.resume):
            box.toggled.connect(self.evaluate)
        self.started.connect(self.dashboard.hide)
        self.evaluate()

    def value(self) -> BatchRequest:
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

    def evaluate(self) -> None:
        """Offer what suits folder and source, and say what is missing."""
        if not self._running:
            folder = self.folder.value()
            self.resume.setVisible(folder is not None and is_unfinished(folder))
            for box in self.results.values():
                box.setEnabled(self.source.value() is None)
        super().evaluate()

    def _place(self) -> None:
        grid = QGridLayout()
        grid.setHorizontalSpacing(2 * self.fontMetrics().averageCharWidth())
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
        self.arrange(form, hint_label(promise), self.dashboard, fields=fields)


@dataclass(frozen=True)
class ReportRequest:
    """The settings of the dialog.

    ``folder``: of the report. ``workers``: processes at a time.
    """

    folder: Path
    settings: ReportSettings
    workers: int


class ReportDialog(RunDialog):
    """Edits a :class:`ReportRequest` for so many particles; begins with what is chosen in the window."""

    def __init__(self, count: int, choices: Choices, folder: Path, parent: QWidget | None = None) -> None:
        super().__init__("report", tr("Report"), folder, PAGE, parent)
        self._count = count
        labels = {
            "method": {key: method.label for key, method in METHODS.items()},
            "preset": {key: preset.label for key, preset in presets().items()},
        }
        self.form = SettingsForm(ReportSettings, labels)
        self.form.setValue(
            {
                "l_max": choices.l_max,
                "facets": choices.facet_count,
                "method": choices.method,
                "preset": choices.preset,
                "seed": choices.seed,
            }
        )
        self.workers = whole_field("report_workers", tr("Number of processes"), 1, 1024, cores())
        self.section = named(QLabel(), "report_section")
        self.section.hide()
        self.form.valueChanged.connect(self.evaluate)
        self._place()
        self.evaluate()

    def value(self) -> ReportRequest:
        if not self._count:
            raise InputError(tr("No particle is open to report on: open one first."))
        folder = self.folder.value()
        if folder is None or folder.is_file():
            raise InputError(tr("Enter a folder for the results."))
        settings: dict[str, Any] = dict(self.form.value())
        return ReportRequest(folder, ReportSettings(**settings), self.workers.value())

    def field_values(self) -> dict[str, Any]:
        """What the next dialog may suggest, as plain JSON: what is not chosen in the window anyway."""
        kept = ("study_particles", "drawn", "splits", "representatives", "heap")
        return {name: value for name, value in self.form.value().items() if name in kept}

    def restore_fields(self, values: Mapping[str, Any]) -> None:
        """Suggest what was given before; what is not understood is left out."""
        known = {each.name: each for each in dataclasses.fields(ReportSettings)}
        numbers = {name: value for name, value in values.items() if type(value) is int and name in known}
        self.form.setValue(self.form.value() | numbers)
        self.evaluate()

    def show_partial(self, value: object) -> None:
        if isinstance(value, SectionBegun):
            place = tr("Section {number} of {total}", number=value.number, total=value.total)
            self.section.setText(f"{place}: {tr(value.title)}")
            self.section.show()

    def finish(self, sentence: str, done: bool = False) -> None:
        """The report is written, or the work has ended otherwise."""
        self.section.hide()
        super().finish(sentence, done)

    def _place(self) -> None:
        rows = cast(QFormLayout, self.form.layout())
        sample = tr_count(N_("1 open particle"), N_("{count:,} open particles"), self._count)
        rows.insertRow(0, tr("Sample"), QLabel(sample))
        rows.addRow(tr("Folder of the results"), self.folder)
        rows.addRow(tr("Number of processes"), self.workers)
        form = QFormLayout()
        form.addRow(self.form)
        contents = tr(
            "Figs. 2 to 9 and Tables 1 and 2 of the paper for the open particles, as one HTML page and "
            "tables. The command “report” writes the same."
        )
        self.arrange(form, hint_label(contents), self.section, fields=(self.form,))
