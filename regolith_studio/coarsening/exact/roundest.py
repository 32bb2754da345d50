"""The roundest polyhedron that meets all constraints but the sphericity: for particles near Goldberg's bound.

Least surface at fixed volume and diameters has many local minima. So several descents begin from polyhedra
that are nearly as round as can be, and the best of them is disturbed and descends again (basin hopping).
"""

from collections.abc import Iterator
from itertools import permutations, product
from math import ceil

import numpy as np

from regolith_studio.coarsening.core.box_search import DENSE_ANGLE, FINE_ANGLE
from regolith_studio.coarsening.exact.constraint_projection import TOLERANCE, max_step
from regolith_studio.coarsening.exact.constraints import SPHERICITY, ConstrainedPoint, Problem, measure
from regolith_studio.coarsening.exact.initial_planes import round_planes
from regolith_studio.coarsening.exact.projected_bfgs import (
    begin_descent,
    descend,
    min_surface,
)
from regolith_studio.coarsening.exact.relaxation import (
    measured_and_projected,
    missing_by,
    sphericity_residual,
)
from regolith_studio.coarsening.exact.single_start import (
    CHUNK,
    Candidate,
    candidate_of,
    descend_from,
    descend_in_chunks,
)
from regolith_studio.coarsening.target import Target
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces

STARTS, HOPS, MORE_HOPS = 6, 12, 36
"""Up to 20 facets; with more, single minima differ less and cost more."""
NEAR = 2e-2
"""Where the sphericity is missed by less (in logarithms), there are :data:`MORE_HOPS`."""
SHORT, MIDDLE, LONG = 24, 48, 200
"""Steps of the descents: from a start, after a hop, and of the best at the end."""
HOP = 0.4
"""By how much a hop turns a normal, as a standard deviation of each component, times sqrt(facets)."""
TURNS = (0.0, 0.02, 0.02, 0.04, 0.04, 0.08, 0.08, 0.16, 0.16)
"""The same where the sphericity is made a little less than the most that was found."""
GAIN = 2e-5
"""A descent ends where :data:`CHUNK` steps bring less (in logarithms)."""
SHARE_FOR_OVERLAP = 0.05
"""Share of the least miss by which more is missed: at the very least nothing can move for the overlap."""


