"""A union of convex parts and its convex hull, measured in memory that is made once.

The hull's triangles are the corners of the dual polyhedron <x_i - c, y> <= 1, where c is the mean of the
corners x_i: faster than Qhull for some 60 corners.
"""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.exposed_edges import (
    add_exposed_surface_charges,
    fill_exposed_areas,
    fill_exposed_edges,
    part_of,
)
from regolith_studio.coarsening.core.intersection import FINE, IntersectionWorkspace, workspace_for
from regolith_studio.coarsening.core.polyhedron_measures import add_vertex_charges, fill_measures
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import inner_kernel
from regolith_studio.geometry.vectors import along, cross, dot, length, mixed, row

EDGES_PER_PLANE = 40
"""Room for exposed edges."""
HIDDEN = 1e-9
"""Facets exposed by less area, at unit volume, count as hidden."""
JOGGLE = 1e-11
"""Distances of corners are changed by up to this share to find the triangles of the hull, so that no four
corners lie in a plane."""
# Gives a triangle without area a normal of 0 instead of none.
NO_AREA = 1e-300
N_EXPOSED, N_FACES, TOUCHING = 0, 1, 2


class Planes(NamedTuple):
    """Half-spaces <n_i, x> <= h_i of k parts, about an origin that they have in common.

    Normals (n, 3) and offsets (n,), which may be negative, are those of all parts: ``first[j]:first[j + 1]``
    of part j, with a point inside it, (k, 3). Of parts that touch, `partner` (n,) is the part on the other
    side of a plane that separates two and never moves, -1 of the other planes.
    """

    normals: FloatArray
    offsets: FloatArray
    first: IntArray
    inner: FloatArray
    partner: IntArray | None = None


class Hull(NamedTuple):
    """The convex hull of v corners.

    Faces to normals (m, 3) are triangles by their corners, outward, their normals times their areas, and
    their normals; edges (3 m / 2, 4) are (from, to, triangle a, triangle b), counter-clockwise around a.
    `joggle` is a factor of each corner, near 1. The others are scratch: corners from their mean, the dual
    polyhedron, and forces on the corners (v, 3).
    """

    faces: IntArray
    area_vectors: FloatArray
    normals: FloatArray
    edges: IntArray
    spokes: FloatArray
    directions: FloatArray
    distances: FloatArray
    points: FloatArray
    areas: FloatArray
    centroids: FloatArray
    work: IntersectionWorkspace
    joggle: FloatArray
    forces: FloatArray


class Parts(NamedTuple):
    """Memory of what a union of k parts has beyond a convex polyhedron with as many half-spaces.

    `first` and `partner` are those of :class:`Planes`, -1 everywhere of parts that may overlap; `inner` is
    the mean of a part's corners, once it is measured. Counts: exposed edges, triangles of the hull, whether
    parts are to touch. For exposed edges see
    :func:`regolith_studio.coarsening.core.exposed_edges.fill_exposed_edges`. Charges (n, 4) are of the volume
    shared with the particle, `curvature` (n, 3, 3) is a second derivative of the volume in which they differ.
    The others are scratch.
    """

    first: IntArray
    partner: IntArray
    inner: FloatArray
    counts: IntArray
    ends: FloatArray
    edge_planes: IntArray
    charges: FloatArray
    curvature: FloatArray
    distances: FloatArray
    centroids: FloatArray
    covers: FloatArray
    by: IntArray
    speeds: FloatArray
    meet: BoolArray
    hull: Hull


def parts_for(planes: Planes) -> Parts:
    """Memory for a union with these parts, which begins with their inner points."""
    n, k = len(planes.offsets), len(planes.inner)
    room = EDGES_PER_PLANE * n
    return Parts(
        np.array(planes.first, np.int64),
        np.full(n, -1, np.int64) if planes.partner is None else np.array(planes.partner, np.int64),
        np.array(planes.inner),
        np.array([0, 0, planes.partner is not None], np.int64),
        np.empty((room, 6)),
        np.empty((room, 3), np.int64),
        np.empty((n, 4)),
        np.empty((n, 3, 3)),
        np.empty(n),
        np.empty((n, 3)),
        np.empty((k, 2)),
        np.empty((k, 2), np.int64),
        np.empty((3, n)),
        np.empty((k, k), np.bool_),
        hull_for(2 * n),
    )


