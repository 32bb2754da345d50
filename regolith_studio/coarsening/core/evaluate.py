"""One evaluation of everything that the loss needs."""

import numpy as np

from regolith_studio.coarsening.core.box import Solid, from_to
from regolith_studio.coarsening.core.box_flush import box_on_facets
from regolith_studio.coarsening.core.intersection import DEGENERATE, FINE, edges_of, intersect
from regolith_studio.coarsening.core.measures import facets_of, volume_of
from regolith_studio.coarsening.core.overlap import shared_by_planes
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.box_facets import Facets
from regolith_studio.geometry.box_search import least_box
from regolith_studio.geometry.compiled import kernel
from regolith_studio.geometry.vectors import length

VOLUME, AREA, SHORTEST, LONGEST, SHARED, FACETS = 0, 1, 2, 3, 4, 5
"""Places in the result of :func:`evaluate`."""
NO_BOX, BOX_ON_FACETS, LEAST_BOX = 0, 1, 2
"""Which box to measure."""
NO_EDGE = 1e-8
"""Edges of a polyhedron of about unit volume that are shorter bear no box."""


@kernel
def evaluate(
    normals: FloatArray,
    offsets: FloatArray,
    directions: FloatArray,
    first: IntArray,
    distance: FloatArray,
    sign: FloatArray,
    weight: float,
    box: int,
    with_overlap: bool,
) -> tuple[int, FloatArray]:
    """Status of the intersection, and volume, area, shortest and longest box edge, shared volume, facets.

    What is not asked for is NaN; `box` is NO_BOX, BOX_ON_FACETS or LEAST_BOX. The rays are those of
    :class:`regolith_studio.coarsening.target.RayTable`.
    """
    values = np.full(6, np.nan)
    status, vertices, triples = intersect(normals, offsets)
    if status != FINE:
        return status, values
    edges = edges_of(triples, len(offsets))
    area, _ = facets_of(normals, offsets, vertices, edges)
    values[VOLUME], values[AREA], values[FACETS] = volume_of(offsets, area), np.sum(area), 0.0
    for i in range(len(area)):
        values[FACETS] += area[i] > 0.0
    solid = Solid(vertices, normals, area, edges)
    if box == BOX_ON_FACETS:
        extents = box_on_facets(solid)
        values[SHORTEST], values[LONGEST] = extents.min(), extents.max()
    elif box == LEAST_BOX:
        extents = least_extents(solid)
        if not extents.min() > 0.0:
            return DEGENERATE, values
        values[SHORTEST], values[LONGEST] = extents.min(), extents.max()
    if with_overlap:
        values[SHARED] = shared_by_planes(normals, offsets, directions, first, distance, sign, weight)
    return status, values


@kernel
def least_extents(solid: Solid) -> FloatArray:
    """Edges of the least box of all, by :func:`regolith_studio.geometry.box_search.least_box`.

    Edges that are too short to have a direction are passed over, as if their ends were one vertex.
    """
    vertices, normals, _, edges = solid
    kept = np.full(len(edges), True)
    for e in range(len(edges)):
        kept[e] = length(from_to(vertices, edges[e, 0], edges[e, 1])) >= NO_EDGE
    facets = Facets(np.ascontiguousarray(vertices.T), normals, edges[kept])
    axes, extents = least_box(facets, np.inf).axes, np.empty(3)
    for k in range(3):
        along = vertices @ axes[k]
        extents[k] = along.max() - along.min()
    return extents


@kernel
def loss_of(
    normals: FloatArray,
    offsets: FloatArray,
    directions: FloatArray,
    first: IntArray,
    distance: FloatArray,
    sign: FloatArray,
    weight: float,
    box: int,
    with_overlap: bool,
    wanted: FloatArray,
    weights: FloatArray,
) -> float:
    """:func:`weighted_loss` of :func:`evaluate`; infinite where the half-spaces bound no proper polyhedron.

    The half-spaces may be locked arrays: only this function is compiled anew for them.
    """
    status, values = evaluate(
        normals.copy(),
        offsets.copy(),
        directions,
        first,
        distance,
        sign,
        weight,
        box,
        with_overlap,
    )
    return weighted_loss(values, wanted, weights) if is_proper(status, values) else np.inf


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
