"""A union of convex parts, measured: corners, exposed facets, volume and surface area."""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.compound.exposed_edges import fill_exposed_areas, fill_exposed_edges
from regolith_studio.coarsening.core.intersection import FINE
from regolith_studio.coarsening.core.polyhedron_measures import measure_polyhedron
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray

EDGES_PER_PLANE = 12


class Planes(NamedTuple):
    """Half-spaces <n_i, x> <= h_i of k parts, about an origin that they have in common.

    Parameters
    ----------
    normals, offsets
        Of all parts, shapes (n, 3) and (n,); offsets may be negative.
    first
        Those of part j are ``first[j]:first[j + 1]``, shape (k + 1,).
    inner
        A point inside each part, shape (k, 3).
    partner
        Of parts that touch: the part on the other side of a plane that separates two and never moves, -1 of
        the other planes, shape (n,); ``None`` of parts that may overlap.
    """

    normals: FloatArray
    offsets: FloatArray
    first: IntArray
    inner: FloatArray
    partner: IntArray | None = None

    @property
    def free(self) -> FloatArray:
        """1 for each coordinate of a plane that may move, 0 for the others, shape (3 n,)."""
        if self.partner is None:
            return np.ones(3 * len(self.offsets))
        return np.repeat(np.where(self.partner < 0, 1.0, 0.0), 3)


class MeasuredCompound(NamedTuple):
    """A union of convex parts.

    Parameters
    ----------
    planes
        Its half-spaces; `inner` is the mean of each part's corners.
    vertices, triples
        Corners of all parts, (v, 3), and the three planes that meet in each, (v, 3).
    ends, edge_planes
        Exposed edges, see :func:`regolith_studio.coarsening.compound.exposed_edges.fill_exposed_edges`.
    areas, centroids
        Of the exposed part of each facet, (n,) and (n, 3); the whole facet's centroid where that is nothing.
    volume, surface_area
        Of the union.
    """

    planes: Planes
    vertices: FloatArray
    triples: IntArray
    ends: FloatArray
    edge_planes: IntArray
    areas: FloatArray
    centroids: FloatArray
    volume: float
    surface_area: float


def measure_compound(planes: Planes) -> MeasuredCompound | None:
    """The union, or ``None`` where a part is unbounded or empty, or does not hold its inner point."""
    normals, offsets, first, inner, _ = planes
    k = len(first) - 1
    vertices, triples, edges, middles, own = [], [], [], np.empty((k, 3)), np.empty((len(offsets), 3))
    count = 0
    for j in range(k):
        start, stop = first[j], first[j + 1]
        mine = normals[start:stop]
        distance = offsets[start:stop] - mine @ inner[j]
        if not distance.min() > 0.0:
            return None
        part = measure_polyhedron(mine, distance)
        if part.status != FINE:
            return None
        vertices.append(part.vertices + inner[j])
        triples.append(part.triples + start)
        edges.append(part.edges + np.array([count, count, start, start]))
        middles[j] = vertices[j].mean(axis=0)
        own[start:stop] = part.centroids + inner[j]
        count += len(part.vertices)
    points, links = np.concatenate(vertices), np.concatenate(edges)
    ends, edge_planes = _exposed_edges(normals, offsets, first, points, links)
    areas, centroids = np.empty(len(offsets)), np.empty((len(offsets), 3))
    volume, surface = fill_exposed_areas(normals, offsets, ends, edge_planes, areas, centroids)
    hidden = areas < HIDDEN
    centroids[hidden] = own[hidden]
    moved = planes._replace(inner=middles)
    return MeasuredCompound(
        moved, points, np.concatenate(triples), ends, edge_planes, areas, centroids, volume, surface
    )


def parts_overlap(compound: MeasuredCompound) -> bool:
    """Whether parts that are to touch overlap: the surfaces of two meet that no plane separates."""
    partner = compound.planes.partner
    if partner is None:
        return False
    part = _part_of_planes(compound.planes)
    meet = _meeting_parts(compound, part)
    meet[part[partner >= 0], partner[partner >= 0]] = False
    return bool(meet.any())


def is_one_body(compound: MeasuredCompound) -> bool:
    """Whether all parts that have an exposed surface hang together."""
    part = _part_of_planes(compound.planes)
    meet = _meeting_parts(compound, part)
    meet.flat[:: len(meet) + 1] = True
    for _ in range(3):  # paths of up to 8 edges: as many as there can be parts
        meet = meet @ meet
    seen = np.bincount(part, np.maximum(compound.areas, 0.0)) > HIDDEN
    return bool(meet[seen][:, seen].all())


def _meeting_parts(compound: MeasuredCompound, part: IntArray) -> BoolArray:
    """Of which parts the surfaces intersect where they are exposed, shape (k, k)."""
    k = len(compound.planes.inner)
    meet = np.zeros((k, k), dtype=np.bool_)
    pairs = part[compound.edge_planes[compound.edge_planes[:, 2] < 0, :2]]
    meet[pairs[:, 0], pairs[:, 1]] = meet[pairs[:, 1], pairs[:, 0]] = True
    return meet


def _part_of_planes(planes: Planes) -> IntArray:
    first = planes.first
    return np.arange(len(first) - 1).repeat(first[1:] - first[:-1])


HIDDEN = 1e-9
"""Facets exposed by less area, at unit volume, count as hidden."""


def _exposed_edges(
    normals: FloatArray, offsets: FloatArray, first: IntArray, vertices: FloatArray, edges: IntArray
) -> tuple[FloatArray, IntArray]:
    room, covers = EDGES_PER_PLANE * len(offsets), np.empty((len(first) - 1, 2))
    while True:
        ends, planes = np.empty((room, 6)), np.empty((room, 3), dtype=np.int64)
        count = fill_exposed_edges(normals, offsets, first, vertices, edges, covers, ends, planes)
        if count <= room:
            return ends[:count], planes[:count]
        room = count