def hull_for(v: int) -> Hull:
    """Memory for the hull of v corners."""
    return Hull(
        np.empty((2 * v, 3), np.int64),
        np.empty((2 * v, 3)),
        np.empty((2 * v, 3)),
        np.empty((3 * v, 4), np.int64),
        np.empty((v, 3)),
        np.empty((v, 3)),
        np.empty(v),
        np.empty((2 * v, 3)),
        np.empty(v),
        np.empty((v, 3)),
        workspace_for(v),
        1.0 + JOGGLE * np.random.default_rng(0).random(v),
        np.empty((v, 3)),
    )


@inner_kernel
def fill_union(
    normals: FloatArray,
    offsets: FloatArray,
    work: IntersectionWorkspace,
    vertices: FloatArray,
    triples: IntArray,
    edges: IntArray,
    areas: FloatArray,
    centroids: FloatArray,
    parts: Parts,
) -> tuple[bool, int, float, float]:
    """Whether the parts bound one body, the number of their corners, volume and surface area.

    Arrays are filled as by :func:`regolith_studio.coarsening.core.polyhedron_measures.fill_measures`, with
    corners and edges of all parts, and areas and centroids of what is exposed of each facet; the whole
    facet's centroid where that is nothing.
    """
    sound, count, links = _fill_corners(normals, offsets, work, vertices, triples, edges, areas, parts)
    if not sound:
        return False, 0, 0.0, 0.0
    exposed = fill_exposed_edges(
        normals,
        offsets,
        parts.first,
        vertices[:count],
        edges[:links],
        parts.covers,
        parts.ends,
        parts.edge_planes,
    )
    if exposed > len(parts.ends):
        return False, 0, 0.0, 0.0
    parts.counts[N_EXPOSED] = exposed
    volume, surface = fill_exposed_areas(
        normals, offsets, parts.ends[:exposed], parts.edge_planes[:exposed], areas, centroids
    )
    for i in range(len(areas)):
        if areas[i] < HIDDEN:
            for c in range(3):
                centroids[i, c] = parts.centroids[i, c]
    _fill_meeting(parts)
    sound = volume > 0.0 and not _overlap(parts) and _is_one_body(areas, parts)
    return sound, count, volume, surface


