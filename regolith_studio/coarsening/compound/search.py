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
NUMBERS = 4
"""At most so many numbers of parts are tried: a given number of facets makes round particles, and those with
shallow hollows, only if it is not shared out among many parts."""
CONFIRMATIONS = 8
RETRIES = 6
"""Further starts where none meets all conditions."""


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


def asked_terms(weights: LossWeights) -> tuple[str, ...]:
    """Descriptors that a compound keeps: those that are named, else all with a weight above 0."""
    if weights.keep is not None:
        return tuple(key for key in KEYS if key in weights.keep)
    return tuple(key for key in KEYS if weights[key] > 0)


def conditions_of(weights: LossWeights) -> IntArray:
    """Indices of :data:`KEYS` that are asked for; the aspect ratio follows from both diameters."""
    asked = [KEYS.index(key) for key in asked_terms(weights)]
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
    touching: bool = False,
) -> Generator[CompoundCandidate, None, CompoundCandidate]:
    """A candidate for each start and each better one of the last descents; returns the best.

    Parameters
    ----------
    touching
        Whether parts touch in planes between them, instead of overlapping.

    Raises
    ------
    GeometryError
        If no start bounds a compound.
    """
    wanted = np.log([target.descriptors[key] for key in KEYS])
    lines = scan_lines(target.mesh, FEW_LINES)
    full = CompoundProblem(lines, wanted, conditions_of(weights), FINE_ANGLE)
    found: list[CompoundCandidate] = []
    numbers = numbers_of_parts(parts)
    for tried, child in enumerate(seed.spawn(effort.starts + RETRIES)):
        if tried >= effort.starts and any(each.exact for each in found):
            break
        best = min(found, key=_rank, default=None)
        chosen = parts if best is None else len(best.point.planes.inner)
        number = numbers[tried] if tried < len(numbers) else chosen
        planes = initial_planes(lines, number, n_facets, np.random.default_rng(child), touching)
        begun = None if planes is None else _from_start(full, planes)
        if begun is not None:
            found.append(begun)
            yield begun
    if not found:
        raise GeometryError("No start of the compound method bounds a union of convex parts.")
    fine = full._replace(lines=scan_lines(target.mesh, MANY_LINES))
    return (yield from _finals(fine, found, effort.finalists))


def numbers_of_parts(most: int) -> tuple[int, ...]:
    """Numbers of parts to begin with, the largest first; later starts take that of the best."""
    spread = np.linspace(most, 2, min(most - 1, NUMBERS))
    return tuple(round(each) for each in spread.tolist())


def _rank(found: CompoundCandidate) -> tuple[bool, float]:
    """Sorting key, the best first: exact before inexact, then overlap or residual."""
    return not found.exact, found.distance if found.exact else found.point.worst


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
    ranked = sorted(found, key=_rank)
    best: CompoundCandidate | None = None
    for begun in ranked[:finalists]:
        for now in _last_descent(fine, begun):
            if best is None or _rank(now) < _rank(best):
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
    """The compound projected once more, as closely as can be, with a dense search for boxes.

    A box that is about to be no minimum any more has a volume that hardly changes while it turns, so that its
    edges are found only slowly: it is found again and again until the conditions hold twice running.
    """
    dense = problem._replace(sample_angle=DENSE_ANGLE)
    for _ in range(CONFIRMATIONS):
        again = point_of(dense, point.planes, point.tangents)
        if again is None:
            break
        metric = overlap_of(problem, again).metric
        point = project(dense, again, metric, LONG_PROJECTION)
        followed = point_of(dense, point.planes, point.tangents, point.tracked)
        if followed is None or followed.worst <= TOLERANCE:
            break
        point = project(dense, followed, metric, LONG_PROJECTION)
    return point


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
