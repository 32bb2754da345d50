"""Starts of the descent, one after the other, and the best of what they lead to."""

from collections.abc import Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from regolith_studio.coarsening.core.facet_insertion import MIN_FACET
from regolith_studio.coarsening.core.polyhedron_measures import measure_polyhedron, tangents_of
from regolith_studio.coarsening.loss import LossFunction, loss
from regolith_studio.coarsening.lower_bounds import sphericity_reason, volume_is_preferred
from regolith_studio.coarsening.optimiser.body import Prices
from regolith_studio.coarsening.optimiser.descent import FOLLOWED, LOCK, MAX_RADIUS, descend
from regolith_studio.coarsening.optimiser.memory import Memory, memory_for
from regolith_studio.coarsening.optimiser.starts import (
    N_SIDES,
    box_start,
    first_starts,
    grouped_start,
    hull_triangles,
    own_planes,
    round_start,
    stage_below,
    with_cuts,
    with_waiting,
)
from regolith_studio.coarsening.progress import MethodStep
from regolith_studio.coarsening.reasons import EXACT, missed_terms, own_reason, reason_for
from regolith_studio.coarsening.result import MethodResult
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import JACCARD, LossWeights
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.descriptors.describe import Descriptors, describe, relative_errors
from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.steps import as_events

TERMS = ("volume", "sphericity", "min_diameter", "max_diameter", "aspect_ratio", "convex_hull_volume")
"""Rows of the descent."""
VOLUME_SHARE, SPHERICITY_SHARE = 3.0, 0.3
"""Of the price of the box's edges: where not all can be kept, the sphericity gives way, and the volume, which
any polyhedron can have, never does."""
TIE_BREAK_PRICE = 1e-2
"""Price of the overlap where it has none: shapes that only meet descriptors drift away from the particle."""
FREE_STEPS, RACE_STEPS, STEPS, FURTHER_STEPS, LAST_STEPS = 25, 30, 60, 30, 120
"""On the overlap alone, on the whole loss until the best go on, and until the end, after half-spaces became
cuts, and of the best at the end."""
CONTINUATIONS = 3
"""Descents that have not met all by then go on so often, with a new metric: most are still on the way."""
SHORTER, NEARLY_MET = (1.0, 1.0, 0.1, 2e-3, 2e-3, 2e-3, 2e-3), 1e-2
"""Those that miss no more than the last go on with another metric, and with first moves shorter by these
factors: vertices of the box may be closer than longer ones."""
GROWTH_STEPS = 25
"""After each stage of cuts on the way from few half-spaces to many."""
ROUND_STARTS = ("round", "round", "grouped")
"""For particles that are rounder than the number of facets can be (Goldberg)."""
DIRECT = 62
"""Where more facets are asked for, no start has so many: growth leads to as much with less effort."""
FACTOR = 2.5
"""Half-spaces after and before each stage of cuts."""
FREE_RADIUS, FIRST_RADIUS, FURTHER_RADIUS = 0.1, 0.2, 0.05
"""Longest moves at first; all but the first shrink with the square root of the number of facets."""
CUT_COST = 2e-3
"""By how much the loss may rise for facets that are put back."""
CUT_TRIALS = ((0.06, 0), (0.02, 0), (0.2, 0), (0.06, 1), (0.06, 3), (0.06, 9))
DEEP, DEEP_TRIALS = 200, ((0.2, 0), (0.06, 0), (0.3, 0), (0.2, 1), (0.2, 3), (0.2, 9))
"""Depths of cuts that only give half-spaces a facet, as shares of the way to the next corner, and how many
corners are passed over; the later ones where a single cut fails. The second where there are more facets than
that: their corners must leave room for cuts across the corners that they make."""
CUT_ROUNDS, CUT_STEPS, CUT_RADIUS = 40, 8, 0.05
"""Attempts to put facets back, steps of each, and their longest moves at first."""
SPREAD = 1.03
"""Two starts whose distances differ by no more count as alike."""
BOX_EVERY = 3
"""Of starts beyond those of the effort every third has the sides of the box, for particles that nearly fill
it."""
WORD_LENGTH = 2.0**-40
"""Wanted values are rounded to this share, far above the rounding of how they were measured."""


@dataclass(frozen=True)
class SearchEffort:
    """Starts, how many of the best come to rest, and how many of each size go on after a race; 0: all.

    `further` starts follow where all is kept, but a half-space bounds no facet or the best two are not alike.
    """

    starts: int
    finalists: int
    raced: int = 0
    further: int = 0


