"""Coordinates of small moves of planes: one shift and two tilts each.

Plane i turns about its pivot: n' = normalise(n + (t1 e1 + t2 e2) / rho), h' = <n', pivot> + s, with
tangents e1, e2 and a scale rho, so that all three coordinates are lengths. The plane's speed at x is
w(x) = ds - <dt1 e1 + dt2 e2, x - pivot> / rho.
"""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import kernel_noalloc
from regolith_studio.geometry.vectors import Vector, along, cross, dot, length, mixed, row

MIN_TILT_SCALE = 0.08
"""Smallest scale of a tilt, in units of the particle's size (the cube root of its volume)."""


def tangents_of(normals: FloatArray) -> FloatArray:
    """Two tangents of each plane, shape (n, 2, 3)."""
    rows, least = np.arange(len(normals)), np.abs(normals).argmin(axis=1)
    one, two = (least + 1) % 3, (least + 2) % 3
    tangents = np.zeros((len(normals), 2, 3))
    first = tangents[:, 0]
    first[rows, one], first[rows, two] = normals[rows, two], -normals[rows, one]
    first /= np.sqrt((first * first).sum(axis=1))[:, None]
    # np.cross takes ten times as long for so few
    turned, again = [1, 2, 0], [2, 0, 1]
    tangents[:, 1] = normals[:, turned] * first[:, again] - normals[:, again] * first[:, turned]
    return tangents


@kernel_noalloc
def fill_tilt_scales(areas: FloatArray, scales: FloatArray) -> None:
    """Fill rho of each plane: the radius of its facet, but not below :data:`MIN_TILT_SCALE`; shape (n,)."""
    for i in range(len(areas)):
        scales[i] = max(np.sqrt(max(areas[i], 0.0) / np.pi), MIN_TILT_SCALE)


def moved_planes(
    normals: FloatArray,
    pivots: FloatArray,
    offsets: FloatArray,
    tangents: FloatArray,
    scales: FloatArray,
    step: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Normals, offsets and tangents after a step in the coordinates (s, t1, t2) of every plane, (3 n,).

    The tangents are carried over without twist.
    """
    turned, shifted, carried = np.empty_like(normals), np.empty_like(offsets), np.empty_like(tangents)
    fill_moved(normals, pivots, offsets, tangents, scales, step, turned, shifted, carried)
    return turned, shifted, carried


@kernel_noalloc
def fill_moved(
    normals: FloatArray,
    pivots: FloatArray,
    offsets: FloatArray,
    tangents: FloatArray,
    scales: FloatArray,
    step: FloatArray,
    turned: FloatArray,
    shifted: FloatArray,
    carried: FloatArray,
) -> None:
    for i in range(len(normals)):
        old, first = row(normals, i), row(tangents[i], 0)
        t1, t2 = step[3 * i + 1] / scales[i], step[3 * i + 2] / scales[i]
        shrink = 1.0 / np.sqrt(1.0 + t1 * t1 + t2 * t2)
        tilt = mixed(first, t1 * shrink, row(tangents[i], 1), t2 * shrink)
        normal = mixed(old, shrink, tilt, 1.0)
        # <n', pivot> + s; the pivot lies in the plane, so that <n, pivot> = h.
        shifted[i] = step[3 * i] + offsets[i] * shrink + along(pivots, i, tilt)
        first = mixed(first, 1.0, normal, -dot(first, normal))
        first = mixed(first, 1.0 / length(first), first, 0.0)
        second = cross(normal, first)
        for c in range(3):
            turned[i, c], carried[i, 0, c], carried[i, 1, c] = normal[c], first[c], second[c]


@kernel_noalloc
def fill_gradient(
    charges: FloatArray, tangents: FloatArray, scales: FloatArray, gradient: FloatArray
) -> None:
    """Fill the derivative with the coordinates of every plane, shape (3 n,), from charges (n, 4)."""
    for i in range(len(charges)):
        moment: Vector = (charges[i, 1], charges[i, 2], charges[i, 3])
        gradient[3 * i] = charges[i, 0]
        gradient[3 * i + 1] = -along(tangents[i], 0, moment) / scales[i]
        gradient[3 * i + 2] = -along(tangents[i], 1, moment) / scales[i]
