"""One course of the exact method from one start: free descent, polish, descent along the conditions."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from regolith_studio.coarsening.core.cuts import SMALLEST_FACET, with_all_facets
from regolith_studio.coarsening.core.evaluate import AREA, FACETS, LONGEST, SHARED, SHORTEST, VOLUME
from regolith_studio.coarsening.core.intersection import DEGENERATE, FINE
from regolith_studio.coarsening.core.planes import tangents_of
from regolith_studio.coarsening.exact.descent import OVERLAP, REACH, TOLERANCE, State, objective_at
from regolith_studio.coarsening.exact.polish import Polished
from regolith_studio.coarsening.exact.problem import Problem
from regolith_studio.coarsening.exact.starts import grouped_planes
from regolith_studio.coarsening.exact.steps import (
    NOWHERE,
    descended,
    first_metric,
    measured,
    polished,
    started,
    steady_metric,
    verified,
)
from regolith_studio.coarsening.polyhedra import facet_areas, intersect_half_spaces, polyhedron_of
from regolith_studio.coarsening.target import Target
from regolith_studio.descriptors.describe import Descriptors, describe
from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.sphere_points import fibonacci_directions

CUT_DEPTHS = (0.3, 0.3, 0.1, 0.03, 0.01)
CHUNK = 8
FREE_ROUNDS = 3
POLISH_STEPS, LONG_POLISH = 6, 30
TIE_BREAK = 1e-7


@dataclass(frozen=True)
class Attempt:
    """A polyhedron on the way.

    Parameters
    ----------
    normals, offsets
        Half-spaces, (n, 3) and (n,).
    jaccard_distance
        By the quadrature of the problem.
    worst
        Largest residual of the conditions, in logarithms.
    n_facets
        Real facets.
    values
        As from :func:`regolith_studio.coarsening.core.evaluate.evaluate`; NaN for the box where no condition
        is about it.
    """

    normals: FloatArray
    offsets: FloatArray
    jaccard_distance: float
    worst: float
    n_facets: int
    values: FloatArray

    @cached_property
    def solid(self) -> ConvexPolyhedron:
        """The polyhedron of all half-spaces whose facets are more than rounding."""
        real = self.without_redundant()
        return ConvexPolyhedron.from_half_spaces(HalfSpaces(real.normals, real.offsets))

    @cached_property
    def descriptors(self) -> Descriptors:
        """Public descriptors of `solid`."""
        return describe(self.solid)

    def without_redundant(self) -> "Attempt":
        """The half-spaces alone whose facets are more than rounding; what was measured is left as it is."""
        real = facet_areas(HalfSpaces(self.normals, self.offsets)) >= SMALLEST_FACET
        return self if real.all() else replace(self, normals=self.normals[real], offsets=self.offsets[real])

    @property
    def exact(self) -> bool:
        """Whether all conditions hold."""
        return self.worst < TOLERANCE

    def better_than(self, other: "Attempt | None") -> bool:
        """Exact before inexact; then all facets real; then overlap (or residual)."""
        if other is None or self.exact != other.exact:
            return other is None or self.exact
        if not self.exact:
            return self.worst < other.worst
        whole, other_whole = self.n_facets == len(self.offsets), other.n_facets == len(other.offsets)
        return whole > other_whole or (
            whole == other_whole and self.jaccard_distance < other.jaccard_distance
        )


def start_planes(target: Target, n_facets: int, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Half-spaces through groups of the hull's triangles, in general position, each with a facet.

    Groups of a smooth needle can all run from end to end, so that nothing bounds the ends; then half-spaces
    that touch it all around are taken.
    """
    hull = target.mesh.hull
    areas = hull.face_areas
    sound = areas > 0.0
    normals, offsets = grouped_planes(
        hull.face_area_vectors[sound] / areas[sound, None],
        areas[sound],
        hull.triangles[sound].mean(axis=1),
        rng.random(n_facets),
        10,
    )
    offsets = np.maximum(offsets, 0.05) * (1.0 + TIE_BREAK * rng.random(n_facets))
    if not _bounds_a_solid(normals, offsets):
        normals, offsets = touching_planes(hull.vertices, n_facets, rng)
    cuts, more_normals, more_offsets = _with_cuts(target, normals, offsets, CUT_DEPTHS[0])
    return (more_normals, more_offsets) if cuts >= 0 else (normals, offsets)


def touching_planes(
    points: FloatArray, n_facets: int, rng: np.random.Generator
) -> tuple[FloatArray, FloatArray]:
    """Half-spaces that touch points about the origin, with the normals of an ellipsoid of their extents."""
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    normals = fibonacci_directions(n_facets) @ rotation / np.ptp(points, axis=0)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    offsets = (points @ normals.T).max(axis=0) * (1.0 + TIE_BREAK * rng.random(n_facets))
    return normals, offsets


def _bounds_a_solid(normals: FloatArray, offsets: FloatArray) -> bool:
    status = intersect_half_spaces(normals, offsets)[0]
    if status != DEGENERATE:
        return bool(status == FINE)
    try:  # not in general position?
        polyhedron_of(HalfSpaces(normals, offsets))
    except GeometryError:
        return False
    return True


