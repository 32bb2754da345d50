"""Volume, area and facets of a polyhedron, and how they follow the planes."""

import numpy as np

from regolith_studio.coarsening.core.intersection import FINE, edges_of, intersect
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel, kernel_noalloc
from regolith_studio.geometry.vectors import cross, dot, row


@kernel
def facets_of(
    normals: FloatArray, offsets: FloatArray, vertices: FloatArray, edges: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Area (n,) and centroid (n, 3) of each facet; a plane without a facet has area 0 and its foot point."""
    n = len(offsets)
    area = np.zeros(n)
    centroid = np.zeros((n, 3))
    for e in range(len(edges)):
        for way in range(2):
            p, q = vertices[edges[e, way]], vertices[edges[e, 1 - way]]
            a = edges[e, 2 + way]
            f0, f1, f2 = normals[a, 0] * offsets[a], normals[a, 1] * offsets[a], normals[a, 2] * offsets[a]
            x0, x1, x2 = p[0] - f0, p[1] - f1, p[2] - f2
            y0, y1, y2 = q[0] - f0, q[1] - f1, q[2] - f2
            piece = 0.5 * (
                normals[a, 0] * (x1 * y2 - x2 * y1)
                + normals[a, 1] * (x2 * y0 - x0 * y2)
                + normals[a, 2] * (x0 * y1 - x1 * y0)
            )
            area[a] += piece
            centroid[a, 0] += piece * (x0 + y0) / 3.0
            centroid[a, 1] += piece * (x1 + y1) / 3.0
            centroid[a, 2] += piece * (x2 + y2) / 3.0
    for a in range(n):
        for c in range(3):
            inner = centroid[a, c] / area[a] if area[a] > 1e-14 else 0.0
            centroid[a, c] = normals[a, c] * offsets[a] + inner
    return area, centroid


@kernel
def fill_polyhedron(
    normals: FloatArray,
    offsets: FloatArray,
    vertices: FloatArray,
    edges: IntArray,
    area: FloatArray,
) -> tuple[int, int]:
    """Status of the intersection of n half-spaces, and number of vertices.

    Fills vertices (2 n, 3), edges (3 n, 4), of which there are 1.5 times as many, and areas of facets (n,).
    """
    status, corners, triples = intersect(normals, offsets)
    if status == FINE:
        vertices[: len(corners)] = corners
        sides = edges_of(triples, len(offsets))
        edges[: len(sides)] = sides
        area[:] = facets_of(normals, offsets, corners, sides)[0]
    return status, len(corners)


@kernel
def volume_of(offsets: FloatArray, area: FloatArray) -> float:
    """Sum of the pyramids over the facets."""
    return np.sum(offsets * area) / 3.0


@kernel
def area_charge(normals: FloatArray, vertices: FloatArray, edges: IntArray, pivots: FloatArray) -> FloatArray:
    """Derivative of the surface area as charges, shape (n, 4): weight, first moment about the pivot.

    Where plane a moves outward at speed w_a(x), the area grows at the rate
    sum over edges of l tan(theta / 2) (w_a + w_b)(midpoint), theta the angle between the normals.
    """
    charge = np.zeros((len(normals), 4))
    for e in range(len(edges)):
        p, q = vertices[edges[e, 0]], vertices[edges[e, 1]]
        a, b = edges[e, 2], edges[e, 3]
        n, m = normals[a], normals[b]
        length = np.sqrt((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2 + (p[2] - q[2]) ** 2)
        cosine = n[0] * m[0] + n[1] * m[1] + n[2] * m[2]
        sine = np.sqrt(
            (n[1] * m[2] - n[2] * m[1]) ** 2
            + (n[2] * m[0] - n[0] * m[2]) ** 2
            + (n[0] * m[1] - n[1] * m[0]) ** 2
        )
        weight = length * sine / max(1.0 + cosine, 1e-12)
        for side in range(2):
            i = a if side == 0 else b
            charge[i, 0] += weight
            for c in range(3):
                charge[i, 1 + c] += weight * (0.5 * (p[c] + q[c]) - pivots[i, c])
    return charge


@kernel
def volume_charge(area: FloatArray, centroid: FloatArray, pivots: FloatArray) -> FloatArray:
    """Derivative of the volume as charges, shape (n, 4)."""
    charge = np.empty((len(area), 4))
    for i in range(len(area)):
        charge[i, 0] = area[i]
        for c in range(3):
            charge[i, 1 + c] = area[i] * (centroid[i, c] - pivots[i, c])
    return charge


@kernel_noalloc
def vertex_charge(
    normals: FloatArray,
    triple: IntArray,
    position: FloatArray,
    force: FloatArray,
    pivots: FloatArray,
    charge: FloatArray,
) -> None:
    """Add the derivative of <force, x> at the vertex of three planes to `charge`, shape (n, 4).

    The vertex moves by dx with <n_i, dx> = w_i(x) for its three planes.
    """
    a, b, c = row(normals, triple[0]), row(normals, triple[1]), row(normals, triple[2])
    sides = (cross(b, c), cross(c, a), cross(a, b))
    det = dot(a, sides[0])
    if abs(det) < 1e-12:
        return
    pull = (force[0], force[1], force[2])
    for k in range(3):
        weight = dot(pull, sides[k]) / det
        i = triple[k]
        charge[i, 0] += weight
        for d in range(3):
            charge[i, 1 + d] += weight * (position[d] - pivots[i, d])
