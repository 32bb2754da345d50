"""Constraints on the descriptors of a polyhedron: residuals and their derivatives with the planes."""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.box import Solid
from regolith_studio.coarsening.core.box_gradient import (
    GradientWorkspace,
    fill_extent_gradients,
    gradient_workspace,
)
from regolith_studio.coarsening.core.box_search import LocalBoxes, empty_boxes, likeness, local_boxes
from regolith_studio.coarsening.core.intersection import FINE
from regolith_studio.coarsening.core.plane_coordinates import fill_gradient, fill_tilt_scales, tangents_of
from regolith_studio.coarsening.core.polyhedron_measures import (
    MeasuredPolyhedron,
    add_surface_charges,
    measure_polyhedron,
)
from regolith_studio.coarsening.core.tracked_boxes import (
    ALIKE,
    TrackedBoxes,
    lost_box_axes,
    merge_boxes,
    select_boxes,
    track_boxes,
)
from regolith_studio.coarsening.target import RayTable
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel_noalloc
from regolith_studio.geometry.vectors import row

VOLUME, SPHERICITY, SHORTEST, LONGEST, RATIO = 0, 1, 2, 3, 4
"""Constraints, in this order everywhere."""
MARGIN = 0.04
"""Boxes up to this share larger than the least are found."""
CLEARANCE = 1e-4
"""Other boxes must be larger than the wanted one by this share."""
PUSHED_CLEARANCE = 2e-4
"""Where they are not, they are pushed to this share."""
CLOSE = 2e-3
"""Other boxes within this share take part in the steps."""
TRACKED = 0.02
"""Other boxes within this share are looked for at every step."""
MAX_RIVALS = 8

_EVERYWHERE = np.empty((0, 3))
_NO_BOXES = empty_boxes(0)
_NO_ROWS = np.empty(0), np.empty((0, 0))
_NOT_TRACKED = TrackedBoxes(
    np.empty((0, 3, 3)), np.empty((0, 13), dtype=np.int64), np.empty((0, 9, 3), dtype=np.int64)
)
_FIRST, _ZERO = np.zeros(1, dtype=np.int64), np.zeros(1)


class Problem(NamedTuple):
    """A particle's rays and the descriptors to be met.

    Parameters
    ----------
    rays
        Of the particle.
    wanted
        Natural logarithm of volume, sphericity, shortest and longest box edge, aspect ratio, shape (5,).
    asked
        Which of them are constraints, shape (5,).
    sample_angle
        Of the search for boxes, in radians.
    held
        So many of the half-spaces, the first ones, never move.
    """

    rays: RayTable
    wanted: FloatArray
    asked: BoolArray
    sample_angle: float
    held: int

    @property
    def needs_box(self) -> bool:
        """Whether a constraint is about the box."""
        return bool(self.asked[SHORTEST] or self.asked[LONGEST] or self.asked[RATIO])


class ConstrainedPoint(NamedTuple):
    """A polyhedron with n half-spaces, and the constraints on it.

    Parameters
    ----------
    polyhedron
        Measured.
    tangents, scales
        Of the planes, as in :mod:`regolith_studio.coarsening.core.plane_coordinates`.
    boxes
        Locally minimal boxes near the least; none where no constraint is about the box.
    residual, rows
        Of the m asked descriptors in logarithms, and their derivatives; shapes (m,) and (m, 3 n).
    slack, rival_rows
        log(volume / volume of the wanted box) of r other boxes, and its derivative; (r,) and (r, 3 n).
    tracked
        The wanted box and others that are to be looked for; ``None`` where no box is asked for.
    worst
        Largest residual, counting boxes that undercut the wanted one; infinite where something could not be
        measured.
    """

    polyhedron: MeasuredPolyhedron
    tangents: FloatArray
    scales: FloatArray
    boxes: LocalBoxes
    residual: FloatArray
    rows: FloatArray
    slack: FloatArray
    rival_rows: FloatArray
    tracked: TrackedBoxes | None
    worst: float

    @property
    def normals(self) -> FloatArray:
        """Of the half-spaces, shape (n, 3)."""
        return self.polyhedron.normals

    @property
    def offsets(self) -> FloatArray:
        """Of the half-spaces, shape (n,)."""
        return self.polyhedron.offsets


