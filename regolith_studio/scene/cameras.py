"""Camera poses as values, and how the mouse orbits, pans, zooms and rolls them.

The views are linked by copying values, never by sharing a camera object: a shared camera repaints
only the view that moved, and keeps the clipping range of the other's surface.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.messages import N_

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Direction:
    """A direction to look from.

    - ``label``: for menus.
    - ``towards_eye``: from the particle to the eye.
    - ``up``: which way is up in the picture.
    """

    label: str
    towards_eye: Vector
    up: Vector


DIRECTIONS: Mapping[str, Direction] = MappingProxyType(
    {
        "isometric": Direction(N_("Isometric"), (1.0, -1.0, 0.8), (0.0, 0.0, 1.0)),
        "front": Direction(N_("Front (from -y)"), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
        "back": Direction(N_("Back (from +y)"), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
        "left": Direction(N_("Left (from -x)"), (-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
        "right": Direction(N_("Right (from +x)"), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
        "top": Direction(N_("Top (from +z)"), (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
        "bottom": Direction(N_("Bottom (from -z)"), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)),
    }
)

FILLED = 0.85
"""Share of the shorter side of a picture that is filled by what it frames."""


@dataclass(frozen=True)
class CameraPose:
    """Position and direction of a camera in parallel projection.

    - ``position``, ``focal_point``: in the unit of the scene.
    - ``view_up``: direction that is up in the picture.
    - ``parallel_scale``: half the height of the picture, in the unit of the scene.
    """

    position: Vector
    focal_point: Vector
    view_up: Vector
    parallel_scale: float


def pose_of(plotter: Any) -> CameraPose:
    """The pose of a plotter's camera."""
    camera = plotter.camera
    return CameraPose(
        tuple(camera.GetPosition()),
        tuple(camera.GetFocalPoint()),
        tuple(camera.GetViewUp()),
        float(camera.GetParallelScale()),
    )


def apply_pose(plotter: Any, pose: CameraPose) -> None:
    """Give a plotter's camera a pose and fit its clipping range to what the plotter shows."""
    camera = plotter.camera
    camera.SetParallelProjection(True)
    camera.SetPosition(*pose.position)
    camera.SetFocalPoint(*pose.focal_point)
    camera.SetViewUp(*pose.view_up)
    camera.SetParallelScale(pose.parallel_scale)
    plotter.renderer.ResetCameraClippingRange()


def framing_pose(
    points: ArrayLike, direction: str | Direction = "isometric", aspect: float = 1.0, *, turning: bool = False
) -> CameraPose:
    """The pose that fills the shorter side of a picture with points.

    - ``points``: vertices, or corners of a box, shape (n, 3).
    - ``direction``: a key of :data:`DIRECTIONS`, or another direction.
    - ``aspect``: width of the picture over its height.
    - ``turning``: whether the points stay in the picture however they are turned; they are smaller then.
    """
    places = np.asarray(points, dtype=np.float64)
    centre = (places.min(axis=0) + places.max(axis=0)) / 2
    radius = max(float(np.linalg.norm(places - centre, axis=1).max()), 1e-12)
    view = DIRECTIONS[direction] if isinstance(direction, str) else direction
    towards = np.asarray(view.towards_eye) / np.linalg.norm(view.towards_eye)
    side = np.cross(view.up, towards)
    side /= np.linalg.norm(side)
    seen = np.column_stack([(places - centre) @ side, (places - centre) @ np.cross(towards, side)])
    middle = (seen.min(axis=0) + seen.max(axis=0)) / 2
    half = max(float(np.ptp(seen, axis=0).max()) / 2, 1e-12)
    if turning:
        middle, half = np.zeros(2), radius
    focus = centre + middle[0] * side + middle[1] * np.cross(towards, side)
    scale = half / FILLED / min(1.0, max(aspect, 1e-3))
    return CameraPose(_vector(focus + 4.0 * radius * towards), _vector(focus), view.up, scale)


def filled(pose: CameraPose, points: ArrayLike, aspect: float) -> CameraPose:
    """The pose that fills width or height of a picture, whichever is filled first, with points."""
    focus, _, upward, side = _frame(pose)
    seen = np.asarray(points, dtype=np.float64) - focus
    half = max(float(np.abs(seen @ upward).max()), float(np.abs(seen @ side).max()) / max(aspect, 1e-3))
    return replace(pose, parallel_scale=max(half, 1e-12) / FILLED)


def turned(pose: CameraPose, direction: str) -> CameraPose:
    """The pose that looks at the same point, at the same scale, from a standard direction."""
    view = DIRECTIONS[direction]
    focus = np.asarray(pose.focal_point)
    distance = float(np.linalg.norm(np.asarray(pose.position) - focus))
    towards = np.asarray(view.towards_eye) / np.linalg.norm(view.towards_eye)
    return CameraPose(_vector(focus + distance * towards), pose.focal_point, view.up, pose.parallel_scale)


