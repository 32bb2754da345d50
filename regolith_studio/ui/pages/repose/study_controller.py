"""Starts and stops the study of the page and shows its progress in the panel."""

from collections.abc import Callable
from pathlib import Path

from regolith_studio.dem.run_io import RunSummary
from regolith_studio.errors import RegolithError
from regolith_studio.jobs.events import Failed, Job
from regolith_studio.jobs.repose_study import SHAPE_KEYS, ReposeStudyRequest, run_repose_study, study_place
from regolith_studio.studies.repose import ReposeStudy, ReposeStudyRun
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.repose.setup import SetupPanel
from regolith_studio.ui.pages.repose.study import StudyPanel
from regolith_studio.ui.translation import tr

LANE = "study"


class ReposeStudyController:
    """Runs one study at a time in the background.

    Parameters
    ----------
    panel, setup
        The varied parameter, and all others.
    show_run
        Called with a run that is selected in the panel.
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
        self._running, self._task = False, 0
        panel.stopWanted.connect(self.stop)
        panel.chosen.connect(self._choose)

    def busy(self) -> str:
        """What closing the window would interrupt; empty for nothing."""
        return (
            tr("A study of the angle of repose would be stopped; it can be resumed later.")
            if self._running
            else ""
        )

    def start(self, runs: Path) -> None:
        """Start or resume the study in its own folder below `runs`."""
        if self._running:
            return
        try:
            request = self._request()
        except RegolithError as error:
            self._context.toast.problem(str(error))
            return
        name = "open-particles" if request.dataset is None else request.dataset.name
        self._folder, self._running = runs / "studies" / f"{request.key}-{name}", True
        self._panel.show_study(None)
        self._panel.set_running(True)
        self._panel.show_status(tr("Every run is kept in {folder}.", folder=self._folder))
        self._task = self._context.start(
            tr("Angle of repose: study"),
            Job(run_repose_study, (request, self._folder)),
            self._finished,
            partial=self._panel.show_study,
            failed=self._failed,
            stopped=self._stopped,
            lane=LANE,
        )

    def stop(self) -> None:
        """Stop; the next start resumes the study."""
        self._context.session.cancel(self._task)

    def _request(self) -> ReposeStudyRequest:
        key, values, repeats, workers = self._panel.request()
        session, request = self._context.session, self._setup.request()
        if key not in SHAPE_KEYS:
            return ReposeStudyRequest(key, values, request, self._setup.dataset, repeats, workers=workers)
        particles = tuple(entry.particle for entry in session.particles)
        coarsening = session.choices.coarsening_request
        return ReposeStudyRequest(key, values, request, None, repeats, particles, coarsening, workers)

    def _finished(self, study: ReposeStudy) -> None:
        self._panel.show_study(study)
        self._over(
            tr("{count} runs; tables and figure are in {folder}.", count=len(study.runs), folder=self._folder)
        )

    def _failed(self, failure: Failed) -> None:
        self._over(failure.sentence)
        self._context.toast.problem(failure.sentence, failure.details)

    def _stopped(self) -> None:
        self._over(tr("Stopped; finished runs are kept, and the start button resumes."))

    def _over(self, text: str) -> None:
        self._running = False
        self._panel.set_running(False)
        self._panel.show_status(text)

    def _choose(self, run: ReposeStudyRun) -> None:
        if self._folder is not None:
            self._show_run(RunSummary(study_place(self._folder, run.folder), run.document))
