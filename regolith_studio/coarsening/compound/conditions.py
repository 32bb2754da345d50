"""Conditions on the descriptors of a union of convex parts: residuals and their derivatives."""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.compound.exposed_edges import add_exposed_surface_charges
from regolith_studio.coarsening.compound.hull import HullOfParts, add_hull_charges, hull_of, hull_solid
from regolith_studio.coarsening.compound.measures import (
    MeasuredCompound,
    Planes,
    is_one_body,
    measure_compound,
    parts_overlap,
)
from regolith_studio.coarsening.compound.scan_lines import ScanLines
from regolith_studio.coarsening.core.box_gradient import (
    GradientWorkspace,
    fill_extent_gradients,
    gradient_workspace,
)
from regolith_studio.coarsening.core.box_search import LocalBoxes, local_boxes
from regolith_studio.coarsening.core.intersection import FINE
from regolith_studio.coarsening.core.plane_coordinates import (
    fill_gradient,
    fill_tilt_scales,
    moved_planes,
    tangents_of,
)
from regolith_studio.coarsening.core.polyhedron_measures import MeasuredPolyhedron, add_volume_charges
from regolith_studio.coarsening.core.tracked_boxes import TrackedBoxes, select_boxes, track_boxes
from regolith_studio.geometry.arrays import FloatArray, IntArray

KEYS = (
    "volume",
    "sphericity",
    "min_diameter",
    "max_diameter",
    "aspect_ratio",
    "convex_hull_volume",
)
"""Descriptors that can be conditions, in this order everywhere."""
MARGIN = 0.04
"""Boxes up to this share larger than the least are found."""
TRACKED = 6e-3
"""Other boxes within this share are followed."""
CLEARANCE, PUSHED_CLEARANCE = 1e-4, 2e-4
"""Other boxes must be larger than the wanted one by the first share; else they are pushed to the second."""
CLOSE = 2e-3
"""Other boxes within this share take part in the steps."""
MAX_RIVALS = 8


class CompoundProblem(NamedTuple):
    """A particle's lines and the descriptors to be met.

    Parameters
    ----------
    lines
        Of the particle.
    wanted
        Natural logarithms of the descriptors of :data:`KEYS`, shape (6,).
    asked
        Indices of those that are conditions.
    sample_angle
        Of the search for boxes, in radians.
    """

    lines: ScanLines
    wanted: FloatArray
    asked: IntArray
    sample_angle: float

    @property
    def needs_box(self) -> bool:
        """Whether a condition is about the box."""
        return any(2 <= each <= 4 for each in self.asked.tolist())


class CompoundPoint(NamedTuple):
    """A union of convex parts with n planes, and the conditions on it.

    Parameters
    ----------
    compound, hull
        Measured.
    tangents, scales
        Of the planes, as in :mod:`regolith_studio.coarsening.core.plane_coordinates`.
    logs
        Logarithms of the descriptors of :data:`KEYS`; NaN where nobody asks.
    residual, rows
        Of the m conditions, and their derivatives; (m,) and (m, 3 n).
    slack, rival_rows
        log(volume / volume of the wanted box) of r other boxes, and its derivative; (r,) and (r, 3 n).
    tracked
        The wanted box and others to be followed; ``None`` where no box is asked for.
    """

    compound: MeasuredCompound
    hull: HullOfParts
    tangents: FloatArray
    scales: FloatArray
    logs: FloatArray
    residual: FloatArray
    rows: FloatArray
    slack: FloatArray
    rival_rows: FloatArray
    tracked: TrackedBoxes | None

    @property
    def planes(self) -> Planes:
        """Half-spaces of all parts."""
        return self.compound.planes

    @property
    def worst(self) -> float:
        """Largest residual, counting boxes that undercut the wanted one."""
        below = CLEARANCE - self.slack
        return float(max(np.abs(self.residual).max(initial=0.0), below.max(initial=0.0)))


def point_of(
    problem: CompoundProblem,
    planes: Planes,
    tangents: FloatArray | None = None,
    near: TrackedBoxes | None = None,
) -> CompoundPoint | None:
    """The union with its conditions, or ``None`` where it cannot be measured or is not one body.

    Parameters
    ----------
    tangents
        Of the planes, shape (n, 2, 3); any where not given.
    near
        Boxes that are followed; searched for everywhere where not given or lost.
    """
    compound = measure_compound(planes)
    if compound is None or not compound.volume > 0.0:
        return None
    if parts_overlap(compound) or not is_one_body(compound):
        return None
    hull = hull_of(compound.vertices)
    boxes = None if hull is None else _boxes(problem, compound, hull, near)
    if hull is None or boxes is None:
        return None
    tangents = tangents_of(planes.normals) if tangents is None else tangents
    scales = np.empty(len(planes.offsets))
    fill_tilt_scales(compound.areas, scales)
    return _with_conditions(problem, compound, hull, tangents, scales, boxes)


def stepped(problem: CompoundProblem, point: CompoundPoint, step: FloatArray) -> CompoundPoint | None:
    """The union after a step in the coordinates of every plane, (3 n,); boxes are followed."""
    compound = point.compound
    planes = compound.planes
    normals, offsets, tangents = moved_planes(
        planes.normals, compound.centroids, planes.offsets, point.tangents, point.scales, step
    )
    return point_of(problem, planes._replace(normals=normals, offsets=offsets), tangents, point.tracked)


def searched(problem: CompoundProblem, point: CompoundPoint) -> CompoundPoint | None:
    """The same union with boxes searched for everywhere."""
    if not problem.needs_box:
        return point
    compound, hull = point.compound, point.hull
    boxes = _boxes(problem, compound, hull, None)
    if boxes is None:
        return None
    return _with_conditions(problem, compound, hull, point.tangents, point.scales, boxes)