EFFORTS = {"fast": SearchEffort(1, 1), "best": SearchEffort(10, 3, raced=5, further=3)}
MORE = SearchEffort(5, 1)
"""Where the least effort keeps all, but a smaller box is found then, or a half-space bounds no facet."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """Where a descent ended, at unit volume: the loss as it sees it, and the largest residual to be kept.

    The relative errors of the terms (Eq. 8) are for the box that it follows, the first of `axes`, (b, 3, 3);
    the Jaccard distance is by the rays of the descent.
    """

    half_spaces: HalfSpaces
    merit: float
    worst: float
    errors: Mapping[str, float]
    jaccard_distance: float
    n_facets: int
    axes: FloatArray

    @property
    def met(self) -> bool:
        """Whether all that is to be kept is met."""
        return self.worst <= EXACT / 2

    def rank(self, n_facets: int) -> tuple[bool, bool, float]:
        """Sorting key, the best first: all is met, all facets are there, the loss."""
        return not self.met, self.n_facets < n_facets, self.merit


def prices_of_union(target: Target, weights: LossWeights, keep: frozenset[str]) -> Prices:
    """What the descent of a union pays: LOCK for a term that is to be kept, its weight for another."""
    wanted = np.array([round(target.descriptors[key] / WORD_LENGTH) * WORD_LENGTH for key in TERMS])
    overlap = weights[JACCARD] or TIE_BREAK_PRICE
    high = np.array([LOCK * overlap if key in keep else weights[key] for key in TERMS])
    high[1] *= SPHERICITY_SHARE if "sphericity" in keep else 1.0
    high[0] *= VOLUME_SHARE if "volume" in keep else 1.0
    if {"min_diameter", "max_diameter", "aspect_ratio"} <= keep:
        high[4] = 0.0  # it follows from the two
    return Prices(wanted, -high, high, overlap)


def prices_of(target: Target, weights: LossWeights, keep: frozenset[str]) -> Prices:
    """What the descent of a convex polyhedron pays, of which V and CH are one number.

    Where neither is to be kept, the loss is least where the one is met for which more is paid; beyond it the
    other pays back (section 2 of the guide's method page).
    """
    wanted, low, high, overlap = prices_of_union(target, weights, keep)
    low[5] = high[5] = 0.0
    if "volume" not in keep:
        hull = target.descriptors["convex_hull_volume"]
        if "convex_hull_volume" in keep:
            wanted[0], high[0], low[0] = hull, LOCK * overlap, -LOCK * overlap
        elif weights["volume"] or weights["convex_hull_volume"]:
            at_volume = volume_is_preferred(weights, target.descriptors)
            size = wanted[0] if at_volume else hull
            for_volume = weights["volume"] * size / wanted[0]
            for_hull = weights["convex_hull_volume"] * size / hull
            high[0] = for_volume - for_hull if at_volume else for_volume + for_hull
            low[0] = -(for_volume + for_hull) if at_volume else for_volume - for_hull
            wanted[0] = size
        elif keep:
            # nothing else gives the polyhedron its size: less surface would shrink it
            high[0], low[0] = LOCK * overlap, -LOCK * overlap
    return Prices(wanted, low, high, overlap)


Planes = tuple[FloatArray, FloatArray, FloatArray]
"""Normals, offsets and tangents."""


class Search:
    """Starts one after the other, and the best of what they lead to.

    Terms in `keep` are kept exactly; where no start does so, there are `retries` more. `fewer` are the
    half-spaces, at unit volume, of a result with fewer facets, from which one more start is made.
    """

    def __init__(
        self,
        target: Target,
        weights: LossWeights,
        keep: frozenset[str],
        n_facets: int,
        effort: SearchEffort,
        retries: int,
        seed: np.random.SeedSequence,
        fewer: HalfSpaces | None = None,
    ) -> None:
        self._target, self._keep, self._n_facets = target, keep, n_facets
        self._effort, self._fewer = effort, fewer
        self._rng = np.random.default_rng(seed)
        self._weights, self._retries, self._seed = weights, retries, seed
        self._prices = prices_of(target, weights, keep)
        nothing = np.zeros(len(TERMS))
        self._free_prices = self._prices._replace(low=nothing, high=nothing)
        self._rays = target.rays
        keeps = "sphericity" in keep
        self._stage = stage_below(target, n_facets, keeps)
        self._plan = first_starts(target, n_facets, keeps, self._stage)
        self._needed = (0 if keeps else 1) if self._stage and n_facets > DIRECT else effort.starts
        self._triangles = hull_triangles(target)
        self._judge = LossFunction(target, weights, everything=True)
        if keeps and sphericity_reason(target.descriptors["sphericity"], n_facets):
            self._plan = tuple((kind, n_facets) for kind in ROUND_STARTS)
            retries = min(retries, len(ROUND_STARTS))
        self._most = effort.starts + retries
        self._memory: dict[int, Memory] = {}
        self._found: list[Candidate] = []
        self._history: list[float] = []
        self._free_distance = np.inf
        self._before = 0

    def steps(self) -> Generator[MethodStep, None, MethodResult]:
        """A step for each better polyhedron, and the result; the first is the first start itself."""
        own = self._itself
        if own is not None:
            yield self._step(0, own.half_spaces)
            return self._result(own, own_reason(own.n_facets, self._n_facets), 0)
        tried = yield from self._candidates()
        solid, achieved = self._confirmed()
        if self._effort == EFFORTS["fast"] and self._nearly(solid, achieved):
            found, more = yield from self._of_another(self._n_facets, MORE)
            self._found, tried = [*self._found, *found], tried + more
            solid, achieved = self._confirmed()
        errors = relative_errors(self._target.descriptors, achieved)
        overlap = self._target.jaccard_distance(solid.half_spaces)
        yield self._better(tried, solid.half_spaces, loss(self._weights, errors, overlap))
        descriptors, free = self._target.descriptors, self._free_distance
        reason = reason_for(descriptors, achieved, self._keep, self._n_facets, solid.n_facets, free)
        return self._result(solid, reason, tried, achieved, overlap)

    def _candidates(self) -> Generator[MethodStep, None, int]:
        """A step for each better polyhedron, and how many starts were tried."""
        yield from self._of_less_effort()
        few = yield from self._of_fewer()
        small = [*few]
        while self._needed == 0 and small:
            yield from self._record(0, self._grown(small.pop(0)))
        tried, race = 0, list[Candidate]()
        for start, held in self._starts():
            if self._good_enough(tried, (*few, *self._found)):
                break
            tried += 1
            if tried == 1 and not few and not self._found:
                yield self._better(0, start, None)
            for found in self._ends(start, held, tried, race):
                if len(found.half_spaces.offsets) == self._n_facets:
                    yield from self._record(tried, found)
                else:
                    small.append(found)
                    few.append(found)
        for found in sorted(small, key=lambda each: each.rank(0))[: self._effort.finalists]:
            yield from self._record(tried, self._grown(found))
        if self._fewer is not None:
            yield from self._record(tried, self._more(self._fewer, self._n_facets, STEPS))
        if not self._found:
            raise GeometryError("No start of the exact method bounds a polyhedron.")
        for candidate in sorted(self._found, key=self._rank)[: self._effort.finalists]:
            steps = LAST_STEPS if self._n_facets <= DIRECT else FURTHER_STEPS
            last = self._further(candidate, steps, FURTHER_RADIUS) or candidate
            yield from self._record(tried, last)
            whole = self._with_facets(last)
            yield from self._record(tried, whole)
            even = self._further(whole, FURTHER_STEPS, FURTHER_RADIUS, steady=True)
            yield from self._record(tried, even)
        yield from self._made_whole(tried, few)
        return tried

    def _of_fewer(self) -> Generator[MethodStep, None, list[Candidate]]:
        """What the same search finds for the next smaller of :data:`STAGES`, with its steps."""
        if self._stage == 0:
            return []
        found, _ = yield from self._of_another(self._stage, self._effort)
        return found[: self._effort.finalists]

    def _of_less_effort(self) -> Iterator[MethodStep]:
        """What the least effort finds is among the candidates of more, with its steps."""
        least = EFFORTS["fast"]
        if self._effort not in (least, MORE):
            found, _ = yield from self._of_another(self._n_facets, least)
            self._found += found[:1]

    def _of_another(
        self, n_facets: int, effort: SearchEffort
    ) -> Generator[MethodStep, None, tuple[list[Candidate], int]]:
        """Candidates of another search with the same seed, the best first, and its number of starts."""
        target, before = self._target, self._before
        search = Search(target, self._weights, self._keep, n_facets, effort, self._retries, self._seed)

        def counted(step: MethodStep) -> Iterator[MethodStep]:
            self._before = before + step.step
            yield replace(step, step=self._before, steps=before + step.steps + self._most)

        tried = yield from as_events(search._candidates(), counted)
        self._history = self._history or search._history
        self._free_distance = min(self._free_distance, search._free_distance)
        return sorted(search._found, key=search._rank), tried

    def _made_whole(self, tried: int, few: Sequence[Candidate]) -> Iterator[MethodStep]:
        """A step for a polyhedron with all facets, from any that keeps all, where the best have lost some."""
        n_facets = self._n_facets
        if any(each.met and each.n_facets == n_facets for each in self._found):
            return
        for found in sorted([*few, *self._found], key=lambda each: each.merit):
            if not found.met:
                continue
            begun = self._descended(with_waiting(found.half_spaces, n_facets), 0, FURTHER_RADIUS)
            whole = None if begun is None else self._with_facets(begun)
            if whole is not None and whole.met and whole.n_facets == n_facets:
                yield from self._record(tried, whole)
                even = self._further(whole, FURTHER_STEPS, FURTHER_RADIUS, steady=True)
                yield from self._record(tried, even)
                return

    def _good_enough(self, tried: int, found: Sequence[Candidate]) -> bool:
        """Whether all is kept, with all facets, and by two starts about as well, or after further starts.

        Where fewer facets have been searched already, it is enough that they could grow.
        """
        if self._needed == 0 and any(each.met and each.n_facets == self._n_facets for each in self._found):
            return True
        met = sorted(each.merit for each in found if each.met)
        whole = any(each.n_facets == len(each.half_spaces.offsets) for each in found if each.met)
        alike = len(met) > 1 and met[1] <= SPREAD * met[0]
        return bool(met) and tried >= max(1, self._needed) + (0 if whole and alike else self._effort.further)

    def _starts(self) -> Iterator[tuple[HalfSpaces, int]]:
        """As many as the effort and the retries allow, some with few half-spaces to grow from.

        With each comes how many of its half-spaces do not move.
        """
        for number in range(self._most):
            kind, size = self._plan[number % len(self._plan)]
            boxed = None
            if number >= self._effort.starts and (number - self._effort.starts) % BOX_EVERY == 0:
                boxed = box_start(self._target, self._triangles, self._n_facets, self._rng)
            if boxed is not None:
                yield boxed, N_SIDES
            elif kind == "round":
                yield round_start(self._target, size, self._rng), 0
            else:
                yield grouped_start(self._target, self._triangles, size, self._rng), 0

    def _ends(self, start: HalfSpaces, held: int, tried: int, race: list[Candidate]) -> Sequence[Candidate]:
        """Where a start leads; nothing while others are still to be raced, then where the best of them do."""
        first, raced = self._needed, self._effort.raced
        if not 0 < raced < first or tried > first:
            found = self._from_start(start, held, STEPS)
            return [] if found is None else [self._continued(found, held)]
        begun = self._from_start(start, held, RACE_STEPS)
        race += [] if begun is None else [begun]
        ends = []
        for size in sorted({len(each.half_spaces.offsets) for each in race}) if tried == first else ():
            same = [each for each in race if len(each.half_spaces.offsets) == size]
            for each in sorted(same, key=lambda each: each.rank(0))[:raced]:
                further = self._further(each, STEPS, FURTHER_RADIUS) or each
                ends.append(self._continued(further, 0))
        return ends

    def _from_start(self, start: HalfSpaces, held: int, steps: int) -> Candidate | None:
        """On the overlap alone, then so many steps on the whole loss."""
        planes = _planes_of(start)
        sound, _, _, distance = self._descend(self._free_prices, planes, FREE_STEPS, FREE_RADIUS, held=held)
        if sound:
            self._free_distance = min(self._free_distance, distance)
            start = HalfSpaces(planes[0], planes[1])
        return self._descended(start, steps, FIRST_RADIUS, held=held)

    def _continued(self, found: Candidate, held: int) -> Candidate:
        """Until all is kept, as far as that can be; then half-spaces without a facet become cuts."""
        for tried in range(CONTINUATIONS + len(SHORTER)):
            if found.met or (tried >= CONTINUATIONS and found.worst > NEARLY_MET):
                break
            share, nearly = (1.0, *SHORTER)[max(0, tried - CONTINUATIONS + 1)], tried >= CONTINUATIONS
            radius = share * FURTHER_RADIUS
            found = self._further(found, STEPS, radius, held=held, steady=nearly) or found
        return self._settled(found, held)

    def _grown(self, few: Candidate) -> Candidate | None:
        """With further half-spaces in stages, as cuts across the corners that hang out farthest."""
        found: Candidate | None = few
        while found is not None and len(found.half_spaces.offsets) < self._n_facets:
            size = min(self._n_facets, round(FACTOR * len(found.half_spaces.offsets)))
            found = self._more(found.half_spaces, size, GROWTH_STEPS)
        return found

    def _more(self, few: HalfSpaces, size: int, steps: int) -> Candidate | None:
        """A polyhedron with further facets, up to `size`, that is not worse where that can be."""
        begun = self._descended(with_waiting(few, size), 0, FURTHER_RADIUS)
        if begun is None:
            return None
        begun = self._with_facets(begun)
        if size == self._n_facets:
            # the free descent may lose facets that cannot be put back
            even = self._further(begun, steps, FURTHER_RADIUS, steady=True)
            self._found += [begun] if even is None else [begun, even]
        found = self._settled(self._further(begun, steps, FURTHER_RADIUS) or begun)
        return begun if begun.rank(0) < found.rank(0) else found

    def _settled(self, found: Candidate, held: int = 0) -> Candidate:
        """Half-spaces without a facet become cuts, where the loss falls by them."""
        if found.n_facets == len(found.half_spaces.offsets):
            return found
        cut = with_cuts(self._target, found.half_spaces)
        further = self._descended(cut, FURTHER_STEPS, FURTHER_RADIUS, held=held, axes=found.axes)
        return found if further is None else min(further, found, key=lambda each: each.rank(0))

    def _with_facets(self, found: Candidate) -> Candidate:
        """With all half-spaces bounding a facet, where that costs little of the loss.

        Cuts are brought to what is kept by a few short steps; where so many at once cannot be, half of them.
        """
        best, most = found, found.merit + CUT_COST * self._prices.overlap
        size, failures = len(found.half_spaces.offsets), 0
        trials = CUT_TRIALS if size <= DEEP else DEEP_TRIALS
        cuts = size - best.n_facets
        for _ in range(CUT_ROUNDS):
            if cuts == 0 or failures == len(trials):
                break
            depth, passed = trials[failures]
            cut = with_cuts(
                self._target, best.half_spaces, cuts, depth, best.axes[0] if len(best.axes) else None, passed
            )
            more = self._descended(cut, CUT_STEPS, CUT_RADIUS, steady=True, restoring=True, axes=best.axes)
            worse = more is None or more.merit > most or (found.met and not more.met)
            if more is None or worse or more.n_facets <= best.n_facets:
                failures += cuts == 1
                cuts = max(1, cuts // 2)
            else:
                best, cuts, failures = more, size - more.n_facets, 0
        return best

    def _further(
        self, found: Candidate, steps: int, radius: float, held: int = 0, steady: bool = False
    ) -> Candidate | None:
        """From where another descent ended, with its boxes."""
        return self._descended(found.half_spaces, steps, radius, held, steady, axes=found.axes)

    def _descended(
        self,
        start: HalfSpaces,
        steps: int,
        radius: float,
        held: int = 0,
        steady: bool = False,
        restoring: bool = False,
        axes: FloatArray | None = None,
    ) -> Candidate | None:
        """Where a descent ends; `axes` are those of the boxes to begin with, where they are known."""
        planes = _planes_of(start)
        radius /= np.sqrt(len(start.offsets))
        sound, merit, worst, distance = self._descend(
            self._prices, planes, steps, radius, held, steady, restoring, axes
        )
        if not sound:
            return None
        n_real = int(np.count_nonzero(measure_polyhedron(planes[0], planes[1]).areas >= MIN_FACET))
        memory, descriptors = self._memory[len(start.offsets)], self._target.descriptors
        residuals, boxes = memory.residuals, memory.frames[: memory.counts[FOLLOWED]].copy()
        volume = self._prices.wanted[0] * (1.0 + residuals[0])
        errors = dict(zip(TERMS, np.abs(residuals), strict=True))
        for key in ("volume", "convex_hull_volume"):  # of a convex polyhedron they are one
            errors[key] = abs(volume / descriptors[key] - 1.0)
        return Candidate(HalfSpaces(planes[0], planes[1]), merit, worst, errors, distance, n_real, boxes)

    def _descend(
        self,
        prices: Prices,
        planes: Planes,
        steps: int,
        radius: float,
        held: int = 0,
        steady: bool = False,
        restoring: bool = False,
        axes: FloatArray | None = None,
    ) -> tuple[bool, float, float, float]:
        normals, offsets, tangents = planes
        size = len(offsets)
        if size not in self._memory:
            self._memory[size] = memory_for(size, len(self._rays.directions))
        memory = self._memory[size]
        # a copy: for an array that is locked numba would compile the descent once more
        return descend(
            self._rays,
            prices,
            np.array(self._target.box.axes),
            steps,
            min(radius, MAX_RADIUS),
            held,
            steady,
            restoring,
            np.empty((0, 3, 3)) if axes is None else axes,
            normals,
            offsets,
            tangents,
            memory,
        )

    def _record(self, tried: int, found: Candidate | None) -> Iterator[MethodStep]:
        """Keep what a start led to; a step where it is the best so far."""
        if found is None:
            return
        best = min((self._rank(each) for each in self._found), default=None)
        self._found.append(found)
        if best is None or self._rank(found) < best:
            # where not all is kept, another box than that of the descent may be the least
            value = loss(self._weights, found.errors, found.jaccard_distance) if found.met else None
            yield self._better(tried, found.half_spaces, value)

    def _better(self, number: int, half_spaces: HalfSpaces, value: float | None) -> MethodStep:
        """A step that the curve of the loss takes up."""
        step = self._step(number, half_spaces, value)
        # less of Eq. 9 that misses more of what is to be kept was no step towards this
        while self._history and self._history[-1] < step.loss:
            self._history.pop()
        if step.loss < np.inf:
            self._history.append(step.loss)
        return step

    def _step(self, number: int, half_spaces: HalfSpaces, value: float | None = None) -> MethodStep:
        """With Eq. 9 where it is known; all but the last by the rays of the descent."""
        if value is None:
            value = self._judge.value(half_spaces.normals, half_spaces.offsets)
        return MethodStep(self._before + number, self._before + self._most, value, half_spaces)

    def _rank(self, candidate: Candidate) -> tuple[bool, bool, float]:
        return candidate.rank(self._n_facets)

    @cached_property
    def _itself(self) -> ConvexPolyhedron | None:
        """The particle, where it is a convex polyhedron with as many facets or fewer."""
        planes = own_planes(self._target, self._n_facets)
        if planes is None:
            return None
        solid = ConvexPolyhedron.from_half_spaces(planes)
        errors = relative_errors(self._target.descriptors, describe(solid, LOSS_KEYS))
        return solid if max(errors.values()) <= EXACT else None

    def _nearly(self, solid: ConvexPolyhedron, achieved: Descriptors) -> bool:
        """Whether a descent kept all, but the public descriptors miss a term or facets are missing."""
        missed = missed_terms(self._target.descriptors, achieved, self._keep)
        return any(each.met for each in self._found) and (bool(missed) or solid.n_facets < self._n_facets)

    def _confirmed(self) -> tuple[ConvexPolyhedron, Descriptors]:
        """The best of which the public descriptors say that all is kept, else that which misses least."""
        checked: list[tuple[float, ConvexPolyhedron, Descriptors]] = []
        for candidate in sorted(self._found, key=self._rank):
            solid = ConvexPolyhedron.from_half_spaces(candidate.half_spaces)
            achieved = describe(solid)
            missed = missed_terms(self._target.descriptors, achieved, self._keep)
            worst = max(missed.values(), default=0.0)
            checked.append((worst, solid, achieved))
            if (
                worst <= 1.01 * candidate.worst + EXACT
            ):  # else a smaller box lies where the search did not look
                break
        return min(checked, key=lambda each: each[0])[1:]

    def _result(
        self,
        solid: ConvexPolyhedron,
        reason: str | None,
        tried: int,
        achieved: Descriptors | None = None,
        overlap: float | None = None,
    ) -> MethodResult:
        achieved = achieved or describe(solid)
        missed = missed_terms(self._target.descriptors, achieved, self._keep)
        return MethodResult(
            solid.half_spaces,
            tuple(self._history),
            reason,
            {"starts": float(tried), "exact": float(not missed)},
            polyhedron=solid,
            achieved=achieved,
            jaccard_distance=overlap,
            free_distance=self._free_distance if self._free_distance < np.inf else None,
        )


def _planes_of(start: HalfSpaces) -> Planes:
    """Normals, offsets and tangents of half-spaces, to be changed in place."""
    normals = np.array(start.normals)
    return normals, np.array(start.offsets), tangents_of(normals)
