"""What a pixel classifier sees of a voxel: Gaussians of several widths, their differences and derivatives.

A Gaussian along one axis of a block is a product with a banded matrix. Blocks whose margins are
:attr:`FeatureSettings.margin` voxels therefore give what the whole volume gives, thin slices cost little more
than their own voxels, and every n-th voxel can be had without the others.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import IntArray
from regolith_studio.imaging.volume import Box, Volume, box_between, grown
from regolith_studio.imaging.volume_slabs import SliceSource, slab_ranges, thick_slabs

FloatBlock = NDArray[np.float32]
_Orders = tuple[int, int, int]
_FIRST: tuple[_Orders, ...] = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
_PURE: tuple[_Orders, ...] = ((2, 0, 0), (0, 2, 0), (0, 0, 2))
_MIXED: tuple[_Orders, ...] = ((1, 1, 0), (1, 0, 1), (0, 1, 1))
"""Orders of derivatives along x, y and z."""

_TRUNCATE = 3.0
"""Standard deviations after which a Gaussian ends."""
_CELL = 64
"""Edge of the cells that scattered voxels are gathered in."""


@dataclass(frozen=True)
class FeatureSettings:
    """Which features a voxel has.

    - ``sigmas``: standard deviations of the Gaussians in voxels, ascending.
    - ``planar``: filter within slices along z only (2-D), in place of all directions (3-D).
    - ``hessian``: whether the eigenvalues of the second derivatives are features: curved and flat surfaces,
      necks and thin plates differ in them.
    """

    sigmas: tuple[float, ...] = (1.0, 2.0, 4.0, 8.0)
    planar: bool = False
    hessian: bool = True

    def __post_init__(self) -> None:
        ascending = all(a < b for a, b in pairwise(self.sigmas))
        if not self.sigmas or not ascending or not all(0.3 <= each <= 32.0 for each in self.sigmas):
            raise InputError(
                f"The sigmas of a classifier's features ascend from 0.3 to at most 32 voxels, "
                f"got {self.sigmas}."
            )

    @property
    def margin(self) -> int:
        """Voxels about a block that its features depend on."""
        return _reach(self.sigmas[-1])

    @property
    def names(self) -> tuple[str, ...]:
        """Of the features, in their order."""
        pairs = pairwise(self.sigmas)
        eigenvalues = range(1, 3 if self.planar else 4) if self.hessian else ()
        return (
            f"gaussian {self.sigmas[-1]:g}",
            *(f"gaussian {a:g} - gaussian {b:g}" for a, b in pairs),
            *(f"gradient magnitude {each:g}" for each in self.sigmas),
            *(f"hessian eigenvalue {k} {each:g}" for each in self.sigmas for k in eigenvalues),
        )


def block_features(
    values: NDArray[Any],
    outer: Box,
    box: Box,
    shape: Sequence[int],
    settings: FeatureSettings,
    step: tuple[int, int, int] = (1, 1, 1),
) -> FloatBlock:
    """Features of the voxels of a box.

    Beyond the border of the volume its outermost voxels are continued. What is no finite number counts as 0.

    - ``values``, ``outer``: the grey values about the box, and where they lie: with a margin of
      :attr:`FeatureSettings.margin` voxels where the volume has them.
    - ``shape``: voxels of the volume along x, y and z.
    - ``step``: of every how many voxels of the box along x, y and z features are taken.

    Returns shape (nx, ny, nz, n_features).
    """
    smooth, gradients, curvatures = [], [], []
    for sigma in settings.sigmas:
        part = grown(box, _reach(sigma), outer)
        cut = tuple(slice(a.start - b.start, a.stop - b.start) for a, b in zip(part, outer, strict=True))
        single = np.array(values[cut].T, dtype=np.float32, order="C")
        if values.dtype.kind == "f":
            np.nan_to_num(single, copy=False, nan=0.0, posinf=0.0, neginf=0.0)
        highest = 2 if settings.hessian else 1
        derivatives = _derivatives(single, part, box, shape, sigma, settings.planar, step, highest)
        smooth.append(derivatives[0, 0, 0])
        gradients.append(np.sqrt(sum(derivatives[order] ** 2 for order in _FIRST)))
        if settings.hessian:
            curvatures += _planar_eigenvalues(derivatives) if settings.planar else _eigenvalues(derivatives)
    differences = [a - b for a, b in pairwise(smooth)]
    return np.stack([smooth[-1], *differences, *gradients, *curvatures], axis=-1).transpose(2, 1, 0, 3)


def features_in(
    volume: Volume, box: Box, settings: FeatureSettings, step: tuple[int, int, int] = (1, 1, 1)
) -> FloatBlock:
    """:func:`block_features` of a volume in memory or mapped from a file."""
    outer = grown(box, settings.margin, box_between((0, 0, 0), volume.shape))
    return block_features(volume.array[outer], outer, box, volume.shape, settings, step)


def features_at(source: SliceSource, positions: IntArray, settings: FeatureSettings) -> FloatBlock:
    """Features of scattered voxels, shape (n, n_features).

    ``positions``: voxels along x, y, z, shape (n, 3).

    Raises InputError if a voxel is not in the volume.
    """
    if len(positions) and not ((positions >= 0) & (positions < source.shape)).all():
        raise InputError(f"Painted voxels lie outside of {source.name} of {source.shape} voxels.")
    features = np.empty((len(positions), len(settings.names)), dtype=np.float32)
    if not len(positions):
        return features
    low, high = int(positions[:, 2].min()), int(positions[:, 2].max()) + 1
    nx, ny, _ = source.shape
    ranges = [(low + first, low + stop) for first, stop in slab_ranges((nx, ny, high - low))]
    for slab in thick_slabs(source, ranges, settings.margin):
        inside = np.flatnonzero((positions[:, 2] >= slab.first) & (positions[:, 2] < slab.stop))
        start = slab.first - slab.inner.start
        outer = box_between((0, 0, start), (nx, ny, start + slab.values.shape[2]))
        for rows in _cells(positions, inside):
            here = positions[rows]
            box = box_between(here.min(axis=0).tolist(), (here.max(axis=0) + 1).tolist())
            block = block_features(slab.values, outer, box, source.shape, settings)
            features[rows] = block[tuple((here - here.min(axis=0)).T)]
    return features


def _cells(positions: IntArray, rows: IntArray) -> list[IntArray]:
    """The rows whose voxels share a cell of the grid of `_CELL` voxels."""
    if not len(rows):
        return []
    _, cell = np.unique(positions[rows] // _CELL, axis=0, return_inverse=True)
    order = np.argsort(cell, kind="stable")
    return np.split(rows[order], np.flatnonzero(np.diff(cell[order])) + 1)


def _reach(sigma: float) -> int:
    return int(_TRUNCATE * sigma + 0.5)


def _derivatives(
    values: FloatBlock,
    part: Box,
    box: Box,
    shape: Sequence[int],
    sigma: float,
    planar: bool,
    step: tuple[int, int, int],
    highest: int,
) -> dict[_Orders, FloatBlock]:
    """Derivatives of a Gaussian of one width in a box, by their orders along x, y and z.

    `highest` is the largest sum of the three orders. Values and results are [z, y, x].
    """
    weights = [
        [
            _matrix(n, inner, outer, pace, 0.0 if planar and axis == 2 else sigma, order)
            for order in range(highest + 1)
        ]
        for axis, (n, inner, outer, pace) in enumerate(zip(shape, box, part, step, strict=True))
    ]
    derivatives: dict[_Orders, FloatBlock] = {(0, 0, 0): values}
    # The axis along which most voxels fall away comes first.
    for axis in np.argsort([len(each[0]) / each[0].shape[1] for each in weights]).tolist():
        derivatives = {
            _with(orders, axis, order): _along(block, weights[axis][order], axis)
            for orders, block in derivatives.items()
            for order in range(highest + 1 - sum(orders))
        }
    return derivatives


def _with(orders: _Orders, axis: int, order: int) -> _Orders:
    x, y, z = (order if each == axis else orders[each] for each in range(3))
    return x, y, z


def _eigenvalues(derivatives: dict[_Orders, FloatBlock]) -> list[FloatBlock]:
    """Eigenvalues of the symmetric matrices of second derivatives, the largest first.

    Closed form by the angle of the characteristic cubic (Smith, Communications of the ACM 4, 168, 1961).
    """
    (xx, yy, zz), (xy, xz, yz) = ([derivatives[orders] for orders in each] for each in (_PURE, _MIXED))
    mean = (xx + yy + zz) / 3.0
    a, b, c = xx - mean, yy - mean, zz - mean
    spread = np.sqrt((a**2 + b**2 + c**2 + 2.0 * (xy**2 + xz**2 + yz**2)) / 6.0)
    determinant = a * (b * c - yz**2) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)
    cube = np.maximum(2.0 * spread**3, np.float32(np.finfo(np.float32).tiny))
    # Rounding takes the quotient beyond 1 where two eigenvalues are one.
    angle = np.arccos(np.clip(determinant / cube, -1.0, 1.0)) / 3.0
    first = mean + 2.0 * spread * np.cos(angle)
    last = mean + 2.0 * spread * np.cos(angle + np.float32(2.0 * np.pi / 3.0))
    return [first, 3.0 * mean - first - last, last]


def _planar_eigenvalues(derivatives: dict[_Orders, FloatBlock]) -> list[FloatBlock]:
    """The same of second derivatives along x and y alone."""
    (xx, yy, _), (xy, *_) = ([derivatives[orders] for orders in each] for each in (_PURE, _MIXED))
    mean, spread = (xx + yy) / 2.0, np.hypot((xx - yy) / 2.0, xy)
    return [mean + spread, mean - spread]


def _along(values: FloatBlock, weights: FloatBlock, axis: int) -> FloatBlock:
    """Weighted sums along axis 0 (x), 1 or 2 of contiguous values [z, y, x], without copies of them.

    Weights have shape (outputs, voxels along the axis).
    """
    if axis == 0:
        return np.asarray(values @ weights.T)
    if axis == 1:
        return np.asarray(weights @ values)
    return np.asarray((weights @ values.reshape(len(values), -1)).reshape(-1, *values.shape[1:]))


def _matrix(n: int, inner: slice, outer: slice, step: int, sigma: float, order: int) -> FloatBlock:
    """Weights of the voxels `outer` in a Gaussian or its derivative at every `step`-th of `inner`.

    Those of the first derivative give 1 of a slope of 1, those of the second 1 of x^2 / 2 and 0 of that
    slope; both give 0 of a constant.
    """
    reach = _reach(sigma)
    offsets = np.arange(-reach, reach + 1)
    kernel = np.exp(-0.5 * (offsets / sigma) ** 2) if sigma else np.ones(1)
    kernel /= kernel.sum()
    if order:
        moment = offsets if order == 1 else offsets**2 - float((kernel * offsets**2).sum())
        kernel = kernel * moment
        response = float((kernel * offsets**order).sum()) / order
        kernel = kernel / max(response, np.finfo(float).tiny)
    outputs = np.arange(inner.start, inner.stop, step)
    inputs = np.clip(outputs[:, None] + offsets, 0, n - 1) - outer.start
    weights = np.zeros((len(outputs), outer.stop - outer.start))
    np.add.at(weights, (np.arange(len(outputs))[:, None], inputs), kernel)
    return weights.astype(np.float32)
