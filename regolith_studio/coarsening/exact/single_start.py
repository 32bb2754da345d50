"""One start of the exact method: free descent, projection onto the constraints, descent along them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from regolith_studio.coarsening.core.facet_insertion import MIN_FACET, insert_lost_facets
from regolith_studio.coarsening.core.plane_coordinates import tangents_of
from regolith_studio.coarsening.exact.constraint_projection import (
    TOLERANCE,
    max_step,
    project,
    project_and_verify,
)
from regolith_studio.coarsening.exact.constraints import (
    CLOSE,
    ConstrainedPoint,
    Problem,
    constrained,
    measure,
)
from regolith_studio.coarsening.exact.projected_bfgs import (
    DescentState,
    begin_descent,
    descend,
    first_metric,
    overlap_objective,
    steady_metric,
)
from regolith_studio.coarsening.loss import LossMeasures
from regolith_studio.coarsening.polyhedra import facet_areas
from regolith_studio.coarsening.target import Target
from regolith_studio.descriptors.describe import Descriptors, describe
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces

CUT_DEPTHS = (0.3, 0.3, 0.1, 0.03, 0.01)
CHUNK = 8
"""Steps of a descent between two candidates."""
FREE_ROUNDS = 3
LONG_PROJECTION = 8
"""Gauss-Newton steps where a polyhedron comes from afar."""
CUT_PROJECTION = 32
"""After cuts: where the box is about to change its contacts, residuals fall by a third a step only."""


@dataclass(frozen=True)
class Candidate:
    """A polyhedron on the way.

    Parameters
    ----------
    normals, offsets
        Half-spaces, (n, 3) and (n,).
    jaccard_distance
        By the quadrature of the problem.
    worst
        Largest residual of the constraints, in logarithms.
    n_facets
        Real facets.
    measures
        For Eq. 9; NaN for the box where no constraint is about it.
    """

    normals: FloatArray
    offsets: FloatArray
    jaccard_distance: float
    worst: float
    n_facets: int
    measures: LossMeasures

    @cached_property
    def solid(self) -> ConvexPolyhedron:
        """The polyhedron of all half-spaces whose facets are more than rounding."""
        real = self.without_redundant()
        return ConvexPolyhedron.from_half_spaces(HalfSpaces(real.normals, real.offsets))

    @cached_property
    def descriptors(self) -> Descriptors:
        """Public descriptors of `solid`."""
        return describe(self.solid)

    def without_redundant(self) -> "Candidate":
        """The half-spaces alone whose facets are more than rounding; what was measured is left as it is."""
        real = facet_areas(HalfSpaces(self.normals, self.offsets)) >= MIN_FACET
        return self if real.all() else replace(self, normals=self.normals[real], offsets=self.offsets[real])

    @property
    def exact(self) -> bool:
        """Whether all constraints hold."""
        return self.worst < TOLERANCE

    def better_than(self, other: "Candidate | None") -> bool:
        """Exact before inexact; then all facets real; then overlap (or residual)."""
        if other is None or self.exact != other.exact:
            return other is None or self.exact
        if not self.exact:
            return self.worst < other.worst
        whole, other_whole = self.n_facets == len(self.offsets), other.n_facets == len(other.offsets)
        return whole > other_whole or (
            whole == other_whole and self.jaccard_distance < other.jaccard_distance
        )


def single_start(
    target: Target,
    free: Problem,
    full: Problem,
    planes: tuple[FloatArray, FloatArray],
    free_steps: int,
    bound_steps: int,
) -> Iterator[Candidate]:
    """Polyhedra of one start, each better than the one before as a rule; the last is the result.

    Parameters
    ----------
    free, full
        The problem with the volume as its only constraint, and with all.
    planes
        To start from.
    free_steps, bound_steps
        Steps of the two descents.
    """
    point = measure(free, *planes)
    if not np.isfinite(point.worst):
        return
    for _ in range(FREE_ROUNDS):
        point = project(free, point, first_metric(free, point), LONG_PROJECTION)
        state = begin_descent(free, point, overlap_objective, max_step(point))
        state = descend(free, state, overlap_objective, free_steps)
        cuts, normals, offsets = _with_cuts(target, state.point, CUT_DEPTHS[0])
        if cuts <= 0:
            break
        point = measure(free, normals, offsets)
    free_end = state.point
    point = constrained(full, free_end.normals, free_end.offsets, free_end.tangents, None)
    point = project_and_verify(full, point, state.metric, LONG_PROJECTION)
    yield from descend_from(target, full, point, bound_steps, bound_steps // 2)


def descend_from(
    target: Target, problem: Problem, point: ConstrainedPoint, steps: int, restoring_steps: int
) -> Iterator[Candidate]:
    """The point; if it meets all constraints, what a descent finds from there, with lost facets put back.

    Parameters
    ----------
    steps, restoring_steps
        Of the descent, and of the one after facets were put back.
    """
    yield candidate_of(problem, point)
    if point.worst > TOLERANCE:
        return
    for later in descend_in_chunks(problem, point, steps, max_step(point) / 2):
        point = later
        yield candidate_of(problem, point)
    yield from restore_lost_facets(target, problem, point, restoring_steps)


def descend_in_chunks(
    problem: Problem, point: ConstrainedPoint, steps: int, radius: float
) -> Iterator[ConstrainedPoint]:
    """Descent of the Jaccard distance in chunks of :data:`CHUNK` steps, `radius` the longest first step."""
    state: DescentState | None = None
    for begun in range(0, steps, CHUNK):
        if state is None:
            state = begin_descent(problem, point, overlap_objective, radius)
        if state.done:
            return
        state = descend(problem, state, overlap_objective, min(CHUNK, steps - begun))
        yield state.point


def descend_further(problem: Problem, begun: Candidate, steps: int) -> Iterator[Candidate]:
    """The descent goes on from a polyhedron that meets all constraints."""
    point = measure(problem, begun.normals, begun.offsets)
    if point.worst < TOLERANCE:
        for later in descend_in_chunks(problem, point, steps, max_step(point) / 2):
            yield candidate_of(problem, later)


def restore_lost_facets(
    target: Target,
    problem: Problem,
    begun: ConstrainedPoint,
    steps: int,
    depths: Sequence[float] = CUT_DEPTHS,
) -> Iterator[Candidate]:
    """Half-spaces without a facet are put back as cuts, projected and taken along by a short descent.

    What a cut loses again in the projection comes back as a smaller one: its volume goes with the cube of its
    depth, so the smallest survive. What the descent loses comes back once more at its end.
    """
    point = begun
    for whole in _cut_again(target, problem, begun, depths):
        yield candidate_of(problem, point := whole)
    if point is begun:
        return
    for later in descend_in_chunks(problem, point, steps, max_step(point) / 10):
        yield candidate_of(problem, point := later)
    for whole in _cut_again(target, problem, point, depths):
        yield candidate_of(problem, whole)


def _cut_again(
    target: Target, problem: Problem, point: ConstrainedPoint, depths: Sequence[float]
) -> Iterator[ConstrainedPoint]:
    """Ever more half-spaces without a facet as cuts that meet all constraints."""
    for depth in depths:
        cuts, normals, offsets = _with_cuts(target, point, depth)
        if cuts <= 0:
            break
        tried = constrained(problem, normals, offsets, tangents_of(normals), point.tracked)
        tried = project_and_verify(problem, tried, steady_metric(problem, tried), CUT_PROJECTION)
        if tried.worst <= TOLERANCE and count_facets(tried) >= count_facets(point):
            point = tried
            yield point


def search_and_project(problem: Problem, found: Candidate) -> Candidate:
    """The polyhedron with boxes searched for everywhere, projected again where that found a smaller box."""
    point = measure(problem, found.normals, found.offsets)
    if point.worst > TOLERANCE:
        point = project_and_verify(problem, point, first_metric(problem, point), LONG_PROJECTION)
    return candidate_of(problem, point)


def count_facets(point: ConstrainedPoint) -> int:
    """Real facets."""
    return int(np.count_nonzero(point.polyhedron.areas >= MIN_FACET))


def candidate_of(problem: Problem, point: ConstrainedPoint) -> Candidate:
    """What is reported of a point."""
    polyhedron, n_facets = point.polyhedron, count_facets(point)
    volume, jaccard = polyhedron.volume, 1.0
    if np.isfinite(point.worst):
        jaccard, _ = overlap_objective(problem, point)
    shared = (1.0 - jaccard) * (1.0 + volume) / (2.0 - jaccard)
    shortest, longest = np.nan, np.nan
    if len(point.boxes.extents):
        shortest, longest = float(point.boxes.extents[0].min()), float(point.boxes.extents[0].max())
    measures = LossMeasures(volume, polyhedron.surface_area, shortest, longest, shared)
    return Candidate(point.normals, point.offsets, jaccard, point.worst, n_facets, measures)


def _with_cuts(target: Target, point: ConstrainedPoint, depth: float) -> tuple[int, FloatArray, FloatArray]:
    rays = target.rays
    near = point.boxes.volumes <= (1.0 + CLOSE) * point.boxes.volumes.min(initial=np.inf)
    axes = point.boxes.frames[near].reshape(-1, 3)
    return insert_lost_facets(
        point.normals, point.offsets, rays.directions, rays.first, rays.distance, depth, axes
    )
