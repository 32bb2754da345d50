"""Work that follows the hand: what is under way is finished and shown, then comes the newest wish."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from regolith_studio.jobs.events import Failed, Job
from regolith_studio.ui.page import PageContext


@dataclass(frozen=True, eq=False)
class _Wish:
    job: Job
    show: Callable[[Any], None]
    refuse: Callable[[str], None]


class LatestJob:
    """Does one piece of work at a time in the background, and leaves out what was wished for in between.

    A lane alone would stop what is under way: who drags without a rest would see nothing.

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
        self._next: _Wish | None = None

    def submit(self, job: Job, show: Callable[[Any], None], refuse: Callable[[str], None]) -> None:
        """Do this as soon as what is under way has ended, unless something newer is wanted by then.

        Parameters
        ----------
        show
            Called with the result.
        refuse
            Called with one sentence if there can be none.
        """
        self._next = _Wish(job, show, refuse)
        if not self._busy:
            self._begin()

    def _begin(self) -> None:
        wish, self._next = self._next, None
        if wish is None:
            return
        self._busy = True
        self._context.start(
            self._title,
            wish.job,
            lambda made: self._end(lambda: wish.show(made)),
            failed=lambda failure: self._end(lambda: self._tell(wish, failure)),
            stopped=lambda: self._end(lambda: None),
            lane=self._lane,
        )

    def _end(self, tell: Callable[[], None]) -> None:
        self._busy = False
        try:
            tell()
        finally:
            self._begin()

    @staticmethod
    def _tell(wish: _Wish, failure: Failed) -> None:
        wish.refuse(failure.sentence)