def measure(problem: Problem, normals: FloatArray, offsets: FloatArray) -> ConstrainedPoint:
    """The polyhedron of half-spaces with its constraints; boxes are searched for everywhere."""
    return constrained(problem, normals, offsets, tangents_of(normals), None)


def search_everywhere(problem: Problem, point: ConstrainedPoint) -> ConstrainedPoint:
    """The same polyhedron with boxes searched for everywhere, besides those that it has."""
    if not problem.needs_box or point.polyhedron.status != FINE:
        return point
    polyhedron = point.polyhedron
    boxes = merge_boxes(point.boxes, _all_boxes(problem, polyhedron))
    return _with_constraints(problem, polyhedron, point.tangents, boxes)


def constrained(
    problem: Problem,
    normals: FloatArray,
    offsets: FloatArray,
    tangents: FloatArray,
    near: TrackedBoxes | None,
) -> ConstrainedPoint:
    """The polyhedron of half-spaces with its constraints.

    Parameters
    ----------
    tangents
        Of the planes, shape (n, 2, 3).
    near
        Boxes that are followed where they still are; ``None`` searches everywhere.
    """
    polyhedron = measure_polyhedron(normals, offsets)
    if polyhedron.status != FINE:
        return _broken(polyhedron, tangents)
    if not problem.needs_box:
        boxes = _NO_BOXES
    elif near is None:
        boxes = _all_boxes(problem, polyhedron)
    else:
        boxes = _boxes_near(problem, polyhedron, near)
    return _with_constraints(problem, polyhedron, tangents, boxes)


def _all_boxes(problem: Problem, polyhedron: MeasuredPolyhedron) -> LocalBoxes:
    return _boxes_along(problem, polyhedron, _EVERYWHERE)


def _boxes_along(problem: Problem, polyhedron: MeasuredPolyhedron, axes: FloatArray) -> LocalBoxes:
    _, normals, _, vertices, _, edges, areas, *_ = polyhedron
    solid = Solid(vertices, normals, areas, edges)
    return local_boxes(solid, MARGIN, problem.sample_angle, axes)


def _boxes_near(problem: Problem, polyhedron: MeasuredPolyhedron, near: TrackedBoxes) -> LocalBoxes:
    """The tracked boxes, or others near lost ones; all where the first of them is gone."""
    n = len(polyhedron.offsets)
    boxes, lost = track_boxes(polyhedron.vertices, polyhedron.triples, n, near)
    if lost is None:
        return boxes
    boxes = merge_boxes(boxes, _boxes_along(problem, polyhedron, lost_box_axes(near, lost)))
    first_found = (likeness(near.frames[:1], boxes.frames) >= ALIKE).any()
    return boxes if first_found else _all_boxes(problem, polyhedron)


def _with_constraints(
    problem: Problem, polyhedron: MeasuredPolyhedron, tangents: FloatArray, boxes: LocalBoxes
) -> ConstrainedPoint:
    """Residuals and derivatives; pivots are the facets' centroids."""
    n, close, asked = len(polyhedron.offsets), 0, problem.asked
    slack, tracked = _NO_ROWS[0], None
    if problem.needs_box:
        if len(boxes.volumes) == 0:
            return _broken(polyhedron, tangents)
        near, apart = _wanted_box_and_others(problem, boxes)
        close = int(np.count_nonzero(apart < CLOSE))
        tracked, slack = select_boxes(boxes, near, polyhedron.triples), apart[1:close]
    scales, values = np.empty(n), np.zeros(5)
    rows, rival_rows = np.empty((5, 3 * n)), np.empty((max(close - 1, 0), 3 * n))
    boxes_near = tracked or _NOT_TRACKED
    _fill_constraints(
        polyhedron,
        tangents,
        scales,
        boxes_near.frames,
        boxes_near.contacts,
        close,
        gradient_workspace(n),
        values,
        rows,
        rival_rows,
    )
    residual = (values - problem.wanted)[asked]
    worst = max([*map(abs, residual.tolist()), *(CLEARANCE - each for each in slack.tolist()), 0.0])
    return ConstrainedPoint(
        polyhedron, tangents, scales, boxes, residual, rows[asked], slack, rival_rows, tracked, worst
    )


def _broken(polyhedron: MeasuredPolyhedron, tangents: FloatArray) -> ConstrainedPoint:
    """Half-spaces that bound no polyhedron, or one of which no box was found."""
    return ConstrainedPoint(
        polyhedron, tangents, polyhedron.areas, _NO_BOXES, *_NO_ROWS, *_NO_ROWS, None, np.inf
    )


