"""Where a locally minimal box touches its solid, and how it settles there when the solid changes.

Of the three freedoms of a box's orientation, each pair of vertices that lie in one side takes one: it *ties*.
A minimum has three ties, or two and a volume that is stationary along the freedom that is left (O'Rourke
1985); a side on a facet counts as two ties. For a rotation w, an axis x turns by w x x, so the difference d
of a tied pair leaves its side at the rate <w, x x d>, and an extent <x, s> changes at the rate <w, x x s>.

A row of contacts holds the number of ties; the vertices at the upper and the lower end of each axis; and for
each tie its side (2 k + 1 for the lower side of axis k, 2 k for the upper) and the vertex that ties with the
one at that end: 13 numbers.
"""

from typing import NamedTuple

import numpy as np

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import inner_kernel
from regolith_studio.geometry.vectors import Vector, along, cross, dot, length, mixed, row

ROW = 13
"""Numbers in a row of contacts."""
VERTICES = np.array([1, 2, 3, 4, 5, 6, 8, 10, 12])
"""Places of the vertices in a row of contacts: six ends of axes, three tied."""
TOUCHING = 1e-6
"""Vertices nearer to a side than this, at size 1, touch it."""
OUTSIDE = 1e-9
"""Vertices farther outside than this are outside."""
APART = 1e-5
"""Ties that leave less of a turn than this, at size 1, are none."""
MAX_TURN = 0.12
"""Boxes that turn by more in one go, in radians, are looked for anew."""
MAX_SWAPS = 6
MAX_RELEASES = 6
NONE, UNSTABLE = -1, -2
"""In place of a tie that is to be released."""
EDGE = 1e-6
"""Shares beyond 0 or 1, and distances beyond an edge at size 1, up to this are rounding."""
SETTLED = 1e-11
"""Last turn of a box that has settled, in radians."""


class Pose(NamedTuple):
    """A box at rest, or on the way there.

    Axes, vectors between the vertices at their ends, and extents; derivatives of the logarithms of the
    extents with a rotation; those of the three conditions (ties, and that the volume is stationary) and their
    residuals; the turn that two ties leave free, zero with three.
    """

    axes: tuple[Vector, Vector, Vector]
    spans: tuple[Vector, Vector, Vector]
    extents: Vector
    slopes: tuple[Vector, Vector, Vector]
    conditions: tuple[Vector, Vector, Vector]
    residuals: Vector
    free: Vector


