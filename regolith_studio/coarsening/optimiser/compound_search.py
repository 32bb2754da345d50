"""The whole search for a compound: several starts on few lines, then the best of them on many.

A start has the hulls of clusters of points in the particle, few planes each.
"""

from collections.abc import Generator
from typing import NamedTuple

import numpy as np
from scipy.spatial import ConvexHull

from regolith_studio.coarsening.core.line_overlap import ScanLines, scan_lines
from regolith_studio.coarsening.core.parts import Planes
from regolith_studio.coarsening.core.polyhedron_measures import tangents_of
from regolith_studio.coarsening.optimiser.body import N_TERMS, Prices
from regolith_studio.coarsening.optimiser.descent import LOCK, descend
from regolith_studio.coarsening.optimiser.memory import Memory, memory_for
from regolith_studio.coarsening.optimiser.search import CONTINUATIONS, TERMS, SearchEffort, prices_of_union
from regolith_studio.coarsening.optimiser.starts import products
from regolith_studio.coarsening.reasons import EXACT
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
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

N_POINTS = 4000
N_CLUSTERINGS = 3
"""Clusterings from which the one with the least volume of hulls is taken."""
CLUSTER_STEPS, NORMAL_STEPS = 12, 12
OVERLAP = 0.05
"""Points whose distances from two centres differ by less than this, at unit volume, belong to both."""
MIN_FACETS, MIN_FREE = 5, 4
"""Facets of a part; of a part that touches others, those that it does not share."""
TOUCH = 1e-8
"""Depth, at unit volume, to which parts that touch reach beyond the plane between them."""


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

    Parts that are `touching` meet in planes between them, instead of overlapping.
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
        lines,
        prices,
        axes,
        steps,
        radius,
        0,
        False,
        False,
        np.empty((0, 3, 3)),
        normals,
        offsets,
        tangents,
        memory,
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


def initial_planes(
    lines: ScanLines, n_parts: int, n_facets: int, rng: np.random.Generator, touching: bool = False
) -> Planes | None:
    """Half-spaces of `n_parts` parts that fill the particle, `n_facets` in all.

    Parts that are `touching` meet in the plane half-way between their centres, which counts as a facet of
    both; ``None`` where so few facets do not suffice for it. Others overlap a little.
    """
    points = points_inside(lines, N_POINTS, rng)
    clusterings = [_clustered(points, n_parts, rng) for _ in range(N_CLUSTERINGS)]
    centres, near = min(clusterings, key=lambda each: _hull_volumes(points, each[1]))
    hulls = [points[near[:, j]] for j in range(n_parts)]
    areas = np.array([ConvexHull(each).area for each in hulls])
    if touching:
        return _touching_planes(points, centres, near, areas, n_facets, rng)
    shares = shared_out(areas, np.full(n_parts, MIN_FACETS), n_facets)
    sides = [_few_planes(hull, int(n), rng) for hull, n in zip(hulls, shares, strict=True)]
    return _joined(sides, np.array([each.mean(axis=0) for each in hulls]))


def _joined(sides: list[tuple[FloatArray, FloatArray]], inner: FloatArray) -> Planes:
    return Planes(
        np.concatenate([normals for normals, _ in sides]),
        np.concatenate([offsets for _, offsets in sides]),
        np.concatenate([[0], np.cumsum([len(offsets) for _, offsets in sides])]),
        inner,
    )


def _touching_planes(
    points: FloatArray,
    centres: FloatArray,
    near: BoolArray,
    areas: FloatArray,
    n_facets: int,
    rng: np.random.Generator,
) -> Planes | None:
    """As :func:`initial_planes`: clusters between the planes half-way to those with which they share points.

    Each plane is moved outward by :data:`TOUCH`, so that rounding leaves no gap in the union.
    """
    k = len(centres)
    neighbours = (near.T.astype(np.int64) @ near > 0) & ~np.eye(k, dtype=np.bool_)
    least = neighbours.sum(axis=1) + MIN_FREE
    if least.sum() > n_facets:
        return None
    shares = shared_out(areas, least, n_facets)
    label = np.linalg.norm(points[:, None] - centres, axis=2).argmin(axis=1)
    sides, partners, inner = [], [], []
    for j in range(k):
        others = np.flatnonzero(neighbours[j])
        between = centres[others] - centres[j]
        between /= np.linalg.norm(between, axis=1)[:, None]
        halfway = np.einsum("ij,ij->i", between, (centres[others] + centres[j]) / 2.0) + TOUCH
        mine = label == j
        shared = (near[mine].sum(axis=1) > 1) if len(others) else None
        own = _few_planes(points[mine], int(shares[j]) - len(others), rng, shared)
        sides.append((np.concatenate([own[0], between]), np.concatenate([own[1], halfway])))
        partners += [np.full(len(own[1]), -1), others]
        inner.append(points[mine].mean(axis=0))
    return _joined(sides, np.array(inner))._replace(partner=np.concatenate(partners))


