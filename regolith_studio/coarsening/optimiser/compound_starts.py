"""Where the descent of a compound begins: hulls of clusters of points in the particle, few planes each."""

import numpy as np
from scipy.spatial import ConvexHull

from regolith_studio.coarsening.core.parts import Planes
from regolith_studio.coarsening.core.scan_lines import ScanLines
from regolith_studio.coarsening.optimiser.starts import products
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray

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


def initial_planes(
    lines: ScanLines, n_parts: int, n_facets: int, rng: np.random.Generator, touching: bool = False
) -> Planes | None:
    """Half-spaces of `n_parts` parts that fill the particle, `n_facets` in all.

    Parameters
    ----------
    touching
        Whether neighbours touch in the plane half-way between their centres, which counts as a facet of
        both; else they overlap a little.

    Returns
    -------
    Planes or None
        ``None`` where so few facets do not suffice for parts that touch.
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
