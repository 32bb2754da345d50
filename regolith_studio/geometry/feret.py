"""Largest and smallest width of a convex solid between parallel planes (Feret), and its three chords."""

from typing import Any

import numpy as np
from scipy.optimize import linprog
from scipy.spatial import ConvexHull, cKDTree
from scipy.spatial.distance import cdist

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import inner_kernel, kernel_noalloc
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.minimum_box.hull_topology import extreme_vertices_of_each, facets_of_hull
from regolith_studio.geometry.vectors import Vector, along, cross, dot, length, mixed, row

PARALLEL = 1e-8
"""Sine of the angle between edges below which the planes through both are those through a face."""

ROUNDING = 1e-12
"""By how much a plane may cut into the solid, and a chord be shorter than the longest and count as it."""


def feret_max(hull: Mesh) -> float:
    """Largest Feret diameter: the largest distance between two vertices."""
    middle, size = _frame(hull)
    return size * longest_chord((hull.vertices - middle) / size)


def feret_min(hull: Mesh) -> float:
    """Smallest Feret diameter, exact.

    The planes touch a face and a vertex, or two edges that are not parallel (Houle and Toussaint 1988).
    """
    middle, size = _frame(hull)
    return size * _min_width((hull.vertices - middle) / size, hull.faces)


def _frame(hull: Mesh) -> tuple[FloatArray, float]:
    low, high = hull.bounds
    return (low + high) / 2, float((high - low).max())


def _min_width(points: FloatArray, faces: IntArray) -> float:
    """Least distance between parallel tangent planes of a closed convex triangulation."""
    facets = facets_of_hull(points, faces)
    if facets is None:
        raise GeometryError("The convex hull of the mesh does not close, so it has no Feret diameter.")
    top, bottom = extreme_vertices_of_each(facets.points, np.ascontiguousarray(facets.normals.T))
    heights = (facets.normals * (points[top] - points[bottom])).sum(axis=1)
    start, end = points[facets.edges[:, 0]], points[facets.edges[:, 1]]
    sides = facets.normals[facets.edges[:, 2:]]
    return min(float(heights.min()), _width_between_edges(start, end - start, sides))


@kernel_noalloc
def _width_between_edges(start: FloatArray, way: FloatArray, sides: FloatArray) -> float:
    """Least :func:`_width_between` of all pairs of edges: starts, vectors (e, 3) and normals (e, 2, 3)."""
    width = np.inf
    for i in range(len(start)):
        for j in range(i):
            width = min(width, _width_between(start, way, sides, i, j))
    return width


@inner_kernel
def _width_between(start: FloatArray, way: FloatArray, sides: FloatArray, i: int, j: int) -> float:
    """Distance between the parallel planes through two edges, infinite unless both planes are tangent."""
    one, two = row(way, i), row(way, j)
    # The cross product of the edges lies between the normals of an edge's two facets only if the other edge
    # points to different sides of these.
    if along(sides[j], 0, one) * along(sides[j], 1, one) > ROUNDING * dot(one, one):
        return np.inf
    if along(sides[i], 0, two) * along(sides[i], 1, two) > ROUNDING * dot(two, two):
        return np.inf
    normal = cross(one, two)
    size = length(normal)
    if size <= PARALLEL * length(one) * length(two):
        return np.inf
    turn = 1.0 if along(sides[i], 0, normal) + along(sides[i], 1, normal) > 0.0 else -1.0
    # The two planes look away from each other.
    if turn * (along(sides[j], 0, normal) + along(sides[j], 1, normal)) > 0.0:
        return np.inf
    return turn * dot(mixed(row(start, i), 1.0, row(start, j), -1.0), normal) / size


LEAF = 24
"""Points in a cell that is not divided."""
DEPTH = 4096
"""Pairs of cells that may wait: many times the square of the depth of a tree that fits into memory."""
ENLARGED = 1e-12
"""By how much a bound is enlarged, as a share of it, so that rounding hides no chord."""


def longest_chord(points: FloatArray) -> float:
    """Largest distance between two points.

    A search through all pairs takes the square of the number of points: 80 s for 160,000 on an ellipsoid.
    Here cells of a tree are compared in pairs from the root on, and only pairs that may hold a longer chord
    than the longest so far are divided. A cell is bounded by its radius, and by its height along the
    direction in which it lies, which is small on a surface that faces that way.

    ``points``: shape (n, 3), about the origin, which lies among them.
    """
    order, cells = _tree(points)
    ordered = np.ascontiguousarray(points[order])
    bounds = np.zeros((len(cells), 8))
    _fill_bounds(ordered, cells, bounds)
    return _longest(ordered, cells, bounds, np.empty((DEPTH, 2), dtype=np.int64))