@inner_kernel
def touched(vertices: FloatArray, frame: FloatArray, contact: IntArray, ties: FloatArray) -> None:
    """Fill a row of contacts for a box by its axes, one a row of `frame`; `ties` (3, 3) is scratch."""
    contact[0] = 0
    for axis in range(3):
        x = row(frame, axis)
        high, low = -np.inf, np.inf
        for v in range(len(vertices)):
            here = along(vertices, v, x)
            if here > high:
                high, contact[1 + 2 * axis] = here, v
            if here < low:
                low, contact[2 + 2 * axis] = here, v
    for n in range(3):
        most, most_side, most_vertex = APART, -1, -1
        for side in range(6):
            x, end = row(frame, side // 2), contact[1 + side]
            for v in range(len(vertices)):
                apart = mixed(row(vertices, v), 1.0, row(vertices, end), -1.0)
                if v == end or abs(dot(apart, x)) > TOUCHING:
                    continue
                turn = cross(x, apart)
                # What the ties before leave of this turn: only a further freedom counts.
                for t in range(n):
                    turn = mixed(turn, 1.0, row(ties, t), -along(ties, t, turn))
                if length(turn) > most:
                    most, most_side, most_vertex = length(turn), side, v
                    for c in range(3):
                        ties[n, c] = turn[c] / most
        if most_side < 0:
            break
        contact[0], contact[7 + 2 * n], contact[8 + 2 * n] = n + 1, most_side, most_vertex


@inner_kernel
def settled(points: FloatArray, contact: IntArray, frame: FloatArray, farthest: float) -> bool:
    """Turn the axes in `frame` until all conditions hold, by Newton's method; False where they cannot.

    Points (9, 3) are those of :func:`fill_points`; the box may turn by `farthest` at most, in radians.
    """
    if contact[0] < 2:
        return False
    total = 0.0
    for _ in range(12):
        pose = pose_of(points, contact, frame)
        sound, turn = solved(pose.conditions, pose.residuals)
        angle = length(turn)
        total += angle
        if not (sound and total < farthest):
            return False
        rotate(frame, mixed(turn, -1.0, turn, 0.0))
        if angle < SETTLED:
            return True
    return False


@inner_kernel
def fill_points(vertices: FloatArray, contact: IntArray, points: FloatArray) -> None:
    """Coordinates of the vertices of a row of contacts, shape (9, 3): six ends of axes, three tied."""
    for i in range(9):
        v = contact[1 + i] if i < 6 else contact[8 + 2 * (i - 6)]
        for c in range(3):
            points[i, c] = vertices[v, c] if i < 6 + contact[0] else 0.0


@inner_kernel
def pose_of(points: FloatArray, contact: IntArray, frame: FloatArray) -> Pose:
    """Everything about a box that follows from its axes and the vertices that it touches."""
    axes = (row(frame, 0), row(frame, 1), row(frame, 2))
    spans = (
        mixed(row(points, 0), 1.0, row(points, 1), -1.0),
        mixed(row(points, 2), 1.0, row(points, 3), -1.0),
        mixed(row(points, 4), 1.0, row(points, 5), -1.0),
    )
    extents = (dot(axes[0], spans[0]), dot(axes[1], spans[1]), dot(axes[2], spans[2]))
    s0, s1, s2 = cross(axes[0], spans[0]), cross(axes[1], spans[1]), cross(axes[2], spans[2])
    s0, s1 = mixed(s0, 1.0 / extents[0], s0, 0.0), mixed(s1, 1.0 / extents[1], s1, 0.0)
    slopes = (s0, s1, mixed(s2, 1.0 / extents[2], s2, 0.0))
    x, y, z = tied_axis(contact, 0, frame), tied_axis(contact, 1, frame), tied_axis(contact, 2, frame)
    d, e, f = tied_pair(points, contact, 0), tied_pair(points, contact, 1), tied_pair(points, contact, 2)
    one, two = cross(x, d), cross(y, e)
    if contact[0] == 3:
        conditions = (one, two, cross(z, f))
        return Pose(
            axes, spans, extents, slopes, conditions, (dot(x, d), dot(y, e), dot(z, f)), (0.0, 0.0, 0.0)
        )
    free = cross(one, two)
    slope = mixed(mixed(slopes[0], 1.0, slopes[1], 1.0), 1.0, slopes[2], 1.0)
    # How <slope, free> changes with a rotation about each coordinate axis: the third row of Newton's matrix.
    bend = (0.0, 0.0, 0.0)
    for k in range(3):
        unit = (1.0 if k == 0 else 0.0, 1.0 if k == 1 else 0.0, 1.0 if k == 2 else 0.0)
        first = cross(cross(cross(unit, x), d), two)
        second = cross(one, cross(cross(unit, y), e))
        change = dot(slope, first) + dot(slope, second)
        for axis in range(3):
            pulled = cross(cross(unit, axes[axis]), spans[axis])
            change += dot(free, pulled) / extents[axis] - slopes[axis][k] * dot(slopes[axis], free)
        bend = (
            change if k == 0 else bend[0],
            change if k == 1 else bend[1],
            change if k == 2 else bend[2],
        )
    residuals = (dot(x, d), dot(y, e), dot(slope, free))
    return Pose(axes, spans, extents, slopes, (one, two, bend), residuals, free)


@inner_kernel
def tied_axis(contact: IntArray, tie: int, frame: FloatArray) -> Vector:
    """Axis of the side in which a tie lies."""
    return row(frame, contact[7 + 2 * tie] // 2 if tie < contact[0] else 0)


@inner_kernel
def tied_pair(points: FloatArray, contact: IntArray, tie: int) -> Vector:
    """From the vertex at the end of the axis to the one that ties with it; zero for a tie that is none."""
    if tie >= contact[0]:
        return 0.0, 0.0, 0.0
    return mixed(row(points, 6 + tie), 1.0, row(points, contact[7 + 2 * tie]), -1.0)


@inner_kernel
def solved(rows: tuple[Vector, Vector, Vector], right: Vector) -> tuple[bool, Vector]:
    """Solution w of <row, w> = right for three rows; False where they are nearly dependent."""
    first, second, third = cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])
    volume = dot(rows[0], first)
    if not abs(volume) > APART * length(rows[0]) * length(rows[1]) * length(rows[2]):
        return False, (0.0, 0.0, 0.0)
    w = mixed(mixed(first, right[0], second, right[1]), 1.0 / volume, third, right[2] / volume)
    return True, w


