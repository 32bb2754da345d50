"""Studies of whole samples: what a chosen l_max and a chosen loss do to the descriptors."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

Mapper = Callable[[Callable[[Any], Any], Iterable[Any]], Iterable[Any]]
"""Anything that maps a picklable function in order: ``map``, or the ordered lazy map of a process pool."""


@dataclass(frozen=True)
class StudyProgress:
    """One step of a study: `done` of `total` pieces of work are finished.

    - ``done``, ``total``: counts of equal pieces of work, 0 <= done <= total.
    - ``message``: what was finished last, for a progress bar.
    - ``partial``: the study's result over the pieces finished so far, or ``None`` where there is none yet.

    Raises ValueError if the counts are out of order.
    """

    done: int
    total: int
    message: str = ""
    partial: object | None = None

    def __post_init__(self) -> None:
        if not 0 <= self.done <= self.total:
            raise ValueError(f"done must lie between 0 and total, got {self.done} of {self.total}")

    @property
    def share(self) -> float:
        """Finished share of the work, 0 to 1."""
        return self.done / self.total if self.total else 1.0
