"""Jobs of a control that is dragged: the running one is finished and shown, then the newest one runs."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from regolith_studio.jobs.events import Failed, Job
from regolith_studio.ui.page import PageContext


@dataclass(frozen=True, eq=False)
class _Request:
    job: Job
    show: Callable[[Any], None]
    refuse: Callable[[str], None]


class LatestJob:
    """Runs one job at a time in the background, and skips those that a newer one has replaced.

    A lane alone would stop the running job, so that nothing would be shown during a drag.

    Parameters
    ----------
    context
        Of the page.
    title
        In the list of tasks.
    lane
        Of that page, for nothing else.
    """

    def __init__(self, context: PageContext, title: str, lane: str) -> None:
        self._context, self._title, self._lane = context, title, lane
        self._busy = False
        self._next: _Request | None = None

    def submit(self, job: Job, show: Callable[[Any], None], refuse: Callable[[str], None]) -> None:
        """Run `job` when the running one has ended, unless a newer one was submitted by then.

        Parameters
        ----------
        show
            Called with the result.
        refuse
            Called with one sentence if the job fails.
        """
        self._next = _Request(job, show, refuse)
        if not self._busy:
            self._begin()

    def _begin(self) -> None:
        request, self._next = self._next, None
        if request is None:
            return
        self._busy = True
        self._context.start(
            self._title,
            request.job,
            lambda result: self._end(lambda: request.show(result)),
            failed=lambda failure: self._end(lambda: self._report(request, failure)),
            stopped=lambda: self._end(lambda: None),
            lane=self._lane,
        )

    def _end(self, report: Callable[[], None]) -> None:
        self._busy = False
        try:
            report()
        finally:
            self._begin()

    @staticmethod
    def _report(request: _Request, failure: Failed) -> None:
        request.refuse(failure.sentence)