@inner_kernel
def rotate(frame: FloatArray, turn: Vector) -> None:
    """Rotate the axes in `frame` by the angle and about the direction of `turn`."""
    angle = length(turn)
    if angle == 0.0:
        return
    axis = mixed(turn, 1.0 / angle, turn, 0.0)
    cosine, sine = np.cos(angle), np.sin(angle)
    for k in range(3):
        x = row(frame, k)
        y = mixed(x, cosine, cross(axis, x), sine)
        y = mixed(y, 1.0, axis, dot(axis, x) * (1.0 - cosine))
        for c in range(3):
            frame[k, c] = y[c]


@inner_kernel
def rested(
    vertices: FloatArray, contact: IntArray, frame: FloatArray, points: FloatArray, farthest: float
) -> bool:
    """Settle a box so that it holds all vertices, with others in its row of contacts where it must be.

    A vertex that is left outside takes the place of one in that side; False where that leads nowhere.
    `points` (9, 3) is filled with the vertices of the row of contacts.
    """
    for _ in range(MAX_SWAPS):
        fill_points(vertices, contact, points)
        if not settled(points, contact, frame, farthest):
            return False
        side, vertex = farthest_outside(vertices, contact, frame)
        if side < 0:
            return True
        place = 1 + side
        for tie in range(contact[0]):
            if contact[7 + 2 * tie] == side:
                place = 8 + 2 * tie
        contact[place] = vertex
    return False


@inner_kernel
def farthest_outside(vertices: FloatArray, contact: IntArray, frame: FloatArray) -> tuple[int, int]:
    """Side beyond which a vertex lies farthest outside, and that vertex; -1 where none does."""
    most, most_side, most_vertex = OUTSIDE, -1, -1
    for axis in range(3):
        x = row(frame, axis)
        high, low = along(vertices, contact[1 + 2 * axis], x), along(vertices, contact[2 + 2 * axis], x)
        for v in range(len(vertices)):
            here = along(vertices, v, x)
            if here - high > most:
                most, most_side, most_vertex = here - high, 2 * axis, v
            if low - here > most:
                most, most_side, most_vertex = low - here, 2 * axis + 1, v
    return most_side, most_vertex


@inner_kernel
def walk_to_minimum(
    vertices: FloatArray,
    contact: IntArray,
    frame: FloatArray,
    points: FloatArray,
    start: FloatArray,
    farthest: float,
) -> bool:
    """Turn a box until it is a local minimum, by an active-set method; False where that leads nowhere.

    The box settles on its ties. As long as a small turn that gives up one tie makes it smaller, it turns so
    until another vertex touches. Where it cannot settle, it begins once more without ties. `start` (3, 3) is
    scratch.
    """
    for axis in range(3):
        start[axis, 0], start[axis, 1], start[axis, 2] = row(frame, axis)
    anew = False
    for _ in range(MAX_RELEASES):
        if not rested(vertices, contact, frame, points, farthest):
            if anew:
                return False
            anew = True
            for axis in range(3):
                frame[axis, 0], frame[axis, 1], frame[axis, 2] = row(start, axis)
            if not gain_ties(vertices, contact, frame, points):
                return False
            continue
        pose = pose_of(points, contact, frame)
        tie, at_end = tie_to_release(pose, contact)
        if tie == NONE:
            tie = tie_to_tip(vertices, contact, frame, points, pose)
            if tie == NONE:
                return True
            fill_points(vertices, contact, points)
            pose = pose_of(points, contact, frame)
        if tie == UNSTABLE or not change_tie(vertices, contact, frame, pose, tie, at_end):
            return False
    return False


@inner_kernel
def gain_ties(vertices: FloatArray, contact: IntArray, frame: FloatArray, points: FloatArray) -> bool:
    """Turn a box without ties the way that it becomes smaller until two or three are there; False for less.

    The third tie is left out where the volume is stationary before another vertex touches.
    """
    contact[0] = 0
    for side in range(6):
        contact[1 + side] = farthest_vertex(vertices, frame, side)
    for n in range(3):
        fill_points(vertices, contact, points)
        pose = pose_of(points, contact, frame)
        turn = downhill(pose, n, n)
        angle, side, vertex = next_contact(vertices, contact, frame, turn)
        if n == 2:
            change = dot(pose.conditions[2], turn)
            if 0.0 < -pose.residuals[2] < angle * change:
                return True
        if side < 0:
            return n == 2
        rotate(frame, mixed(turn, angle, turn, 0.0))
        contact[0], contact[7 + 2 * n], contact[8 + 2 * n] = n + 1, side, vertex
    return True


