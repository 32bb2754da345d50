"""What lies outside of a scanner's circle: one value, or none, that no grain and no air has."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.geometry.arrays import BoolArray
from regolith_studio.imaging.segmentation.thresholding import (
    ThresholdSettings,
    finite,
    grain_voxels,
    histogram,
    level_of,
)
from regolith_studio.imaging.volume import Volume
from regolith_studio.imaging.volume_slabs import ScratchArrays, SharedArray, slab_ranges

_SLICES = 16
"""Slices that are looked at, evenly spread."""
_CORNER, _MIDDLE = 1.2, 0.6
"""Distance from the axis, over that of the sides, beyond which is the corner and within which the middle."""
_IN_CORNER, _IN_MIDDLE = 0.99, 0.01
"""Least share of the corner and largest of the middle that have the value."""


@dataclass(frozen=True)
class ScanOutside:
    """The value outside of the circle, NaN for no number, and the share of the voxels that have it."""

    value: float
    share: float

    def of(self, values: NDArray[Any]) -> BoolArray:
        """Voxels that have the value."""
        return np.asarray(np.isnan(values) if np.isnan(self.value) else values == self.value)


def find_outside(volume: Volume) -> ScanOutside | None:
    """What fills the corners of the slices and is not found in their middle, if there is such a value."""
    (nx, ny, _), slices = volume.shape, _slices(volume)
    x, y = (2.0 * np.arange(n) / max(n - 1, 1) - 1.0 for n in (nx, ny))
    away = np.hypot(x[:, None], y[None, :])
    corner, middle = slices[away > _CORNER], slices[away < _MIDDLE]
    if not corner.size or not middle.size:
        return None
    known = finite(corner)
    value = float("nan")
    if 2 * known.size >= corner.size:
        found, counts = np.unique(known, return_counts=True)
        value = float(found[counts.argmax()])
    outside = ScanOutside(value, 0.0)
    if outside.of(corner).mean() < _IN_CORNER or outside.of(middle).mean() > _IN_MIDDLE:
        return None
    return replace(outside, share=float(outside.of(slices).mean()))


def _slices(volume: Volume) -> NDArray[Any]:
    nz = volume.shape[2]
    places = np.unique(np.linspace(0, nz - 1, min(nz, _SLICES)).astype(int))
    return np.stack([volume.array[:, :, z] for z in places], axis=2)


def background_filled(
    volume: Volume, outside: ScanOutside, threshold: ThresholdSettings, scratch: ScratchArrays
) -> Volume:
    """A copy whose voxels outside have grey values that are drawn from those of the background inside.

    Raises
    ------
    InputError
        If the rest is too uniform for an automatic threshold.
    """
    slices = _slices(volume)
    inside = finite(slices[~outside.of(slices)])
    level = level_of(histogram(inside), threshold, volume.dtype)
    pool = inside[~grain_voxels(inside, level, threshold)]
    pool = pool if pool.size else inside
    filled = SharedArray(scratch.zeros(volume.shape, volume.dtype))
    for first, stop in slab_ranges(volume.shape):
        slab = np.array(volume.read(first, stop))
        empty = outside.of(slab)
        draws = np.random.default_rng(np.random.SeedSequence(0, spawn_key=(first,)))
        slab[empty] = draws.choice(pool, int(np.count_nonzero(empty)))
        filled.write(first, slab)
    return replace(volume, array=filled.array)
