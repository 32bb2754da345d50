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
from regolith_studio.geometry.compiled import kernel


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
    """Memory that one search reuses: side (n,), rim (e, 2), flat (v, 2), work (6, 3)."""

    side: FloatArray
    rim: IntArray
    flat: FloatArray
    work: FloatArray


@kernel
def scratch_for(solid: Solid) -> Scratch:
    """Memory for a search of boxes around `solid`."""
    return Scratch(
        np.empty(len(solid.normals)),
        np.empty((len(solid.edges), 2), np.int64),
        np.empty((len(solid.vertices), 2)),
        np.empty((6, 3)),
    )


@kernel
def empty_touch() -> Touch:
    """A box to be filled."""
    return Touch(np.empty((3, 3)), np.empty(3), np.empty(7, np.int64))


@kernel
def box_at(axis: FloatArray, solid: Solid, limit: float, scratch: Scratch, touch: Touch) -> float:
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
    vertices, edges, side, rim, flat = solid.vertices, solid.edges, scratch.side, scratch.rim, scratch.flat
    count = 0
    for e in range(len(edges)):
        up = side[edges[e, 2]] > 0.0
        if up == (side[edges[e, 3]] > 0.0):
            continue
        p, q = (edges[e, 0], edges[e, 1]) if up else (edges[e, 1], edges[e, 0])
        rim[count, 0], rim[count, 1] = p, q
        flat[p, 0] = vertices[p, 0] * u0 + vertices[p, 1] * u1 + vertices[p, 2] * u2
        flat[p, 1] = vertices[p, 0] * v0 + vertices[p, 1] * v1 + vertices[p, 2] * v2
        count += 1
    touch.extents[0], touch.piece[0], touch.piece[1] = height, top, bottom
    least, dx, dy = least_rectangle(count, rim, flat, touch)
    for c in range(3):
        u = u0 if c == 0 else (u1 if c == 1 else u2)
        v = v0 if c == 0 else (v1 if c == 1 else v2)
        touch.frame[0, c] = axis[c]
        touch.frame[1, c] = dy * u - dx * v
        touch.frame[2, c] = dx * u + dy * v
    return float(least * height)


@kernel
def height_and_shadow(axis: FloatArray, solid: Solid, side: FloatArray) -> tuple[float, float, int, int]:
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


@kernel
def least_rectangle(count: int, rim: IntArray, flat: FloatArray, touch: Touch) -> tuple[float, float, float]:
    """Area and direction of the least rectangle around the silhouette, flush with one of its edges.

    `rim` holds the silhouette's edges counter-clockwise, `flat` the plane coordinates of its vertices. Fills
    extents 1 and 2 and slots 2 to 6 of the piece.
    """
    least, at_dx, at_dy = np.inf, 1.0, 0.0
    for k in range(count):
        p, q = rim[k, 0], rim[k, 1]
        dx, dy = flat[q, 0] - flat[p, 0], flat[q, 1] - flat[p, 1]
        length = np.sqrt(dx * dx + dy * dy)
        if length < 1e-9:
            continue
        dx, dy = dx / length, dy / length
        flush = flat[p, 0] * dy - flat[p, 1] * dx
        across, right, left = np.inf, -np.inf, np.inf
        at_across, at_right, at_left = 0, 0, 0
        for j in range(count):
            i = rim[j, 0]
            s, t = flat[i, 0] * dx + flat[i, 1] * dy, flat[i, 0] * dy - flat[i, 1] * dx
            if t < across:
                across, at_across = t, i
            if s > right:
                right, at_right = s, i
            if s < left:
                left, at_left = s, i
        if (flush - across) * (right - left) < least:
            least, at_dx, at_dy = (flush - across) * (right - left), dx, dy
            touch.extents[1], touch.extents[2] = flush - across, right - left
            touch.piece[2], touch.piece[3] = p, q
            touch.piece[4], touch.piece[5], touch.piece[6] = at_across, at_right, at_left
    return least, at_dx, at_dy


