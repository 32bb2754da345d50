"""What lies outside of a scanner's circle: one value, or none, that no grain and no air has."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import BoolArray
from regolith_studio.imaging.segmentation.thresholding import finite, grain_voxels, histogram, level_of
from regolith_studio.imaging.settings import ThresholdSettings
from regolith_studio.imaging.volume import Box, Volume
from regolith_studio.imaging.volume_slabs import ScratchArrays, SharedArray, SliceSource, slab_ranges
from regolith_studio.messages import N_, Message, Number

_SLICES = 16
"""Slices that are looked at, evenly spread."""
_CORNER, _MIDDLE = 1.2, 0.6
"""Distance from the axis, over that of the sides, beyond which is the corner and within which the middle."""
_IN_CORNER, _IN_MIDDLE = 0.99, 0.01
"""Least share of the corner and largest of the middle that have the value."""
_IN_COLUMN = 0.5
"""Least share of a column of voxels along z, for the column to be outside."""
AUTO, NONE, NAN = "auto", "none", "nan"
OUTSIDE = -1
"""Label of the voxels outside, which are in no grain."""


@dataclass(frozen=True, eq=False)
class ScanOutside:
    """What lies outside of the circle.

    - ``value``: the grey value there; NaN for no number.
    - ``share``: share of the voxels that lie there.
    - ``columns``: columns of voxels along z that lie there, shape (nx, ny). The value within the others is a
      grey value as any.
    """

    value: float
    share: float
    columns: BoolArray

    def of(self, values: NDArray[Any]) -> BoolArray:
        """Voxels outside among slices, shape (nx, ny, n)."""
        return _has(values, self.value) & self.columns[:, :, None]

    def within(self, box: Box) -> "ScanOutside":
        """The same of a part of the volume."""
        return replace(self, columns=self.columns[box[:2]])

    @property
    def hint_label(self) -> str:
        """One sentence for the user."""
        template = N_(
            "{share} % of the voxels lie outside of the scanner's circle (value {value}) and are left out."
        )
        if np.isnan(self.value):
            template = N_(
                "{share} % of the voxels lie outside of the scanner's circle (no number) and are left out."
            )
        return Message(template, share=Number(100 * self.share, ".1f"), value=Number(self.value, "g"))


@dataclass(frozen=True, eq=False)
class Padding:
    """Tells of slices of a scan which voxels lie outside of the scanner's circle; picklable."""

    scanned: SharedArray
    outside: ScanOutside

    def of(self, part: tuple[int, int]) -> BoolArray:
        """Voxels outside in the slices of a slab."""
        return self.outside.of(self.scanned.slices(*part))


def find_outside(volume: SliceSource, choice: str = AUTO) -> ScanOutside | None:
    """What lies outside of the scanner's circle, if anything.

    ``choice``: ``auto`` for a value that fills the corners of the slices and is not found in their middle,
    ``none``, or the value: a number, or ``nan``.

    Raises InputError if the volume has no column of voxels of the value.
    """
    if choice == NONE or volume.kind != "grey":
        return None
    slices = _slices(volume)
    value = _value_outside(slices) if choice == AUTO else float(choice)
    if value is None:
        return None
    columns = _has(slices, value).mean(axis=2) >= _IN_COLUMN
    if columns.any():
        outside = ScanOutside(value, 0.0, columns)
        return replace(outside, share=float(outside.of(slices).mean()))
    if choice == AUTO:
        return None
    raise InputError(
        f"No part of {volume.name} is filled with {choice} along z, so that nothing lies outside; its values "
        f"go from {finite(slices).min():g} to {finite(slices).max():g}."
    )


def _value_outside(slices: NDArray[Any]) -> float | None:
    """The value that fills the corners of slices and is not found in their middle."""
    nx, ny, _ = slices.shape
    x, y = (2.0 * np.arange(n) / max(n - 1, 1) - 1.0 for n in (nx, ny))
    away = np.hypot(x[:, None], y[None, :])
    corner, middle = slices[away > _CORNER], slices[away < _MIDDLE]
    if not corner.size or not middle.size:
        return None
    known, value = finite(corner), float("nan")
    if 2 * known.size >= corner.size:
        levels, counts = np.unique(known, return_counts=True)
        value = float(levels[counts.argmax()])
    if _has(corner, value).mean() < _IN_CORNER or _has(middle, value).mean() > _IN_MIDDLE:
        return None
    return value


def _has(values: NDArray[Any], value: float) -> BoolArray:
    return np.asarray(np.isnan(values) if np.isnan(value) else values == value)


def _slices(volume: SliceSource) -> NDArray[Any]:
    nz = volume.shape[2]
    places = np.unique(np.linspace(0, nz - 1, min(nz, _SLICES)).astype(int))
    return np.concatenate([volume.read(z, z + 1) for z in places.tolist()], axis=2)


def background_filled(
    volume: SliceSource, outside: ScanOutside, threshold: ThresholdSettings, scratch: ScratchArrays
) -> Volume:
    """A copy whose voxels outside have grey values that are drawn from those of the background inside.

    Filters near the circle then see what they see between grains.
    """
    slices = _slices(volume)
    pool = _background(finite(slices[~outside.of(slices)]), threshold, volume.dtype)
    filled = SharedArray(scratch.zeros(volume.shape, volume.dtype))
    for first, stop in slab_ranges(volume.shape):
        slab = np.array(volume.read(first, stop))
        empty = outside.of(slab)
        draws = np.random.default_rng(np.random.SeedSequence(0, spawn_key=(first,)))
        slab[empty] = draws.choice(pool, int(np.count_nonzero(empty)))
        filled.write(first, slab)
    edges = np.asarray(volume.voxel_size, dtype=np.float64)
    return Volume(filled.array, edges, volume.kind, volume.name, volume.origin)


def _background(inside: NDArray[Any], threshold: ThresholdSettings, dtype: np.dtype[Any]) -> NDArray[Any]:
    """The values of voxels that are no grain; all where they are too uniform for a threshold."""
    seen = histogram(inside)
    try:
        level = level_of(seen, threshold, dtype)
    except InputError:
        return inside
    pool = inside[~grain_voxels(inside, level, threshold)]
    return pool if pool.size else inside
