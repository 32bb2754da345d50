"""The whole search for a compound: several starts on few lines, then the best of them on many."""

from collections.abc import Generator
from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.parts import Planes
from regolith_studio.coarsening.core.plane_coordinates import tangents_of
from regolith_studio.coarsening.core.scan_lines import ScanLines, scan_lines
from regolith_studio.coarsening.optimiser.body import N_TERMS, Prices
from regolith_studio.coarsening.optimiser.compound_starts import initial_planes
from regolith_studio.coarsening.optimiser.descent import LOCK, descend
from regolith_studio.coarsening.optimiser.memory import Memory, memory_for
from regolith_studio.coarsening.optimiser.search import CONTINUATIONS, TERMS, SearchEffort, prices_of_union
from regolith_studio.coarsening.reasons import EXACT
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces

FEW_LINES, MANY_LINES = 3_600, 15_000
"""Lines that meet a compact particle, for the starts and for the last descent."""
FREE_STEPS, START_STEPS, LAST_STEPS = 15, 60, 120
"""Of a start without other conditions than the volume and with all, and of the last descent."""
FREE_RADIUS, START_RADIUS, LAST_RADIUS = 0.06, 0.06, 0.02
"""Longest moves of a plane in the first step of each."""
NUMBERS = 4
"""At most so many numbers of parts are tried: a given number of facets makes round particles, and those with
shallow hollows, only if it is not shared out among many parts."""
RETRIES = 6
"""Further starts where none meets all conditions."""


class CompoundCandidate(NamedTuple):
    """Where a descent ended: half-spaces, Jaccard distance by lines, loss, what is missed, residuals (6,)."""

    planes: Planes
    distance: float
    merit: float
    worst: float
    residuals: FloatArray

    @property
    def met(self) -> bool:
        """Whether all that is to be kept is met."""
        return self.worst <= EXACT / 2

    @property
    def rank(self) -> tuple[bool, float]:
        """Sorting key, the best first."""
        return not self.met, self.merit


def asked_terms(weights: LossWeights) -> tuple[str, ...]:
    """Descriptors that a compound keeps: those that are named, else all with a weight above 0."""
    if weights.keep is not None:
        return tuple(key for key in TERMS if key in weights.keep)
    return tuple(key for key in TERMS if weights[key] > 0)


def search_compound(
    target: Target,
    weights: LossWeights,
    parts: int,
    n_facets: int,
    effort: SearchEffort,
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
    prices = prices_of_union(target, weights, frozenset(asked_terms(weights)))
    lines, axes = scan_lines(target.mesh, FEW_LINES), target.box.axes
    found: list[CompoundCandidate] = []
    numbers = numbers_of_parts(parts)
    for tried, child in enumerate(seed.spawn(effort.starts + RETRIES)):
        if tried >= effort.starts and any(each.met for each in found):
            break
        best = min(found, key=lambda each: each.rank, default=None)
        chosen = parts if best is None else len(best.planes.inner)
        number = numbers[tried] if tried < len(numbers) else chosen
        planes = initial_planes(lines, number, n_facets, np.random.default_rng(child), touching)
        begun = None if planes is None else _from_start(lines, axes, prices, planes)
        if begun is not None:
            found.append(begun)
            yield begun
    if not found:
        raise GeometryError("No start of the compound method bounds a union of convex parts.")
    fine, last = scan_lines(target.mesh, MANY_LINES), list[CompoundCandidate]()
    for begun in sorted(found, key=lambda each: each.rank)[: effort.finalists]:
        planes = begun.planes
        for steps in (0, LAST_STEPS, LAST_STEPS):
            ended = _descended(fine, axes, prices, planes, steps, LAST_RADIUS)
            if ended is None:
                continue
            if ended.rank < min((each.rank for each in last), default=(True, np.inf)):
                yield ended
            last.append(ended)
            if steps and ended.met:
                break
            planes = ended.planes
    return min(last or found, key=lambda each: each.rank)


def numbers_of_parts(most: int) -> tuple[int, ...]:
    """Numbers of parts to begin with, the largest first; later starts take that of the best."""
    spread = np.linspace(most, 2, min(most - 1, NUMBERS))
    return tuple(round(each) for each in spread.tolist())


def _from_start(
    lines: ScanLines, axes: FloatArray, prices: Prices, planes: Planes
) -> CompoundCandidate | None:
    """Descent with the volume alone, then with all terms; ``None`` where nothing is bounded."""
    high = np.zeros(N_TERMS)
    high[0] = LOCK * prices.overlap
    wanted = prices.wanted
    free = _descended(
        lines, axes, Prices(wanted, -high, high, prices.overlap), planes, FREE_STEPS, FREE_RADIUS
    )
    if free is None:
        return None
    found = _descended(lines, axes, prices, free.planes, START_STEPS, START_RADIUS)
    for _ in range(CONTINUATIONS):
        if found is None or found.met:
            break
        found = _descended(lines, axes, prices, found.planes, START_STEPS, LAST_RADIUS)
    return found


def _descended(
    lines: ScanLines, axes: FloatArray, prices: Prices, planes: Planes, steps: int, radius: float
) -> CompoundCandidate | None:
    """Where a descent ends; ``None`` where the half-spaces bound no union."""
    normals, offsets = np.array(planes.normals), np.array(planes.offsets)
    memory: Memory = memory_for(len(offsets), 0, planes)
    tangents = tangents_of(normals)
    sound, merit, worst, distance = descend(
        lines, prices, axes, steps, radius, 0, False, False, normals, offsets, tangents, memory
    )
    if not sound or memory.one.parts is None:
        return None
    ended = planes._replace(normals=normals, offsets=offsets, inner=memory.one.parts.inner.copy())
    return CompoundCandidate(ended, distance, merit, worst, memory.residuals)


def compound_of(planes: Planes) -> ConvexCompound:
    """The value with the planes' parts, each about its inner point."""
    parts = []
    for j in range(len(planes.inner)):
        mine = slice(planes.first[j], planes.first[j + 1])
        normals, inner = planes.normals[mine], planes.inner[j]
        parts.append(
            ConvexPolyhedron.from_half_spaces(
                HalfSpaces(normals, planes.offsets[mine] - (normals * inner).sum(axis=1))
            )
        )
    return ConvexCompound(tuple(parts), planes.inner)
