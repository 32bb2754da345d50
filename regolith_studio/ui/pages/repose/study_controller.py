"""Starts and stops the study of the page, and tells its panel what becomes of it."""

from collections.abc import Callable
from pathlib import Path

from regolith_studio.dem.run_folder import RunSummary
from regolith_studio.errors import RegolithError
from regolith_studio.jobs.events import Failed, Job
from regolith_studio.jobs.repose_jobs import SHAPE_KEYS, ReposeStudyRequest, run_repose_study
from regolith_studio.studies.repose import ReposeStudy, ReposeStudyRun
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.repose.setup import SetupPanel
from regolith_studio.ui.pages.repose.study import StudyPanel
from regolith_studio.ui.translation import tr

LANE = "study"


class ReposeStudyController:
    """One study at a time, in the background; what is on screen can be used meanwhile.

    Parameters
    ----------
    panel, setup
        What is varied; what stays the same.
    show_run
        Shows a run that was chosen in the panel.
    """

    def __init__(
        self,
        context: PageContext,
        panel: StudyPanel,
        setup: SetupPanel,
        show_run: Callable[[RunSummary], None],
    ) -> None:
        self._context, self._panel, self._setup, self._show_run = context, panel, setup, show_run
        self._folder: Path | None = None
        self._running = False
        panel.stopWanted.connect(self.stop)
        panel.chosen.connect(self._choose)

    def busy(self) -> str:
        """What would be lost if the window closed now."""
        return (
            tr("A study of the angle of repose would be stopped; it can go on later.")
            if self._running
            else ""
        )

    def start(self, runs: Path) -> None:
        """Run what the panel says, or go on with it, in a folder of its own below `runs`."""
        if self._running:
            return
        try:
            wish = self._wish()
        except RegolithError as error:
            self._context.toast.problem(str(error))
            return
        name = "open-particles" if wish.dataset is None else wish.dataset.name
        self._folder, self._running = runs / "studies" / f"{wish.key}-{name}", True
        self._panel.show_study(None)
        self._panel.set_running(True)
        self._panel.tell(tr("Every run is kept in {folder}.", folder=self._folder))
        self._context.start(
            tr("Angle of repose: study"),
            Job(run_repose_study, (wish, self._folder)),
            self._finished,
            partial=self._panel.show_study,
            failed=self._failed,
            stopped=self._stopped,
            lane=LANE,
        )

    def stop(self) -> None:
        """Stop; starting it again goes on after what is finished."""
        self._context.stop(LANE)

    def _wish(self) -> ReposeStudyRequest:
        key, values, repeats = self._panel.wish()
        session, order = self._context.session, self._setup.order()
        if key not in SHAPE_KEYS:
            return ReposeStudyRequest(key, values, order, self._setup.dataset, repeats)
        particles = tuple(entry.particle for entry in session.particles)
        return ReposeStudyRequest(key, values, order, None, repeats, particles, session.choices.order)

    def _finished(self, study: ReposeStudy) -> None:
        self._panel.show_study(study)
        self._over(
            tr("{count} runs; tables and figure are in {folder}.", count=len(study.runs), folder=self._folder)
        )

    def _failed(self, failure: Failed) -> None:
        self._over(failure.sentence)
        self._context.toast.problem(failure.sentence, failure.details)

    def _stopped(self) -> None:
        self._over(tr("Stopped; what is finished is kept, and the start button goes on there."))

    def _over(self, text: str) -> None:
        self._running = False
        self._panel.set_running(False)
        self._panel.tell(text)

    def _choose(self, run: ReposeStudyRun) -> None:
        if self._folder is not None:
            self._show_run(RunSummary(self._folder / run.folder, run.document))
