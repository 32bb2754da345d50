"""Page "Angle of repose": the angle, what limits it, section, set-up, runs, study, calibration, player."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from platformdirs import user_data_path
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QFileDialog

from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dem.angle_of_repose import ReposeMeasurement
from regolith_studio.dem.case import PreparedCase, ScalingReport, scaling_report, with_number
from regolith_studio.dem.engines import engine_named
from regolith_studio.dem.evaluation.section import NotAPileError
from regolith_studio.dem.run_io import (
    RunSummary,
    find_runs,
    read_run,
)
from regolith_studio.dem.snapshot import ParticleState, Snapshot
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.jobs.dataset_jobs import DatasetOptions, build_dataset_folder
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.repose_jobs import ReposeRequest, ReposeRun, preview_repose, remeasure, repose_steps
from regolith_studio.messages import N_
from regolith_studio.scene.repose_export import ReposeExport, repose_export_steps
from regolith_studio.session.project import fingerprint
from regolith_studio.studies.repose import ReposeStudyRun
from regolith_studio.ui.dialogs.files import FolderDialog
from regolith_studio.ui.layout import scrolled_column, side_by_side, tabs, vbox
from regolith_studio.ui.page import PageContext, PageWidget, ValuePanel
from regolith_studio.ui.pages.repose.calibration import (
    CalibrationController,
    CalibrationPanel,
    StudyController,
    StudyPanel,
)
from regolith_studio.ui.pages.repose.heap import (
    HeapSections,
    drum_record,
    heap_record,
    interval_caption,
    run_notes,
    run_origin,
    scale_of_run,
)
from regolith_studio.ui.pages.repose.player import (
    BALLS,
    ImportedHeap,
    RunPlayer,
    choose_positions,
    export_measurement,
    read_pile,
    restored_heap,
)
from regolith_studio.ui.pages.repose.runs import (
    RunsPanel,
    checks_text,
    hash_of_run,
    new_folder,
    time_note,
    time_written,
)
from regolith_studio.ui.pages.repose.setup import CaseScale, LimitsStrip, SetupPanel, engine_table
from regolith_studio.ui.result_card import ResultRecord, ResultState, ResultView, RunController
from regolith_studio.ui.translation import tr, translate

PREVIEW_DELAY = 250
"""Milliseconds from the last change to the preview."""
ANGLE_SIZE, ANGLE_LINES = 4.5, 5
"""Size of the angle in units of the letters, and lines of text beside it."""
BUILDING = N_("A dataset of the open particles is being built.")
RUN, PREVIEW, MEASURE, BUILD, EXPORT = "run", "preview", "measure", "build", "export"


class ReposePage(PageWidget):
    """Places the panels and starts the jobs; keeps the current pile and its measurement."""

    def __init__(self, context: PageContext) -> None:
        super().__init__()
        self.setObjectName("repose")
        self._context = context
        self._folder = Path(context.recall("folder", str(user_data_path("regolith-studio") / "repose")))
        self._pile: ParticleState | None = None
        self._drum: RunSummary | None = None
        self._measured: ReposeMeasurement | None = None
        self._shown_run: Path | None = None
        self._imported: ImportedHeap | None = None
        self._origin = ("", "")
        self._notes: tuple[str, ...] = ()
        self._prepared: tuple[PreparedCase, ReposeRequest] | None = None
        self._live_scene: tuple[Sequence[Sequence[FloatArray]], bool, LiftingCylinderTest] | None = None
        self._live_pile: ParticleState | None = None
        self._followed: tuple[Path, int] | None = None

    def build(self) -> None:
        self.setup = SetupPanel()
        self.player = RunPlayer(self._context.views)
        captions = (tr("Angle of repose"), interval_caption(None))
        self.angle = ResultView(
            "repose_angle", captions, tr("Run the test"), lead=ANGLE_SIZE, lines=ANGLE_LINES
        )
        self.limits = LimitsStrip()
        self.sections = HeapSections()
        self.runs = RunsPanel()
        self.study = StudyPanel()
        self.calibration = CalibrationPanel()
        self._later = QTimer(self, singleShot=True, interval=PREVIEW_DELAY)
        self._later.timeout.connect(self._preview)
        self.run = RunController(
            self._context,
            self.angle,
            RUN,
            self.run_or_build,
            tr("The run was stopped before it was measured."),
            tr("A simulation of the angle of repose would be stopped."),
            lambda _running: self._offer_run(),
        )
        note = tr("The dataset was not built.")
        self.building = RunController(self._context, self.angle, BUILD, None, note)
        self.studies = StudyController(self._context, self.study, self.setup, lambda: self._folder)
        self.calibrations = CalibrationController(
            self._context, self.calibration, self.setup, lambda: self._folder
        )
        self._place()
        self._connect()
        self._show_nothing(tr("Open a dataset, or build one from the open particles."))
        self._context.bindings.refresh("dataset_folder", self._take_dataset)
        self._offer_run()
        self._list_runs()

    # --- the page of the window ----------------------------------------------------------------

    def commands(self) -> Mapping[str, Callable[..., object]]:
        return {
            "open_dataset": self.open_dataset,
            "make_dataset": self.make_dataset,
            "run_test": self.run_test,
            "start_study": self.studies.start,
            "start_calibration": self.calibrations.start,
            "play": lambda: self.player.play_or_report(self._context.toast.problem),
            "open_positions": self.open_positions,
            "export_run": self.export_run,
            "export_heap": self.export_heap,
            "choose_folder": self.choose_folder,
        }

    def busy(self) -> str:
        return self.run.busy() or self.studies.run.busy() or self.calibrations.run.busy()

    def panels(self) -> Mapping[str, ValuePanel]:
        return {"setup": self.setup, "study": self.study, "calibration": self.calibration}

    def state(self) -> dict[str, Any]:
        shown = self._shown_run
        run = {"folder": str(shown), "sha256": hash_of_run(shown)} if shown else None
        followed = self._followed and str(self._followed[0])
        return self.settings() | {
            "shown": run,
            "imported": self._imported and asdict(self._imported),
            "followed": followed,
            "calibrated": self.calibration.has_runs,
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        super().restore(state)
        if isinstance(followed := state.get("followed"), str):  # which is not made anew by being opened
            self._followed = (Path(followed), time_written(Path(followed)))
        if state.get("calibrated") is True:
            self.calibrations.show_kept()
        if isinstance(shown := state.get("shown"), Mapping):
            self._restore_run(Path(str(shown.get("folder"))), shown.get("sha256"))
        elif isinstance(imported := state.get("imported"), Mapping):
            self._restore_imported(imported)

    def _restore_run(self, folder: Path, sha256: object) -> None:
        """Show the run of a project, which the project names but does not hold."""
        try:
            run = read_run(folder)
        except RegolithError as error:
            self._show_nothing(str(error), ResultState.FAILED)
            return
        if hash_of_run(folder) != sha256:
            note = tr(
                "The run in {folder} is not the one that was shown when the project was saved.", folder=folder
            )
            self._context.toast.problem(note)
        self._later.stop()  # the preview of the set-up would take the place of the run
        self._show_run(run)
        self.runs.select(folder)

    def _restore_imported(self, state: Mapping[str, Any]) -> None:
        """Show the positions of a project, which the project names but does not hold."""
        try:
            heap, pile = restored_heap(state)
        except RegolithError as error:
            self._show_nothing(str(error), ResultState.FAILED)
            return
        if fingerprint(Path(heap.file)) != heap.fingerprint:
            note = tr("{file} is not the file that was shown when the project was saved.", file=heap.file)
            self._context.toast.problem(note)
        self._show_imported(heap, pile)

    def on_hide(self) -> None:
        self.player.pause()

    def on_close(self) -> None:
        self._later.stop()
        self.player.release()

    # --- commands ------------------------------------------------------------------------------

    def open_dataset(self) -> None:
        if name := QFileDialog.getExistingDirectory(
            self, tr("Open a dataset"), str(self.setup.dataset or "")
        ):
            folder = Path(name)
            self.setup.set_dataset(folder, by_hand=folder != self._context.session.dataset_folder)

    def make_dataset(self) -> None:
        """Build a dataset of the open particles in the folder of runs."""
        session = self._context.session
        particles = [entry.particle for entry in session.particles]
        if not particles:
            self._context.toast.problem(tr("No particles are open; open some, or the shipped sample."))
            return
        if under_way := self._under_way():
            self._context.toast.problem(under_way)
            return
        folder = self._folder / "datasets" / "open-particles"
        options = DatasetOptions(name=N_("open particles"), preset=session.choices.preset, overwrite=True)
        job = Job(build_dataset_folder, (particles, session.choices.coarsening_request, folder, options))
        self.building.start(
            tr("Building a dataset"),
            job,
            lambda built: self.setup.set_dataset(built.folder),
            tr(BUILDING),
        )

    def _under_way(self) -> str:
        """What the card shows and nothing else may take the place of; empty for nothing."""
        if self.run.running:
            return tr("A run is under way: stop it first.")
        return tr(BUILDING) if self.building.running else ""

    def run_or_build(self) -> None:
        """What the button of the card starts: the test, or a dataset of the open particles for it."""
        if self.setup.dataset is None:
            self.make_dataset()
        else:
            self.run_test()

    def run_with(self, count: int) -> None:
        """Simulate the case of the set-up panel with another number of particles."""
        self.setup.particles.setValue(count)
        self.run_test()

    def run_test(self) -> None:
        dataset = self.setup.dataset
        if (under_way := self._under_way()) or dataset is None:
            note = tr("There is no dataset yet: open or build one first.")
            self._context.toast.problem(under_way or note)
            return
        with self._context.toast.reporting():
            request = self.setup.request()
            self._later.stop()
            self._live_scene = self._live_pile = None
            note = (
                tr("The angle is measured when the drum has turned.")
                if request.case.drum
                else tr("The angle is measured when the particles have come to rest.")
            )
            earlier = self.angle.record
            self._show_nothing(note)
            self.tabs.setCurrentIndex(0)
            folder = new_folder(self._folder, f"{dataset.name}-{request.case.n_particles}")
            self._preview()
            self.run.start(
                tr("Angle of repose, {count:,} particles", count=request.case.n_particles),
                Job(repose_steps, (dataset, folder, request)),
                self._show_progress,
                note,
                self._end_run,
                earlier,
            )

    def open_positions(self) -> None:
        """Ask for a file of positions of another program and measure its pile."""
        if path := choose_positions(self):
            self.open_path(path)

    def open_path(self, path: Path) -> None:
        with self._context.toast.reporting():
            read = read_pile(self, path)
            if read is None:
                return
            heap, pile, notes = read
            for note in notes:
                self._context.toast.note(note)
            self._show_imported(heap, pile)

    def _show_imported(self, heap: ImportedHeap, pile: ParticleState) -> None:
        name = Path(heap.file).name
        self._later.stop()  # the preview of the set-up would take the place of the heap
        self._context.stop(PREVIEW)
        self._shown_run = None
        self._imported = heap
        self.runs.select(None)
        self._origin = (tr("{count:,} particles of {name}", count=len(pile), name=name), "")
        self._notes = ()
        self.player.set_scene(BALLS, True, LiftingCylinderTest())
        self.player.show_moment(pile, name, tr("{count:,} particles", count=len(pile)))
        self.limits.show_scale(CaseScale(len(pile)))
        self._measure(pile)

    def export_run(self) -> None:
        """Ask for a folder and write Fig. 9 and the measurement."""
        if self._pile is None or self._measured is None:
            self._context.toast.problem(tr("There is no measured heap to export yet."))
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
            self._context.start(tr("Exporting the run"), job, self._exported, queue=EXPORT)

    def _exported(self, export: ReposeExport) -> None:
        self._context.toast.note(
            tr("The run is in {name}; README.txt says how to open it.", name=export.folder)
        )

    def choose_folder(self) -> None:
        if name := FolderDialog.ask(self, tr("Folder of runs"), str(self._folder)):
            self.set_runs_folder(Path(name))

    def set_runs_folder(self, folder: Path) -> None:
        self._folder = folder
        self._context.remember("folder", str(folder))
        self._list_runs()

    # --- set-up and preview --------------------------------------------------------------------

    def _take_dataset(self) -> None:
        """Follow the dataset that was made or opened last, unless the user has chosen one here."""
        written = self._context.session.dataset_folder
        if written is None:
            return
        last, self._followed = self._followed, (written, time_written(written))
        if self._followed != last and not self.setup.by_hand:
            self.setup.set_dataset(written)

    def _ask_preview(self) -> None:
        self._prepared = None
        if not self._under_way() and self.setup.dataset is not None:
            self._show_nothing(tr("Drawing particles …"))
        self._offer_run()
        self._later.start()

    def _preview(self) -> None:
        self._draw_particles(self._show_preview, self._refuse)

    def _draw_particles(
        self,
        take: Callable[[ReposeRequest, PreparedCase, ParticleState], None],
        refuse: Callable[[str], None],
    ) -> None:
        """Draw the particles of the set-up: its consequences, and the shapes that a run shows."""
        if self.setup.dataset is None:
            return
        try:
            request = self.setup.request()
        except RegolithError as error:
            refuse(str(error))
            return
        self._context.start(
            tr("Drawing particles"),
            Job(preview_repose, (self.setup.dataset, request)),
            lambda drawn: take(request, *drawn),
            failed=lambda each: refuse(each.sentence),
            queue=PREVIEW,
            repeats=True,
        )

    def _refuse(self, problem: str) -> None:
        """Show why the case of the set-up cannot be run."""
        if not self._under_way():
            self._show_nothing(translate(problem), ResultState.FAILED)
        self._note_problem(problem)

    def _offer_run(self) -> None:
        """Let the button of the card start what can be started, or say in its tool tip why nothing can."""
        has_dataset = self.setup.dataset is not None
        self.angle.set_start(tr("Run the test") if has_dataset else tr("Use the open particles"))
        self.angle.set_startable(self.setup.problem_of_run() if has_dataset else "")

    def _show_preview(self, request: ReposeRequest, prepared: PreparedCase, pile: ParticleState) -> None:
        report = self._take_prepared(request, prepared)
        scene = (prepared.part_vertices, request.case.shapes == "spheres", request.case.test)
        scale = CaseScale(len(prepared), report.diameters_across, report.coarse_graining)
        self.limits.show_scale(scale, self._seconds)
        if self._under_way():
            self._live_scene = self._live_scene or scene
            return
        self._live_scene = scene
        note = time_note(self._seconds(len(prepared)))
        self._show_nothing(note, made_from=tr("Dataset {folder}", folder=self.setup.dataset))
        self.player.set_scene(*scene)
        self.player.show_moment(
            pile,
            tr("Before the run") if len(pile) else tr("Shown once the run begins"),
            tr(
                "{count:,} particles of the dataset “{name}”",
                count=len(prepared),
                name=translate(prepared.dataset_name),
            ),
        )

    def _take_prepared(self, request: ReposeRequest, prepared: PreparedCase) -> ScalingReport:
        self._prepared = (prepared, request)
        report = scaling_report(prepared)
        self.setup.show_consequences([*map(translate, (*prepared.filling_notes, *report.sentences))])
        self._offer_run()
        return report

    def _prepare_behind(self, run: RunSummary) -> None:
        """Draw the particles of the set-up for the times at the buttons; the run that is shown stays."""

        def take(request: ReposeRequest, prepared: PreparedCase, _pile: ParticleState) -> None:
            self._take_prepared(request, prepared)
            if self._shown_run == run.folder:
                self.limits.show_scale(scale_of_run(run.document), self._seconds)

        self._draw_particles(take, self._note_problem)

    def _note_problem(self, problem: str) -> None:
        self.setup.show_consequences([], problem)
        self._offer_run()

    def _seconds(self, count: int) -> float:
        """Estimated time of a run of the set-up with so many particles."""
        assert self._prepared is not None, "it is asked of drawn particles"
        prepared, request = self._prepared
        return engine_named(request.engine).seconds(with_number(prepared, count), request.settings)

    # --- a run ---------------------------------------------------------------------------------

    def _show_progress(self, event: Any) -> None:
        if isinstance(event, Snapshot) and self._live_scene is not None:
            self._live_pile = event.particles
            self.player.set_scene(*self._live_scene)
            self.player.show_moment(event.particles, tr("Running"), translate(event.message))
        elif isinstance(event, ReposeRun):
            self._list_runs(event.folder)
            summary = RunSummary(event.folder, event.document)
            self._show_run(summary)
            for problem in event.document["checks"]["problems"]:
                self._context.toast.problem(translate(summary.message(problem)))

    def _end_run(self) -> None:
        """Show the particles of a run that has failed or was stopped."""
        self._list_runs()
        if self._live_pile is not None and self._live_scene is not None:
            self.player.set_scene(*self._live_scene)
            self.player.show_moment(self._live_pile, tr("Stopped"), tr("the particles when it was stopped"))

    # --- what a run left -----------------------------------------------------------------------

    def _list_runs(self, chosen: Path | None = None) -> None:
        runs = find_runs(self._folder) if self._folder.is_dir() else []
        self.runs.set_runs(runs, chosen)
        self.setup.set_fillings([run.folder for run in runs if run.document["state"] == "finished"])

    def _show_study_run(self, run: ReposeStudyRun) -> None:
        if not self._under_way():
            self._show_run(self.studies.summary(run))

    def _show_run(self, run: RunSummary) -> None:
        try:
            pile = self.player.show_folder(run, checks_text(run))
        except (RegolithError, TypeError) as error:
            self._context.toast.problem(str(error))
            return
        self._imported = None
        self._origin, self._notes = run_origin(run.document), run_notes(run)
        if pile is not None and run.document["case"].get("drum"):
            self._drum = run
            self.player.frame_heap(pile)
            self._show_drum()
        elif pile is not None:
            self._measure(pile)
        else:
            state = run.document["state"]
            failed = ResultState.FAILED if state == "failed" else ResultState.STOPPED
            self._show_nothing(tr("This run was not finished: {state}.", state=tr(state)), failed)
        self._shown_run = run.folder
        self.limits.show_scale(scale_of_run(run.document), self._seconds if self._prepared else None)
        if self._prepared is None and not self._under_way():
            self._prepare_behind(run)

    def _show_drum(self) -> None:
        """Show the angles of a drum beside the user's own."""
        if self._drum is None:
            return
        run = self._drum
        self._show_nothing("")
        self._drum, self._shown_run = run, run.folder
        self.angle.caption(0, tr("Dynamic angle"))
        self._show_card(drum_record(run, *self._origin, self._notes, self.setup.measured_angle()))
        self.sections.show_drum(run.document["measurement"])

    def _measure(self, pile: ParticleState) -> None:
        self._drum = None
        self.angle.caption(0, tr("Angle of repose"))
        self._pile = pile
        self.player.frame_heap(pile)
        self._show_card(ResultRecord((), *self._origin, note=tr("The heap is being measured.")))
        self._measure_again()

    def _measure_again(self) -> None:
        if self._pile is None:
            return
        with self._context.toast.reporting():
            job = Job(remeasure, (self._pile, self.setup.evaluation_settings()))
            self._context.start(tr("Measuring the heap"), job, self._show_measurement, queue=MEASURE)

    def _show_measurement(self, measured: ReposeMeasurement | NotAPileError) -> None:
        if self._pile is None:
            return
        self._measured = measured if isinstance(measured, ReposeMeasurement) else None
        self.angle.caption(1, interval_caption(measured))
        self._show_card(heap_record(measured, *self._origin, self._notes))
        self.sections.show_heap(self._pile, measured)

    def _show_nothing(
        self, sentence: str, state: ResultState = ResultState.NONE, made_from: str = ""
    ) -> None:
        """Show that there is no measurement of what is seen, and why."""
        self._context.stop(MEASURE)
        self._pile = self._measured = self._shown_run = self._drum = self._imported = None
        self.angle.caption(0, tr("Angle of repose"))
        self.angle.caption(1, interval_caption(None))
        self._show_card(ResultRecord((), made_from, state=state, note=sentence))
        self.sections.show_nothing()

    def _show_card(self, record: ResultRecord) -> None:
        self.angle.show_record(record)
        self._offer_run()

    def _take_cut(self, name: str, share: float) -> None:
        if name == "low":
            self.setup.set_evaluation(cut_bottom=round(min(share, 0.45), 3), toe=0.0)
        else:
            self.setup.set_evaluation(cut_top=round(min(1.0 - share, 0.45), 3))

    # --- layout --------------------------------------------------------------------------------

    def _place(self) -> None:
        pages = [
            (self.sections, tr("Section")),
            (scrolled_column([self.setup]), tr("Set-up")),
            (self.runs, tr("Runs")),
            (self.study, tr("Study")),
            (self.calibration, tr("Calibration")),
            (engine_table(), tr("Engines")),
        ]
        self.tabs = tabs("repose_tabs", pages)
        pictures = side_by_side([self.tabs, self.player], [700, 520], stretch=0)
        pictures.setObjectName("repose_pictures")
        vbox(self.angle, self.limits, (pictures, 1), parent=self, margins=(10, 10, 10, 8))

    def _connect(self) -> None:
        self.setup.valueChanged.connect(self._ask_preview)
        self.setup.evaluationChanged.connect(self._measure_again)
        self.setup.measuredChanged.connect(self._show_drum)
        self.setup.open_button.clicked.connect(self.open_dataset)
        self.setup.sample_button.clicked.connect(self.make_dataset)
        self.limits.runRequested.connect(self.run_with)
        self.runs.chosen.connect(self._show_run)
        self.study.chosen.connect(self._show_study_run)
        self.sections.plot.cutDragged.connect(self._take_cut)