@inner_kernel
def _fill_corners(
    normals: FloatArray,
    offsets: FloatArray,
    work: IntersectionWorkspace,
    vertices: FloatArray,
    triples: IntArray,
    edges: IntArray,
    areas: FloatArray,
    parts: Parts,
) -> tuple[bool, int, int]:
    """Corners and edges of every part; False where one is unbounded, or does not hold its inner point."""
    count, links = 0, 0
    for j in range(len(parts.first) - 1):
        start, stop, inner = parts.first[j], parts.first[j + 1], row(parts.inner, j)
        for i in range(start, stop):
            parts.distances[i] = offsets[i] - along(normals, i, inner)
            if not parts.distances[i] > 0.0:
                return False, 0, 0
        status, corners, _, _ = fill_measures(
            normals[start:stop],
            parts.distances[start:stop],
            work,
            vertices[count:],
            triples[count:],
            edges[links:],
            areas[start:stop],
            parts.centroids[start:stop],
        )
        if status != FINE:
            return False, 0, 0
        for c in range(3):
            # The next inner point is the mean of the corners: after a step the old one may come to lie
            # outside.
            parts.inner[j, c] = 0.0
            for v in range(count, count + corners):
                vertices[v, c] += inner[c]
                triples[v, c] += start
                parts.inner[j, c] += vertices[v, c] / corners
            for i in range(start, stop):
                parts.centroids[i, c] += inner[c]
        # Three edges meet in each corner, and each edge has two.
        for e in range(links, links + 3 * corners // 2):
            for c in range(2):
                edges[e, c] += count
                edges[e, 2 + c] += start
        count, links = count + corners, links + 3 * corners // 2
    return True, count, links


@inner_kernel
def _fill_meeting(parts: Parts) -> None:
    """Of which parts the surfaces intersect where they are exposed."""
    parts.meet[:, :] = False
    for e in range(parts.counts[N_EXPOSED]):
        if parts.edge_planes[e, 2] < 0:
            one, two = (
                part_of(parts.first, parts.edge_planes[e, 0]),
                part_of(parts.first, parts.edge_planes[e, 1]),
            )
            parts.meet[one, two] = parts.meet[two, one] = True


@inner_kernel
def _overlap(parts: Parts) -> bool:
    """Whether parts that are to touch overlap: the surfaces of two meet that no plane separates."""
    if parts.counts[TOUCHING] == 0:
        return False
    k = len(parts.first) - 1
    for one in range(k):
        for two in range(k):
            separate = not parts.meet[one, two]
            for i in range(parts.first[one], parts.first[one + 1]):
                separate = separate or parts.partner[i] == two
            if not separate:
                return True
    return False


@inner_kernel
def _is_one_body(areas: FloatArray, parts: Parts) -> bool:
    """Whether all parts that have an exposed surface hang together."""
    k, meet = len(parts.first) - 1, parts.meet
    # The middle one outermost (Warshall), so that chains of any length are found in one go.
    for via in range(k):
        for one in range(k):
            for two in range(k):
                if meet[one, via] and meet[via, two]:
                    meet[one, two] = True
    seen = -1
    for j in range(k):
        exposed = 0.0
        for i in range(parts.first[j], parts.first[j + 1]):
            exposed += max(areas[i], 0.0)
        if exposed <= HIDDEN:
            continue
        if seen >= 0 and not meet[seen, j]:
            return False
        seen = j
    return seen >= 0


@inner_kernel
def add_union_surface_charges(
    normals: FloatArray, pivots: FloatArray, size: float, parts: Parts, charges: FloatArray
) -> None:
    """Add `size` times the derivative of the union's surface area, shape (n, 4)."""
    count = parts.counts[N_EXPOSED]
    add_exposed_surface_charges(normals, parts.ends[:count], parts.edge_planes[:count], pivots, size, charges)


@inner_kernel
def fill_hull(vertices: FloatArray, counts: IntArray, hull: Hull) -> float:
    """Fill the triangles of the hull of corners; its volume, 0 where it is flat."""
    v = len(vertices)
    counts[N_FACES] = 0
    spokes = hull.spokes[:v]
    for c in range(3):
        mean = 0.0
        for i in range(v):
            mean += vertices[i, c] / v
        for i in range(v):
            spokes[i, c] = vertices[i, c] - mean
    for i in range(v):
        distance = length(row(spokes, i))
        if not distance > 0.0:
            return 0.0
        # The plane of the dual polyhedron lies at one over the distance of the corner.
        hull.distances[i] = hull.joggle[i] / distance
        for c in range(3):
            hull.directions[i, c] = spokes[i, c] / distance
    status, m, _, _ = fill_measures(
        hull.directions[:v],
        hull.distances[:v],
        hull.work,
        hull.points,
        hull.faces,
        hull.edges,
        hull.areas[:v],
        hull.centroids[:v],
    )
    if status != FINE:
        return 0.0
    counts[N_FACES] = m
    for e in range(3 * m // 2):
        # An edge of the dual polyhedron joins two triangles of the hull and separates two of its corners.
        start, end, one, two = hull.edges[e, 0], hull.edges[e, 1], hull.edges[e, 2], hull.edges[e, 3]
        hull.edges[e, 0], hull.edges[e, 1], hull.edges[e, 2], hull.edges[e, 3] = one, two, end, start
    return _fill_area_vectors(spokes, m, hull)


@inner_kernel
def _fill_area_vectors(points: FloatArray, m: int, hull: Hull) -> float:
    """Fill the normals of m triangles, and times their areas; the volume that they enclose."""
    volume = 0.0
    for f in range(m):
        a, b, c = row(points, hull.faces[f, 0]), row(points, hull.faces[f, 1]), row(points, hull.faces[f, 2])
        normal = cross(mixed(b, 1.0, a, -1.0), mixed(c, 1.0, a, -1.0))
        size = max(length(normal), NO_AREA)
        for x in range(3):
            hull.area_vectors[f, x] = 0.5 * normal[x]
            hull.normals[f, x] = normal[x] / size
        volume += dot(a, normal) / 6.0
    return volume


@inner_kernel
def add_hull_charges(
    normals: FloatArray,
    triples: IntArray,
    vertices: FloatArray,
    pivots: FloatArray,
    size: float,
    parts: Parts,
    charges: FloatArray,
) -> None:
    """Add `size` times the derivative of the hull's volume, shape (n, 4)."""
    hull, v = parts.hull, len(vertices)
    hull.forces[:v] = 0.0
    for f in range(parts.counts[N_FACES]):
        for corner in range(3):
            for c in range(3):
                # A corner that moves by dx changes the volume by a third of <area vector, dx> for each of its
                # triangles.
                hull.forces[hull.faces[f, corner], c] += hull.area_vectors[f, c] * size / 3.0
    for i in range(v):
        force = row(hull.forces, i)
        if dot(force, force) > 0.0:
            add_vertex_charges(normals, triples, vertices, i, force, pivots, charges)
