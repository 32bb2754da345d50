"""Starting half-spaces: the hull's triangles grouped by the direction of their normals."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import kernel


def grouped_planes(
    normals: FloatArray, areas: FloatArray, centres: FloatArray, numbers: FloatArray, rounds: int
) -> tuple[FloatArray, FloatArray]:
    """Spherical k-means of the hull's facets, weighted by area, started as k-means++.

    Parameters
    ----------
    normals, areas, centres
        Of the hull's triangles, shapes (m, 3), (m,), (m, 3).
    numbers
        Uniform random numbers in [0, 1), shape (k,): one a group.
    rounds
        Of reassignment.

    Returns
    -------
    normals, offsets
        Mean normal of each group and the area-weighted mean of <n, x> over it, shapes (k, 3) and (k,).
    """
    middle, offsets = np.empty((len(numbers), 3)), np.zeros(len(numbers))
    _fill_groups(normals, areas, centres, numbers, rounds, middle, offsets)
    return middle, offsets


@kernel
def _fill_groups(
    normals: FloatArray,
    areas: FloatArray,
    centres: FloatArray,
    numbers: FloatArray,
    rounds: int,
    middle: FloatArray,
    offsets: FloatArray,
) -> None:
    """Fill mean normals (k, 3) and offsets (k,), which must be 0."""
    k, m = len(numbers), len(areas)
    far = np.full(m, 2.0)
    for j in range(k):
        total = np.cumsum(areas * far)
        at = min(m - 1, np.searchsorted(total, numbers[j] * total[-1]))
        middle[j] = normals[at]
        for i in range(m):
            dot = normals[i, 0] * middle[j, 0] + normals[i, 1] * middle[j, 1] + normals[i, 2] * middle[j, 2]
            far[i] = min(far[i], max(0.0, 1.0 - dot))
    group = np.zeros(m, np.int64)
    for _ in range(rounds):
        assign(normals, middle, group)
        sums = np.zeros((k, 3))
        for i in range(m):
            for c in range(3):
                sums[group[i], c] += areas[i] * normals[i, c]
        for j in range(k):
            length = np.sqrt(np.sum(sums[j] ** 2))
            if length > 1e-9:
                middle[j] = sums[j] / length
    assign(normals, middle, group)
    weight = np.zeros(k)
    for i in range(m):
        j = group[i]
        weight[j] += areas[i]
        for c in range(3):
            offsets[j] += areas[i] * middle[j, c] * centres[i, c]
    for j in range(k):
        if weight[j] > 0.0:
            offsets[j] /= weight[j]
        else:
            offsets[j] = support(centres, middle[j])


@kernel
def assign(normals: FloatArray, middle: FloatArray, group) -> None:  # type: ignore[no-untyped-def]
    """Nearest middle of each normal."""
    for i in range(len(normals)):
        best = -2.0
        for j in range(len(middle)):
            dot = normals[i, 0] * middle[j, 0] + normals[i, 1] * middle[j, 1] + normals[i, 2] * middle[j, 2]
            if dot > best:
                best = dot
                group[i] = j


@kernel
def support(points: FloatArray, direction: FloatArray) -> float:
    """Largest <direction, x> over points."""
    most = -np.inf
    for i in range(len(points)):
        most = max(
            most,
            points[i, 0] * direction[0] + points[i, 1] * direction[1] + points[i, 2] * direction[2],
        )
    return most