def refitted(pose: CameraPose, before: float, after: float) -> CameraPose:
    """The pose that shows as much along the shorter side of a picture as one of another shape showed.

    ``before``, ``after``: width over height of the two pictures.
    """
    share = min(1.0, max(before, 1e-3)) / min(1.0, max(after, 1e-3))
    return replace(pose, parallel_scale=pose.parallel_scale * share)


def _vector(values: FloatArray) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z


TURN = 2.6
"""Radians that a drag across the whole picture turns the particle by."""


def orbited(pose: CameraPose, right: float, up: float) -> CameraPose:
    """Turn about the focal point.

    ``right``, ``up``: how far was dragged, as shares of the picture's height.
    """
    focus, eye, upward, side = _frame(pose)
    about_up = _rotation(upward, -TURN * right)
    about_side = _rotation(about_up @ side, TURN * up)
    turn = about_side @ about_up
    return replace(pose, position=_vector(focus + turn @ (eye - focus)), view_up=_vector(turn @ upward))


def panned(pose: CameraPose, right: float, up: float) -> CameraPose:
    """Shift the picture with the mouse; distances as in :func:`orbited`."""
    focus, eye, upward, side = _frame(pose)
    step = -2.0 * pose.parallel_scale * (right * side + up * upward)
    return replace(pose, position=_vector(eye + step), focal_point=_vector(focus + step))


def zoomed(pose: CameraPose, factor: float) -> CameraPose:
    """Show everything `factor` times as large."""
    return replace(pose, parallel_scale=pose.parallel_scale / factor)


def rolled(pose: CameraPose, angle: float) -> CameraPose:
    """Turn the picture counter-clockwise by `angle` in radians."""
    focus, eye, upward, _ = _frame(pose)
    towards = (eye - focus) / np.linalg.norm(eye - focus)
    return replace(pose, view_up=_vector(_rotation(towards, -angle) @ upward))


def _frame(pose: CameraPose) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Focal point, eye, and the unit vectors that are up and right in the picture."""
    focus, eye = np.asarray(pose.focal_point), np.asarray(pose.position)
    forward = (focus - eye) / np.linalg.norm(focus - eye)
    side = np.cross(forward, pose.view_up)
    side /= np.linalg.norm(side)
    return focus, eye, np.cross(side, forward), side


def _rotation(axis: FloatArray, angle: float) -> FloatArray:
    """Rotation matrix about a unit axis (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross)


END_ON = 0.25
"""Length at which a unit vector is seen below which it counts as seen end on."""


@dataclass(frozen=True)
class Projection:
    """A camera pose and the size of the picture that it fills.

    ``width``, ``height``: in pixels.
    """

    pose: CameraPose
    width: float
    height: float

    @property
    def per_pixel(self) -> float:
        """Length that a pixel shows, in the unit of the scene."""
        return 2.0 * self.pose.parallel_scale / max(self.height, 1.0)

    @property
    def axes(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Unit vectors to the right, up, and into the picture."""
        focus, eye = np.asarray(self.pose.focal_point), np.asarray(self.pose.position)
        forward = (focus - eye) / np.linalg.norm(focus - eye)
        right = np.cross(forward, self.pose.view_up)
        right /= np.linalg.norm(right)
        return right, np.cross(right, forward), forward

    def ray(self, x: float, y: float) -> tuple[FloatArray, FloatArray]:
        """Where the line of sight through a pixel begins, and its direction; x to the right, y down."""
        right, up, forward = self.axes
        across = (x - self.width / 2) * self.per_pixel
        above = (self.height / 2 - y) * self.per_pixel
        return np.asarray(self.pose.position) + across * right + above * up, forward

    def seen(self, points: ArrayLike) -> FloatArray:
        """Pixels at which points of shape (n, 3) are seen, shape (n, 2)."""
        right, up, _ = self.axes
        step = np.atleast_2d(np.asarray(points, dtype=np.float64)) - np.asarray(self.pose.position)
        flat = np.stack([step @ right, -(step @ up)], axis=1) / self.per_pixel
        return np.asarray(flat + np.array([self.width / 2, self.height / 2]))

    def along(self, direction: ArrayLike, right: float, down: float) -> float:
        """How far a drag of so many pixels moves a point along a unit direction.

        A direction that is seen nearly end on follows the drag upwards instead.
        """
        side, up, forward = self.axes
        towards = np.asarray(direction, dtype=np.float64)
        flat = np.array([towards @ side, -(towards @ up)])
        square = float(flat @ flat)
        if square < END_ON**2:
            return float(np.sign(forward @ towards or 1.0) * -down * self.per_pixel)
        return float(flat @ [right, down]) * self.per_pixel / square
