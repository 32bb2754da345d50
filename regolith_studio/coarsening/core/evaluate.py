"""One evaluation of everything that the loss needs."""

import numpy as np

from regolith_studio.coarsening.core.intersection import (
    DEGENERATE,
    FINE,
    NUMBER,
    REACH,
    IntersectionWorkspace,
    cut_out,
    work_for,
)
from regolith_studio.coarsening.core.overlap import shared_by_planes
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.minimum_box.extents import between, extreme_vertices
from regolith_studio.geometry.minimum_box.hull_topology import Facets
from regolith_studio.geometry.minimum_box.search import best_box
from regolith_studio.geometry.vectors import along, cross, dot, length, row

VOLUME, AREA, SHORTEST, LONGEST, SHARED, FACETS = 0, 1, 2, 3, 4, 5
"""Places in the result of :func:`evaluate`."""
NO_EDGE = 1e-8
"""Edges of a polyhedron of about unit volume that are shorter bear no box."""


@kernel
def evaluate(
    normals: FloatArray,
    offsets: FloatArray,
    crossings: FloatArray,
    weight: float,
    with_box: bool,
    values: FloatArray,
) -> int:
    """Status of the intersection; fills `values`, shape (6,).

    These are volume, area, shortest and longest box edge, shared volume and number of facets. What is not
    asked for is NaN.

    Parameters
    ----------
    normals, offsets
        Of the half-spaces.
    crossings, weight
        Of the particle, as from :func:`regolith_studio.coarsening.core.overlap.crossings_of`, and of a ray;
        without crossings the shared volume is not asked for.
    with_box
        Whether to measure the minimum-volume box.
    """
    n = len(offsets)
    values[:] = np.nan
    vertices, triples = np.empty((2 * n, 3)), np.empty((2 * n, 3), np.int64)
    work, reach = work_for(n), REACH * offsets.max()
    status, count = cut_out(normals, offsets, reach, work, vertices, triples)
    if status != FINE:
        return status
    edges = np.empty((3 * n, 4), np.int64)
    measure_facets(normals, offsets, vertices[:count], triples, work, edges, values)
    if with_box:
        points = np.ascontiguousarray(vertices[:count].T)
        extents = least_extents(normals, points, edges[: 3 * count // 2])
        if not extents.min() > 0.0:
            return DEGENERATE
        values[SHORTEST], values[LONGEST] = extents.min(), extents.max()
    if crossings.shape[1] > 0:
        dual = np.empty((n, 3))
        for i in range(n):
            for c in range(3):
                dual[i, c] = normals[i, c] / offsets[i]
        values[SHARED] = shared_by_planes(dual, crossings, weight)
    return status


@kernel
def measure_facets(
    normals: FloatArray,
    offsets: FloatArray,
    vertices: FloatArray,
    triples: IntArray,
    work: IntersectionWorkspace,
    edges: IntArray,
    values: FloatArray,
) -> None:
    """Fill `edges` as :func:`regolith_studio.coarsening.core.intersection.edges_of`; volume, area, facets.

    Along the edges of a facet, counter-clockwise, the vector products of start and end add up to twice its
    area, along its normal.
    """
    owner, number, count = work.owner, work.lists[NUMBER], 0
    areas = np.zeros(len(offsets))
    for v in range(len(vertices)):
        for k in range(3):
            a, b = triples[v, k], triples[v, (k + 1) % 3]
            if a < b:
                edges[count, 0], edges[count, 1] = number[owner[b, a]], v
                edges[count, 2], edges[count, 3] = a, b
                count += 1
    for e in range(count):
        a, b = edges[e, 2], edges[e, 3]
        turn = cross(row(vertices, edges[e, 0]), row(vertices, edges[e, 1]))
        areas[a] += 0.5 * along(normals, a, turn)
        areas[b] -= 0.5 * along(normals, b, turn)
    volume = area = facets = 0.0
    for i in range(len(offsets)):
        volume += offsets[i] * areas[i]
        area += areas[i]
        facets += areas[i] > 0.0
    values[VOLUME], values[AREA], values[FACETS] = volume / 3.0, area, facets


@kernel
def least_extents(normals: FloatArray, points: FloatArray, edges: IntArray) -> FloatArray:
    """Edges of the least box of all, by :func:`regolith_studio.geometry.minimum_box.search.best_box`.

    Edges that are too short to have a direction are passed over, as if their ends were one vertex.

    Parameters
    ----------
    normals, points
        Of the facets (n, 3), and the vertices (3, v).
    edges
        As from :func:`regolith_studio.coarsening.core.intersection.edges_of`, shape (e, 4).
    """
    long, count = np.empty((len(edges), 4), np.int64), 0
    for e in range(len(edges)):
        for k in range(4):
            long[count, k] = edges[e, k]
        count += length(between(points, edges[e, 1], edges[e, 0])) >= NO_EDGE
    axes, extents = best_box(Facets(points, normals, long[:count])).axes, np.empty(3)
    for k in range(3):
        top, bottom = extreme_vertices(points, row(axes, k))
        extents[k] = dot(between(points, top, bottom), row(axes, k))
    return extents


@kernel
def weighted_loss(values: FloatArray, wanted: FloatArray, weights: FloatArray) -> float:
    """Eq. 9 for a particle of unit volume.

    Parameters
    ----------
    values
        As from :func:`evaluate`.
    wanted, weights
        Volume, sphericity, shortest and longest box edge, aspect ratio and volume of the convex hull of the
        particle, shape (6,); their weights, and last that of the Jaccard distance, shape (7,).
    """
    volume, shortest, longest = values[VOLUME], values[SHORTEST], values[LONGEST]
    sphericity = np.pi ** (1.0 / 3.0) * (6.0 * volume) ** (2.0 / 3.0) / values[AREA]
    loss = 0.0
    found = (volume, sphericity, shortest, longest, longest / shortest, volume)
    for i in range(6):
        if weights[i] > 0.0:
            loss += weights[i] * abs(found[i] / wanted[i] - 1.0)
    if weights[6] > 0.0:
        loss += weights[6] * (1.0 - values[SHARED] / (1.0 + volume - values[SHARED]))
    return loss
