"""Length, width and thickness of a convex solid by chords, as tables of simulants give them.

The length is the longest chord, the width the longest one perpendicular to it, the thickness the longest one
perpendicular to both. For an ellipsoid they are its axes; of a cuboid the length is the space diagonal, where
its bounding box has the longest edge.
"""

import numpy as np
from scipy.optimize import linprog
from scipy.spatial import ConvexHull
from scipy.spatial.distance import cdist

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.feret import longest_chord
from regolith_studio.geometry.mesh import Mesh

ROUNDING = 1e-12
"""By how much a chord may be shorter than the longest and count as it, as a share of it."""


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
