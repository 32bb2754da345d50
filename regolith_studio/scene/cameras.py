"""Camera poses as values: read from one plotter, applied to another.

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

    Parameters
    ----------
    label
        For menus.
    towards_eye
        From the particle to the eye.
    up
        Which way is up in the picture.
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

MARGIN = 1.16
"""Half the shorter side of the picture over the radius of what it frames."""


@dataclass(frozen=True)
class CameraPose:
    """Where a camera stands and what it shows; parallel projection.

    Parameters
    ----------
    position, focal_point
        In the unit of the scene.
    view_up
        Direction that is up in the picture.
    parallel_scale
        Half the height of the picture, in the unit of the scene.
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
    points: ArrayLike, direction: str = "isometric", aspect: float = 1.0, margin: float = MARGIN
) -> CameraPose:
    """The pose that shows points whole, whichever way they are turned.

    Parameters
    ----------
    points
        Vertices, or corners of a box, shape (n, 3).
    direction
        A key of :data:`DIRECTIONS`.
    aspect
        Width of the picture over its height.
    margin
        Half the shorter side of the picture over the radius of the sphere about all points.
    """
    places = np.asarray(points, dtype=np.float64)
    centre = (places.min(axis=0) + places.max(axis=0)) / 2
    radius = max(float(np.linalg.norm(places - centre, axis=1).max()), 1e-12)
    view = DIRECTIONS[direction]
    towards = np.asarray(view.towards_eye) / np.linalg.norm(view.towards_eye)
    eye = centre + 4.0 * radius * towards
    scale = radius * margin / min(1.0, max(aspect, 1e-3))
    return CameraPose(_vector(eye), _vector(centre), view.up, scale)


def turned(pose: CameraPose, direction: str) -> CameraPose:
    """The pose that looks at the same point, at the same scale, from a standard direction."""
    view = DIRECTIONS[direction]
    focus = np.asarray(pose.focal_point)
    distance = float(np.linalg.norm(np.asarray(pose.position) - focus))
    towards = np.asarray(view.towards_eye) / np.linalg.norm(view.towards_eye)
    return CameraPose(_vector(focus + distance * towards), pose.focal_point, view.up, pose.parallel_scale)


def refitted(pose: CameraPose, before: float, after: float) -> CameraPose:
    """The pose that shows as much along the shorter side of a picture as one of another shape showed.

    Parameters
    ----------
    before, after
        Width over height of the two pictures.
    """
    share = min(1.0, max(before, 1e-3)) / min(1.0, max(after, 1e-3))
    return replace(pose, parallel_scale=pose.parallel_scale * share)


def _vector(values: FloatArray) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