@inner_kernel
def farthest_vertex(vertices: FloatArray, frame: FloatArray, side: int) -> int:
    """The vertex that lies farthest beyond a side of a box."""
    x, at, most = row(frame, side // 2), 0, -np.inf
    x = mixed(x, 1.0 if side % 2 == 0 else -1.0, x, 0.0)
    for v in range(len(vertices)):
        here = along(vertices, v, x)
        if here > most:
            at, most = v, here
    return at


@inner_kernel
def downhill(pose: Pose, n: int, released: int) -> Vector:
    """Turn along which the volume falls fastest while n ties hold, all but the one that is released."""
    slope = mixed(mixed(pose.slopes[0], 1.0, pose.slopes[1], 1.0), 1.0, pose.slopes[2], 1.0)
    turn, first = mixed(slope, -1.0, slope, 0.0), (0.0, 0.0, 0.0)
    for t in range(n):
        if t != released:
            held = pose.conditions[0] if t == 0 else (pose.conditions[1] if t == 1 else pose.conditions[2])
            # At most two ties hold, so that each has to be made orthogonal to one other only.
            held = mixed(held, 1.0, first, -dot(held, first))
            held = mixed(held, 1.0 / length(held), held, 0.0)
            turn = mixed(turn, 1.0, held, -dot(held, turn))
            first = held
    return turn


@inner_kernel
def next_contact(
    vertices: FloatArray, contact: IntArray, frame: FloatArray, turn: Vector
) -> tuple[float, int, int]:
    """Share of a turn after which, to first order, a vertex touches a side; side (-1 for none) and vertex."""
    soonest, next_side, next_vertex = np.inf, -1, -1
    for s in range(6):
        x, end = row(frame, s // 2), contact[1 + s]
        x = mixed(x, 1.0 if s % 2 == 0 else -1.0, x, 0.0)
        rate_of = cross(x, turn)
        for v in range(len(vertices)):
            apart = mixed(row(vertices, end), 1.0, row(vertices, v), -1.0)
            rate = dot(rate_of, apart)
            if rate <= 0.0 or v == end:
                continue
            tied = False
            for t in range(contact[0]):
                tied = tied or (contact[7 + 2 * t] == s and contact[8 + 2 * t] == v)
            # A vertex that rounding puts outside touches at once.
            gap = max(0.0, dot(x, apart))
            if not tied and gap < soonest * rate:
                soonest, next_side, next_vertex = gap / rate, s, v
    return soonest, next_side, next_vertex


@inner_kernel
def tie_to_release(pose: Pose, contact: IntArray) -> tuple[int, bool]:
    """The tie that a turn to a smaller box gives up, and whether the vertex at the end of the axis leaves.

    NONE where no small turn makes the box smaller, as far as the contacts tell; UNSTABLE where the volume is
    not least along the freedom that two ties leave. Where a pair ties, either vertex may end the axis, and
    some mixture of the slopes that this makes must vanish. Of a side on a facet any three vertices may be
    named, so that a mixture with a negative share does not tell anything.
    """
    if contact[0] == 2 and not dot(pose.conditions[2], pose.free) > 0.0:
        return UNSTABLE, False
    shares = tie_shares(pose, contact)
    worst, found, at_end = EDGE, NONE, False
    for t in range(contact[0]):
        side, alone = contact[7 + 2 * t], True
        for other in range(contact[0]):
            alone = alone and (other == t or contact[7 + 2 * other] != side)
        if alone and max(-shares[t], shares[t] - 1.0) > worst:
            worst, found, at_end = max(-shares[t], shares[t] - 1.0), t, shares[t] > 0.5
    return found, at_end


@inner_kernel
def tie_shares(pose: Pose, contact: IntArray) -> Vector:
    """Share of each tied vertex, against that at the end of its axis, in the mixture of slopes that vanishes.

    0 for a third tie that is none.
    """
    slope = mixed(mixed(pose.slopes[0], 1.0, pose.slopes[1], 1.0), 1.0, pose.slopes[2], 1.0)
    rows = pose.conditions
    third = rows[2] if contact[0] == 3 else pose.free
    one, two, three = cross(rows[1], third), cross(third, rows[0]), cross(rows[0], rows[1])
    volume = dot(rows[0], one)
    shares = (dot(slope, one) / volume, dot(slope, two) / volume, dot(slope, three) / volume)
    return (
        # Slopes are those of logarithms, ties are lengths.
        shares[0] * signed_extent(pose, contact, 0),
        shares[1] * signed_extent(pose, contact, 1),
        shares[2] * signed_extent(pose, contact, 2),
    )


@inner_kernel
def signed_extent(pose: Pose, contact: IntArray, tie: int) -> float:
    """Extent along the axis of a tie, less than 0 for its upper side; 0 for a tie that is none."""
    if tie >= contact[0]:
        return 0.0
    side = contact[7 + 2 * tie]
    return pose.extents[side // 2] * (-1.0 if side % 2 == 0 else 1.0)


@inner_kernel
def tie_to_tip(
    vertices: FloatArray, contact: IntArray, frame: FloatArray, points: FloatArray, pose: Pose
) -> int:
    """The tie that a box gives up which tips over an edge of the facet under a side; NONE if it rests.

    The mixture of slopes that vanishes is a point in the facet's plane. The box rests if the facet holds it;
    if it lies beyond an edge, the box becomes smaller when it turns about that edge. Then the row of contacts
    is changed to name the two vertices of the edge, and a third one in the tie to be given up.
    """
    first, second = tied_to_one_side(contact)
    if second == NONE:
        return NONE
    side, shares = contact[7 + 2 * first], tie_shares(pose, contact)
    axis, end = row(frame, side // 2), row(points, side)
    at = mixed(tied_pair(points, contact, first), shares[first], end, 1.0)
    at = mixed(at, 1.0, tied_pair(points, contact, second), shares[second])
    a, b, c = contact[1 + side], contact[8 + 2 * first], contact[8 + 2 * second]
    for _ in range(len(vertices)):
        for _ in range(2):  # c opposite the edge that is farthest within
            if beyond(vertices, a, b, c, axis, at) < max(
                beyond(vertices, b, c, a, axis, at), beyond(vertices, c, a, b, axis, at)
            ):
                a, b, c = b, c, a
        if beyond(vertices, a, b, c, axis, at) < EDGE:
            return NONE
        farther, most = NONE, EDGE
        for v in range(len(vertices)):
            apart = mixed(row(vertices, v), 1.0, end, -1.0)
            if abs(dot(apart, axis)) < TOUCHING and v != a and v != b:
                here = beyond(vertices, a, b, c, axis, row(vertices, v))
                if here > most:
                    farther, most = v, here
        if farther == NONE:
            contact[1 + side], contact[8 + 2 * first], contact[8 + 2 * second] = a, b, c
            return second
        c = farther
    return NONE


@inner_kernel
def tied_to_one_side(contact: IntArray) -> tuple[int, int]:
    """The two ties of a side on a facet; NONE where no side is on one."""
    for first in range(contact[0]):
        for second in range(first + 1, contact[0]):
            if contact[7 + 2 * first] == contact[7 + 2 * second]:
                return first, second
    return NONE, NONE


@inner_kernel
def beyond(vertices: FloatArray, a: int, b: int, c: int, axis: Vector, at: Vector) -> float:
    """Distance of a point in the plane of three vertices from the edge (a, b), beyond it as seen from c."""
    start = row(vertices, a)
    edge = mixed(row(vertices, b), 1.0, start, -1.0)
    out = cross(edge, axis)
    across = dot(out, mixed(at, 1.0, start, -1.0)) / max(length(out), 1e-300)
    return across if dot(out, mixed(row(vertices, c), 1.0, start, -1.0)) < 0.0 else -across


@inner_kernel
def change_tie(
    vertices: FloatArray, contact: IntArray, frame: FloatArray, pose: Pose, tie: int, at_end: bool
) -> bool:
    """Give up a tie for that of the vertex which touches next, to first order in the turn; False for none."""
    turn, last = downhill(pose, contact[0], tie), contact[0] - 1
    if at_end:
        contact[1 + contact[7 + 2 * tie]] = contact[8 + 2 * tie]
    # Ties have no order: the last takes the place of the one given up.
    contact[7 + 2 * tie], contact[8 + 2 * tie] = contact[7 + 2 * last], contact[8 + 2 * last]
    contact[0] = last
    _, side, vertex = next_contact(vertices, contact, frame, turn)
    contact[0], contact[7 + 2 * last], contact[8 + 2 * last] = last + 1, side, vertex
    return side >= 0
