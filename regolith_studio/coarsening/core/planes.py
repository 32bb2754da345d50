"""Coordinates of small moves of planes: one shift and two tilts each.

Plane i turns about its pivot: n' = normalise(n + (t1 e1 + t2 e2) / rho), h' = <n', pivot> + s, with
tangents e1, e2 and a lever rho, so that all three coordinates are lengths. The plane's speed at x is
w(x) = ds - <dt1 e1 + dt2 e2, x - pivot> / rho.
"""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.vectors import cross, dot, length, mixed, row


def tangents_of(normals: FloatArray) -> FloatArray:
    """Two tangents of each plane, shape (n, 2, 3)."""
    first = np.cross(normals, np.eye(3)[np.abs(normals).argmin(axis=1)])
    first /= np.sqrt((first * first).sum(axis=1))[:, None]
    return np.stack([first, np.cross(normals, first)], axis=1)


@kernel
def carried(frames: FloatArray, normals: FloatArray) -> FloatArray:
    """Tangents carried over to new normals without twist."""
    moved = np.empty(frames.shape)
    for i in range(len(normals)):
        normal, first = row(normals, i), row(frames[i], 0)
        first = mixed(first, 1.0, normal, -dot(first, normal))
        first = mixed(first, 1.0 / length(first), first, 0.0)
        second = cross(normal, first)
        for c in range(3):
            moved[i, 0, c], moved[i, 1, c] = first[c], second[c]
    return moved


@kernel
def levers_of(area: FloatArray, least: float) -> FloatArray:
    """rho of each plane: the radius of its facet, but not below `least`."""
    return np.maximum(np.sqrt(np.maximum(area, 0.0) / np.pi), least)


@kernel
def gradient_of(charge: FloatArray, frames: FloatArray, levers: FloatArray) -> FloatArray:
    """Derivative with respect to the coordinates (s, t1, t2) of every plane, shape (3 n,)."""
    n = len(charge)
    gradient = np.empty(3 * n)
    for i in range(n):
        gradient[3 * i] = charge[i, 0]
        for k in range(2):
            gradient[3 * i + 1 + k] = (
                -(
                    charge[i, 1] * frames[i, k, 0]
                    + charge[i, 2] * frames[i, k, 1]
                    + charge[i, 3] * frames[i, k, 2]
                )
                / levers[i]
            )
    return gradient


@kernel
def moved(
    normals: FloatArray,
    pivots: FloatArray,
    offsets: FloatArray,
    frames: FloatArray,
    levers: FloatArray,
    step: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Normals and offsets after a step in the coordinates (s, t1, t2) of every plane, shape (3 n,)."""
    n = len(normals)
    turned = np.empty((n, 3))
    shifted = np.empty(n)
    for i in range(n):
        t1, t2 = step[3 * i + 1] / levers[i], step[3 * i + 2] / levers[i]
        length = np.sqrt(1.0 + t1 * t1 + t2 * t2)
        for c in range(3):
            turned[i, c] = (normals[i, c] + t1 * frames[i, 0, c] + t2 * frames[i, 1, c]) / length
        shifted[i] = step[3 * i] + offsets[i] / length
        tilt = 0.0
        for c in range(3):
            tilt += (turned[i, c] - normals[i, c] / length) * pivots[i, c]
        shifted[i] += tilt
    return turned, shifted
