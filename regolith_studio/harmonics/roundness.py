"""Wadell's roundness (1932) of an outline, and of the broadest section of a fitted particle."""

import numpy as np
from scipy.spatial import Delaunay

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.radius_function import best_fit_ellipsoid
from regolith_studio.harmonics.synthesis import radii, reconstruct

N_OUTLINE = 1024
"""Points of a section: 34 for each of the 30 waves round it at degree 30."""
N_INSCRIBED = 256
"""Points that are enough for the inscribed circle: its radius is then at most 1e-4 too large."""
# Ten times the error of the inscribed radius, by which every arc of the inscribed circle would be a corner.
MIN_EXCESS = 1e-3
"""A corner is sharper than the inscribed circle by at least this share."""

MAX_RIPPLE = np.pi / 4
"""Angle that a stretch of a section turns by at most if it is to count as a ripple of the series."""
MIN_AREA = 1e-12
"""Twice a triangle's area over the square of the curve's size, up to which its corners are collinear."""


def wadell_roundness(fit: HarmonicFit) -> float:
    """Roundness of the section of a fit in the plane of its longest and middle principal axes.

    Wadell's "total degree of roundness in one plane": see :func:`outline_roundness`. The plane is the one
    that a particle at rest shows from above, and goes through the star point. Stretches that turn by less
    than one wave of the highest degree, 2 pi / l_max, or by less than 45 degrees at low ones, are ripples of
    the series on flat sides and no corners. Corners are those of the expansion: a fit of a higher degree has
    more and sharper ones, so that only values of one l_max can be compared.

    Raises GeometryError if the expansion has a negative radius.
    """
    axes = best_fit_ellipsoid(reconstruct(fit)).axes
    angles = np.linspace(0.0, 2 * np.pi, N_OUTLINE, endpoint=False)
    circle = np.column_stack((np.cos(angles), np.sin(angles)))
    radius = radii(fit, circle @ axes[:2])
    if radius.min() <= 0:
        raise GeometryError(f"The expansion has a negative radius at l_max = {fit.l_max}.")
    ripple = min(2 * np.pi / fit.l_max, MAX_RIPPLE) if fit.l_max else 0.0
    return outline_roundness(circle * radius[:, None], ripple)


def outline_roundness(points: FloatArray, min_turn: float = 0.0) -> float:
    """Wadell's roundness of a closed curve: mean radius of its corners over that of the inscribed circle.

    A corner is a stretch of the curve that bends more than the largest inscribed circle; its radius is the
    smallest radius of curvature there, that of the largest circle that touches it from inside. 1 where there
    is no corner, towards 0 for sharp ones. H. Wadell, Volume, shape, and roundness of rock particles,
    J. Geol. 40 (1932) 443-451.

    ``points``: along the curve, counter-clockwise, closed by the first one, shape (n, 2); close enough to
    resolve its corners. ``min_turn``: angle in radians that a corner turns by at least.
    """
    curvature = _curvature(points)
    bend = curvature * inscribed_radius(points[:: max(1, len(points) // N_INSCRIBED)])
    turn = curvature * _length(np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)) / 2
    corners = [run for run in _runs(bend > 1 + MIN_EXCESS) if turn[run].sum() >= min_turn]
    return float(np.mean([1 / bend[run].max() for run in corners])) if corners else 1.0


def inscribed_radius(points: FloatArray) -> float:
    """Radius of the largest circle inside a closed curve of points (n, 2).

    The largest circumcircle of the Delaunay triangles inside, whose error is of second order in the
    distance of the points.
    """
    size = float(np.ptp(points))
    scaled = (points - points.mean(axis=0)) / size
    triangles = scaled[np.sort(Delaunay(scaled).simplices)]  # along the curve: counter-clockwise inside
    first, second, third = (triangles[:, k] for k in range(3))
    doubled_area = _cross(second - first, third - first)
    sides = _length(second - first) * _length(third - second) * _length(first - third)
    inside = doubled_area > MIN_AREA
    return size * float((sides[inside] / (2 * doubled_area[inside])).max())


def _curvature(points: FloatArray) -> FloatArray:
    """Signed curvature (n,): of the circle through each point and its neighbours, exact on arcs (Menger)."""
    before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
    sides = _length(points - before) * _length(after - points) * _length(after - before)
    return np.asarray(2 * _cross(points - before, after - points) / sides)


def _runs(chosen: BoolArray) -> list[IntArray]:
    """Indices of each stretch of a closed sequence that is chosen throughout."""
    if chosen.all() or not chosen.any():
        return [np.arange(len(chosen))] if chosen.any() else []
    # Beginning at a point that is not chosen, no run is split where the curve closes.
    start = int(np.argmin(chosen))
    order = np.roll(np.arange(len(chosen)), -start)
    borders = np.flatnonzero(np.diff(chosen[order].astype(int))) + 1
    return [run for run in np.split(order, borders) if chosen[run[0]]]


def _cross(one: FloatArray, other: FloatArray) -> FloatArray:
    return np.asarray(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])


def _length(vectors: FloatArray) -> FloatArray:
    return np.asarray(np.hypot(vectors[:, 0], vectors[:, 1]))