def _tree(points: FloatArray) -> tuple[IntArray, IntArray]:
    """Order of the points, and the cells: first point, one after the last, and both halves or -1."""
    tree = cKDTree(points, leafsize=LEAF)
    cells: list[tuple[int, int, int, int]] = [(0, 0, -1, -1)]
    waiting: list[tuple[Any, int]] = [(tree.tree, 0)]
    while waiting:
        node, place = waiting.pop()
        if node.split_dim < 0:
            cells[place] = node.start_idx, node.end_idx, -1, -1
            continue
        lesser = len(cells)
        cells += [(0, 0, -1, -1)] * 2
        cells[place] = node.start_idx, node.end_idx, lesser, lesser + 1
        waiting += [(node.lesser, lesser), (node.greater, lesser + 1)]
    return np.asarray(tree.indices, dtype=np.int64), np.array(cells, dtype=np.int64)


@kernel_noalloc
def _fill_bounds(points: FloatArray, cells: IntArray, bounds: FloatArray) -> None:
    """For each cell its centre, the direction in which it lies, its height along that, and its radius."""
    for c in range(len(cells)):
        first, end = cells[c, 0], cells[c, 1]
        for i in range(first, end):
            for k in range(3):
                bounds[c, k] += points[i, k] / (end - first)
        away = np.sqrt(bounds[c, 0] ** 2 + bounds[c, 1] ** 2 + bounds[c, 2] ** 2)
        for k in range(3):
            bounds[c, 3 + k] = bounds[c, k] / away if away > 0.0 else 0.0
        for i in range(first, end):
            offset = mixed(row(points, i), 1.0, row(bounds, c), -1.0)
            height = abs(offset[0] * bounds[c, 3] + offset[1] * bounds[c, 4] + offset[2] * bounds[c, 5])
            bounds[c, 6] = max(bounds[c, 6], height)
            bounds[c, 7] = max(bounds[c, 7], length(offset))


@inner_kernel
def _reach(bounds: FloatArray, c: int, direction: Vector) -> float:
    """How far a cell reaches from its centre along a direction of length one."""
    # With height h along d and radius R no point is farther along u than h |<d, u>| + R sqrt(1 - <d, u>^2).
    turn = abs(direction[0] * bounds[c, 3] + direction[1] * bounds[c, 4] + direction[2] * bounds[c, 5])
    tilted = bounds[c, 6] * turn + bounds[c, 7] * np.sqrt(max(0.0, 1.0 - turn * turn))
    return float(min(bounds[c, 7], tilted))


@inner_kernel
def _bound(bounds: FloatArray, a: int, b: int) -> float:
    """Square of a distance that no two points of two cells exceed."""
    between = mixed(row(bounds, a), 1.0, row(bounds, b), -1.0)
    distance, radii = length(between), bounds[a, 7] + bounds[b, 7]
    if distance == 0.0:
        return float(radii * radii * (1.0 + ENLARGED))
    direction = (between[0] / distance, between[1] / distance, between[2] / distance)
    chord = distance + _reach(bounds, a, direction) + _reach(bounds, b, direction)
    # Along the line of the centres two points are at most `chord` apart, across it at most both radii.
    whole = distance + radii
    return float(min(whole * whole, chord * chord + radii * radii) * (1.0 + ENLARGED))


@kernel_noalloc
def _longest(points: FloatArray, cells: IntArray, bounds: FloatArray, waiting: IntArray) -> float:
    """Largest distance between points of one cell or of two, from the root on."""
    # Begun with a long chord, most pairs of cells are passed over.
    longest = _first_guess(points)
    n_waiting, waiting[0, 0], waiting[0, 1] = 1, 0, 0
    while n_waiting:
        n_waiting -= 1
        a, b = waiting[n_waiting, 0], waiting[n_waiting, 1]
        if _bound(bounds, a, b) <= longest:
            continue
        if cells[a, 2] < 0 and cells[b, 2] < 0:
            longest = max(longest, _longest_between(points, cells, a, b))
            continue
        if cells[b, 2] < 0 or (cells[a, 2] >= 0 and bounds[a, 7] >= bounds[b, 7]):
            divided, other = a, b
        else:
            divided, other = b, a
        for half in range(2):
            waiting[n_waiting, 0], waiting[n_waiting, 1] = cells[divided, 2 + half], other
            if a == b:
                waiting[n_waiting, 1] = cells[divided, 2 + half]
            n_waiting += 1
        if a == b:
            waiting[n_waiting, 0], waiting[n_waiting, 1] = cells[a, 2], cells[a, 3]
            n_waiting += 1
    return float(np.sqrt(longest))


