"""Parallel projection from points of the scene to points of the picture and back."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.scene.cameras import CameraPose

END_ON = 0.25
"""Length at which a unit vector is seen below which it counts as seen end on."""


@dataclass(frozen=True)
class Projection:
    """A camera pose and the size of the picture that it fills.

    Parameters
    ----------
    width, height
        In pixels.
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
