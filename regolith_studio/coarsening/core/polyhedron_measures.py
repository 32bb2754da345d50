"""Polyhedra of half-spaces: vertices, facets and measures, how planes move, and derivatives.

Plane i turns about its pivot: n' = normalise(n + (t1 e1 + t2 e2) / rho), h' = <n', pivot> + s, with tangents
e1, e2 and a scale rho, so that the shift s and the tilts t1, t2 are lengths. The plane's speed at x is
w(x) = ds - <dt1 e1 + dt2 e2, x - pivot> / rho.

A *charge* of a plane is the derivative of a number with its motion: the rate per unit of speed, and its first
moment about the plane's pivot. Where the plane moves outward at the speed w(x) = w0 + <g, x - pivot>, the
number changes at the rate charge[0] w0 + <charge[1:4], g>.
"""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.intersection import (
    FINE,
    NUMBER,
    REACH,
    IntersectionWorkspace,
    fill_vertices,
    workspace_for,
)
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.kernels import inner_kernel, kernel_noalloc
from regolith_studio.geometry.vectors import Vector, along, cross, dot, length, mixed, row

NO_AREA = 1e-14
"""Facets of less area have no centroid of their own."""


class MeasuredPolyhedron(NamedTuple):
    """The polyhedron <n_i, x> <= h_i of n half-spaces; only status and half-spaces hold unless it is FINE.

    The status is that of :mod:`regolith_studio.coarsening.core.intersection`. Vertices (v, 3) come with the
    three planes that meet in each, counter-clockwise seen from outside; edges (e, 4) are (from, to, plane a,
    plane b), counter-clockwise around a, with a < b. A plane without a facet has area 0, and its foot point
    as centroid.
    """

    status: int
    normals: FloatArray
    offsets: FloatArray
    vertices: FloatArray
    triples: IntArray
    edges: IntArray
    areas: FloatArray
    centroids: FloatArray
    volume: float
    surface_area: float


