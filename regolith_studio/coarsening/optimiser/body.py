"""A polyhedron with all that a step of the optimiser needs: measures, boxes, residuals and derivatives.

It is convex, or a union of convex parts. Where it has no parts, numba leaves out what is about them: a
compiled function with ``None`` for its parts is another one than with parts.

Terms stand in the order V, S, D_min, D_max, AR, CH. A residual is a relative error, value / wanted - 1; the
derivatives of all are with the coordinates (shift and two tilts) of every plane. D_min, D_max and AR have a
kink where two edges of the box are equal; four further rows say what the middle edge must not pass there.
D_min and D_max have another where two vertices are equally far out at one end; four rows more say how far out
the second of them may be.
Nothing here calls BLAS or LAPACK, so that every processor finds the same.
"""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.box_contacts import (
    MAX_TURN,
    ROW,
    fill_points,
    pose_of,
    touched,
    walk_to_minimum,
)
from regolith_studio.coarsening.core.box_following import (
    ALIKE,
    extent_forces,
    likeness_of,
    update_vertex_ids,
)
from regolith_studio.coarsening.core.intersection import FINE, IntersectionWorkspace, workspace_for
from regolith_studio.coarsening.core.parts import (
    Parts,
    add_hull_charges,
    add_union_surface_charges,
    fill_hull,
    fill_union,
)
from regolith_studio.coarsening.core.polyhedron_measures import (
    add_surface_charges,
    add_vertex_charges,
    fill_gradient,
    fill_measures,
    fill_tilt_scales,
)
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import inner_kernel
from regolith_studio.geometry.vectors import along, row

VOLUME, SPHERICITY, SHORTEST, LONGEST, RATIO, HULL = 0, 1, 2, 3, 4, 5
N_TERMS, N_FIXED = 6, 14
MIDDLE_LONGEST, MIDDLE_SHORTEST, MIDDLE_SHORT, LONG_MIDDLE = 6, 7, 8, 9
"""Rows of the middle edge: it is at most D_max, at least D_min, and neither makes AR larger."""
FIRST_TIE = 10
"""Rows of D_min and then D_max, each with another vertex at the upper, then at the lower end of the edge."""
FAR_BELOW = -1.0
"""Residual of a row of a vertex that is not there."""
NEARLY_TIED = 0.03
"""Vertices farther from a side than this, at unit volume, do not count as the next one at its end."""
MAX_BOXES = 8
"""Boxes followed at a time: the one that is measured, and rivals that came below it on the way."""
GONE = 1.0
"""Slack of a rival that is no local minimum any more."""
SAME_VOLUME, SAME_FRAME = 1e-6, 1.0 - 1e-9
"""Boxes that differ by less, as shares and by the cosine of the angle between their axes, are one."""
N_VERTICES, N_BOXES = 0, 1
BODY_VOLUME, SURFACE, JACCARD = 0, 1, 2


class Prices(NamedTuple):
    """What the loss pays for V, S, D_min, D_max, AR, CH.

    Wanted values, and the derivatives of the loss below and above a residual of 0, low <= 0 <= high, all
    (6,); both are 0 for CH of a convex polyhedron, which is V. The Jaccard distance has a price above 0.
    """

    wanted: FloatArray
    low: FloatArray
    high: FloatArray
    overlap: float


class Body(NamedTuple):
    """Memory of one polyhedron with n half-spaces.

    Planes, and vertices to centroids, as in :mod:`regolith_studio.coarsening.core.polyhedron_measures`, the
    vertices, triples and edges with room to spare. Counts: vertices, boxes; numbers: volume, surface area,
    Jaccard distance. Frames (b, 3, 3), contacts (b, 13), planes (b, 9, 3) and extents (b, 3) of the boxes,
    the measured one first. Residuals (14,) and rows (14, 3 n) of the terms, the middle edge and vertices that
    nearly tie. Slack is volume / volume of the measured box - 1 of the boxes, with its derivatives (b, 3 n).
    The vertices of a union are those of all parts, and its areas are exposed ones; a convex polyhedron has no
    parts.
    """

    normals: FloatArray
    offsets: FloatArray
    tangents: FloatArray
    scales: FloatArray
    vertices: FloatArray
    triples: IntArray
    edges: IntArray
    areas: FloatArray
    centroids: FloatArray
    counts: IntArray
    numbers: FloatArray
    frames: FloatArray
    contacts: IntArray
    planes: IntArray
    extents: FloatArray
    residuals: FloatArray
    rows: FloatArray
    slack: FloatArray
    rival_rows: FloatArray
    parts: Parts | None