@inner_kernel
def _longest_between(points: FloatArray, cells: IntArray, a: int, b: int) -> float:
    """Square of the largest distance between points of two leaves."""
    longest = 0.0
    for i in range(cells[a, 0], cells[a, 1]):
        for j in range(cells[b, 0], cells[b, 1]):
            chord = mixed(row(points, i), 1.0, row(points, j), -1.0)
            longest = max(longest, dot(chord, chord))
    return longest


@inner_kernel
def _first_guess(points: FloatArray) -> float:
    """Square of the distance of a point from the farthest one, taken from one to the next a few times."""
    longest, start = 0.0, 0
    for _ in range(4):
        farthest = start
        for i in range(len(points)):
            chord = mixed(row(points, i), 1.0, row(points, start), -1.0)
            if dot(chord, chord) > longest:
                longest, farthest = dot(chord, chord), i
        start = farthest
    return longest


def length_width_thickness(hull: Mesh) -> tuple[float, float, float]:
    """The three chords of a convex solid, in its unit of length.

    Raises GeometryError if the thickness cannot be found: a solid that is almost flat.
    """
    low, high = hull.bounds
    size = float((high - low).max())
    points = (hull.vertices - (low + high) / 2) / size
    start, end = _ends(points, longest_chord(points))
    length = float(np.linalg.norm(end - start))
    along = (end - start) / length
    chord = _widest_chord(points, _edges(hull.faces), along)
    width = float(np.linalg.norm(chord))
    across = np.cross(along, chord / width)
    return size * length, size * width, size * _chord_along(points, across)


def _ends(points: FloatArray, length: float) -> tuple[FloatArray, FloatArray]:
    """Both ends of a longest chord, the first of equal ones."""
    away = np.linalg.norm(points, axis=1)
    # The distances of both ends from the origin add up to the length of the chord or more.
    far = points[away >= length * (1.0 - ROUNDING) - away.max()]
    distances = cdist(far, far)
    first, second = np.unravel_index(int((distances >= length * (1.0 - ROUNDING)).argmax()), distances.shape)
    return far[first], far[second]


def _edges(faces: IntArray) -> IntArray:
    """Every edge of a closed triangulation once, shape (e, 2)."""
    pairs = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    return np.unique(pairs, axis=0)


def _widest_chord(points: FloatArray, edges: IntArray, along: FloatArray) -> FloatArray:
    """The longest chord perpendicular to a direction.

    Its ends lie in one plane perpendicular to the direction. As this plane moves between two vertices, the
    square of the distance of two points on edges is convex, so that the longest is at the height of a vertex.
    """
    heights = points @ along
    low, high = np.sort(heights[edges], axis=1).T
    lower = np.where((heights[edges[:, 0]] <= heights[edges[:, 1]])[:, None], edges, edges[:, ::-1])
    longest, chord = 0.0, np.zeros(3)
    for height in np.unique(heights):
        crossing = (low <= height) & (high >= height)
        rise = (high - low)[crossing]
        share = np.where(rise > 0.0, (height - low[crossing]) / np.where(rise > 0.0, rise, 1.0), 0.0)
        starts, ends = points[lower[crossing, 0]], points[lower[crossing, 1]]
        section = np.concatenate([starts + share[:, None] * (ends - starts), ends[rise == 0.0]])
        # No chord is longer than the diagonal of the section's box: few sections are compared in pairs.
        if len(section) < 2 or float(np.linalg.norm(np.ptp(section, axis=0))) <= longest:
            continue
        distances = cdist(section, section)
        first, second = np.unravel_index(int(distances.argmax()), distances.shape)
        if distances[first, second] > longest * (1.0 + ROUNDING):
            longest, chord = float(distances[first, second]), section[second] - section[first]
    return np.asarray(chord - (chord @ along) * along)


def _chord_along(points: FloatArray, direction: FloatArray) -> float:
    """The longest chord in a direction: a linear program in its lower end and its length."""
    planes = ConvexHull(points).equations
    normals, offsets = planes[:, :3], -planes[:, 3]
    rise = normals @ direction
    both = np.concatenate([np.column_stack([normals, 0.0 * rise]), np.column_stack([normals, rise])])
    optimum = linprog([0, 0, 0, -1], both, np.tile(offsets, 2), bounds=[(None, None)] * 3 + [(0, None)])
    if optimum.x is None:
        raise GeometryError("The thickness cannot be found: the solid is almost flat.")
    return float(optimum.x[3])