def course(
    target: Target,
    free: Problem,
    full: Problem,
    planes: tuple[FloatArray, FloatArray],
    free_steps: int,
    bound_steps: int,
) -> Iterator[Attempt]:
    """Polyhedra of one course, each better than the one before as a rule; the last is the outcome.

    Parameters
    ----------
    free, full
        The problem with the volume as its only condition, and with all.
    planes
        To start from.
    free_steps, bound_steps
        Steps of the two descents.
    """
    point = measured(free, planes[0], planes[1], tangents_of(planes[0]), NOWHERE)
    if not np.isfinite(point.worst):
        return
    point = polished(free, point, first_metric(free, point.shape), LONG_POLISH, TOLERANCE, reach(point))
    for _ in range(FREE_ROUNDS):
        state = descended(
            free, started(free, point, OVERLAP, reach(point)), OVERLAP, free_steps, POLISH_STEPS
        )
        shape = state.point.shape
        cuts, normals, offsets = _with_cuts(target, shape.normals, shape.offsets, CUT_DEPTHS[0])
        if cuts <= 0:
            break
        point = measured(free, normals, offsets, tangents_of(normals), NOWHERE)
        point = polished(free, point, first_metric(free, point.shape), LONG_POLISH, TOLERANCE, reach(point))
    point = measured(full, shape.normals, shape.offsets, state.point.frames, NOWHERE)
    point = verified(full, point, state.metric, LONG_POLISH, TOLERANCE, reach(point))
    yield attempt(full, point)
    if point.worst > TOLERANCE:
        return
    state = started(full, point, OVERLAP, reach(point) / 2)
    for later in steps_down(full, state, bound_steps):
        state = later
        yield attempt(full, state.point)
    yield from mended(target, full, state.point, bound_steps // 2)


def steps_down(problem: Problem, state: State, steps: int) -> Iterator[State]:
    """The descent in chunks."""
    for begun in range(0, steps, CHUNK):
        if state.done:
            return
        state = descended(problem, state, OVERLAP, min(CHUNK, steps - begun), POLISH_STEPS)
        yield state


def onward(problem: Problem, begun: Attempt, steps: int) -> Iterator[Attempt]:
    """The descent goes on from a polyhedron that meets all conditions."""
    point = measured(problem, begun.normals, begun.offsets, tangents_of(begun.normals), NOWHERE)
    if point.worst < TOLERANCE:
        for later in steps_down(problem, started(problem, point, OVERLAP, reach(point) / 2), steps):
            yield attempt(problem, later.point)


def mended(target: Target, problem: Problem, begun: Polished, steps: int) -> Iterator[Attempt]:
    """Redundant half-spaces are put back as cuts, polished and taken along by a short descent.

    What a cut loses again in the polish comes back as a smaller one: its volume goes with the cube of its
    depth, so the smallest survive.
    """
    point = begun
    for depth in CUT_DEPTHS:
        shape = point.shape
        cuts, normals, offsets = _with_cuts(target, shape.normals, shape.offsets, depth)
        if cuts <= 0:
            break
        tried = measured(problem, normals, offsets, tangents_of(normals), point.conditions.watched)
        tried = verified(
            problem, tried, steady_metric(problem, tried.shape), LONG_POLISH, TOLERANCE, reach(tried)
        )
        if tried.worst <= TOLERANCE and n_facets(tried) >= n_facets(point):
            point = tried
            yield attempt(problem, point)
    if point is begun:
        return
    for later in steps_down(problem, started(problem, point, OVERLAP, reach(point) / 10), steps):
        yield attempt(problem, later.point)


def n_facets(point: Polished) -> int:
    """Real facets."""
    return int(np.count_nonzero(point.shape.area >= SMALLEST_FACET))


def densely_checked(dense: Problem, found: Attempt) -> Attempt:
    """The polyhedron measured with a fine search for boxes; polished again where that found a smaller box."""
    point = measured(dense, found.normals, found.offsets, tangents_of(found.normals), NOWHERE)
    if point.worst > TOLERANCE:
        point = verified(dense, point, first_metric(dense, point.shape), LONG_POLISH, TOLERANCE, reach(point))
    return attempt(dense, point)


def reach(point: Polished) -> float:
    """Longest step."""
    return float(REACH / np.sqrt(len(point.shape.offsets)))


def attempt(problem: Problem, point: Polished) -> Attempt:
    """What is reported of a point."""
    shape, sound = point.shape, bool(np.isfinite(point.worst))
    jaccard = objective_at(problem, shape, OVERLAP) if sound else 1.0
    values = np.full(6, np.nan)
    values[VOLUME], values[AREA], values[FACETS] = shape.volume, shape.surface, n_facets(point)
    values[SHARED] = (1.0 - jaccard) * (1.0 + shape.volume) / (2.0 - jaccard)
    if len(shape.boxes.extents):
        values[SHORTEST], values[LONGEST] = shape.boxes.extents[0].min(), shape.boxes.extents[0].max()
    return Attempt(shape.normals, shape.offsets, jaccard, point.worst, n_facets(point), values)


def _with_cuts(
    target: Target, normals: FloatArray, offsets: FloatArray, depth: float
) -> tuple[int, FloatArray, FloatArray]:
    normals, offsets, rays = np.array(normals), np.array(offsets), target.rays
    cuts = with_all_facets(normals, offsets, rays.directions, rays.first, rays.distance, depth)
    return cuts, normals, offsets
