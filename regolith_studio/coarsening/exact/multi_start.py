"""The whole exact method: starts until one meets all constraints, and relaxations if none does."""

from collections.abc import Generator, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product

import numpy as np

from regolith_studio.coarsening.core.box_search import DENSE_ANGLE, FINE_ANGLE, SAMPLE_ANGLE
from regolith_studio.coarsening.exact.constraint_selection import (
    CONSTRAINT_KEYS,
    EXACT,
    NEARLY,
    ConstraintRequest,
    missed_constraints,
    own_planes,
    own_reason,
    reason_for,
)
from regolith_studio.coarsening.exact.constraints import SPHERICITY, VOLUME, Problem
from regolith_studio.coarsening.exact.facet_growth import (
    grow_facets,
    more_surface_than_hull,
    numbers_to_grow_from,
    with_waiting,
)
from regolith_studio.coarsening.exact.initial_planes import start_planes
from regolith_studio.coarsening.exact.record import Record
from regolith_studio.coarsening.exact.relaxation import relax, with_facets_back
from regolith_studio.coarsening.exact.roundest import solve_round
from regolith_studio.coarsening.exact.single_start import (
    Candidate,
    descend_further,
    search_and_project,
    single_start,
)
from regolith_studio.coarsening.exact.sliver_removal import COST, has_small_facets, remove_slivers
from regolith_studio.coarsening.exact.start_from_box import FEW_FACETS, solve_from_box
from regolith_studio.coarsening.exact.start_from_fewer import DEPTHS, grown_from_fewer, relaxed_from_fewer
from regolith_studio.coarsening.loss import LossFunction
from regolith_studio.coarsening.lower_bounds import sphericity_reason
from regolith_studio.coarsening.progress import MethodStep
from regolith_studio.coarsening.result import MethodResult
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.descriptors.comparison import relative_errors
from regolith_studio.descriptors.describe import describe
from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces


@dataclass(frozen=True)
class Level:
    """Effort: starts, polyhedra with few facets at each to grow many from, steps of each descent.

    The best `continued` of what single starts led to descend by `further_steps` more.
    """

    starts: int
    few_starts: int
    free_steps: int
    bound_steps: int
    sliver_steps: int
    continued: int
    further_steps: int

    def starts_for(self, n_facets: int) -> int:
        """Beyond 20 facets fewer, since each takes longer and they differ less."""
        return max(1, round(self.starts * min(1.0, 20 / n_facets)))


LEVELS = {"fast": Level(1, 2, 12, 28, 28, 0, 0), "best": Level(6, 2, 12, 16, 60, 3, 80)}
CHECK_ANGLES = (FINE_ANGLE, DENSE_ANGLE)
"""Of the searches for boxes that confirm a result."""
RELAXATION_FACETS = (12, 20)
"""Facets to start from, besides all, where constraints cannot be met together."""
RELAXATION_STARTS = 4
"""Starts with all facets there, so that what is reached hangs little on one of them."""
ROUNDER_STARTS = 2
"""Starts that are made rounder where the particle is rounder than what they lead to."""
SIZED = np.arange(5) == VOLUME
"""The volume is held while the sphericity is sought, asked for or not: less surface would shrink the body."""
OUT_OF_REACH = 4e-3
"""Where all polyhedra miss a constraint by more (in logarithms), no further start is tried."""
COSTLY_SURPLUS = 0.12
"""Where a particle has so much more surface than its hull (in logarithms), keeping it may cost overlap."""
RISE = 9e-4
"""By how much the Jaccard distance may lie above that of a result with fewer facets."""
FURTHER_STARTS = 3
"""Where all constraints are met, but a half-space bounds no facet, or the overlap is poor."""
POOR = 1.3
"""A Jaccard distance so many times that of a polyhedron that misses constraints is poor: the start ended far
from the particle, and another one may not."""