class BodyScratch(NamedTuple):
    """Memory that the measurement of any body uses.

    Nine vertices of a box (9, 3), forces on them (3, 9, 3), charges of the planes (n, 4), derivatives of the
    logarithms of a box's edges (3, 3 n), the vertex that owns two planes (n, n), two frames (3, 3) and a row
    of contacts (13,).
    """

    intersection: IntersectionWorkspace
    points: FloatArray
    forces: FloatArray
    charges: FloatArray
    gradients: FloatArray
    owner: IntArray
    start: FloatArray
    ties: FloatArray
    contact: IntArray


def empty_body(n: int, parts: Parts | None = None) -> Body:
    """Room for n half-spaces."""
    return Body(
        np.empty((n, 3)),
        np.empty(n),
        np.empty((n, 2, 3)),
        np.empty(n),
        np.empty((2 * n, 3)),
        np.empty((2 * n, 3), np.int64),
        np.empty((3 * n, 4), np.int64),
        np.empty(n),
        np.empty((n, 3)),
        np.zeros(2, np.int64),
        np.zeros(3),
        np.empty((MAX_BOXES, 3, 3)),
        np.empty((MAX_BOXES, ROW), np.int64),
        np.empty((MAX_BOXES, 9, 3), np.int64),
        np.empty((MAX_BOXES, 3)),
        np.zeros(N_FIXED),
        np.zeros((N_FIXED, 3 * n)),
        np.zeros(MAX_BOXES),
        np.zeros((MAX_BOXES, 3 * n)),
        parts,
    )


def body_scratch(n: int) -> BodyScratch:
    """Memory for n half-spaces."""
    return BodyScratch(
        workspace_for(n),
        np.empty((9, 3)),
        np.empty((3, 9, 3)),
        np.empty((n, 4)),
        np.empty((3, 3 * n)),
        np.empty((n, n), np.int64),
        np.empty((3, 3)),
        np.empty((3, 3)),
        np.empty(ROW, np.int64),
    )


@inner_kernel
def fill_body(body: Body, wanted: FloatArray, needs_box: bool, scratch: BodyScratch) -> bool:
    """Measure the half-spaces of a body against wanted values (6,); False where they bound no polyhedron.

    Its boxes are followed where a term needs them.
    """
    if not _fill_shape(body, body.parts, scratch):
        return False
    fill_tilt_scales(body.areas, body.scales)
    _fill_volume_and_sphericity(body, wanted, scratch)
    if not _fill_hull_term(body, body.parts, wanted, scratch):
        return False
    if needs_box and body.counts[N_BOXES] > 0:
        _follow_boxes(body, scratch)
        fill_box_terms(body, wanted, scratch)
    return True


@inner_kernel
def _fill_shape(body: Body, parts: Parts | None, scratch: BodyScratch) -> bool:
    """Vertices, facets, volume and surface area; False where there is no polyhedron."""
    normals, offsets, work = body.normals, body.offsets, scratch.intersection
    vertices, triples, edges, areas, centroids = (
        body.vertices,
        body.triples,
        body.edges,
        body.areas,
        body.centroids,
    )
    if parts is None:
        status, count, volume, surface = fill_measures(
            normals, offsets, work, vertices, triples, edges, areas, centroids
        )
        sound = status == FINE
    else:
        sound, count, volume, surface = fill_union(
            normals, offsets, work, vertices, triples, edges, areas, centroids, parts
        )
    body.counts[N_VERTICES] = count
    body.numbers[BODY_VOLUME], body.numbers[SURFACE] = volume, surface
    return sound


