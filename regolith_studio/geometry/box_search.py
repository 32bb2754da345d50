"""Search for the minimum-volume box of a convex solid.

O'Rourke (1985): two adjacent sides of a minimum-volume box are each flush with an edge of the hull. A
side that is flush with an edge has its normal on the edge's Gauss arc, the arc between the normals of
the two faces that meet there.

So all arcs are searched, by branch and bound with the bounds of :mod:`regolith_studio.geometry.box_view`:
a piece of an arc that could hold a smaller box is halved, or cut where a face turns its back. Once no face
does so within the piece, and only one edge or two could be flush with a second side there, the least volume
along it is found by descent. Of solids with many faces, whole neighbourhoods of normals are ruled out first.
"""

import numpy as np

from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.box_arc import Arc, Search, box_on, box_on_arc, descend
from regolith_studio.geometry.box_view import (
    View,
    bound_after_turn,
    bound_within_cap,
    empty_view,
    flush_after_turn,
)
from regolith_studio.geometry.compiled import kernel
from regolith_studio.geometry.hull_graph import HullGraph, hull_graph
from regolith_studio.geometry.vectors import along, cross, dot, length, mixed, row

MANY_FACES = 100
FIRST_FACES = 16
"""Solids with more faces than MANY_FACES are first seen along so many normals, to know a good box soon."""

STRIDES = 8
CAPS = np.radians(np.array([24.0, 16.0, 11.0, 7.5, 5.0, 3.3, 2.2, 1.5, 1.0]))
"""Neighbourhoods of a normal that are tried, in radians."""

NARROW = np.radians(8.0)
"""Pieces of an arc wider than this are halved."""
WIDEST = np.radians(20.0)
"""Arcs are searched in pieces that are no wider."""
UNIMODAL = np.radians(3.0)
"""Widest piece along which is descended."""
FINEST = 1e-10
"""Angle down to which pieces are halved, in radians."""
MANY_PIECES = 500
"""After so many pieces of one arc, needed only where the volume hardly changes along it, FINEST grows."""

SAME_NORMAL = 1e-8
EDGE_ON = 1e-10
EQUAL = 1e-11
"""Boxes whose volumes differ by a smaller share are not told apart."""

DEPTH = 256


@kernel
def minimum_box(points: FloatArray, faces: IntArray) -> FloatArray:
    """Axes of the minimum-volume box, one a row, shape (3, 3); zeros if the faces do not close.

    Parameters
    ----------
    points
        Vertices of a convex solid of size about 1 near the origin, shape (n, 3); each on a face.
    faces
        Its outward triangles, shape (m, 3).
    """
    return least_box(hull_graph(points, faces))


@kernel
def least_box(graph: HullGraph) -> FloatArray:
    """Axes of the minimum-volume box of a solid, one a row, shape (3, 3); zeros if it does not close."""
    search = Search(empty_view(len(graph.points)), np.full(2, np.inf), np.zeros((3, 3)), np.empty((DEPTH, 2)))
    if not graph.closed:
        return search.axes
    done = np.zeros(len(graph.twin), np.bool_)
    if len(graph.normals) > MANY_FACES:
        _rule_out(graph, done, search)
    else:
        for f in range(len(graph.normals)):
            if graph.facet[f] == f:
                box_on(graph, row(graph.normals, f), search)
    for h in range(len(graph.twin)):
        if h < graph.twin[h] and not done[h]:
            search_arc(graph, h, search)
    return search.axes