class Search:
    """Starts of the exact method, one after the other, and the best of what they lead to.

    Parameters
    ----------
    levels
        Their starts one after the other, so that more effort never leads to less.
    retries
        Further starts where those of a level do not meet all constraints.
    seed
        Of all starts.
    fewer
        Half-spaces of a result with fewer facets at unit volume, from which one more start is made.
    """

    def __init__(
        self,
        target: Target,
        weights: LossWeights,
        n_facets: int,
        levels: Sequence[Level],
        retries: int,
        seed: np.random.SeedSequence,
        fewer: HalfSpaces | None = None,
    ) -> None:
        request = ConstraintRequest.of(target, weights)
        self._target, self._request, self._n_facets = target, request, n_facets
        self._levels, self._level = levels, levels[0]
        self._rng = np.random.default_rng(seed)
        self._fewer = fewer
        self._free = request.problem(target.rays, SAMPLE_ANGLE, only_volume=True)
        self._full = request.problem(target.rays, SAMPLE_ANGLE)
        rest = request.problem(target.rays, SAMPLE_ANGLE, sphericity=False)
        self._rest = rest._replace(asked=rest.asked | SIZED)
        self._checks = tuple(request.problem(target.rays, angle) for angle in CHECK_ANGLES)
        self._judge = LossFunction(target, weights, everything=True)
        self._round_asked = bool(request.asked[SPHERICITY])
        wanted = target.descriptors["sphericity"]
        self._hopeless = self._round_asked and sphericity_reason(wanted, n_facets) is not None
        self._most = [1 if self._hopeless else each.starts_for(n_facets) + retries for each in levels]
        self._total = sum(self._most)
        self._numbers = (
            (n_facets,) if self._hopeless else numbers_to_grow_from(target, n_facets, self._round_asked)
        )
        self._record = Record(self._judge, self._total)
        self._planes: tuple[FloatArray, FloatArray]
        self._misses: list[float] = []
        self._confirmed: Candidate | None = None
        self._roundest: tuple[tuple[float, float], Candidate | None] = (np.inf, np.inf), None
        self._tried = self._tried_before = 0
        self._in_box = False

    def steps(self) -> Iterator[MethodStep]:
        """A step for each better polyhedron, level by level; the first is the first start itself.

        A later level begins with what was found.

        Raises
        ------
        GeometryError
            If no start bounds a polyhedron.
        """
        for level, most in zip(self._levels, self._most, strict=True):
            even = self._without_slivers() if self._tried else None
            self._level, self._tried_before = level, self._tried
            if even is not None:
                yield from self._record.record_candidates(self._tried, [even])
            yield from self._from_starts(most)
            yield from self._continued()
            yield from self._relaxations()
        if self._fewer is not None and not self._as_good_as_fewer():
            yield from self._from_fewer(self._fewer)

    def _from_starts(self, most: int) -> Iterator[MethodStep]:
        """A step for each better polyhedron until one is good enough."""
        for _ in range(most):
            self._tried += 1
            self._planes = start_planes(self._target, self._n_facets, self._rng)
            if self._tried == 1:
                value = self._judge.value(*self._planes)
                yield MethodStep(0, self._total, value, HalfSpaces(*self._planes))
            yield from self._record.record_candidates(self._tried, self._solved())
            if self._in_box or not self._whole:
                yield from self._record.record_candidates(self._tried, self._from_box())
                self._in_box = self._record.met
            if self._round_asked and not self._record.met and self._tried <= ROUNDER_STARTS:
                yield from self._made_rounder()
            if self._record.best is None:
                yield from self._record.record_candidates(self._tried, self._all_at_once())
            if self._good_enough() or self._out_of_reach():
                break
        if (self._misses or self._hopeless) and not self._record.met:
            yield from self._as_round_as_can_be()

    def _continued(self) -> Iterator[MethodStep]:
        """A step for each better polyhedron in longer descents from the best ends of single starts."""
        most, steps = self._level.continued, self._level.further_steps
        for number, found in self._record.best_ends(most):
            further = descend_further(self._full, found, steps)
            yield from self._record.record_candidates(number, further)
        if most and self._record.met:
            self._confirm()

    def _from_fewer(self, fewer: HalfSpaces) -> Iterator[MethodStep]:
        """A step for each better polyhedron that is cut out of one with fewer facets."""
        sizes = self._n_facets, self._level.bound_steps
        for problem, depths in product(self._checks, DEPTHS):
            found = grown_from_fewer(self._target, problem, fewer, *sizes, depths)
            yield from self._record.record_candidates(self._total, found)
            if self._record.met:
                self._confirm()
            if self._as_good_as_fewer():
                return
        if not self._record.met:
            relaxed = relaxed_from_fewer(self._target, self._full, self._rest, fewer, *sizes)
            yield from self._record.record_candidates(self._total, relaxed)

    def _as_good_as_fewer(self) -> bool:
        """Whether the best polyhedron needs no start from that with fewer facets, which leaves slivers."""
        return self._whole and self._room(self._without_slivers() or self._found()) >= 0.0

    def _relaxations(self) -> Iterator[MethodStep]:
        """A step for each polyhedron with less loss, where no start could meet all constraints together."""
        best = self._found()
        if not self._round_asked or self._record.met or self._misses or self._itself is not None:
            return
        all_planes = [
            start_planes(self._target, self._n_facets, self._rng) for _ in range(RELAXATION_STARTS - 1)
        ]
        few_planes = [
            with_waiting(*start_planes(self._target, few, self._rng), self._n_facets)
            for few in RELAXATION_FACETS
            if few < self._n_facets
        ]
        for planes in (self._planes, (best.normals, best.offsets), *all_planes, *few_planes):
            yield from self._record.record_candidates(self._total, self._relax(planes))

    def finish(self) -> Generator[MethodStep, None, MethodResult]:
        """A step for what is reported, where it is not what was told last, and the result.

        That is the best polyhedron without half-spaces that bound nothing, and a reason where it is not as
        asked.

        Raises
        ------
        GeometryError
            If no start bounds a polyhedron.
        """
        if not self._record.met and self._itself is not None:
            solid, found = self._itself, describe(self._itself)
            reason: str | None = own_reason(solid.n_facets, self._n_facets)
        else:
            outcome = self._without_slivers() or self._least_miss or self._record.result or self._found()
            outcome = with_facets_back(
                self._target, self._checks, self._judge, self._kept(outcome), self._n_facets
            )
            solid, found = outcome.solid, outcome.descriptors
            reason = reason_for(self._target, self._request, self._n_facets, solid.n_facets, found)
        met = not missed_constraints(self._target, self._request, found)
        counts = {"starts": float(self._tried), "exact": float(met)}
        yield from self._record.record_final(solid.half_spaces)
        history = tuple(self._record.history)
        free = self._without_sphericity()
        return MethodResult(
            solid.half_spaces,
            history,
            reason,
            counts,
            polyhedron=solid,
            achieved=found,
            without_sphericity=None if free is None else free.solid.half_spaces,
        )

    def _without_sphericity(self) -> Candidate | None:
        """What one start finds with the sphericity free, where keeping it may cost overlap."""
        costly = bool(self._misses) or more_surface_than_hull(self._target) > COSTLY_SURPLUS
        if not self._round_asked or not costly:
            return None
        best: Candidate | None = None
        planes = start_planes(self._target, self._n_facets, self._rng)
        for found in single_start(self._target, self._free, self._rest, planes, *self._descent_steps):
            best = found if found.better_than(best) else best
        return best if best is not None and best.exact else None

    def _without_slivers(self) -> Candidate | None:
        """The best with larger small facets, where it meets all constraints and they can be had."""
        best = self._record.best
        if best is None or not best.exact or not has_small_facets(best.normals, best.offsets):
            return None
        even = remove_slivers(self._full, best, self._level.sliver_steps, min(COST, self._room(best)))
        even = confirmed(self._request, self._checks, even)
        dear = even.jaccard_distance > best.jaccard_distance + COST or self._room(even) < 0.0
        return even if even.exact and even.n_facets >= best.n_facets and not dear else None

    def _room(self, found: Candidate) -> float:
        """By how much its Jaccard distance may rise until the result with fewer facets is clearly better."""
        if self._fewer is None:
            return np.inf
        distance = self._target.jaccard_distance
        return distance(self._fewer) + RISE - distance(found.solid.half_spaces)

    def _kept(self, outcome: Candidate) -> Candidate:
        """One that misses a constraint, the others confirmed by public descriptors, where that can be."""
        if outcome.exact:
            return outcome
        for nearly in (NEARLY, EXACT):
            request = self._request.nearly_met_by(outcome.descriptors, nearly)
            problems = (request.problem(self._target.rays, angle) for angle in CHECK_ANGLES)
            found = confirmed(request, tuple(problems), outcome.without_redundant())
            if found.exact:
                return replace(found, worst=outcome.worst)
        return outcome

    @cached_property
    def _itself(self) -> ConvexPolyhedron | None:
        """The particle, where it is a convex polyhedron with fewer facets, and so meets all constraints."""
        planes = own_planes(self._target, self._n_facets)
        if planes is None:
            return None
        solid = ConvexPolyhedron.from_half_spaces(planes)
        errors = relative_errors(self._target.descriptors, describe(solid, LOSS_KEYS))
        return solid if max(errors.values()) <= EXACT else None

    def _solved(self) -> Iterator[Candidate]:
        """From few facets or from all at once, in turns; nothing where the sphericity is above its bound."""
        few = self._numbers[(self._tried - 1) % len(self._numbers)]
        if few < self._n_facets:
            sizes = self._n_facets, few, self._level.few_starts
            yield from grow_facets(
                self._target, self._free, self._full, *sizes, self._rng, *self._descent_steps
            )
        elif not self._hopeless:
            yield from self._all_at_once()

    def _all_at_once(self) -> Iterator[Candidate]:
        return single_start(self._target, self._free, self._full, self._planes, *self._descent_steps)

    def _from_box(self) -> Iterator[Candidate]:
        """With six half-spaces on the sides of the particle's box, where a constraint is about the box."""
        if self._full.needs_box:
            problems = self._free, self._full, self._rest
            yield from solve_from_box(
                self._target, problems, self._n_facets, self._tried - 1, self._rng, self._descent_steps
            )

    def _made_rounder(self) -> Iterator[MethodStep]:
        """The way to the sphericity from below; it is noted by how much it is missed."""
        rounder = list(self._relax(self._planes, only_rounder=True))
        yield from self._record.record_candidates(self._tried, rounder)
        self._misses += [rounder[-1].worst] if rounder else []

    def _as_round_as_can_be(self) -> Iterator[MethodStep]:
        """A step for each better polyhedron on the way to the roundest, which is kept in mind.

        Where an earlier level missed by much, a later one does not try again.
        """
        best, steps = self._record.best, self._level.bound_steps
        if self._roundest[1] is not None and self._roundest[1].worst > OUT_OF_REACH:
            return
        problems = self._full, self._rest
        for found in solve_round(self._target, problems, best, self._n_facets, self._rng, steps):
            rank = found.worst, self._judge.value(found.normals, found.offsets)
            if rank <= self._roundest[0]:
                self._roundest = rank, found
            yield from self._record.record_candidates(self._tried, [found])
        if self._record.met:
            self._confirm()

    def _relax(
        self, planes: tuple[FloatArray, FloatArray], only_rounder: bool = False
    ) -> Iterator[Candidate]:
        steps = self._level.bound_steps
        return relax(self._target, self._full, self._rest, planes, steps, only_rounder)

    def _good_enough(self) -> bool:
        """Whether public descriptors say that all is met, with all facets or after enough starts for them."""
        best, tried = self._record.best, self._tried - self._tried_before
        starts = self._level.starts_for(self._n_facets)
        if tried < starts or best is None or not best.exact:
            return False
        best = self._confirm()
        satisfactory = best.n_facets == self._n_facets and not self._overlaps_poorly(best)
        return best.exact and (satisfactory or tried >= starts + FURTHER_STARTS)

    def _overlaps_poorly(self, best: Candidate) -> bool:
        """Whether other starts may overlap much better; on rough particles the sphericity costs overlap."""
        is_rough = self._round_asked and more_surface_than_hull(self._target) > COSTLY_SURPLUS
        return not is_rough and best.jaccard_distance > POOR * self._record.min_distance

    def _confirm(self) -> Candidate:
        """The best so far that the public descriptors confirm, if any, else the nearest.

        A finer search for boxes may take facets or constraints from the best: then another is better.
        """
        best = self._confirmed
        left = sorted(
            self._record.exact, key=lambda each: (each.n_facets < len(each.offsets), each.jaccard_distance)
        )
        for found in left:
            if not found.better_than(best):
                break
            checked = confirmed(self._request, self._checks, found)
            best = checked if checked.better_than(best) else best
        self._record.exact.clear()
        self._confirmed = self._record.best = best or self._found()
        return self._confirmed

    def _out_of_reach(self) -> bool:
        """Whether the sphericity is missed by so much that other starts would miss it too."""
        best = self._record.best
        nearly_met = best is not None and best.worst < OUT_OF_REACH
        enough = self._hopeless or self._tried >= len(FEW_FACETS)
        return enough and sum(self._misses) > OUT_OF_REACH and not nearly_met

    @property
    def _least_miss(self) -> Candidate | None:
        """The roundest polyhedron, where the sphericity alone is missed and no other start came nearer."""
        best, (_, roundest) = self._record.best, self._roundest
        if best is None or best.exact or roundest is None or roundest.worst > best.worst:
            return None
        return roundest

    @property
    def _whole(self) -> bool:
        """Whether a polyhedron with all facets meets all constraints."""
        best = self._record.best
        return best is not None and best.exact and best.n_facets == self._n_facets

    @property
    def _descent_steps(self) -> tuple[int, int]:
        return self._level.free_steps, self._level.bound_steps

    def _found(self) -> Candidate:
        if self._record.best is None:
            raise GeometryError("No start of the exact method bounds a polyhedron.")
        return self._record.best


def confirmed(request: ConstraintRequest, problems: tuple[Problem, ...], found: Candidate) -> Candidate:
    """The candidate, projected with ever finer searches for boxes until the public descriptors agree.

    Its residual is the largest error of the public descriptors where they never do.
    """
    wanted = dict(zip(CONSTRAINT_KEYS, request.values, strict=True))
    for problem in problems:
        found = search_and_project(problem, found)
        if not found.exact:
            return found
        errors = (abs(found.descriptors[key] / wanted[key] - 1.0) for key in request.keys)
        worst = max(errors, default=0.0)
        if worst <= EXACT / 2:  # so that the ratio of two diameters has no more than EXACT
            return found
    return replace(found, worst=worst)
