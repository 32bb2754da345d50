"""The page: finds representatives, builds, checks and exports a dataset."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt, QUrl
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget

from regolith_studio.dataset.build import singleton_class
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import ExportOptions, ExportResult
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dataset.lifting_cylinder import CylinderFilling
from regolith_studio.dataset.representatives import QualityPoint
from regolith_studio.dataset.size_distributions import ShapeClass
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.dataset_jobs import (
    ChosenParticles,
    DatasetBuildResult,
    DatasetOptions,
    RepresentativesSurvey,
    build_dataset_folder,
    choose_job,
    export_dataset_folder,
    open_dataset_folder,
    survey_representatives,
    validate_dataset_folder,
)
from regolith_studio.jobs.events import Failed, Job
from regolith_studio.messages import N_
from regolith_studio.session.project import fingerprint
from regolith_studio.session.recipe import DatasetRequest
from regolith_studio.ui.dialogs.files import FolderDialog
from regolith_studio.ui.layout import (
    FoldingSplitter,
    equal_parts,
    framed,
    hbox,
    scrolled,
    stacked,
    tabs,
    vbox,
)
from regolith_studio.ui.page import PageContext, PageWidget, ValuePanel
from regolith_studio.ui.pages.dataset.controls import (
    DatasetControls,
    FolderPanel,
    RepresentativesPanel,
    SizesPanel,
)
from regolith_studio.ui.pages.dataset.export_panel import (
    DatasetCard,
    ExportPanel,
    ExportsList,
    LossesLabel,
    entry_of,
    export_of,
    filling_of,
)
from regolith_studio.ui.pages.dataset.views import (
    SHAPE_FIELDS,
    SIZE,
    QualityPlot,
    RepresentativesGallery,
    SizesPlot,
    chosen_particles,
    coarsening_text,
    dataset_title,
    provenance_text,
    shapes,
)
from regolith_studio.ui.result_card import ResultRecord, ResultState, failed_record
from regolith_studio.ui.translation import tr, tr_count

FIND, BUILD, EXPORT = "find", "build", "export"
PROPOSED = "regolith-dem"
"""Folder in that of the user which the first export proposes."""
SETTINGS = (*SHAPE_FIELDS, *("weights", "settings", "seed", "target", "l_max", "level", "fit_options"))
"""Choices that the shapes of a dataset depend on."""
MAX_MEASURED = 1000
"""Number of particles up to which measured sizes are drawn: volumes are computed in the GUI thread, .14 s for
1,000 meshes of 1,280 triangles, and number and median size of a case 75 ms."""


class DatasetPage(PageWidget):
    """Starts jobs for representatives, datasets and exports, and shows their results."""

    def __init__(self, context: PageContext) -> None:
        super().__init__()
        self.setObjectName("dataset")
        self._context = context
        self._particles: tuple[Particle, ...] = ()
        self._survey: RepresentativesSurvey | None = None
        self._chosen: ChosenParticles | None = None
        self._points: list[QualityPoint] = []
        self._dataset: Dataset | None = None
        self._folder: Path | None = None
        self._exports: list[ExportResult] = []
        self._made_with: tuple[Any, ...] | None = None
        self._opened: DatasetRequest | None = None
        self._to_reopen: Mapping[str, Any] | None = None
        self._to_build: tuple[Path, bool, Path | None] | None = None
        self._task = 0  # of the build or export that is running
        self._classes_to_build: list[ShapeClass] = []

    def build(self) -> None:
        self.representatives, self.sizes = RepresentativesPanel(), SizesPanel()
        self.folder, self.targets = FolderPanel(), ExportPanel()
        self.result = DatasetCard()
        self._controls = DatasetControls(self.representatives, self.sizes, self.folder, self.targets)
        self.quality, self.distribution = QualityPlot(), SizesPlot()
        self.gallery, self.losses, self.exports = RepresentativesGallery(), LossesLabel(), ExportsList()
        self._place()
        self._connect()
        self._context.bindings.refresh("particles", self._show_particles, keeps_particles=True)
        self._context.bindings.refresh("choices", self._show_choices, SETTINGS, slow=True)
        self._context.bindings.refresh("opened_request", self._take_opened)
        self._context.bindings.refresh("tasks", self._follow, slow=True)
        self._show_losses()
        self._forget_dataset()
        self._enable_export()

    # --- the page of the window ----------------------------------------------------------------

    def commands(self) -> Mapping[str, Callable[..., object]]:
        return {
            "find": self.find_representatives,
            "open_dataset": self.open_dataset,
            "validate": self.validate,
            "export": self.export,
            "formats": lambda: self._controls.go_to_formats(),
        }

    def panels(self) -> Mapping[str, ValuePanel]:
        return {"representatives": self.representatives, "export": self.targets}

    def settings(self) -> dict[str, Any]:
        return super().settings() | {"sizes": self.sizes.text(), "name": self.folder.name.text()}

    def state(self) -> dict[str, Any]:
        made: dict[str, Any] = {"found": True} if self._survey is not None else {}
        if self._folder is not None:
            document = fingerprint(self._folder / "dataset.json")
            made |= {"folder": str(self._folder), "fingerprint": document, "current": self._is_current()}
            made["exports"] = [entry_of(one) for one in self._exports]
        return self.settings() | {"made": made}

    def resume(self, state: Mapping[str, Any]) -> None:
        made = state.get("made") or {}
        self._show_particles()
        self._to_reopen = made if made.get("folder") else None
        if made.get("found"):
            self._find()
        else:
            self._reopen()

    def _reopen(self) -> None:
        """Show the dataset of a project, which the project names but does not hold, if there is one."""
        made, self._to_reopen = self._to_reopen, None
        if made is None:
            return
        folder = Path(made["folder"])
        if fingerprint(folder / "dataset.json") != made.get("fingerprint"):
            note = tr(
                "The dataset in {folder} has been moved or changed since: build it again.", folder=folder
            )
            self.result.show_record(ResultRecord(state=ResultState.FAILED, note=note))
            return

        def take(answer: tuple[Path, Dataset]) -> None:
            self._take_dataset(*answer)
            self._made_with = self._settings() if made.get("current") else ("others",)
            self._show_exports_again(made.get("exports") or (), answer[1])
            self._show_result()

        job = Job(open_dataset_folder, (folder,))
        self._context.start(tr("Reading the dataset"), job, take, queue=BUILD, repeats=True)

    def _show_exports_again(self, kept: Sequence[Mapping[str, str]], dataset: Dataset) -> None:
        """List the exports of a project that are still where they were, and note the others."""
        for entry in kept:
            if (found := export_of(entry, dataset)) is not None:
                self._exports.append(found)
            else:
                folder = entry["folder"]
                note = tr("The export in {folder} has been moved or changed since.", folder=folder)
                self._context.toast.note(note)
        self.exports.show_exports(self._exports)

    def restore(self, state: Mapping[str, Any]) -> None:
        super().restore(state)
        self.sizes.set_text(str(state.get("sizes", "measured")))
        self.folder.name.setText(str(state.get("name", "regolith")))

    def on_close(self) -> None:
        self.gallery.release()

    # --- commands ------------------------------------------------------------------------------

    def find_representatives(self) -> None:
        """Choose representatives for many numbers, and draw the curve."""
        self._find()

    def _find(self, to_build: tuple[Path, bool, Path | None] | None = None) -> None:
        """Choose representatives; then build their dataset in a folder, if one is given."""
        if not self._particles:
            self._context.toast.problem(tr("There are no particles to choose from: open some first."))
            return
        if self._to_build is not None and to_build is None:
            self._show_stopped()
        self._points, self._to_build = [], to_build
        known = self._survey.population if self._survey else None
        job = Job(survey_representatives, (self._particles, self.representatives.request(), known))
        task = self._context.start(
            tr("Finding representatives"),
            job,
            self._show_survey,
            self._show_point,
            self._show_failure if to_build else None,
            self._show_stopped if to_build else None,
            FIND,
        )
        self._task = task if to_build else self._task

    def build_in(self, folder: Path, overwrite: bool = False, exports: Path | None = None) -> None:
        """Coarsen the representatives, which are found where there are none, and write the dataset.

        ``exports``: folder that the selected formats are written into afterwards; by default none are.
        """
        session, survey_now = self._context.session, self._survey
        if self.sizes.sizing() is None:
            return
        every = self.representatives.every
        self.result.begin(folder)
        if not every and (self._chosen is None or survey_now is None):
            self._find(to_build=(folder, overwrite, exports))
            return
        preset = None if session.choices.preset_modified else session.choices.preset
        options = DatasetOptions(
            self.folder.name.text().strip(),
            preset,
            overwrite=overwrite,
            representatives=None if every else self.representatives.request(),
            sizes=self.sizes.text(),
        )
        population = None if every or survey_now is None else survey_now.population
        arguments = (self._particles, session.choices.coarsening_request, folder, options, population)
        self._context.remember("place", str(folder.parent))
        self._task = self._context.start(
            tr("Building the dataset"),
            Job(build_dataset_folder, arguments),
            lambda built: self._take_built(built, exports),
            failed=self._show_failure,
            stopped=self._show_stopped,
            queue=BUILD,
        )

    def _follow(self) -> None:
        """Show how far a build or an export is."""
        for task in self._context.session.tasks:
            if task.id == self._task:
                self.result.show_task(task)

    def _stop(self) -> None:
        self._context.session.cancel(self._task)
        self._follow()

    def _act(self) -> None:
        """Do what the button of the card says."""
        if self.result.record.state is ResultState.CURRENT:
            folder = self._exports[0].folder.parent if self._exports else self._folder
            QDesktopServices.openUrl(QUrl.fromLocalFile(str(folder)))
        else:
            self.export()

    def _show_stopped(self) -> None:
        """Show what was there before a build or an export was stopped: nothing is written before its end."""
        self.result.end()
        if self._dataset is None:
            self._forget_dataset()
        else:
            self._show_result()
        before, note = self.result.record, tr("Stopped before anything was written.")
        if before.state is ResultState.NONE:
            self.result.show_record(ResultRecord(state=ResultState.STOPPED, note=note))
        else:
            self.result.show_record(replace(before, note=f"{note} {before.note}"))

    def _show_failure(self, failure: Failed) -> None:
        self.result.end()
        self._show_result()
        self.result.show_record(failed_record(self.result.record, failure.sentence))
        self._context.toast.problem(failure.sentence, failure.details)

    def open_dataset(self) -> None:
        place = str(self._context.recall("place", str(Path.home())))
        name = QFileDialog.getExistingDirectory(self, tr("Open a dataset"), place)
        if name:
            self.open_folder(Path(name))

    def open_folder(self, folder: Path) -> None:
        self._context.start(
            tr("Reading the dataset"),
            Job(open_dataset_folder, (folder,)),
            lambda answer: self._take_dataset(*answer),
            queue=BUILD,
        )

    def open_path(self, path: Path) -> None:
        self.open_folder(path if path.is_dir() else path.parent)

    def validate(self) -> None:
        if self._folder is None:
            self._context.toast.problem(tr("There is no dataset to check: build or open one first."))
            return
        job = Job(validate_dataset_folder, (self._folder,))
        self._context.start(tr("Checking the dataset"), job, self._report_problems, queue="validate")

    def export(self) -> None:
        """Ask for a folder, and write the selected formats there, and the dataset unless it is written."""
        if not self.targets.export.isEnabled():  # asked for by its key or from the palette
            self._context.toast.problem(self.targets.export.toolTip())
            return
        before = Path(self._context.recall("place", str(Path.home() / PROPOSED)))
        name = FolderDialog.ask(self, tr("Export into this folder"), str(before.parent), before.name)
        if not name:
            return
        if self._is_current():
            self.export_to(Path(name))
            return
        folder = Path(name) / self.folder.folder_name()
        replaced = folder.is_dir() and any(folder.iterdir())
        question = tr("There is a folder {folder} already. Replace the dataset in it?", folder=folder)
        if not replaced or self._confirm(question):
            self.build_in(folder, replaced, Path(name))

    def _is_current(self) -> bool:
        """Whether the dataset on disk is that of the settings shown."""
        return self._folder is not None and self._made_with in (None, self._settings())

    def export_to(self, folder: Path) -> None:
        """Write the selected formats, each into its own folder below `folder`."""
        if self._folder is None or not self.targets.chosen():
            return
        targets = self.targets
        arguments = (self._folder, targets.chosen(), folder, targets.options(), targets.consent())
        self._context.remember("place", str(folder))
        self.result.begin(folder)
        self._task = self._context.start(
            tr("Exporting"),
            Job(export_dataset_folder, arguments),
            self._take_exports,
            failed=self._show_failure,
            stopped=self._show_stopped,
            queue=EXPORT,
        )

    def _confirm(self, question: str) -> bool:
        answer = QMessageBox.question(self, tr("Replace the dataset"), question)
        return answer == QMessageBox.StandardButton.Yes

    # --- answers -------------------------------------------------------------------------------

    def _show_particles(self) -> None:
        now = tuple(entry.particle for entry in self._context.session.particles)
        if now != self._particles:
            if self._to_build is not None:
                self.result.end()
            self._particles, self._survey, self._chosen, self._to_build = now, None, None, None
            self._context.stop(FIND)
            self.quality.show_curve(None)
            self._show_chosen()
        self.representatives.show_population(len(now))
        self.gallery.show_hint(has_particles=bool(now))
        self._enable_export()

    def _show_point(self, point: QualityPoint) -> None:
        self._points.append(point)
        self.quality.show_points(self._points)

    def _show_survey(self, found: RepresentativesSurvey) -> None:
        self._survey = found
        self.quality.show_curve(found.curve)
        if found.population.omitted:
            (name, reason), more = found.population.omitted[0], len(found.population.omitted) - 1
            named = tr("{name} and {count} more", name=name, count=more) if more else name
            self._context.toast.problem(tr("Left out: {names}.", names=named) + f" {reason}")
        self._choose(int(self.representatives.count.value()))

    def _choose(self, count: int) -> None:
        """Show another number of representatives; compute the choice unless the survey has it."""
        self.quality.set_marker(float(count))
        if self._survey is None:
            return
        known = self._survey.chosen(count)
        if known is not None:
            self._take_chosen(known)
            return
        request = replace(self.representatives.request(), count=count)
        job = Job(choose_job, (self._survey.population, request))
        self._context.start(tr("Choosing representatives"), job, self._take_chosen, queue="choice")

    def _take_chosen(self, chosen: ChosenParticles) -> None:
        self._chosen = chosen
        self._show_chosen()
        self._reopen()
        to_build, self._to_build = self._to_build, None
        if to_build is not None:
            self.build_in(*to_build)

    def _forget_dataset(self) -> None:
        """Show no dataset and no export of other particles or of another number of representatives."""
        self._dataset = self._folder = self._made_with = None
        self._exports = []
        self.exports.show_exports(())
        self.result.show_record(ResultRecord(note=tr("No dataset of these particles has been written yet.")))
        self._enable_export()

    def _show_chosen(self) -> None:
        self._forget_dataset()
        every = self.representatives.every
        chosen = None if every else self._chosen
        shown = chosen_particles(self._particles, chosen) if chosen is not None else []
        title = tr_count(N_("1 representative"), N_("{count} representatives"), len(shown))
        self.gallery.show_shapes(title if shown else "", shown)
        self._show_sizes()
        self._update_request()

    def _show_sizes(self) -> None:
        classes = self._classes()
        sizing = self.sizes.sizing()
        try:
            made = [replace(one, sizes=sizing(one)) for one in classes] if sizing else []
        except RegolithError as error:
            self.sizes.show_problem(str(error))
            made = []
        self._classes_to_build = made
        self.distribution.show_classes(made)
        self._enable_export()
        self._show_result()

    def _enable_export(self) -> None:
        """Let the dataset be exported, or say at the button why it cannot."""
        reason = self.sizes.reason()
        if not self._particles:
            reason = tr("There is no dataset to export: open particles or a dataset first.")
        elif len(self._particles) < 2 and not self.representatives.every:
            reason = tr("There are too few particles to choose from: open two or more.")
        if self._is_current():
            reason = ""
        # before it is built, nobody knows: the result of the method of compounds may be convex
        compounds = self._dataset is not None and self._is_current() and bool(self._dataset.compounds)
        # first, since each change shows the filling again, and without classes there is none
        self.targets.show_filling(self._filling if self._dataset or self._classes_to_build else None)
        self.targets.set_ready(reason, compounds)

    def _classes(self) -> Sequence[ShapeClass]:
        if self._dataset is not None:
            return [ShapeClass(one.weight, one.sizes, one.n_members) for one in self._dataset.representatives]
        if self._chosen is not None and not self.representatives.every:
            return self._chosen.representatives.classes
        if len(self._particles) > MAX_MEASURED:
            return []
        return [singleton_class(particle) for particle in self._particles if particle.mesh.volume > 0.0]

    def _take_built(self, built: DatasetBuildResult, exports: Path | None = None) -> None:
        self.result.end()
        self._take_dataset(built.folder, built.dataset)
        self._made_with = self._settings()
        self._show_result()
        self._context.toast.note(
            tr("{count} shapes in {folder}.", count=len(built.dataset), folder=built.folder)
        )
        self._enable_export()
        if exports is not None:
            self.export_to(exports)

    def _take_dataset(self, folder: Path, dataset: Dataset) -> None:
        self._folder, self._dataset = folder, dataset
        self._context.session.dataset_folder = folder
        self.gallery.show_shapes(dataset_title(dataset), shapes(dataset))
        self._exports, self._made_with = [], None
        self.exports.show_exports(())
        self._show_result()
        self.distribution.show_classes(self._classes())
        self._enable_export()

    def _filling(self, options: ExportOptions) -> CylinderFilling:
        """The particles of a script that fills a cylinder with the dataset."""
        by_classes = self._chosen is not None and not self.representatives.every
        by_volume = by_classes and self.representatives.request().weighting == "volume"
        return filling_of(self._dataset, self._classes_to_build, options, by_volume=by_volume)

    def _settings(self) -> tuple[Any, ...]:
        """What a dataset that is built now depends on, besides the particles and their number."""
        weighting = self.representatives.weighting.value()
        every, choices = self.representatives.every, self._context.session.choices
        return self.sizes.text(), every, weighting, choices.coarsening_request

    def _show_result(self) -> None:
        """What has been written, and where."""
        if self._dataset is None or self._folder is None:
            return
        written = tr("The dataset is in {folder}.", folder=self._folder)
        if self._exports:
            place = self._exports[0].folder.parent
            written += " " + tr("The exports are in {folder}.", folder=place)
        current = self._is_current()
        if not current:
            written = tr("Built with other settings than those shown.") + " " + written
        values = (str(len(self._dataset)), str(len(self._exports)))
        state = ResultState.CURRENT if current else ResultState.STALE
        origin = provenance_text(self._dataset)
        self.result.show_record(ResultRecord(values, origin, state=state, note=written))

    def _report_problems(self, problems: Sequence[str]) -> None:
        if problems:
            self._context.toast.problem(
                tr("The dataset is not valid: {problem}", problem=problems[0]), "\n".join(problems)
            )
        else:
            self._context.toast.note(tr("The dataset is valid."))

    def _take_exports(self, done: Sequence[ExportResult]) -> None:
        self.result.end()
        self._exports = list(done)
        self.exports.show_exports(done)
        self._lower.setCurrentIndex(1)
        self._show_result()
        labels = [tr(EXPORTERS[each.key].label) for each in done]
        self._context.toast.note(
            tr("{formats} written to {folder}.", formats=", ".join(labels), folder=done[0].folder.parent)
        )

    # --- parts ---------------------------------------------------------------------------------

    def _show_choices(self) -> None:
        self.folder.shapes.setText(coarsening_text(self._context.session.choices))
        self._show_result()
        self._enable_export()

    def _take_opened(self) -> None:
        """Show the values of an opened recipe, once."""
        opened = self._context.session.opened_request
        if opened is not None and opened is not self._opened:
            self._opened = opened
            self._controls.show_recipe(opened)

    def _update_request(self) -> None:
        """Set the session's request of a dataset; ``None`` before representatives are chosen."""
        is_chosen = self._chosen is not None or (self.representatives.every and bool(self._particles))
        is_complete = is_chosen and self.sizes.sizing() is not None
        self._context.session.dataset_request = self._controls.request() if is_complete else None

    def _show_losses(self) -> None:
        self.losses.show_formats(self.targets.chosen(), self.targets.refusing())

    def _connect(self) -> None:
        self.representatives.start.clicked.connect(self.find_representatives)
        self.representatives.countChanged.connect(self._choose)
        self.representatives.weighting.currentIndexChanged.connect(
            lambda: self.find_representatives() if self._survey else None
        )
        self.sizes.sizesChanged.connect(self._show_sizes)
        self.representatives.whichChanged.connect(self._show_chosen)
        self.folder.open.clicked.connect(self.open_dataset)
        self.result.startRequested.connect(self._act)
        self.result.stopRequested.connect(self._stop)
        self.targets.exportRequested.connect(self.export)
        self.targets.chosenChanged.connect(self._show_losses)
        for signal in (self.targets.chosenChanged, self.targets.optionsChanged, self.sizes.sizesChanged):
            signal.connect(self._update_request)
        self.folder.name.textChanged.connect(lambda _: self._update_request())

    def _place(self) -> None:
        for plot in (self.quality, self.distribution):
            plot.fit_to_font()
        upper = equal_parts(Qt.Orientation.Horizontal, (framed(self.quality), framed(self.distribution)))
        upper.setObjectName("dataset_upper")
        lower = [(self.losses, tr("Limits of the formats")), (scrolled(self.exports), tr("Exported"))]
        self._lower = tabs("dataset_lower", lower)
        self.gallery.setMinimumHeight(SIZE + 12 + 5 * self.fontMetrics().height())
        middle = stacked((upper, self.gallery, self._lower), (260, 330, 120), stretch=1)
        middle.setObjectName("dataset_middle")
        results = QWidget()
        vbox(self.result, (middle, 1), parent=results, margins=(10, 10, 2, 8))
        whole = FoldingSplitter(results, self._controls, (1200, 320))
        whole.setObjectName("dataset_whole")
        hbox(whole, parent=self)
