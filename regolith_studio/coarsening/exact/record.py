"""What the exact method has found so far."""

from collections.abc import Iterable, Iterator

import numpy as np

from regolith_studio.coarsening.exact.single_start import Candidate
from regolith_studio.coarsening.loss import LossFunction
from regolith_studio.coarsening.progress import MethodStep
from regolith_studio.geometry.half_spaces import HalfSpaces

AS_GOOD_AS_MET = 4e-3
"""Polyhedra whose constraints hold to this come before those with less loss."""
SAME = 1e-6
"""Losses that differ by less are of one polyhedron, which boxes were searched for once more."""


class Record:
    """The best polyhedron, and the one with the smallest loss of those that miss a constraint.

    `exact` lists those that meet all constraints and were not confirmed yet; `min_distance` is the smallest
    Jaccard distance of all, whether or not they meet the constraints.

    Parameters
    ----------
    judge
        Eq. 9.
    steps
        Number of steps in all.
    """

    def __init__(self, judge: LossFunction, steps: int) -> None:
        self.best: Candidate | None = None
        self.history: list[float] = []
        self.exact: list[Candidate] = []
        self.min_distance = np.inf
        self._ends: dict[int, Candidate] = {}
        self._nearest: Candidate | None = None
        self._min_loss = np.inf
        self._judge = judge
        self._steps = steps

    @property
    def met(self) -> bool:
        """Whether the best polyhedron meets all constraints."""
        return self.best is not None and self.best.exact

    @property
    def result(self) -> Candidate | None:
        """The best where it meets all constraints or nearly so, else the one with the smallest loss."""
        if self.best is None or self.best.worst < AS_GOOD_AS_MET:
            return self.best
        return self._nearest or self.best

    def best_ends(self, most: int) -> list[tuple[int, Candidate]]:
        """The best of each step that meets all constraints, with its number; `most` of them, best first."""
        rank = sorted(
            self._ends.items(),
            key=lambda end: (end[1].n_facets < len(end[1].offsets), end[1].jaccard_distance),
        )
        return rank[:most]

    def _value(self, found: Candidate) -> float:
        """Eq. 9; of one that nobody will confirm with the least box of all, not one that was tracked."""
        if found.exact:
            return self._judge.of(found.measures).loss
        return self._judge.value(found.normals, found.offsets)

    def record_candidates(self, step: int, candidates: Iterable[Candidate]) -> Iterator[MethodStep]:
        """Keep what is better; a step number `step` for each."""
        for found in candidates:
            value = self._value(found)
            worth = found.better_than(self.best)
            self.min_distance = min(self.min_distance, found.jaccard_distance)
            if found.exact:
                self.exact.append(found)
                self._ends[step] = found if found.better_than(self._ends.get(step)) else self._ends[step]
            if worth:
                self.best = found
            if not found.exact and not self.met and value < self._min_loss:
                self._nearest, self._min_loss, worth = found, value, True
            if worth:
                self.history.append(value)
                yield MethodStep(step, self._steps, value, HalfSpaces(found.normals, found.offsets))

    def record_final(self, reported: HalfSpaces) -> Iterator[MethodStep]:
        """A step for what is reported, where it is not that of the last step."""
        value = self._judge.value(reported.normals, reported.offsets)
        if not self.history or abs(value - self.history[-1]) > SAME:
            self.history.append(value)
            yield MethodStep(self._steps, self._steps, value, reported)
