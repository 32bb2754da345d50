"""Starts and stops the calibration of the page and shows its progress in the panel."""

import hashlib
from pathlib import Path

from regolith_studio.errors import RegolithError
from regolith_studio.io.file_names import MAX_NAME_BYTES, cut_name, file_stem
from regolith_studio.io.output_lock import output_lock
from regolith_studio.jobs.events import Failed, Job, Steps
from regolith_studio.jobs.repose_calibration import ReposeCalibrationRequest, calibration_steps
from regolith_studio.studies.repose_calibration import ReposeCalibration
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.repose.calibration import CalibrationPanel
from regolith_studio.ui.pages.repose.setup import SetupPanel
from regolith_studio.ui.translation import tr

LANE = "calibration"


class CalibrationController:
    """Runs one calibration at a time in the background.

    Parameters
    ----------
    panel, setup
        What is wanted, and all other values of a run.
    """

    def __init__(self, context: PageContext, panel: CalibrationPanel, setup: SetupPanel) -> None:
        self._context, self._panel, self._setup = context, panel, setup
        self._running, self._task = False, 0
        panel.stopWanted.connect(self.stop)

    def busy(self) -> str:
        """What closing the window would interrupt; empty for nothing."""
        return tr("A calibration would be stopped; it can be resumed later.") if self._running else ""

    def start(self, runs: Path) -> None:
        """Start or resume the calibration in its own folder below `runs`."""
        if self._running:
            return
        try:
            request = self._panel.request(self._setup.dataset, self._setup.request())
        except RegolithError as error:
            self._context.toast.problem(tr(str(error)))
            return
        folder = runs / "studies" / folder_name(request)
        self._running = True
        self._panel.show_calibration(None)
        self._panel.set_running(True)
        self._panel.show_status(tr("Every run is kept in {folder}.", folder=folder))
        self._task = self._context.start(
            tr("Angle of repose: calibration"),
            Job(locked_calibration, (request, folder)),
            self._finished,
            partial=self._panel.show_calibration,
            failed=self._failed,
            stopped=self._stopped,
            lane=LANE,
        )

    def stop(self) -> None:
        """Stop; the next start resumes."""
        self._context.session.cancel(self._task)

    def _finished(self, calibration: ReposeCalibration) -> None:
        self._end()
        self._panel.show_calibration(calibration)

    def _failed(self, failure: Failed) -> None:
        self._end()
        self._panel.show_status(failure.sentence)
        self._context.toast.problem(failure.sentence, failure.details)

    def _stopped(self) -> None:
        self._end()
        self._panel.show_status(tr("Stopped; finished runs are kept, and the start button resumes."))

    def _end(self) -> None:
        self._running = False
        self._panel.set_running(False)


def folder_name(request: ReposeCalibrationRequest) -> str:
    """One name for all calibrations whose runs can serve each other."""
    same = repr((request.datasets, sorted(request.ranges), request.request))
    name = cut_name(request.datasets[0].name, MAX_NAME_BYTES - 21)
    return f"calibration-{file_stem(name)}-{hashlib.sha256(same.encode()).hexdigest()[:8]}"


def locked_calibration(request: ReposeCalibrationRequest, folder: Path) -> Steps:
    """The job in a folder that no other process writes to."""
    with output_lock(folder):
        return (yield from calibration_steps(request, folder))
