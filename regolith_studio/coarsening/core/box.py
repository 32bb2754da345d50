"""The least box around a convex solid for a given axis, and how it changes as the axis turns.

For a given axis the box is the height times the least rectangle around the shadow, which is flush with an
edge of the silhouette.

A *piece* names the vertices and the edge that a box touches:
``(top, bottom, flush from, flush to, across, right, left)``; top and bottom along the normal, the flush
edge on the second side and the vertex across from it, right and left along the flush edge.
"""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import inline_kernel, kernel_noalloc
from regolith_studio.geometry.vectors import Vector, cross, dot, length, mixed, row


class Solid(NamedTuple):
    """A convex solid.

    Parameters
    ----------
    vertices
        Shape (v, 3).
    normals, areas
        Of its facets, shapes (n, 3) and (n,); area 0 where a plane bounds no facet.
    edges
        Rows (from, to, facet a, facet b), counter-clockwise around a, shape (e, 4).
    """

    vertices: FloatArray
    normals: FloatArray
    areas: FloatArray
    edges: IntArray


class Touch(NamedTuple):
    """One box and where it touches the solid; filled in place.

    Parameters
    ----------
    frame
        The axis, the outward normal of the flush side and the direction of the flush edge, shape (3, 3).
    extents
        Edge lengths along them, shape (3,).
    piece
        See above, shape (7,).
    """

    frame: FloatArray
    extents: FloatArray
    piece: IntArray


class Scratch(NamedTuple):
    """Memory that one search reuses: side (n,), next vertex (v,), rim (v,) and flat (v, 2) in its order."""

    side: FloatArray
    after: IntArray
    rim: IntArray
    flat: FloatArray


def scratch_for(solid: Solid) -> Scratch:
    """Memory for a search of boxes around `solid`."""
    return Scratch(
        np.empty(len(solid.normals)),
        np.empty(len(solid.vertices), np.int64),
        np.empty(len(solid.vertices), np.int64),
        np.empty((len(solid.vertices), 2)),
    )


def empty_touch() -> Touch:
    """A box to be filled."""
    return Touch(np.empty((3, 3)), np.empty(3), np.empty(7, np.int64))


@kernel_noalloc
def box_at(axis: Vector, solid: Solid, limit: float, scratch: Scratch, touch: Touch) -> float:
    """Volume of the least box with a side normal to `axis`, or infinity if it must exceed `limit`."""
    height, shadow, top, bottom = height_and_shadow(axis, solid, scratch.side)
    if shadow * height > limit:
        return np.inf
    length = np.sqrt(axis[1] * axis[1] + axis[2] * axis[2])
    if length > 0.5:
        u0, u1, u2 = 0.0, -axis[2] / length, axis[1] / length
    else:
        length = np.sqrt(axis[0] * axis[0] + axis[2] * axis[2])
        u0, u1, u2 = axis[2] / length, 0.0, -axis[0] / length
    v0, v1, v2 = axis[1] * u2 - axis[2] * u1, axis[2] * u0 - axis[0] * u2, axis[0] * u1 - axis[1] * u0
    vertices, edges, side, flat = solid.vertices, solid.edges, scratch.side, scratch.flat
    count, first = 0, 0
    for e in range(len(edges)):
        up = side[edges[e, 2]] > 0.0
        if up == (side[edges[e, 3]] > 0.0):
            continue
        first, last = (edges[e, 0], edges[e, 1]) if up else (edges[e, 1], edges[e, 0])
        scratch.after[first] = last
        count += 1
    at = first
    for k in range(count):
        scratch.rim[k] = at
        flat[k, 0] = vertices[at, 0] * u0 + vertices[at, 1] * u1 + vertices[at, 2] * u2
        flat[k, 1] = vertices[at, 0] * v0 + vertices[at, 1] * v1 + vertices[at, 2] * v2
        at = scratch.after[at]
    touch.extents[0], touch.piece[0], touch.piece[1] = height, top, bottom
    least, dx, dy = least_rectangle(count, scratch.rim, flat, touch)
    for c in range(3):
        u = u0 if c == 0 else (u1 if c == 1 else u2)
        v = v0 if c == 0 else (v1 if c == 1 else v2)
        touch.frame[0, c] = axis[c]
        touch.frame[1, c] = dy * u - dx * v
        touch.frame[2, c] = dx * u + dy * v
    return float(least * height)


@kernel_noalloc
def height_and_shadow(axis: Vector, solid: Solid, side: FloatArray) -> tuple[float, float, int, int]:
    """Extent along `axis`, area of the shadow, top and bottom vertex; `side` takes <axis, n_f>."""
    a0, a1, a2 = axis[0], axis[1], axis[2]
    shadow = 0.0
    for f in range(len(solid.normals)):
        side[f] = solid.normals[f, 0] * a0 + solid.normals[f, 1] * a1 + solid.normals[f, 2] * a2
        shadow += abs(side[f]) * solid.areas[f]
    low, high, bottom, top = np.inf, -np.inf, 0, 0
    for i in range(len(solid.vertices)):
        z = solid.vertices[i, 0] * a0 + solid.vertices[i, 1] * a1 + solid.vertices[i, 2] * a2
        if z < low:
            low, bottom = z, i
        if z > high:
            high, top = z, i
    return high - low, 0.5 * shadow, top, bottom