@kernel
def _rule_out(graph: HullGraph, done: BoolArray, search: Search) -> None:
    """Mark the half-edges whose arcs hold no smaller box, by what is seen along some of the normals."""
    m = len(graph.normals)
    for k in range(FIRST_FACES):
        box_on(graph, row(graph.normals, k * m // FIRST_FACES), search)
    known, seen, stack = np.zeros(m, np.bool_), np.full(m, -1), np.empty(m, np.int64)
    for start in range(STRIDES):
        for f in range(start, m, STRIDES):
            if known[f]:
                continue
            axis = row(graph.normals, f)
            n = abs(box_on(graph, axis, search))
            event, reach = 0, 0.0
            for angle in CAPS:
                event = bound_within_cap(search.sight, n, angle, search.record[0] * (1.0 - EQUAL), event)
                if event < 0:
                    reach = angle
                    break
            near = np.cos(reach)
            seen[f], stack[0], count = f, f, 1
            i = 0
            while i < count:
                for h in range(3 * stack[i], 3 * stack[i] + 3):
                    g = graph.twin[h] // 3
                    if seen[g] != f and along(graph.normals, g, axis) >= near:
                        seen[g], stack[count] = f, g
                        count += 1
                i += 1
            for i in range(count):
                known[stack[i]] = True
                for h in range(3 * stack[i], 3 * stack[i] + 3):
                    if seen[graph.twin[h] // 3] == f:
                        done[h] = done[graph.twin[h]] = True


@kernel
def search_arc(graph: HullGraph, h: int, search: Search) -> None:
    """Branch and bound along the Gauss arc of half-edge `h`."""
    start, end = row(graph.normals, h // 3), row(graph.normals, graph.twin[h] // 3)
    across = mixed(end, 1.0, start, -dot(start, end))
    sine = length(across)
    if sine < SAME_NORMAL:
        return
    angle = np.arctan2(sine, dot(start, end))
    across = mixed(across, 1.0 / sine, start, 0.0)
    across = mixed(across, 1.0, start, -dot(across, start))
    across = mixed(across, 1.0 / length(across), start, 0.0)
    arc = Arc(start, across, cross(across, start), angle)
    todo = search.todo
    n = int(np.ceil(angle / WIDEST))
    for i in range(n):
        todo[i, 0], todo[i, 1] = angle * i / n, angle * (i + 1) / n
    pieces, finest = 0, FINEST
    while n > 0:
        n -= 1
        low, high = todo[n, 0], todo[n, 1]
        cut = _look_into(graph, arc, low, high, search)
        pieces += 1
        if pieces % MANY_PIECES == 0:
            finest *= 100.0
        if cut >= 0.0 and n + 2 <= DEPTH and high - low > finest:
            todo[n, 0], todo[n, 1] = low, cut
            todo[n + 1, 0], todo[n + 1, 1] = cut, high
            n += 2


@kernel
def _look_into(graph: HullGraph, arc: Arc, low: float, high: float, search: Search) -> float:
    """Search a piece of an arc; where to cut it if it may still hold a smaller box, else -1."""
    middle, half = (low + high) / 2.0, (high - low) / 2.0
    n, _ = box_on_arc(graph, arc, middle, search)
    view, limit = search.sight, search.record[0] * (1.0 - EQUAL)
    cosine, sine = np.cos(half), np.sin(half)
    bound = bound_after_turn(view, abs(n), cosine, -sine)
    if bound >= limit:
        bound = bound_after_turn(view, abs(n), cosine, sine)
    if bound >= limit:
        return -1.0
    if n < 0 or high - low > NARROW:
        return middle
    turn = _next_flip(graph, arc, middle, half, n, view)
    if turn != 0.0:
        return middle + turn
    count, one, two = _flush_edges(view, n, half, limit)
    if count == 0:
        return -1.0
    if count > 2 or high - low > UNIMODAL:
        return middle
    descend(graph, arc, low, high, one, search)
    if count == 2:
        descend(graph, arc, low, high, two, search)
    return -1.0


@kernel
def _next_flip(graph: HullGraph, arc: Arc, middle: float, half: float, n: int, view: View) -> float:
    """Least turn from the middle at which a face beside the outline turns its back; 0 if none does."""
    axis = mixed(arc.start, np.cos(middle), arc.across, np.sin(middle))
    second = mixed(arc.across, np.cos(middle), arc.start, -np.sin(middle))
    nearest = np.inf
    for i in range(n):
        for side in range(2):
            f = (view.rim[i] if side == 0 else graph.twin[view.rim[i]]) // 3
            up, rise = along(graph.normals, f, axis), along(graph.normals, f, second)
            if abs(up) < abs(rise) * 1.1 * half:
                turn = np.arctan(-up / rise)
                if abs(turn) < half - EDGE_ON and abs(turn) < abs(nearest):
                    nearest = turn
    return nearest if nearest < np.inf else 0.0


@kernel
def _flush_edges(view: View, n: int, half: float, limit: float) -> tuple[int, int, int]:
    """How many edges of the outline could be flush with a second side of a box below `limit`; the last two.

    The outline must keep its edges. Over half a piece the volume with the touched vertices held fast lies
    above its chord, less what its curvature allows. Three, where an edge is seen so nearly end-on that
    nothing is known.
    """
    cosine, sine = np.cos(half), np.sin(half)
    count, one, two = 0, -1, -1
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        here, squared = flush_after_turn(view, n, i, 1.0, 0.0)
        deep = view.z[j] - view.z[i]
        before, squared_before = flush_after_turn(view, n, i, cosine, -sine)
        after, squared_after = flush_after_turn(view, n, i, cosine, sine)
        lever = min(squared, squared_before, squared_after)
        if lever == 0.0 or lever < 16.0 * half * half * (squared + deep * deep):
            return 3, one, two
        dip = here * (4.0 * (squared + deep * deep) / lever + 12.0) * half * half
        if min(_least_under(before, here, dip), _least_under(here, after, dip)) < limit:
            count, one, two = count + 1, i, one
    return count, one, two


@kernel
def _least_under(one: float, two: float, dip: float) -> float:
    """Least value of the parabola through both values that hangs ``dip / 4`` below their chord."""
    rise = abs(two - one)
    return min(one, two) if rise >= dip else min(one, two) - (dip - rise) ** 2 / (4.0 * dip)
