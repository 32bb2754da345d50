"""One evaluation of everything that the loss needs."""

import numpy as np

from regolith_studio.coarsening.core.box import Solid
from regolith_studio.coarsening.core.box_search import local_boxes
from regolith_studio.coarsening.core.intersection import DEGENERATE, FINE, edges_of, intersect
from regolith_studio.coarsening.core.measures import facets_of, volume_of
from regolith_studio.coarsening.core.overlap import exits, shared_volume
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.compiled import kernel

VOLUME, AREA, SHORTEST, LONGEST, SHARED, FACETS = 0, 1, 2, 3, 4, 5
"""Places in the result of :func:`evaluate`."""


@kernel
def evaluate(
    normals: FloatArray,
    offsets: FloatArray,
    directions: FloatArray,
    first: IntArray,
    distance: FloatArray,
    sign: FloatArray,
    weight: float,
    with_box: bool,
    with_overlap: bool,
    sample_angle: float,
) -> tuple[int, FloatArray]:
    """Status of the intersection, and volume, area, shortest and longest box edge, shared volume, facets.

    What is not asked for is NaN. The rays are those of :class:`regolith_studio.coarsening.target.RayTable`.
    """
    values = np.full(6, np.nan)
    status, vertices, triples = intersect(normals, offsets)
    if status != FINE:
        return status, values
    edges = edges_of(triples, len(offsets))
    area, _ = facets_of(normals, offsets, vertices, edges)
    values[VOLUME], values[AREA] = volume_of(offsets, area), np.sum(area)
    values[FACETS] = np.sum(area > 0.0)
    if with_box:
        boxes = local_boxes(Solid(vertices, normals, area, edges), 1e-3, sample_angle, np.empty((0, 3, 3)))
        if len(boxes.volumes) == 0:
            return DEGENERATE, values
        values[SHORTEST], values[LONGEST] = boxes.extents[0].min(), boxes.extents[0].max()
    if with_overlap:
        radius, plane = np.empty(len(directions)), np.empty(len(directions), np.int64)
        exits(normals, offsets, directions, radius, plane)
        values[SHARED] = shared_volume(first, distance, sign, weight, radius)
    return status, values