_NO_BOXES = LocalBoxes(np.empty(0), np.empty((0, 3, 3)), np.empty((0, 3)), np.empty((0, 13), np.int64))


def _boxes(
    problem: CompoundProblem, compound: MeasuredCompound, hull: HullOfParts, near: TrackedBoxes | None
) -> LocalBoxes | None:
    """Boxes near the least one, the wanted one first; none where no condition is about the box."""
    if not problem.needs_box:
        return _NO_BOXES
    if near is not None:
        n = len(compound.areas)
        boxes, lost = track_boxes(compound.vertices, compound.triples, n, near)
        if lost is None or not lost[0]:
            return boxes
    solid = hull_solid(hull, compound.vertices)
    boxes = local_boxes(solid, MARGIN, problem.sample_angle)
    return _wanted_first(problem, boxes) if len(boxes.volumes) else None


def _wanted_first(problem: CompoundProblem, boxes: LocalBoxes) -> LocalBoxes:
    """The box nearest to the wanted size and not far above the least, then others about as large."""
    logs = np.log(boxes.volumes)
    sizes = _box_logs(np.log(boxes.extents))
    asked = problem.asked[(problem.asked >= 2) & (problem.asked <= 4)]
    off = logs + np.abs(sizes[:, asked - 2] - problem.wanted[asked]).sum(axis=1)
    wanted = int(np.argmin(off))
    apart = logs - logs[wanted]
    others = np.argsort(apart)
    others = others[(others != wanted) & (apart[others] < TRACKED)][:MAX_RIVALS]
    return boxes.selected(np.concatenate([[wanted], others]))


def _box_logs(extents: FloatArray) -> FloatArray:
    """Logarithms of shortest edge, longest edge and their ratio from those of all edges, (k, 3)."""
    low, high = extents.min(axis=1), extents.max(axis=1)
    return np.column_stack([low, high, high - low])


def _with_conditions(
    problem: CompoundProblem,
    compound: MeasuredCompound,
    hull: HullOfParts,
    tangents: FloatArray,
    scales: FloatArray,
    boxes: LocalBoxes,
) -> CompoundPoint:
    n, pivots = len(scales), compound.centroids
    volume, surface = compound.volume, compound.surface_area
    logs, rows = np.full(6, np.nan), np.zeros((6, 3 * n))
    charges = np.zeros((3, n, 4))
    add_volume_charges(np.maximum(compound.areas, 0.0), 1.0 / volume, charges[0])
    normals = compound.planes.normals
    add_exposed_surface_charges(
        normals, compound.ends, compound.edge_planes, pivots, 1.0 / surface, charges[1]
    )
    charges[1] = charges[0] * (2.0 / 3.0) - charges[1]
    add_hull_charges(compound, hull, 1.0 / hull.volume, charges[2])
    for which, condition in enumerate((0, 1, 5)):
        fill_gradient(charges[which], tangents, scales, rows[condition])
    logs[0], logs[5] = np.log(volume), np.log(hull.volume)
    logs[1] = np.log(np.pi) / 3.0 + np.log(6.0 * volume) * 2.0 / 3.0 - np.log(surface)
    slack, rival_rows, tracked = np.empty(0), np.empty((0, 3 * n)), None
    if problem.needs_box:
        tracked = select_boxes(boxes, np.arange(len(boxes.volumes)), compound.triples)
        slack, rival_rows = _fill_box(compound, tangents, scales, boxes, logs, rows)
    asked, free = problem.asked, compound.planes.free
    residual = (logs - problem.wanted)[asked]
    return CompoundPoint(
        compound,
        hull,
        tangents,
        scales,
        logs,
        residual,
        rows[asked] * free,
        slack,
        rival_rows * free,
        tracked,
    )


def _fill_box(
    compound: MeasuredCompound,
    tangents: FloatArray,
    scales: FloatArray,
    boxes: LocalBoxes,
    logs: FloatArray,
    rows: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Fill what is about the box; slack and derivatives of the others."""
    apart = np.log(boxes.volumes / boxes.volumes[0])
    close = np.flatnonzero(apart < CLOSE)
    close = close[close > 0]
    work = gradient_workspace(len(scales))
    shape = _as_polyhedron(compound)
    volume_row = np.zeros(rows.shape[1])
    rival_rows = np.empty((len(close), rows.shape[1]))
    for at, b in enumerate([0, *close.tolist()]):
        _extent_gradients(shape, boxes, b, tangents, scales, work)
        total = work.gradients.sum(axis=0)
        if at > 0:
            rival_rows[at - 1] = total - volume_row
            continue
        volume_row = total
        low, high = int(work.logs.argmin()), int(work.logs.argmax())
        logs[2], logs[3], logs[4] = work.logs[low], work.logs[high], work.logs[high] - work.logs[low]
        rows[2], rows[3] = work.gradients[low], work.gradients[high]
        rows[4] = rows[3] - rows[2]
    return apart[close], rival_rows


def _extent_gradients(
    shape: MeasuredPolyhedron,
    boxes: LocalBoxes,
    b: int,
    tangents: FloatArray,
    scales: FloatArray,
    work: GradientWorkspace,
) -> None:
    fill_extent_gradients(shape, boxes.frames[b], boxes.contacts[b], tangents, scales, work)


def _as_polyhedron(compound: MeasuredCompound) -> MeasuredPolyhedron:
    """Corners of all parts as those of one polyhedron, for the derivatives of boxes."""
    normals, offsets = compound.planes[:2]
    return MeasuredPolyhedron(
        FINE,
        normals,
        offsets,
        compound.vertices,
        compound.triples,
        np.empty((0, 4), dtype=np.int64),
        compound.areas,
        compound.centroids,
        compound.volume,
        compound.surface_area,
    )
