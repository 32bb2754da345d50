"""The one controller of a job in the background whose state, time left and result are on a card."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from regolith_studio.jobs.events import Failed, Job
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.widgets.result_view import ResultRecord, ResultState, ResultView


class RunController:
    """Runs one job at a time in the background, with its state on a card.

    Parameters
    ----------
    card
        Its button starts what `start` does, and stops the job.
    queue
        Of the job.
    start
        Called by the button.
    stopped
        Note on the card of a job that was stopped.
    warning
        What closing the window would interrupt, which the list of tasks does not say.
    changed
        Called with whether the job is running.
    """

    def __init__(
        self,
        context: PageContext,
        card: ResultView,
        queue: str,
        start: Callable[[], object],
        stopped: str = "",
        warning: str = "",
        changed: Callable[[bool], object] = lambda _running: None,
    ) -> None:
        self._context, self._card, self._queue = context, card, queue
        self._warning, self._stop_note, self._changed = warning, stopped, changed
        self._task, self.running = 0, False
        self._ended: ResultState | None = None
        card.startRequested.connect(start)
        card.stopRequested.connect(self.stop)
        context.bindings.refresh("tasks", self._follow, slow=True)

    def busy(self) -> str:
        """What closing the window would interrupt; empty for nothing."""
        return self._warning if self.running else ""

    def start(
        self,
        title: str,
        job: Job,
        show: Callable[[Any], ResultRecord | None],
        note: str = "",
        ended: Callable[[], object] | None = None,
    ) -> None:
        """Start a job.

        Parameters
        ----------
        show
            Shows a partial or the final result, and returns the record of its card.
        note
            On the card until there is a result.
        ended
            Called when the job has failed or was stopped.
        """
        self._on_end, self._ended = ended or (lambda: None), None
        self._set_running(True)
        self._show(ResultRecord(state=ResultState.RUNNING, note=note))
        self._task = self._context.start(
            title,
            job,
            lambda result: self._finish(show, result),
            partial=lambda result: self._show(show(result), ResultState.RUNNING),
            failed=self._fail,
            stopped=self._stop,
            queue=self._queue,
        )

    def stop(self) -> None:
        """Stop the job."""
        self._context.session.cancel(self._task)
        self._follow()

    def forget(self) -> None:
        """Stop the job silently, and clear the card: its input is there no more."""
        self._context.stop(self._queue)
        self._task, self._ended = 0, None
        self._set_running(False)
        self._show(ResultRecord())

    def set_outdated(self, outdated: bool) -> None:
        """Mark the result as one of other choices than the present, or as the present one again."""
        if self._card.record.values and self._ended is not None:
            self._show(self._card.record, ResultState.STALE if outdated else self._ended)

    def _follow(self) -> None:
        """Show how far the job is."""
        mine = (task for task in self._context.session.tasks if task.id == self._task)
        self._card.show_task(next(mine, None))

    def _finish(self, show: Callable[[Any], ResultRecord | None], result: Any) -> None:
        self._set_running(False)
        self._ended = ResultState.CURRENT
        self._show(show(result), self._ended)

    def _fail(self, failure: Failed) -> None:
        self._set_running(False)
        self._on_end()
        self._ended = ResultState.FAILED
        self._show(replace(self._card.record, state=self._ended, note=failure.sentence))
        self._context.toast.problem(failure.sentence, failure.details)

    def _stop(self) -> None:
        self._set_running(False)
        self._on_end()
        self._ended = ResultState.STOPPED
        note = self._stop_note or self._card.record.note
        self._show(replace(self._card.record, state=self._ended, note=note))

    def _set_running(self, running: bool) -> None:
        self.running = running
        self._changed(running)

    def _show(self, record: ResultRecord | None, state: ResultState | None = None) -> None:
        if record is not None:
            self._card.show_record(record if state is None else replace(record, state=state))