def measure_polyhedron(normals: FloatArray, offsets: FloatArray) -> MeasuredPolyhedron:
    """Intersect half-spaces in general position and measure the result."""
    n = len(offsets)
    # With three planes at each vertex there are 2 n - 4 vertices and 3 n - 6 edges.
    vertices, triples = np.empty((2 * n, 3)), np.empty((2 * n, 3), dtype=np.int64)
    edges, areas, centroids = np.empty((3 * n, 4), dtype=np.int64), np.empty(n), np.empty((n, 3))
    work = workspace_for(n)
    status, count, volume, surface = fill_measures(
        normals, offsets, work, vertices, triples, edges, areas, centroids
    )
    vertices, triples, edges = vertices[:count], triples[:count], edges[: 3 * count // 2]
    return MeasuredPolyhedron(
        status, normals, offsets, vertices, triples, edges, areas, centroids, volume, surface
    )


@kernel_noalloc
def fill_measures(
    normals: FloatArray,
    offsets: FloatArray,
    work: IntersectionWorkspace,
    vertices: FloatArray,
    triples: IntArray,
    edges: IntArray,
    areas: FloatArray,
    centroids: FloatArray,
) -> tuple[int, int, float, float]:
    """Status, number of vertices, volume and surface area; fills the arrays."""
    n, largest = len(offsets), 0.0
    for i in range(n):
        largest = max(largest, offsets[i])
        areas[i] = centroids[i, 0] = centroids[i, 1] = centroids[i, 2] = 0.0
    status, count = fill_vertices(normals, offsets, REACH * largest, work, vertices, triples)
    if status != FINE:
        return status, 0, 0.0, 0.0
    e = 0
    for v in range(count):
        for k in range(3):
            a, b = triples[v, k], triples[v, (k + 1) % 3]
            # Every edge is met at both of its ends, with its planes the other way round.
            if a < b:
                edges[e, 0], edges[e, 1] = work.lists[NUMBER, work.owner[b, a]], v
                edges[e, 2], edges[e, 3] = a, b
                for way in range(2):
                    _add_triangle(normals, offsets, vertices, edges, e, way, areas, centroids)
                e += 1
    volume, surface = 0.0, 0.0
    for i in range(n):
        for c in range(3):
            inner = centroids[i, c] / areas[i] if areas[i] > NO_AREA else 0.0
            centroids[i, c] = normals[i, c] * offsets[i] + inner
        volume += offsets[i] * areas[i] / 3.0
        surface += areas[i]
    return status, count, volume, surface


@inner_kernel
def _add_triangle(
    normals: FloatArray,
    offsets: FloatArray,
    vertices: FloatArray,
    edges: IntArray,
    e: int,
    way: int,
    areas: FloatArray,
    centroids: FloatArray,
) -> None:
    """Add the triangle of an edge and the plane's foot point to the facet on one side of it."""
    i = edges[e, 2 + way]
    normal = row(normals, i)
    foot = mixed(normal, offsets[i], normal, 0.0)
    one = mixed(row(vertices, edges[e, way]), 1.0, foot, -1.0)
    two = mixed(row(vertices, edges[e, 1 - way]), 1.0, foot, -1.0)
    # Signed, as the foot point may lie outside of the facet.
    area = 0.5 * dot(normal, cross(one, two))
    areas[i] += area
    for c in range(3):
        centroids[i, c] += area * (one[c] + two[c]) / 3.0


@inner_kernel
def add_volume_charges(areas: FloatArray, size: float, charges: FloatArray) -> None:
    """Add `size` times the derivative of the volume, with the facets' centroids as pivots; charges (n, 4)."""
    for i in range(len(areas)):
        charges[i, 0] += size * areas[i]


@inner_kernel
def add_surface_charges(
    normals: FloatArray,
    vertices: FloatArray,
    edges: IntArray,
    pivots: FloatArray,
    size: float,
    charges: FloatArray,
) -> None:
    """Add `size` times the derivative of the surface area, shape (n, 4).

    Where plane a moves outward at speed w_a(x), the area grows at the rate
    sum over edges of l tan(theta / 2) (w_a + w_b)(midpoint), theta the angle between the normals.
    """
    for e in range(len(edges)):
        p, q = row(vertices, edges[e, 0]), row(vertices, edges[e, 1])
        n, m = row(normals, edges[e, 2]), row(normals, edges[e, 3])
        edge = length(mixed(p, 1.0, q, -1.0))
        # |n x m| / (1 + <n, m>) = tan(theta / 2).
        weight = size * edge * length(cross(n, m)) / max(1.0 + dot(n, m), 1e-12)
        for side in range(2):
            add_force(charges, edges[e, 2 + side], weight, mixed(p, 0.5, q, 0.5), pivots)


@inner_kernel
def add_vertex_charges(
    normals: FloatArray,
    triples: IntArray,
    vertices: FloatArray,
    v: int,
    force: Vector,
    pivots: FloatArray,
    charges: FloatArray,
) -> None:
    """Add the derivative of <force, x> at vertex v, shape (n, 4).

    The vertex moves by dx with <n_i, dx> = w_i(x) for its three planes.
    """
    i, j, k = triples[v, 0], triples[v, 1], triples[v, 2]
    a, b, c = row(normals, i), row(normals, j), row(normals, k)
    bc, ca, ab = cross(b, c), cross(c, a), cross(a, b)
    det = dot(a, bc)
    if abs(det) < 1e-12:
        return
    at = row(vertices, v)
    add_force(charges, i, dot(force, bc) / det, at, pivots)
    add_force(charges, j, dot(force, ca) / det, at, pivots)
    add_force(charges, k, dot(force, ab) / det, at, pivots)


@inner_kernel
def add_force(charges: FloatArray, i: int, weight: float, at: Vector, pivots: FloatArray) -> None:
    """Add a rate `weight` per unit of speed of plane i at a point."""
    charges[i, 0] += weight
    for c in range(3):
        charges[i, 1 + c] += weight * (at[c] - pivots[i, c])


def polyhedron_of(half_spaces: HalfSpaces) -> ConvexPolyhedron:
    """The polyhedron of half-spaces, quick enough for every step of a method.

    Where they are in no general position, it is that of :meth:`ConvexPolyhedron.from_half_spaces`.
    """
    size = float(half_spaces.offsets.max())
    # Areas are compared with absolute tolerances.
    # Copies: numba would compile kernels a second time for arrays that cannot be written.
    found = measure_polyhedron(np.array(half_spaces.normals), half_spaces.offsets / size)
    if found.status != FINE:
        return ConvexPolyhedron.from_half_spaces(half_spaces)
    n = len(half_spaces)
    following: list[dict[int, int]] = [{} for _ in range(n)]
    for start, end, left, right in found.edges.tolist():
        following[left][start] = end
        following[right][end] = start
    kept = [plane for plane in range(n) if following[plane]]
    facets = tuple(_loop(following[plane]) for plane in kept)
    solid = HalfSpaces(half_spaces.normals[kept], half_spaces.offsets[kept])
    return ConvexPolyhedron(solid, np.asarray(found.vertices * size), facets)


def _loop(following: dict[int, int]) -> tuple[int, ...]:
    """Vertices of a facet in order, from the map of each to the next."""
    first = at = next(iter(following))
    loop = [first]
    while (at := following[at]) != first:
        loop.append(at)
    return tuple(loop)


MIN_TILT_SCALE = 0.08
"""Smallest scale of a tilt, in units of the particle's size (the cube root of its volume)."""


def tangents_of(normals: FloatArray) -> FloatArray:
    """Two tangents of each plane, shape (n, 2, 3)."""
    rows, least = np.arange(len(normals)), np.abs(normals).argmin(axis=1)
    one, two = (least + 1) % 3, (least + 2) % 3
    tangents = np.zeros((len(normals), 2, 3))
    first = tangents[:, 0]
    first[rows, one], first[rows, two] = normals[rows, two], -normals[rows, one]
    first /= np.sqrt((first * first).sum(axis=1))[:, None]
    # np.cross takes ten times as long for so few
    turned, again = [1, 2, 0], [2, 0, 1]
    tangents[:, 1] = normals[:, turned] * first[:, again] - normals[:, again] * first[:, turned]
    return tangents


@inner_kernel
def fill_tilt_scales(areas: FloatArray, scales: FloatArray) -> None:
    """Fill rho of each plane: the radius of its facet, but not below :data:`MIN_TILT_SCALE`; shape (n,)."""
    for i in range(len(areas)):
        scales[i] = max(np.sqrt(max(areas[i], 0.0) / np.pi), MIN_TILT_SCALE)


@inner_kernel
def fill_moved(
    normals: FloatArray,
    pivots: FloatArray,
    offsets: FloatArray,
    tangents: FloatArray,
    scales: FloatArray,
    step: FloatArray,
    turned: FloatArray,
    shifted: FloatArray,
    carried: FloatArray,
) -> None:
    """Fill normals, offsets and tangents after a step (3 n,); tangents are carried over without twist."""
    for i in range(len(normals)):
        old, first = row(normals, i), row(tangents[i], 0)
        t1, t2 = step[3 * i + 1] / scales[i], step[3 * i + 2] / scales[i]
        shrink = 1.0 / np.sqrt(1.0 + t1 * t1 + t2 * t2)
        tilt = mixed(first, t1 * shrink, row(tangents[i], 1), t2 * shrink)
        normal = mixed(old, shrink, tilt, 1.0)
        # <n', pivot> + s; the pivot lies in the plane, so that <n, pivot> = h.
        shifted[i] = step[3 * i] + offsets[i] * shrink + along(pivots, i, tilt)
        first = mixed(first, 1.0, normal, -dot(first, normal))
        first = mixed(first, 1.0 / length(first), first, 0.0)
        second = cross(normal, first)
        for c in range(3):
            turned[i, c], carried[i, 0, c], carried[i, 1, c] = normal[c], first[c], second[c]


@inner_kernel
def fill_gradient(
    charges: FloatArray, tangents: FloatArray, scales: FloatArray, gradient: FloatArray
) -> None:
    """Fill the derivative with the coordinates of every plane, shape (3 n,), from charges (n, 4)."""
    for i in range(len(charges)):
        moment: Vector = (charges[i, 1], charges[i, 2], charges[i, 3])
        gradient[3 * i] = charges[i, 0]
        gradient[3 * i + 1] = -along(tangents[i], 0, moment) / scales[i]
        gradient[3 * i + 2] = -along(tangents[i], 1, moment) / scales[i]
