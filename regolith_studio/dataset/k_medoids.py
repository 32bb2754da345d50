"""k-medoids: the k points of a population with the minimum sum of distances to all points.

BUILD (Kaufman and Rousseeuw 1990) finds a start, eager swaps (FasterPAM, Schubert and Rousseeuw
2021) improve it: each candidate's gain against all medoids at once in one pass over the points.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from scipy.spatial.distance import cdist

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel

MAX_TABLE_SIZE = 5000
"""Maximum number of points in the table of distances; larger populations are searched on a random subset."""


def k_medoids(
    points: FloatArray, k: int, weights: FloatArray | None = None, seed: int = 0
) -> tuple[IntArray, IntArray]:
    """Medoids and the class of each point.

    Parameters
    ----------
    points
        Shape (n, d); distances are Euclidean.
    k
        Number of medoids, 1 to n.
    weights
        Weight of each point, shape (n,); 1 by default.
    seed
        Of the random subset of populations beyond :data:`MAX_TABLE_SIZE`; unused otherwise.

    Returns
    -------
    tuple
        Indices of the medoids in ascending order, shape (k,), and for each point the position of its
        nearest medoid, shape (n,).

    Raises
    ------
    InputError
        If k is not between 1 and n.
    """
    return next(medoid_series(points, (k,), weights, seed))


def medoid_series(
    points: FloatArray, counts: Sequence[int], weights: FloatArray | None = None, seed: int = 0
) -> Iterator[tuple[IntArray, IntArray]]:
    """As :func:`k_medoids` for each k of `counts`, with one table of distances and one BUILD for all.

    Raises
    ------
    InputError
        If a count is not between 1 and n.
    """
    n = len(points)
    for k in counts:
        if not 1 <= k <= n:
            raise InputError(f"Between 1 and {n} representatives can be chosen from {n} particles, got {k}.")
    counted = np.ones(n) if weights is None else np.asarray(weights, dtype=np.float64)
    subset = np.arange(n)
    if n > MAX_TABLE_SIZE:
        generator = np.random.default_rng(np.random.SeedSequence(seed))
        subset = np.sort(generator.choice(n, max(MAX_TABLE_SIZE, *counts), replace=False))
    table = cdist(points[subset], points[subset])
    built = np.empty(max(counts), dtype=np.int64)
    build_medoids(table, counted[subset], built)
    for k in counts:
        chosen = built[:k].copy()
        if 1 < k < len(subset):
            swap_medoids(table, counted[subset], chosen)
        medoids = np.sort(subset[chosen])
        nearest = cdist(points, points[medoids]).argmin(axis=1)
        nearest[medoids] = np.arange(k)
        yield medoids.astype(np.int64), nearest.astype(np.int64)


@kernel
def build_medoids(table: FloatArray, weights: FloatArray, chosen: IntArray) -> None:
    """BUILD: fill `chosen` (k,) with the points that lower the weighted sum of distances most, in turn."""
    n = len(table)
    nearest = np.full(n, np.inf)
    taken = np.zeros(n, dtype=np.bool_)
    for step in range(len(chosen)):
        best, best_total = -1, np.inf
        for candidate in range(n):
            if taken[candidate]:
                continue
            total = 0.0
            for point in range(n):
                total += weights[point] * min(nearest[point], table[candidate, point])
            if best < 0 or total < best_total:
                best, best_total = candidate, total
        chosen[step] = best
        taken[best] = True
        for point in range(n):
            nearest[point] = min(nearest[point], table[best, point])


@kernel
def swap_medoids(table: FloatArray, weights: FloatArray, chosen: IntArray) -> int:
    """Swap medoids of `chosen` (in place) for better points until there are none; the number of swaps."""
    n, k = len(table), len(chosen)
    first, second = np.empty(n), np.empty(n)
    owner = np.empty(n, dtype=np.int64)
    loss, change = np.empty(k), np.empty(k)
    _two_nearest(table, weights, chosen, first, second, owner, loss)
    scale = max(np.sum(weights * first), 1e-300)
    swaps, quiet, candidate = 0, 0, 0
    while quiet < n and swaps < 100 * n:
        shared = 0.0
        change[:] = loss
        for point in range(n):
            distance, mine = table[candidate, point], owner[point]
            if distance < first[point]:
                shared += weights[point] * (distance - first[point])
                change[mine] += weights[point] * (first[point] - second[point])
            elif distance < second[point]:
                change[mine] += weights[point] * (distance - second[point])
        best = np.argmin(change)
        quiet += 1
        if change[best] + shared < -1e-12 * scale:
            chosen[best] = candidate
            _two_nearest(table, weights, chosen, first, second, owner, loss)
            swaps, quiet = swaps + 1, 0
        candidate = (candidate + 1) % n
    return swaps


@kernel
def _two_nearest(
    table: FloatArray,
    weights: FloatArray,
    chosen: IntArray,
    first: FloatArray,
    second: FloatArray,
    owner: IntArray,
    loss: FloatArray,
) -> None:
    """Distances to each point's two nearest medoids, the nearest one, and the loss of removing each."""
    loss[:] = 0.0
    for point in range(len(table)):
        first[point] = second[point] = np.inf
        owner[point] = 0
        for medoid in range(len(chosen)):
            distance = table[chosen[medoid], point]
            if distance < first[point]:
                second[point] = first[point]
                first[point] = distance
                owner[point] = medoid
            elif distance < second[point]:
                second[point] = distance
        loss[owner[point]] += weights[point] * (second[point] - first[point])