@kernel
def turned_frame(axis: FloatArray, edge: FloatArray, frame: FloatArray) -> float:
    """Fill the frame of the box with a side normal to `axis` and one flush with `edge`; its lever."""
    w0, w1, w2 = (
        edge[1] * axis[2] - edge[2] * axis[1],
        edge[2] * axis[0] - edge[0] * axis[2],
        edge[0] * axis[1] - edge[1] * axis[0],
    )
    length = np.sqrt(w0 * w0 + w1 * w1 + w2 * w2)
    frame[0, 0], frame[0, 1], frame[0, 2] = axis[0], axis[1], axis[2]
    frame[1, 0], frame[1, 1], frame[1, 2] = w0 / length, w1 / length, w2 / length
    frame[2, 0] = axis[1] * frame[1, 2] - axis[2] * frame[1, 1]
    frame[2, 1] = axis[2] * frame[1, 0] - axis[0] * frame[1, 2]
    frame[2, 2] = axis[0] * frame[1, 1] - axis[1] * frame[1, 0]
    return float(length)


@kernel
def log_slope(
    turn: FloatArray,
    edge: FloatArray,
    lever: float,
    frame: FloatArray,
    spans: FloatArray,
    extents: FloatArray,
) -> float:
    """Derivative of log(volume) with the angle along the arc.

    Parameters
    ----------
    turn
        Derivative of the axis, shape (3,).
    edge, lever
        The flush edge, and the length of its cross product with the axis.
    frame, spans, extents
        Axes of the box; for each axis the vector between the two vertices that the box touches (3, 3); the
        extents along the axes.
    """
    b0, b1, b2 = frame[1, 0], frame[1, 1], frame[1, 2]
    w0 = (edge[1] * turn[2] - edge[2] * turn[1]) / lever
    w1 = (edge[2] * turn[0] - edge[0] * turn[2]) / lever
    w2 = (edge[0] * turn[1] - edge[1] * turn[0]) / lever
    along = b0 * w0 + b1 * w1 + b2 * w2
    w0, w1, w2 = w0 - along * b0, w1 - along * b1, w2 - along * b2
    a0, a1, a2 = frame[0, 0], frame[0, 1], frame[0, 2]
    c0 = turn[1] * b2 - turn[2] * b1 + a1 * w2 - a2 * w1
    c1 = turn[2] * b0 - turn[0] * b2 + a2 * w0 - a0 * w2
    c2 = turn[0] * b1 - turn[1] * b0 + a0 * w1 - a1 * w0
    return float(
        (turn[0] * spans[0, 0] + turn[1] * spans[0, 1] + turn[2] * spans[0, 2]) / extents[0]
        + (w0 * spans[1, 0] + w1 * spans[1, 1] + w2 * spans[1, 2]) / extents[1]
        + (c0 * spans[2, 0] + c1 * spans[2, 1] + c2 * spans[2, 2]) / extents[2]
    )


@kernel
def slope_at(turn: FloatArray, solid: Solid, touch: Touch, work: FloatArray) -> float:
    """Derivative of log(volume) along the arc for the box of :func:`box_at`; `work` (6, 3) is scratch."""
    vertices, piece = solid.vertices, touch.piece
    for c in range(3):
        work[0, c] = vertices[piece[0], c] - vertices[piece[1], c]
        work[1, c] = vertices[piece[2], c] - vertices[piece[4], c]
        work[2, c] = vertices[piece[5], c] - vertices[piece[6], c]
        work[3, c] = vertices[piece[3], c] - vertices[piece[2], c]
    edge, axis = work[3], touch.frame[0]
    lever = np.sqrt(
        (edge[1] * axis[2] - edge[2] * axis[1]) ** 2
        + (edge[2] * axis[0] - edge[0] * axis[2]) ** 2
        + (edge[0] * axis[1] - edge[1] * axis[0]) ** 2
    )
    return log_slope(turn, edge, lever, touch.frame, work[:3], touch.extents)
