"""Page "Angle of repose": set-up, player, sections, runs, study and engines."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from platformdirs import user_data_path
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QVBoxLayout, QWidget

from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dem.angle_of_repose import PAPER_AZIMUTHS, ReposeMeasurement
from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engines import engine_named
from regolith_studio.dem.evaluation.section import NotAPileError
from regolith_studio.dem.run_io import (
    FINAL,
    RunSummary,
    find_runs,
    read_final_state,
    read_shapes,
    snapshot_files,
)
from regolith_studio.dem.scaling_report import scaling_report
from regolith_studio.dem.snapshot import ParticleState, Snapshot
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.jobs.dataset_jobs import DatasetOptions, build_dataset_folder
from regolith_studio.jobs.events import Failed, Job
from regolith_studio.jobs.repose_jobs import (
    ReposeRequest,
    ReposeRun,
    preview_repose,
    remeasure,
    repose_steps,
)
from regolith_studio.messages import N_
from regolith_studio.scene.repose_export import ReposeExport, repose_export_steps
from regolith_studio.ui.dialogs.folder import FolderDialog
from regolith_studio.ui.layout import padded, scrolled_column, side_by_side, stacked, tabs
from regolith_studio.ui.page import PageContext, PageWidget
from regolith_studio.ui.pages.repose.calibration import CalibrationPanel
from regolith_studio.ui.pages.repose.calibration_controller import CalibrationController
from regolith_studio.ui.pages.repose.export import export_measurement, read_other
from regolith_studio.ui.pages.repose.player import RunPlayer
from regolith_studio.ui.pages.repose.runs import RunsPanel, angle_text, checks_text, duration_text
from regolith_studio.ui.pages.repose.section_plot import SectionPlot
from regolith_studio.ui.pages.repose.setup import EnginePanel, SetupPanel
from regolith_studio.ui.pages.repose.study import StudyPanel
from regolith_studio.ui.pages.repose.study_controller import ReposeStudyController
from regolith_studio.ui.translation import localized, tr, translate
from regolith_studio.ui.widgets.headline import Headline

PREVIEW_DELAY = 250
"""Milliseconds from the last change to the preview."""
RUN, PREVIEW, MEASURE, BUILD, EXPORT = "run", "preview", "measure", "build", "export"


class ReposePage(PageWidget):
    """Places the panels and starts the jobs; keeps the current pile and its measurement."""

    def __init__(self, context: PageContext) -> None:
        super().__init__()
        self.setObjectName("repose")
        self._context = context
        self._folder = Path(context.recall("folder", str(user_data_path("regolith-studio") / "repose")))
        self._pile: ParticleState | None = None
        self._measured: ReposeMeasurement | None = None
        self._shown_run: Path | None = None
        self._running = False
        self._live_scene: tuple[Sequence[Sequence[FloatArray]], bool, LiftingCylinderTest] | None = None
        self._live_pile: ParticleState | None = None

    def build(self) -> None:
        self.setup = SetupPanel()
        self.player = RunPlayer(self._context.views)
        self.x_z, self.y_z = SectionPlot("x"), SectionPlot("y")
        self.angle = Headline("repose_angle", (tr("Angle of repose"), tr("Interval")))
        self.verdict = self.angle.sentence
        self._show_answer(tr("No pile yet."))
        self.runs = RunsPanel()
        self.study = StudyPanel()
        self.calibration = CalibrationPanel()
        self.engines = EnginePanel()
        self.studies = ReposeStudyController(self._context, self.study, self.setup, self._show_study_run)
        self.calibrations = CalibrationController(self._context, self.calibration, self.setup)
        self._later = QTimer(self, singleShot=True, interval=PREVIEW_DELAY)
        self._later.timeout.connect(self._preview)
        self._place()
        self._connect()
        self._context.bindings.refresh("dataset_folder", self._take_dataset)
        self.setup.show_consequences([tr("Open a dataset, or build one from the open particles.")])
        self._list_runs()

    # --- the page of the window ----------------------------------------------------------------

    def commands(self) -> Mapping[str, Callable[..., object]]:
        return {
            "open_dataset": self.open_dataset,
            "make_dataset": self.make_dataset,
            "run_test": self.run_test,
            "start_study": self.start_study,
            "start_calibration": self.start_calibration,
            "play": lambda: self.player.play_or_report(self._context.toast.problem),
            "open_positions": self.open_positions,
            "export_run": self.export_run,
            "export_heap": self.export_heap,
            "choose_folder": self.choose_folder,
        }

    def busy(self) -> str:
        if self._running:
            return tr("A simulation of the angle of repose would be stopped.")
        return self.studies.busy() or self.calibrations.busy()

    def state(self) -> dict[str, Any]:
        return {
            "setup": self.setup.state(),
            "study": self.study.state(),
            "calibration": self.calibration.state(),
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        if isinstance(state.get("setup"), Mapping):
            self.setup.restore(state["setup"])
        if isinstance(state.get("study"), Mapping):
            self.study.restore(state["study"])
        if isinstance(state.get("calibration"), Mapping):
            self.calibration.restore(state["calibration"])

    def on_hide(self) -> None:
        self.player.stop()

    def on_close(self) -> None:
        self._later.stop()
        self.player.release()

    # --- commands ------------------------------------------------------------------------------

    def open_dataset(self) -> None:
        """Ask for a dataset folder."""
        if name := QFileDialog.getExistingDirectory(
            self, tr("Open a dataset"), str(self.setup.dataset or "")
        ):
            self.setup.set_dataset(Path(name))

    def make_dataset(self) -> None:
        """Build a dataset of the open particles in the folder of runs."""
        session = self._context.session
        particles = [entry.particle for entry in session.particles]
        if not particles:
            self._context.toast.problem(tr("No particles are open; open some, or the shipped sample."))
            return
        folder = self._folder / "datasets" / "open-particles"
        options = DatasetOptions(name=N_("open particles"), preset=session.choices.preset, overwrite=True)
        job = Job(build_dataset_folder, (particles, session.choices.coarsening_request, folder, options))
        self._context.start(
            tr("Building a dataset"), job, lambda built: self.setup.set_dataset(built.folder), lane=BUILD
        )

    def run_test(self) -> None:
        """Simulate the case of the set-up panel."""
        dataset = self.setup.dataset
        if dataset is None:
            self._context.toast.problem(tr("There is no dataset yet: open or build one first."))
            return
        try:
            request = self.setup.request()
        except RegolithError as error:
            self._context.toast.problem(str(error))
            return
        self._later.stop()
        self._live_scene = self._live_pile = None
        self._show_nothing(tr("The angle is measured when the particles have come to rest."))
        folder = self._new_folder(f"{dataset.name}-{request.case.n_particles}")
        self._set_running(True)
        self._start_preview(dataset, request)
        self._context.start(
            tr("Angle of repose, {count:,} particles", count=request.case.n_particles),
            Job(repose_steps, (dataset, folder, request)),
            self._finished,
            partial=self._show_moment,
            failed=self._failed,
            stopped=self._stopped,
            lane=RUN,
        )

    def start_study(self) -> None:
        """Start or resume the study."""
        self.studies.start(self._folder)

    def start_calibration(self) -> None:
        """Start or resume the calibration."""
        self.calibrations.start(self._folder)

    def open_positions(self) -> None:
        """Measure the pile of another program from a file of positions."""
        pile = read_other(self, self._context.toast)
        if pile is not None:
            self._shown_run = None
            ball = ((self.player_ball(),),)
            self.player.set_scene(ball, True, LiftingCylinderTest())
            self.player.show_moment(
                pile, tr("Imported particles"), tr("{count:,} particles", count=len(pile))
            )
            self._measure(pile)

    def export_run(self) -> None:
        """Ask for a folder and write Fig. 9 and the measurement."""
        if self._pile is None or self._measured is None:
            self._context.toast.problem(tr("There is no measured pile to export yet."))
            return
        export_measurement(self, self._context.toast, self._pile, self._measured)

    def export_heap(self) -> None:
        """Ask for a folder and write the shown run for ParaView, OVITO and viewers of glTF."""
        if self._shown_run is None:
            self._context.toast.problem(
                tr("There is no run to export: run a test or choose one in the list.")
            )
            return
        name = FolderDialog.ask(self, tr("Export for ParaView and OVITO"))
        if name:
            job = Job(repose_export_steps, (self._shown_run, Path(name)))
            self._context.start(tr("Exporting the run"), job, self._exported, lane=EXPORT)

    def _exported(self, export: ReposeExport) -> None:
        self._context.toast.note(
            tr("The run is in {name}; README.txt says how to open it.", name=export.folder)
        )

    def choose_folder(self) -> None:
        """Ask for the folder of runs."""
        if name := FolderDialog.ask(self, tr("Folder of runs"), str(self._folder)):
            self.set_runs_folder(Path(name))

    def set_runs_folder(self, folder: Path) -> None:
        """Set the folder of runs and list its runs."""
        self._folder = folder
        self._context.remember("folder", str(folder))
        self._list_runs()

    @staticmethod
    def player_ball() -> Any:
        """A sphere-like shape for particles of which only the size is known."""
        from regolith_studio.geometry.sphere_points import icosphere

        return icosphere(1).vertices

    # --- set-up and preview --------------------------------------------------------------------

    def _take_dataset(self) -> None:
        written = self._context.session.dataset_folder
        if written is not None and self.setup.dataset is None:
            self.setup.set_dataset(written)

    def _ask_preview(self) -> None:
        self._later.start()

    def _preview(self) -> None:
        dataset = self.setup.dataset
        if dataset is None:
            return
        try:
            request = self.setup.request()
        except RegolithError as error:
            self.setup.show_consequences([], str(error))
            return
        self._start_preview(dataset, request)

    def _start_preview(self, dataset: Path, request: ReposeRequest) -> None:
        """Draw the particles of a request: its consequences, and the shapes that a run shows."""

        def show(drawn: tuple[PreparedCase, ParticleState]) -> None:
            self._show_preview(request, *drawn)

        job = Job(preview_repose, (dataset, request.case))
        self._context.start(
            tr("Drawing particles"),
            job,
            show,
            failed=lambda each: self.setup.show_consequences([], each.sentence),
            lane=PREVIEW,
            repeats=True,
        )

    def _show_preview(self, request: ReposeRequest, prepared: PreparedCase, pile: ParticleState) -> None:
        seconds = engine_named(request.engine).seconds(prepared, request.settings)
        time = tr(
            "About {time} on one core, up to {longer} while other work runs.",
            time=duration_text(seconds),
            longer=duration_text(2 * seconds),
        )
        self.setup.show_consequences([time, *map(translate, scaling_report(prepared).sentences)])
        scene = (prepared.part_vertices, request.case.shapes == "spheres", request.case.test)
        if self._running:
            self._live_scene = self._live_scene or scene
            return
        self._show_nothing(tr("Not run yet with these values."))
        self.player.set_scene(*scene)
        self.player.show_moment(
            pile,
            tr("Before the lift") if len(pile) else tr("Shown once the run begins"),
            tr(
                "{count:,} particles of the dataset “{name}”",
                count=len(prepared),
                name=translate(prepared.dataset_name),
            ),
        )

    # --- a run ---------------------------------------------------------------------------------

    def _show_moment(self, moment: Any) -> None:
        if isinstance(moment, Snapshot) and self._live_scene is not None:
            self._live_pile = moment.particles
            self.player.set_scene(*self._live_scene)
            self.player.show_moment(moment.particles, tr("Running"), translate(moment.message))

    def _finished(self, run: ReposeRun) -> None:
        self._set_running(False)
        self._list_runs(run.folder)
        summary = RunSummary(run.folder, run.document)
        self._show_run(summary)
        for problem in run.document["checks"]["problems"]:
            self._context.toast.problem(translate(summary.message(problem)))

    def _failed(self, failure: Failed) -> None:
        self._set_running(False)
        self._list_runs()
        self._show_nothing(failure.sentence)
        self._context.toast.problem(failure.sentence, failure.details)

    def _stopped(self) -> None:
        self._set_running(False)
        self._list_runs()
        self._show_nothing(tr("The run was stopped before it was measured."))
        if self._live_pile is not None and self._live_scene is not None:
            self.player.set_scene(*self._live_scene)
            self.player.show_moment(self._live_pile, tr("Stopped"), tr("the particles when it was stopped"))

    def _set_running(self, running: bool) -> None:
        self._running = running
        self.setup.set_running(running)

    # --- what a run left -----------------------------------------------------------------------

    def _list_runs(self, chosen: Path | None = None) -> None:
        self._context.session.runs_folder = self._folder
        self.runs.set_runs(find_runs(self._folder) if self._folder.is_dir() else [], chosen)

    def _show_study_run(self, run: RunSummary) -> None:
        if not self._running:
            self._show_run(run)

    def _show_run(self, run: RunSummary) -> None:
        case = run.document["case"]
        try:
            shapes = read_shapes(run.folder)
            test = LiftingCylinderTest(**case["test"])
            files = snapshot_files(run.folder)
            final = run.folder / FINAL
            self.player.set_scene(shapes, case["shapes"] == "spheres", test)
            self.player.show_run(
                [*files, final] if final.exists() else files, run.folder.name, checks_text(run)
            )
            pile = read_final_state(final) if final.exists() else None
        except (RegolithError, TypeError) as error:
            self._context.toast.problem(str(error))
            return
        self._shown_run = run.folder
        if pile is not None:
            self._measure(pile)
        else:
            self._show_measurement(
                NotAPileError(tr("This run was not finished: {state}.", state=tr(run.document["state"])))
            )

    def _measure(self, pile: ParticleState) -> None:
        self._pile = pile
        self.player.frame_heap(pile)
        self._measure_again()

    def _measure_again(self) -> None:
        if self._pile is None:
            return
        try:
            job = Job(remeasure, (self._pile, self.setup.evaluation_settings()))
        except RegolithError as error:
            self._context.toast.problem(str(error))
            return
        self._context.start(tr("Measuring the pile"), job, self._show_measurement, lane=MEASURE)

    def _show_measurement(self, measured: ReposeMeasurement | NotAPileError) -> None:
        if isinstance(measured, NotAPileError) or self._pile is None:
            self._measured = None
            self._show_answer(tr("There is no angle of repose."))
            for plot in (self.x_z, self.y_z):
                plot.show_nothing(translate(getattr(measured, "sentence", "")))
            return
        self._measured = measured
        low, high = measured.interval
        interval = tr("{low:.1f}° to {high:.1f}°", low=low, high=high)
        self.angle.caption(1, tr("{share:.0%} interval", share=measured.settings.confidence))
        self.angle.show_values((localized(f"{measured.angle:.1f}°"), interval), angle_text(measured))
        for plot, azimuth in zip((self.x_z, self.y_z), PAPER_AZIMUTHS, strict=True):
            section = measured.section_at(azimuth)
            if section is None:
                plot.show_nothing(tr("This section has no two straight flanks and is not measured."))
            else:
                plot.show_section(self._pile, section)

    def _show_nothing(self, sentence: str) -> None:
        """Show that there is no measurement of what is seen, and why."""
        self._context.stop(MEASURE)
        self._pile = self._measured = self._shown_run = None
        self._show_answer(sentence)
        for plot in (self.x_z, self.y_z):
            plot.show_nothing(sentence)

    def _show_answer(self, sentence: str) -> None:
        """Show why there is no angle."""
        self.angle.show_values(("–", "–"), sentence, fresh=False)

    def _take_cut(self, name: str, share: float) -> None:
        if name == "low":
            self.setup.set_evaluation(cut_bottom=round(min(share, 0.45), 3), toe=0.0)
        else:
            self.setup.set_evaluation(cut_top=round(min(1.0 - share, 0.45), 3))

    # --- layout --------------------------------------------------------------------------------

    def _place(self) -> None:
        sections = QWidget()
        row = QHBoxLayout(sections)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self.x_z)
        row.addWidget(self.y_z)
        pages = [
            (sections, tr("Sections")),
            (self.runs, tr("Runs")),
            (self.study, tr("Study")),
            (self.calibration, tr("Calibration")),
            (self.engines, tr("Engines")),
        ]
        below = tabs("repose_tabs", pages)
        results = QWidget()
        column = QVBoxLayout(results)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.angle)
        column.addWidget(below, 1)
        pictures = stacked([self.player, results], [480, 380], stretch=0)
        pictures.setObjectName("repose_pictures")
        parts = [padded(pictures, 10, 10, 2, 8), scrolled_column([self.setup])]
        columns = side_by_side(parts, [1180, 350], stretch=0)
        columns.setObjectName("repose_columns")
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(columns)

    def _connect(self) -> None:
        self.setup.valueChanged.connect(self._ask_preview)
        self.setup.evaluationChanged.connect(self._measure_again)
        self.setup.datasetWanted.connect(self.open_dataset)
        self.setup.sampleWanted.connect(self.make_dataset)
        self.setup.runWanted.connect(self.run_test)
        self.runs.chosen.connect(self._show_run)
        self.study.startWanted.connect(self.start_study)
        self.calibration.startWanted.connect(self.start_calibration)
        for plot in (self.x_z, self.y_z):
            plot.cutDragged.connect(self._take_cut)

    def _new_folder(self, stem: str) -> Path:
        number = 1
        while (self._folder / f"{stem}-{number:03d}").exists():
            number += 1
        return self._folder / f"{stem}-{number:03d}"
