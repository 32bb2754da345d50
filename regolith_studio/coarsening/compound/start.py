"""Where the descent of a compound begins: hulls of clusters of points in the particle, few planes each."""

import numpy as np
from scipy.spatial import ConvexHull

from regolith_studio.coarsening.compound.measures import Planes
from regolith_studio.coarsening.compound.scan_lines import ScanLines
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray

N_POINTS = 4000
N_CLUSTERINGS = 3
"""Clusterings from which the one with the least volume of hulls is taken."""
CLUSTER_STEPS, NORMAL_STEPS = 12, 12
OVERLAP = 0.05
"""Points whose distances from two centres differ by less than this, at unit volume, belong to both."""
MIN_FACETS = 5
"""Facets of a part."""


def initial_planes(lines: ScanLines, n_parts: int, n_facets: int, rng: np.random.Generator) -> Planes:
    """Half-spaces of `n_parts` parts that overlap a little and fill the particle, `n_facets` in all."""
    points = points_inside(lines, N_POINTS, rng)
    clusterings = [_clustered(points, n_parts, rng) for _ in range(N_CLUSTERINGS)]
    near = min(clusterings, key=lambda near: _hull_volumes(points, near))
    hulls = [points[near[:, j]] for j in range(n_parts)]
    shares = shared_out(np.array([ConvexHull(each).area for each in hulls]), n_facets)
    sides = [_few_planes(hull, int(n), rng) for hull, n in zip(hulls, shares, strict=True)]
    return Planes(
        np.concatenate([normals for normals, _ in sides]),
        np.concatenate([offsets for _, offsets in sides]),
        np.concatenate([[0], np.cumsum(shares)]),
        np.array([each.mean(axis=0) for each in hulls]),
    )


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


def _clustered(points: FloatArray, k: int, rng: np.random.Generator) -> BoolArray:
    """Which points belong to each of k clusters (k-means), the nearest of others too; shape (n, k)."""
    centres = points[_spread_out(points, np.ones(len(points)), k, rng)]
    for _ in range(CLUSTER_STEPS):
        label = np.linalg.norm(points[:, None] - centres, axis=2).argmin(axis=1)
        sizes = np.bincount(label, minlength=k)
        sums = np.column_stack([np.bincount(label, points[:, c], minlength=k) for c in range(3)])
        centres = np.where(sizes[:, None] > 0, sums / np.maximum(sizes, 1)[:, None], centres)
    distance = np.linalg.norm(points[:, None] - centres, axis=2)
    return np.asarray(distance - distance.min(axis=1)[:, None] < OVERLAP)


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


def shared_out(areas: FloatArray, n_facets: int) -> IntArray:
    """Facets for each part by its area, :data:`MIN_FACETS` at least, `n_facets` in all."""
    shares = np.full(len(areas), MIN_FACETS)
    for _ in range(n_facets - int(shares.sum())):
        shares[np.argmax(areas / shares)] += 1
    return shares


def _few_planes(points: FloatArray, n: int, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Normals (n, 3) and offsets (n,) of planes that stand for the facets of the points' hull.

    The facets are clustered by their normals, weighted by area.
    """
    hull = ConvexHull(points)
    normals, offsets = hull.equations[:, :3], -hull.equations[:, 3]
    a, b, c = np.moveaxis(points[hull.simplices], 1, 0)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    middles = (a + b + c) / 3.0
    means = normals[_spread_out(normals, areas, n, rng)]
    for _ in range(NORMAL_STEPS):
        label = (normals @ means.T).argmax(axis=1)
        sums = np.column_stack([np.bincount(label, areas * normals[:, x], minlength=n) for x in range(3)])
        lengths = np.linalg.norm(sums, axis=1)[:, None]
        means = np.where(lengths > 0.0, sums / np.maximum(lengths, 1e-300), means)
    weight = np.bincount(label, areas, minlength=n)
    heights = np.einsum("ij,ij->i", middles, means[label])
    found = np.bincount(label, areas * heights, minlength=n) / np.maximum(weight, 1e-300)
    return means, np.where(weight > 0.0, found, offsets.max())
