"""How a drag of the mouse moves a camera: pure functions of the pose, the same in every view."""

import dataclasses

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.scene.cameras import CameraPose, Vector

TURN = 2.6
"""Radians that a drag across the whole picture turns the particle by."""


def orbited(pose: CameraPose, right: float, up: float) -> CameraPose:
    """Turn about the focal point.

    Parameters
    ----------
    right, up
        How far was dragged, as shares of the picture's height.
    """
    focus, eye, upward, side = _frame(pose)
    about_up = _rotation(upward, -TURN * right)
    about_side = _rotation(about_up @ side, TURN * up)
    turn = about_side @ about_up
    return dataclasses.replace(
        pose, position=_vector(focus + turn @ (eye - focus)), view_up=_vector(turn @ upward)
    )


def panned(pose: CameraPose, right: float, up: float) -> CameraPose:
    """Shift the picture with the mouse; distances as in :func:`orbited`."""
    focus, eye, upward, side = _frame(pose)
    step = -2.0 * pose.parallel_scale * (right * side + up * upward)
    return dataclasses.replace(pose, position=_vector(eye + step), focal_point=_vector(focus + step))


def zoomed(pose: CameraPose, factor: float) -> CameraPose:
    """Show everything `factor` times as large."""
    return dataclasses.replace(pose, parallel_scale=pose.parallel_scale / factor)


def rolled(pose: CameraPose, angle: float) -> CameraPose:
    """Turn the picture counter-clockwise by `angle` in radians."""
    focus, eye, upward, _ = _frame(pose)
    towards = (eye - focus) / np.linalg.norm(eye - focus)
    return dataclasses.replace(pose, view_up=_vector(_rotation(towards, -angle) @ upward))


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


def _vector(values: FloatArray) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
