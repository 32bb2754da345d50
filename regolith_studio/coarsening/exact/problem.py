"""What the exact method is asked for, and everything it measures of one polyhedron, in compiled form."""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.box import Solid
from regolith_studio.coarsening.core.box_follow import Watched, followed, lost_axes, together
from regolith_studio.coarsening.core.box_search import Boxes, local_boxes, no_boxes
from regolith_studio.coarsening.core.intersection import FINE, edges_of, intersect
from regolith_studio.coarsening.core.measures import facets_of, volume_of
from regolith_studio.coarsening.core.overlap import exits, shared_volume
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel

VOLUME, SPHERICITY, SHORTEST, LONGEST, RATIO = 0, 1, 2, 3, 4
"""Conditions, in this order everywhere."""
MARGIN = 0.04
"""Boxes up to this share larger than the least are watched."""


class Problem(NamedTuple):
    """A particle's rays and the descriptors to be met.

    Parameters
    ----------
    directions, first, distance, sign, weight
        As in :class:`regolith_studio.coarsening.target.RayTable`.
    wanted
        Natural logarithm of volume, sphericity, shortest and longest box edge, aspect ratio, shape (5,).
    asked
        Which of them are conditions, shape (5,).
    sample_angle
        Of the search for boxes.
    held
        So many of the half-spaces, the first ones, never move.
    """

    directions: FloatArray
    first: IntArray
    distance: FloatArray
    sign: FloatArray
    weight: float
    wanted: FloatArray
    asked: BoolArray
    sample_angle: float
    held: int


class Shape(NamedTuple):
    """A polyhedron with what the conditions are made of.

    Parameters
    ----------
    status
        Of :func:`regolith_studio.coarsening.core.intersection.intersect`; the rest is void unless FINE.
    normals, offsets
        Half-spaces, (n, 3) and (n,).
    vertices, triples, edges
        As there.
    area, centroid
        Of each facet, (n,) and (n, 3).
    volume, surface
        Volume and area of the whole.
    boxes
        Locally minimal boxes near the least; none where the conditions need none.
    """

    status: int
    normals: FloatArray
    offsets: FloatArray
    vertices: FloatArray
    triples: IntArray
    edges: IntArray
    area: FloatArray
    centroid: FloatArray
    volume: float
    surface: float
    boxes: Boxes


@kernel
def needs_box(problem: Problem) -> bool:
    """Whether a condition is about the box."""
    return bool(problem.asked[SHORTEST] or problem.asked[LONGEST] or problem.asked[RATIO])


@kernel
def shape_of(problem: Problem, normals: FloatArray, offsets: FloatArray, near: Watched) -> Shape:
    """Intersect and measure; the boxes are those of `near`, or others near them; if it is empty, all."""
    boxes = no_boxes()
    status, vertices, triples = intersect(normals, offsets)
    if status != FINE:
        none = np.empty((0, 4), np.int64)
        nothing = np.zeros(len(offsets))
        return Shape(status, normals, offsets, vertices, triples, none, nothing, normals, 0.0, 0.0, boxes)
    edges = edges_of(triples, len(offsets))
    area, centroid = facets_of(normals, offsets, vertices, edges)
    if needs_box(problem):
        solid = Solid(vertices, normals, area, edges)
        if len(near.frames) == 0:
            boxes = local_boxes(solid, MARGIN, problem.sample_angle, np.empty((0, 3)))
        else:
            boxes, lost = followed(solid, triples, near)
            if lost.any():
                others = local_boxes(solid, MARGIN, problem.sample_angle, lost_axes(near, lost))
                boxes = together(boxes, others)
    volume = volume_of(offsets, area)
    return Shape(
        status, normals, offsets, vertices, triples, edges, area, centroid, volume, np.sum(area), boxes
    )


@kernel
def shared_with(
    problem: Problem, normals: FloatArray, offsets: FloatArray, radius: FloatArray, plane: IntArray
) -> float:
    """Volume shared with the particle; `radius` and `plane` (k,) are filled."""
    exits(normals, offsets, problem.directions, radius, plane)
    return shared_volume(problem.first, problem.distance, problem.sign, problem.weight, radius)


@kernel
def log_sphericity(volume: float, surface: float) -> float:
    """Natural logarithm of Wadell's sphericity."""
    return float(np.log(np.pi) / 3.0 + np.log(6.0 * volume) * 2.0 / 3.0 - np.log(surface))
