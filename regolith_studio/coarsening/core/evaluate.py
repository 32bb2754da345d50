"""One evaluation of everything that the loss needs."""

import numpy as np

from regolith_studio.coarsening.core.box_flush import (
    AREAS,
    DESK,
    EDGES,
    FLAT,
    FROM,
    NORMALS,
    ONE,
    OTHER,
    POINTS,
    TO,
    least_on_facets,
    room_for,
)
from regolith_studio.coarsening.core.intersection import (
    DEGENERATE,
    FINE,
    NUMBER,
    REACH,
    Work,
    cut_out,
    work_for,
)
from regolith_studio.coarsening.core.overlap import shared_by_planes
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.box_facets import Facets
from regolith_studio.geometry.box_search import least_box
from regolith_studio.geometry.box_widths import between, ends_along
from regolith_studio.geometry.kernels import kernel, kernel_noalloc
from regolith_studio.geometry.vectors import along, cross, dot, length, row

VOLUME, AREA, SHORTEST, LONGEST, SHARED, FACETS = 0, 1, 2, 3, 4, 5
"""Places in the result of :func:`evaluate`."""
NO_BOX, BOX_ON_FACETS, LEAST_BOX = 0, 1, 2
"""Which box to measure."""
NO_EDGE = 1e-8
"""Edges of a polyhedron of about unit volume that are shorter bear no box."""


@kernel
def evaluate(
    normals: FloatArray, offsets: FloatArray, crossings: FloatArray, weight: float, box: int
) -> tuple[int, FloatArray]:
    """Status of the intersection, and volume, area, shortest and longest box edge, shared volume, facets.

    What is not asked for is NaN; `box` is NO_BOX, BOX_ON_FACETS or LEAST_BOX.

    Parameters
    ----------
    normals, offsets
        Of the half-spaces; they may be locked.
    crossings, weight
        Of the particle, as from :func:`regolith_studio.coarsening.core.overlap.crossings_of`, and of a ray;
        without crossings the shared volume is not asked for.
    """
    n, values = len(offsets), np.full(6, np.nan)
    planes, heights, vertices, triples = (
        np.empty((n, 3)),
        np.empty(n),
        np.empty((2 * n, 3)),
        np.empty((2 * n, 3), np.int64),
    )
    for i in range(n):
        heights[i] = offsets[i]
        for c in range(3):
            planes[i, c] = normals[i, c]
    work, reach = work_for(n), REACH * heights.max()
    status, count = cut_out(planes, heights, reach, work, vertices, triples)
    if status != FINE:
        return status, values
    desk, sides = np.empty((DESK, room_for(n, count))), np.empty((EDGES, 3 * n), np.int64)
    laid_out(planes, heights, vertices[:count], triples, work, desk, sides, values)
    if box == BOX_ON_FACETS:
        extents = np.empty(3)
        least_on_facets(desk, sides, n, count, 3 * count // 2, extents)
        values[SHORTEST], values[LONGEST] = extents.min(), extents.max()
    elif box == LEAST_BOX:
        extents = least_extents(planes, desk[POINTS:FLAT, :count].copy(), sides[:4, : 3 * count // 2])
        if not extents.min() > 0.0:
            return DEGENERATE, values
        values[SHORTEST], values[LONGEST] = extents.min(), extents.max()
    if crossings.shape[1] > 0:
        for i in range(n):
            for c in range(3):
                planes[i, c] /= heights[i]
        values[SHARED] = shared_by_planes(planes, crossings, weight)
    return status, values


@kernel_noalloc
def laid_out(
    normals: FloatArray,
    offsets: FloatArray,
    vertices: FloatArray,
    triples: IntArray,
    work: Work,
    desk: FloatArray,
    sides: IntArray,
    values: FloatArray,
) -> None:
    """Fill the desk and the sides of :mod:`regolith_studio.coarsening.core.box_flush`, and the first values.

    Edges are in the order of :func:`regolith_studio.coarsening.core.intersection.edges_of`. Along the edges
    of a facet, counter-clockwise, the vector products of start and end add up to twice its area, along its
    normal.
    """
    owner, number, edges = work.owner, work.lists[NUMBER], np.uintp(0)
    for i in range(len(offsets)):
        for c in range(3):
            desk[NORMALS + c, i] = normals[i, c]
        desk[AREAS, i] = 0.0
    for v in range(len(vertices)):
        for c in range(3):
            desk[POINTS + c, v] = vertices[v, c]
        for k in range(3):
            a, b = np.uintp(triples[v, k]), np.uintp(triples[v, (k + 1) % 3])
            sides[ONE, edges], sides[OTHER, edges] = a, b
            sides[FROM, edges], sides[TO, edges] = number[np.uintp(owner[b, a])], v
            edges += np.uintp(a < b)
    for e in range(int(edges)):
        a, b = np.uintp(sides[ONE, e]), np.uintp(sides[OTHER, e])
        turn = cross(row(vertices, sides[FROM, e]), row(vertices, sides[TO, e]))
        desk[AREAS, a] += 0.5 * along(normals, int(a), turn)
        desk[AREAS, b] -= 0.5 * along(normals, int(b), turn)
    volume = area = facets = 0.0
    for i in range(len(offsets)):
        volume += offsets[i] * desk[AREAS, i]
        area += desk[AREAS, i]
        facets += desk[AREAS, i] > 0.0
    values[VOLUME], values[AREA], values[FACETS] = volume / 3.0, area, facets


@kernel
def least_extents(normals: FloatArray, points: FloatArray, sides: IntArray) -> FloatArray:
    """Edges of the least box of all, by :func:`regolith_studio.geometry.box_search.least_box`.

    Edges that are too short to have a direction are passed over, as if their ends were one vertex.

    Parameters
    ----------
    normals, points
        Of the facets (n, 3), and the vertices (3, v).
    sides
        Of the edges their two facets, and their vertices, counter-clockwise around the first, shape (4, e).
    """
    edges, count = np.empty((sides.shape[1], 4), np.int64), 0
    for e in range(sides.shape[1]):
        one, two = sides[FROM, e], sides[TO, e]
        edges[count, 0], edges[count, 1] = one, two
        edges[count, 2], edges[count, 3] = sides[ONE, e], sides[OTHER, e]
        count += length(between(points, two, one)) >= NO_EDGE
    axes, extents = least_box(Facets(points, normals, edges[:count]), np.inf).axes, np.empty(3)
    for k in range(3):
        top, bottom = ends_along(points, row(axes, k))
        extents[k] = dot(between(points, top, bottom), row(axes, k))
    return extents


@kernel
def loss_of(normals: FloatArray, offsets: FloatArray, crossings: FloatArray, facts: FloatArray) -> float:
    """:func:`weighted_loss` of :func:`evaluate`; infinite where the half-spaces bound no proper polyhedron.

    Parameters
    ----------
    facts
        What is wanted (6), the weights (7), the weight of a ray, and which box to measure: shape (15,).
    """
    status, values = evaluate(normals, offsets, crossings, facts[13], int(facts[14]))
    return weighted_loss(values, facts[:6], facts[6:13]) if is_proper(status, values) else np.inf


@kernel
def is_proper(status: int, values: FloatArray) -> bool:
    """Whether an evaluation found a polyhedron with a box of some thickness."""
    return bool(status == FINE and not values[SHORTEST] <= 0.0)


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