@kernel_noalloc
def _fill_constraints(
    polyhedron: MeasuredPolyhedron,
    tangents: FloatArray,
    scales: FloatArray,
    frames: FloatArray,
    contacts: IntArray,
    n_boxes: int,
    work: GradientWorkspace,
    values: FloatArray,
    rows: FloatArray,
    rival_rows: FloatArray,
) -> None:
    """Fill scales, logarithms of the descriptors, their derivatives, and those of the rivals' volumes.

    Parameters
    ----------
    frames, contacts, n_boxes
        The wanted box first; without boxes only volume and sphericity are filled.
    rival_rows
        Of the log volume of the other boxes over that of the wanted one, shape (n_boxes - 1, 3 n).
    """
    _, normals, _, vertices, _, edges, areas, pivots, volume, surface = polyhedron
    fill_tilt_scales(areas, scales)
    values[VOLUME], values[SPHERICITY] = np.log(volume), log_sphericity(volume, surface)
    work.charges[:] = 0.0
    add_surface_charges(normals, vertices, edges, pivots, 1.0 / surface, work.charges)
    fill_gradient(work.charges, tangents, scales, rows[SPHERICITY])
    for i in range(len(areas)):
        for c in range(3):
            rows[VOLUME, 3 * i + c] = areas[i] / volume if c == 0 else 0.0
    for j in range(3 * len(areas)):
        rows[SPHERICITY, j] = 2.0 / 3.0 * rows[VOLUME, j] - rows[SPHERICITY, j]
    for b in range(n_boxes):
        fill_extent_gradients(polyhedron, frames[b], contacts[b], tangents, scales, work)
        logs, change = work.logs, work.gradients
        low, high = 0, 0
        for k in range(1, 3):
            low = k if logs[k] < logs[low] else low
            high = k if logs[k] > logs[high] else high
        for j in range(3 * len(areas)):
            total = change[0, j] + change[1, j] + change[2, j]
            if b == 0:
                rows[SHORTEST, j], rows[LONGEST, j] = change[low, j], change[high, j]
                rows[RATIO, j] = change[high, j] - change[low, j]
                for other in range(1, n_boxes):
                    rival_rows[other - 1, j] = -total
            else:
                rival_rows[b - 1, j] += total
        if b == 0:
            values[SHORTEST], values[LONGEST] = logs[low], logs[high]
            values[RATIO] = logs[high] - logs[low]


def _wanted_box_and_others(problem: Problem, boxes: LocalBoxes) -> tuple[IntArray, FloatArray]:
    """Indices of the box that is to become the least and of others about as large, and log volumes over its.

    The others rise in volume.
    """
    if len(boxes.volumes) == 1:
        return _FIRST, _ZERO
    apart = np.empty(len(boxes.volumes))
    at = _wanted_box(boxes, problem.wanted, problem.asked, apart)
    near = np.argsort(apart)
    near = near[(apart[near] < TRACKED) & (near != at)]
    near = np.concatenate(([at], near[:MAX_RIVALS]))
    return near, apart[near]


@kernel_noalloc
def _wanted_box(boxes: LocalBoxes, wanted: FloatArray, asked: BoolArray, apart: FloatArray) -> int:
    """Index of the box that is near the wanted size and not far above the least.

    Fills `apart`: log(volume / volume of that box), shape (k,).
    """
    nearest, at = np.inf, 0
    for b in range(len(boxes.volumes)):
        one, two, three = row(boxes.extents, b)
        low, high = np.log(min(one, two, three)), np.log(max(one, two, three))
        apart[b] = np.log(boxes.volumes[b])
        off = apart[b]
        if asked[SHORTEST]:
            off += abs(low - wanted[SHORTEST])
        if asked[LONGEST]:
            off += abs(high - wanted[LONGEST])
        if asked[RATIO]:
            off += abs(high - low - wanted[RATIO])
        if off < nearest:
            nearest, at = off, b
    least = apart[at]
    for b in range(len(apart)):
        apart[b] -= least
    return at


@kernel_noalloc
def log_sphericity(volume: float, surface: float) -> float:
    """Natural logarithm of Wadell's sphericity."""
    return float(np.log(np.pi) / 3.0 + np.log(6.0 * volume) * 2.0 / 3.0 - np.log(surface))