def points_inside(lines: ScanLines, n: int, rng: np.random.Generator) -> FloatArray:
    """Random points inside the particle, evenly spread, shape (n, 3)."""
    line = np.repeat(np.arange(len(lines.points)), np.diff(lines.first))
    lengths = np.diff(lines.distance)
    depth = -np.cumsum(lines.sign)[:-1]  # 0 between the last crossing of a line and the first of the next
    lengths = np.where((line[1:] == line[:-1]) & (depth > 0.5), lengths, 0.0)
    chosen = rng.choice(len(lengths), n, p=lengths / lengths.sum())
    along = lines.distance[chosen] + rng.uniform(size=n) * lengths[chosen]
    at = line[chosen]
    return np.asarray(lines.points[at] + along[:, None] * lines.directions[lines.bundle[at]])


def _clustered(points: FloatArray, k: int, rng: np.random.Generator) -> tuple[FloatArray, BoolArray]:
    """Centres of k clusters (k-means), (k, 3), and which points belong to each, near ones too; (n, k)."""
    centres = points[_spread_out(points, np.ones(len(points)), k, rng)]
    for _ in range(CLUSTER_STEPS):
        label = np.linalg.norm(points[:, None] - centres, axis=2).argmin(axis=1)
        sizes = np.bincount(label, minlength=k)
        sums = np.column_stack([np.bincount(label, points[:, c], minlength=k) for c in range(3)])
        centres = np.where(sizes[:, None] > 0, sums / np.maximum(sizes, 1)[:, None], centres)
    distance = np.linalg.norm(points[:, None] - centres, axis=2)
    return centres, np.asarray(distance - distance.min(axis=1)[:, None] < OVERLAP)


def _spread_out(points: FloatArray, weights: FloatArray, k: int, rng: np.random.Generator) -> IntArray:
    """Indices of k points far from each other (k-means++)."""
    chosen = [int(rng.choice(len(points), p=weights / weights.sum()))]
    squared = ((points - points[chosen[0]]) ** 2).sum(axis=1)
    while len(chosen) < k:
        share = weights * squared
        chosen.append(int(rng.choice(len(points), p=share / share.sum())))
        squared = np.minimum(squared, ((points - points[chosen[-1]]) ** 2).sum(axis=1))
    return np.array(chosen)


def _hull_volumes(points: FloatArray, near: BoolArray) -> float:
    return sum(float(ConvexHull(points[near[:, j]]).volume) for j in range(near.shape[1]))


def shared_out(areas: FloatArray, least: IntArray, n_facets: int) -> IntArray:
    """Facets for each part by its area, not fewer than `least`, `n_facets` in all."""
    shares = least.copy()
    for _ in range(n_facets - int(shares.sum())):
        shares[np.argmax(areas / shares)] += 1
    return shares


def _few_planes(
    points: FloatArray, n: int, rng: np.random.Generator, shared: BoolArray | None = None
) -> tuple[FloatArray, FloatArray]:
    """Normals (n, 3) and offsets (n,) of planes that stand for the facets of the points' hull.

    The facets are clustered by their normals, weighted by area. Facets whose corners are all `shared` are
    left out.
    """
    hull = ConvexHull(points)
    normals, offsets = hull.equations[:, :3], -hull.equations[:, 3]
    simplices = hull.simplices
    if shared is not None:
        kept = ~shared[simplices].all(axis=1)
        normals, offsets, simplices = normals[kept], offsets[kept], simplices[kept]
    a, b, c = np.moveaxis(points[simplices], 1, 0)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    middles = (a + b + c) / 3.0
    means = normals[_spread_out(normals, areas, n, rng)]
    for _ in range(NORMAL_STEPS):
        label = products(normals, means).argmax(axis=1)
        sums = np.column_stack([np.bincount(label, areas * normals[:, x], minlength=n) for x in range(3)])
        lengths = np.linalg.norm(sums, axis=1)[:, None]
        means = np.where(lengths > 0.0, sums / np.maximum(lengths, 1e-300), means)
    weight = np.bincount(label, areas, minlength=n)
    heights = np.einsum("ij,ij->i", middles, means[label])
    found = np.bincount(label, areas * heights, minlength=n) / np.maximum(weight, 1e-300)
    return means, np.where(weight > 0.0, found, offsets.max())
