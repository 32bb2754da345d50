"""The whole search for a compound: several starts on few lines, then the best of them on many."""

from collections.abc import Generator, Iterator
from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.compound.conditions import (
    KEYS,
    CompoundPoint,
    CompoundProblem,
    point_of,
)
from regolith_studio.coarsening.compound.descent import (
    LONG_PROJECTION,
    LOOSE,
    TOLERANCE,
    descend,
    overlap_of,
    project,
)
from regolith_studio.coarsening.compound.measures import Planes
from regolith_studio.coarsening.compound.scan_lines import scan_lines
from regolith_studio.coarsening.compound.start import initial_planes
from regolith_studio.coarsening.core.box_search import DENSE_ANGLE, FINE_ANGLE
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import IntArray
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces

FEW_LINES, MANY_LINES = 3_600, 15_000
"""Lines that meet a compact particle, for the starts and for the last descent."""
FREE_STEPS, START_STEPS, LAST_STEPS = 15, 40, 80
"""Of a start without other conditions than the volume and with all, and of the last descent."""
FINALISTS = 2
RETRIES = 2
"""Further starts with each smaller number of parts where none meets all conditions: few facets make round
particles only if they are not shared out among many parts."""


class Effort(NamedTuple):
    """Starts, and how many of the best of them descend on many lines."""

    starts: int
    finalists: int


class CompoundCandidate(NamedTuple):
    """A compound on the way: where it is, and its Jaccard distance by the lines of its problem."""

    point: CompoundPoint
    distance: float

    @property
    def exact(self) -> bool:
        """Whether all conditions hold."""
        return self.point.worst <= LOOSE

    def better_than(self, other: "CompoundCandidate | None") -> bool:
        """Exact before inexact, then overlap (or residual)."""
        if other is None or self.exact != other.exact:
            return other is None or self.exact
        if not self.exact:
            return self.point.worst < other.point.worst
        return self.distance < other.distance


def conditions_of(weights: LossWeights) -> IntArray:
    """Indices of :data:`KEYS` whose weights are above 0; the aspect ratio follows from both diameters."""
    asked = [index for index, key in enumerate(KEYS) if weights[key] > 0]
    if {2, 3} <= set(asked) and 4 in asked:
        asked.remove(4)
    return np.array(asked, dtype=np.int64)


def search_compound(
    target: Target,
    weights: LossWeights,
    parts: int,
    n_facets: int,
    effort: Effort,
    seed: np.random.SeedSequence,
) -> Generator[CompoundCandidate, None, CompoundCandidate]:
    """A candidate for each start and each better one of the last descents; returns the best.

    Raises
    ------
    GeometryError
        If no start bounds a compound.
    """
    wanted = np.log([target.descriptors[key] for key in KEYS])
    lines = scan_lines(target.mesh, FEW_LINES)
    full = CompoundProblem(lines, wanted, conditions_of(weights), FINE_ANGLE)
    found: list[CompoundCandidate] = []
    numbers = [*[parts] * effort.starts, *[k for k in range(parts - 1, 1, -1) for _ in range(RETRIES)]]
    for tried, (k, child) in enumerate(zip(numbers, seed.spawn(len(numbers)), strict=True)):
        if tried >= effort.starts and any(each.exact for each in found):
            break
        planes = initial_planes(lines, k, n_facets, np.random.default_rng(child))
        begun = _from_start(full, planes)
        if begun is not None:
            found.append(begun)
            yield begun
    if not found:
        raise GeometryError("No start of the compound method bounds a union of convex parts.")
    fine = full._replace(lines=scan_lines(target.mesh, MANY_LINES))
    return (yield from _finals(fine, found, effort.finalists))


def _from_start(full: CompoundProblem, planes: Planes) -> CompoundCandidate | None:
    """Descent with the volume alone, then with all conditions; ``None`` where nothing is bounded."""
    free = full._replace(asked=np.zeros(1, dtype=np.int64))
    point = point_of(free, planes)
    if point is None:
        return None
    point = project(free, point, np.eye(3 * len(planes.offsets)), LONG_PROJECTION)
    if point.worst <= TOLERANCE:
        point = _least(CompoundCandidate(point, np.inf), descend(free, point, FREE_STEPS)).point
    bound = point_of(full, point.planes)
    if bound is None:
        return None
    bound = project(full, bound, overlap_of(full, bound).metric, LONG_PROJECTION)
    begun = CompoundCandidate(bound, overlap_of(full, bound).distance)
    return _least(begun, descend(full, bound, START_STEPS)) if begun.exact else begun


def _least(begun: CompoundCandidate, descent: Iterator[tuple[CompoundPoint, float]]) -> CompoundCandidate:
    """The candidate with the least Jaccard distance of all."""
    return min([begun, *(CompoundCandidate(*each) for each in descent)], key=lambda each: each.distance)


def _finals(
    fine: CompoundProblem, found: list[CompoundCandidate], finalists: int
) -> Generator[CompoundCandidate, None, CompoundCandidate]:
    """Descents of the best on many lines."""
    ranked = sorted(
        found, key=lambda each: (not each.exact, each.distance if each.exact else each.point.worst)
    )
    best: CompoundCandidate | None = None
    for begun in ranked[:finalists]:
        for now in _last_descent(fine, begun):
            if now.better_than(best):
                best = now
                yield now
    if best is None:
        return ranked[0]
    return CompoundCandidate(confirmed(fine, best.point), best.distance)


def _last_descent(fine: CompoundProblem, begun: CompoundCandidate) -> Iterator[CompoundCandidate]:
    yield CompoundCandidate(begun.point, overlap_of(fine, begun.point).distance)
    if begun.exact:
        for point, distance in descend(fine, begun.point, LAST_STEPS):
            yield CompoundCandidate(point, distance)


def confirmed(problem: CompoundProblem, point: CompoundPoint) -> CompoundPoint:
    """The compound projected once more, as closely as can be, with a dense search for boxes."""
    dense = problem._replace(sample_angle=DENSE_ANGLE)
    again = point_of(dense, point.planes, point.tangents)
    if again is None:
        return point
    return project(dense, again, overlap_of(problem, again).metric, LONG_PROJECTION)


def compound_of(planes: Planes) -> ConvexCompound:
    """The value with the planes' parts, each about its inner point."""
    parts = []
    for j in range(len(planes.inner)):
        mine = slice(planes.first[j], planes.first[j + 1])
        normals, inner = planes.normals[mine], planes.inner[j]
        parts.append(
            ConvexPolyhedron.from_half_spaces(HalfSpaces(normals, planes.offsets[mine] - normals @ inner))
        )
    return ConvexCompound(tuple(parts), planes.inner)