@inner_kernel
def _add_surface(body: Body, parts: Parts | None, size: float, charges: FloatArray) -> None:
    """Add `size` times the derivative of the surface area, shape (n, 4)."""
    if parts is None:
        edges = body.edges[: 3 * body.counts[N_VERTICES] // 2]
        add_surface_charges(body.normals, body.vertices, edges, body.centroids, size, charges)
    else:
        add_union_surface_charges(body.normals, body.centroids, size, parts, charges)


@inner_kernel
def _fill_hull_term(body: Body, parts: Parts | None, wanted: FloatArray, scratch: BodyScratch) -> bool:
    """Residual and row of CH of a union; False where its hull is flat."""
    if parts is not None:
        vertices, charges = body.vertices[: body.counts[N_VERTICES]], scratch.charges
        volume = fill_hull(vertices, parts.counts, parts.hull)
        if not volume > 0.0:
            return False
        charges[:] = 0.0
        add_hull_charges(
            body.normals, body.triples, vertices, body.centroids, 1.0 / wanted[HULL], parts, charges
        )
        fill_gradient(charges, body.tangents, body.scales, body.rows[HULL])
        body.residuals[HULL] = volume / wanted[HULL] - 1.0
    return True


@inner_kernel
def cube_root_near_one(x: float) -> float:
    """Cube root by Newton's method, for 1e-3 < x < 1e3."""
    y = 1.0 if x < 8.0 else 4.0
    for _ in range(60):
        step = (y - x / (y * y)) / 3.0
        y -= step
        if abs(step) <= 1e-16 * y:
            break
    return y


@inner_kernel
def _fill_volume_and_sphericity(body: Body, wanted: FloatArray, scratch: BodyScratch) -> None:
    """Residuals and rows of V and S."""
    n, volume, surface = len(body.offsets), body.numbers[BODY_VOLUME], body.numbers[SURFACE]
    charges, rows = scratch.charges, body.rows
    charges[:] = 0.0
    _add_surface(body, body.parts, 1.0 / surface, charges)
    fill_gradient(charges, body.tangents, body.scales, rows[SPHERICITY])
    # S^3 = 36 pi V^2 / A^3, so that one cube root remains
    sphericity = cube_root_near_one(36.0 * np.pi * volume * volume / (surface * surface * surface))
    body.residuals[VOLUME] = volume / wanted[VOLUME] - 1.0
    body.residuals[SPHERICITY] = sphericity / wanted[SPHERICITY] - 1.0
    share = sphericity / wanted[SPHERICITY]
    for i in range(n):
        rows[VOLUME, 3 * i] = max(body.areas[i], 0.0) / wanted[VOLUME]
        rows[VOLUME, 3 * i + 1] = rows[VOLUME, 3 * i + 2] = 0.0
    for j in range(3 * n):
        growth = rows[VOLUME, j] * wanted[VOLUME] / volume
        rows[SPHERICITY, j] = share * (2.0 / 3.0 * growth - rows[SPHERICITY, j])


@inner_kernel
def _follow_boxes(body: Body, scratch: BodyScratch) -> None:
    """Bring every box to the local minimum near by; what is lost, or falls together, gets slack GONE."""
    vertices, owner, points = body.vertices[: body.counts[N_VERTICES]], scratch.owner, scratch.points
    triples = body.triples[: body.counts[N_VERTICES]]
    owner[:] = -1
    for v in range(len(triples)):
        for k in range(3):
            owner[triples[v, k], triples[v, (k + 1) % 3]] = v
    for b in range(body.counts[N_BOXES]):
        if body.slack[b] == GONE:
            continue
        contact, frame = body.contacts[b], body.frames[b]
        update_vertex_ids(vertices, contact, frame, body.planes[b], owner, triples)
        found = walk_to_minimum(vertices, contact, frame, points, scratch.start, MAX_TURN)
        for axis in range(3):
            found = found and along(frame, axis, row(scratch.start, axis)) >= ALIKE
        if not found:
            for axis in range(3):
                for c in range(3):
                    frame[axis, c] = scratch.start[axis, c]
            found = settle_box(body, b, scratch)
        set_box(body, b, scratch)
        body.slack[b] = 0.0 if found or b == 0 else GONE
        for other in range(b):
            if body.slack[other] != GONE and is_same_box(body, other, b):
                body.slack[b] = GONE


@inner_kernel
def settle_box(body: Body, b: int, scratch: BodyScratch) -> bool:
    """Bring box `b`, of which only the axes are known, to the local minimum near by.

    False where there is none: then it has no ties, and its extents change as if it could not turn.
    """
    vertices, contact, frame = body.vertices[: body.counts[N_VERTICES]], body.contacts[b], body.frames[b]
    touched(vertices, frame, contact, scratch.ties)
    if contact[0] < 2:
        contact[0] = 0
        return False
    kept = scratch.ties  # touched has no more use for it
    for axis in range(3):
        for c in range(3):
            kept[axis, c] = frame[axis, c]
    if walk_to_minimum(vertices, contact, frame, scratch.points, scratch.start, MAX_TURN):
        return True
    for axis in range(3):
        for c in range(3):
            frame[axis, c] = kept[axis, c]
    touched(vertices, frame, contact, scratch.start)
    contact[0] = 0
    return False


@inner_kernel
def set_box(body: Body, b: int, scratch: BodyScratch) -> None:
    """Extents of a box, and the planes of the vertices that it touches."""
    contact, points = body.contacts[b], scratch.points
    fill_points(body.vertices, contact, points)
    pose = pose_of(points, contact, body.frames[b])
    body.extents[b, 0], body.extents[b, 1], body.extents[b, 2] = pose.extents
    for i in range(6 + contact[0]):
        v = contact[1 + i] if i < 6 else contact[8 + 2 * (i - 6)]
        for k in range(3):
            body.planes[b, i, k] = body.triples[v, k]


@inner_kernel
def box_volume(body: Body, b: int) -> float:
    """Of box `b`."""
    return body.extents[b, 0] * body.extents[b, 1] * body.extents[b, 2]  # type: ignore[no-any-return]


@inner_kernel
def fill_box_terms(body: Body, wanted: FloatArray, scratch: BodyScratch) -> None:
    """Residuals and rows of the measured box; slack and rows of the others."""
    rows, rivals, changes = body.rows, body.rival_rows, scratch.gradients
    size = 3 * len(body.offsets)
    for b in range(body.counts[N_BOXES]):
        if b > 0:
            if body.slack[b] == GONE:
                rivals[b] = 0.0
                continue
            body.slack[b] = box_volume(body, b) / box_volume(body, 0) - 1.0
        fill_extent_gradients(body, b, scratch)
        low, high = 0, 0
        for k in range(1, 3):
            low = k if body.extents[b, k] < body.extents[b, low] else low
            high = k if body.extents[b, k] > body.extents[b, high] else high
        mid = 3 - low - high if low != high else 0
        short, middle, long = body.extents[b, low], body.extents[b, mid], body.extents[b, high]
        for j in range(size):
            total = changes[0, j] + changes[1, j] + changes[2, j]
            if b == 0:
                rivals[0, j] = total
                rows[SHORTEST, j] = changes[low, j] * short / wanted[SHORTEST]
                rows[LONGEST, j] = changes[high, j] * long / wanted[LONGEST]
                rows[RATIO, j] = (changes[high, j] - changes[low, j]) * long / short / wanted[RATIO]
                rows[MIDDLE_LONGEST, j] = changes[mid, j] * middle / wanted[LONGEST]
                rows[MIDDLE_SHORTEST, j] = -changes[mid, j] * middle / wanted[SHORTEST]
                rows[MIDDLE_SHORT, j] = (changes[mid, j] - changes[low, j]) * middle / short / wanted[RATIO]
                rows[LONG_MIDDLE, j] = (changes[high, j] - changes[mid, j]) * long / middle / wanted[RATIO]
            else:
                rivals[b, j] = (total - rivals[0, j]) * (1.0 + body.slack[b])
        if b == 0:
            body.residuals[SHORTEST] = short / wanted[SHORTEST] - 1.0
            body.residuals[LONGEST] = long / wanted[LONGEST] - 1.0
            body.residuals[RATIO] = long / short / wanted[RATIO] - 1.0
            body.residuals[MIDDLE_LONGEST] = middle / wanted[LONGEST] - 1.0
            body.residuals[MIDDLE_SHORTEST] = 1.0 - middle / wanted[SHORTEST]
            body.residuals[MIDDLE_SHORT] = middle / short / wanted[RATIO] - 1.0
            body.residuals[LONG_MIDDLE] = long / middle / wanted[RATIO] - 1.0
            for end in range(2):
                _fill_tie(body, FIRST_TIE + end, 2 * low + end, wanted[SHORTEST], scratch)
                _fill_tie(body, FIRST_TIE + 2 + end, 2 * high + end, wanted[LONGEST], scratch)


@inner_kernel
def _fill_tie(body: Body, r: int, side: int, wanted: float, scratch: BodyScratch) -> None:
    """Residual and row of an edge of the measured box if it ended, on one side, at the next vertex.

    A side with ties turns the box when its vertices change, and has no such row.
    """
    contact, frame, other = body.contacts[0], body.frames[0], scratch.contact
    body.residuals[r] = FAR_BELOW
    for tie in range(contact[0]):
        if contact[7 + 2 * tie] == side:
            return
    axis, end, sign = row(frame, side // 2), contact[1 + side], 1.0 - 2.0 * (side % 2)
    least, at = NEARLY_TIED, -1
    for v in range(body.counts[N_VERTICES]):
        gap = sign * (along(body.vertices, end, axis) - along(body.vertices, v, axis))
        if v != end and gap < least:
            least, at = gap, v
    if at < 0:
        return
    for c in range(len(other)):
        other[c] = contact[c]
    other[1 + side] = at
    k, charges = side // 2, scratch.charges
    fill_points(body.vertices, other, scratch.points)
    extent = extent_forces(scratch.points, other, frame, scratch.forces)[k]
    _fill_charges(body, other, scratch.forces[k], charges)
    fill_gradient(charges, body.tangents, body.scales, body.rows[r])
    for j in range(body.rows.shape[1]):
        body.rows[r, j] *= extent / wanted
    body.residuals[r] = extent / wanted - 1.0


@inner_kernel
def _fill_charges(body: Body, contact: IntArray, forces: FloatArray, charges: FloatArray) -> None:
    """Charges of the planes for forces (9, 3) on the vertices of a row of contacts."""
    charges[:] = 0.0
    for i in range(6 + contact[0]):
        v = contact[1 + i] if i < 6 else contact[8 + 2 * (i - 6)]
        force = row(forces, i)
        add_vertex_charges(body.normals, body.triples, body.vertices, v, force, body.centroids, charges)


@inner_kernel
def fill_extent_gradients(body: Body, b: int, scratch: BodyScratch) -> None:
    """Fill the derivatives (3, 3 n) of the logarithms of a box's edges with the planes, in `scratch`."""
    points, forces = scratch.points, scratch.forces
    charges, gradients = scratch.charges, scratch.gradients
    contact, frame = body.contacts[b], body.frames[b]
    fill_points(body.vertices, contact, points)
    extent_forces(points, contact, frame, forces)
    for k in range(3):
        _fill_charges(body, contact, forces[k], charges)
        fill_gradient(charges, body.tangents, body.scales, gradients[k])


@inner_kernel
def copy_boxes(source: Body, to: Body) -> None:
    """Let one body begin with the boxes of another."""
    to.counts[N_BOXES] = source.counts[N_BOXES]
    for b in range(source.counts[N_BOXES]):
        to.slack[b] = source.slack[b]
        for axis in range(3):
            for c in range(3):
                to.frames[b, axis, c] = source.frames[b, axis, c]
        for c in range(source.contacts.shape[1]):
            to.contacts[b, c] = source.contacts[b, c]
        for i in range(9):
            for c in range(3):
                to.planes[b, i, c] = source.planes[b, i, c]


@inner_kernel
def is_same_box(body: Body, one: int, two: int) -> bool:
    """Whether two boxes have the same volume and axes."""
    same = abs(box_volume(body, one) - box_volume(body, two)) < SAME_VOLUME * box_volume(body, one)
    return same and likeness_of(body.frames[one], body.frames[two]) > SAME_FRAME