@kernel_noalloc
def least_rectangle(count: int, rim: IntArray, flat: FloatArray, touch: Touch) -> tuple[float, float, float]:
    """Area and direction of the least rectangle around the silhouette, flush with one of its edges.

    Calipers turn with the edges. Fills extents 1 and 2 and slots 2 to 6 of the piece.

    Parameters
    ----------
    count, rim, flat
        Vertices of the silhouette, counter-clockwise, and their coordinates in the plane, shape (count, 2).
    """
    least, at_dx, at_dy = np.inf, 1.0, 0.0
    right = across = left = -1
    for k in range(count):
        end = k + 1 if k + 1 < count else 0
        dx, dy = flat[end, 0] - flat[k, 0], flat[end, 1] - flat[k, 1]
        squared = dx * dx + dy * dy
        if squared < 1e-18:
            continue
        shrink = 1.0 / np.sqrt(squared)
        dx, dy = dx * shrink, dy * shrink
        right = farthest(flat, count, end if right < 0 else right, dx, dy)
        across = farthest(flat, count, right if across < 0 else across, -dy, dx)
        left = farthest(flat, count, across if left < 0 else left, -dx, -dy)
        deep = (flat[k, 0] - flat[across, 0]) * dy - (flat[k, 1] - flat[across, 1]) * dx
        wide = (flat[right, 0] - flat[left, 0]) * dx + (flat[right, 1] - flat[left, 1]) * dy
        if deep * wide < least:
            least, at_dx, at_dy = deep * wide, dx, dy
            touch.extents[1], touch.extents[2] = deep, wide
            touch.piece[2], touch.piece[3] = rim[k], rim[end]
            touch.piece[4], touch.piece[5], touch.piece[6] = rim[across], rim[right], rim[left]
    return least, at_dx, at_dy


@kernel_noalloc
def farthest(flat: FloatArray, count: int, start: int, dx: float, dy: float) -> int:
    """Corner of a convex polygon that is farthest along (dx, dy), going counter-clockwise from `start`."""
    at, here = start, flat[start, 0] * dx + flat[start, 1] * dy
    for _ in range(count):
        further = at + 1 if at + 1 < count else 0
        there = flat[further, 0] * dx + flat[further, 1] * dy
        if there < here:
            break
        at, here = further, there
    return at


@kernel_noalloc
def turned_frame(axis: Vector, edge: Vector) -> tuple[float, Vector, Vector]:
    """Axes of the box with a side normal to `axis` and one flush with `edge`, after the lever.

    The lever is the length of the edge's cross product with the axis; then the outward normal of the flush
    side, and the direction along the edge.
    """
    across = cross(edge, axis)
    lever = length(across)
    second = mixed(across, 1.0 / lever, across, 0.0)
    return lever, second, cross(axis, second)


@kernel_noalloc
def log_slope(
    turn: Vector,
    edge: Vector,
    lever: float,
    axis: Vector,
    second: Vector,
    spans: tuple[Vector, Vector, Vector],
    extents: Vector,
) -> float:
    """Derivative of log(volume) with the angle along the arc.

    Parameters
    ----------
    turn
        Derivative of the axis.
    edge, lever
        The flush edge, and the length of its cross product with the axis.
    axis, second
        The first two axes of the box.
    spans, extents
        For each axis the vector between the two vertices that the box touches, and the extent along it.
    """
    change = cross(edge, turn)
    change = mixed(change, 1.0 / lever, second, -dot(change, second) / lever)
    third = mixed(cross(turn, second), 1.0, cross(axis, change), 1.0)
    return (
        dot(turn, spans[0]) / extents[0]
        + dot(change, spans[1]) / extents[1]
        + dot(third, spans[2]) / extents[2]
    )


@kernel_noalloc
def slope_at(turn: Vector, solid: Solid, touch: Touch) -> float:
    """Derivative of log(volume) along the arc for the box of :func:`box_at`."""
    vertices, piece = solid.vertices, touch.piece
    spans = (
        from_to(vertices, piece[1], piece[0]),
        from_to(vertices, piece[4], piece[2]),
        from_to(vertices, piece[6], piece[5]),
    )
    edge, axis = from_to(vertices, piece[2], piece[3]), row(touch.frame, 0)
    extents = (touch.extents[0], touch.extents[1], touch.extents[2])
    return log_slope(turn, edge, length(cross(edge, axis)), axis, row(touch.frame, 1), spans, extents)


@inline_kernel
def from_to(vertices: FloatArray, one: int, two: int) -> Vector:
    """Vector from vertex `one` to vertex `two`, rows of shape (v, 3)."""
    return mixed(row(vertices, two), 1.0, row(vertices, one), -1.0)