def solve_round(
    target: Target,
    problems: tuple[Problem, Problem],
    begun: Candidate | None,
    n_facets: int,
    rng: np.random.Generator,
    steps: int,
) -> Iterator[Candidate]:
    """Ever rounder polyhedra; once round enough, such that meet all constraints, with ever better overlap.

    Where the sphericity is not reached, the roundest comes once more as it overlaps most, and then one a
    little less round for more overlap, both with the least miss that was found. Nothing comes where the
    other constraints are not met together.

    Parameters
    ----------
    problems
        With and without the sphericity.
    begun
        One of the polyhedra to begin from.
    rng
        Chooses the others.
    steps
        Of the descents of the Jaccard distance.
    """
    full, rest = (each._replace(sample_angle=FINE_ANGLE) for each in problems)
    missed, point = np.inf, None
    for missed, point in _rounder_and_rounder(target, full, rest, begun, n_facets, rng):
        yield missing_by(missed, candidate_of(rest, point))
    if point is None:
        return
    wanted = full.wanted.copy()
    wanted[SPHERICITY] -= (1.0 + SHARE_FOR_OVERLAP) * max(missed, 0.0)
    held = full._replace(wanted=wanted, sample_angle=DENSE_ANGLE)
    planes = turned_to_particle(target, point)
    turned = measured_and_projected(rest._replace(sample_angle=DENSE_ANGLE), *planes)
    if turned.worst < TOLERANCE:
        yield missing_by(missed, candidate_of(rest, turned))
    near = _a_little_less_round(held, planes, rng)
    if near is None:
        return
    if missed <= 0.0:
        yield from descend_from(target, held, near, steps, steps // 2)
        return
    for later in descend_in_chunks(held, near, steps, max_step(near) / 2):
        near = later
    yield missing_by(missed, candidate_of(held, near))


def _a_little_less_round(
    held: Problem, planes: tuple[FloatArray, FloatArray], rng: np.random.Generator
) -> ConstrainedPoint | None:
    """A polyhedron that meets `held`, whose sphericity is just below that of the planes.

    At the roundest polyhedron the constraints depend on each other, so that a projection may fail; then the
    planes are turned a little first. ``None`` where all fail.
    """
    begun = measure(held, *planes)
    for size in TURNS:
        near = measured_and_projected(held, *_disturbed(begun, size, rng))
        if near.worst < TOLERANCE:
            return near
    return None


def _rounder_and_rounder(
    target: Target,
    full: Problem,
    rest: Problem,
    begun: Candidate | None,
    n_facets: int,
    rng: np.random.Generator,
) -> Iterator[tuple[float, ConstrainedPoint]]:
    """Ever rounder polyhedra that meet `rest`, each with the logarithm of the wanted sphericity over its own.

    They end with the first that is at least as round as wanted.
    """
    best: tuple[float, ConstrainedPoint] | None = None
    share = min(1.0, 20 / n_facets)
    starts = [round_planes(target, n_facets, rng, bool(k % 2)) for k in range(ceil(share * STARTS))]
    for planes in starts if begun is None else [(begun.normals, begun.offsets), *starts]:
        found = _descended(full, rest, planes, SHORT)
        if found is not None and (best is None or found[0] < best[0]):
            yield (best := found)
            if best[0] <= 0.0:
                return
    if best is None:
        return
    for hop in range(ceil(share * MORE_HOPS)):
        if hop >= share * HOPS and best[0] > NEAR:
            break
        found = _descended(full, rest, _disturbed(best[1], HOP, rng), MIDDLE)
        if found is not None and found[0] < best[0]:
            yield (best := found)
            if best[0] <= 0.0:
                return
    found = _descended(full, rest, (best[1].normals, best[1].offsets), LONG)
    if found is not None and found[0] < best[0]:
        yield found


def _descended(
    full: Problem, rest: Problem, planes: tuple[FloatArray, FloatArray], steps: int
) -> tuple[float, ConstrainedPoint] | None:
    """What is missed after a descent of the surface, and the polyhedron; ``None`` where `rest` is not met."""
    point = measured_and_projected(rest, *planes)
    if not point.worst < TOLERANCE:
        return None
    state = begin_descent(rest, point, min_surface, max_step(point) / 2)
    missed = np.inf
    for _ in range(0, steps, CHUNK):
        state = descend(rest, state, min_surface, CHUNK)
        before, missed = missed, -sphericity_residual(full, state.point)
        if state.done or missed <= 0.0 or before - missed < GAIN:
            break
    return missed, state.point


def _disturbed(
    point: ConstrainedPoint, size: float, rng: np.random.Generator
) -> tuple[FloatArray, FloatArray]:
    """Every half-space turned about the centroid of its facet, by about `size` / sqrt(facets)."""
    normals = point.normals + size / np.sqrt(len(point.offsets)) * rng.normal(size=point.normals.shape)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    return normals, np.einsum("ij,ij->i", normals, point.polyhedron.centroids)


def turned_to_particle(target: Target, point: ConstrainedPoint) -> tuple[FloatArray, FloatArray]:
    """The polyhedron turned, reflected and shifted so that its box lies as the particle's, and overlaps most.

    No descriptor changes by that.
    """
    centre = ConvexPolyhedron.from_half_spaces(HalfSpaces(point.normals, point.offsets)).centroid
    offsets = point.offsets - point.normals @ centre
    frame = point.boxes.frames[0] if len(point.boxes.frames) else target.box.axes
    placed = []
    for signs, order in product(product((-1.0, 1.0), repeat=3), permutations(range(3))):
        turn = target.box.axes.T @ (np.array(signs)[:, None] * frame[list(order)])
        placed.append(HalfSpaces(point.normals @ turn.T, offsets))
    best = min(placed, key=target.jaccard_distance)
    return np.array(best.normals), np.array(best.offsets)
