"""A few slices of a volume, read for a limited time, as a coarse volume that fills the same space."""

import math
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.imaging.volume import Volume
from regolith_studio.imaging.volume_slabs import SliceSource

SLICE_BYTES, ALL_BYTES = 2**22, 2**26
"""Bytes of one slice, and of all: larger slices are thinned out, and no more are read."""


def sparse_slices(source: SliceSource, seconds: float, *, in_order: bool = False) -> Volume:
    """The middle slice, and as many others at equal distances as can be read within `seconds`.

    The distance is halved until the time ends or every slice is read; slices of the last, unfinished halving
    are left out. The voxels of the result are longer along z, and wider where slices are thinned out.

    Parameters
    ----------
    in_order
        Take the first slices instead, for a file that must be unpacked from its beginning; the result then
        fills only their part of the volume.
    """
    nx, ny, nz = source.shape
    slice_bytes = nx * ny * source.dtype.itemsize
    thin = max(1, math.ceil(math.sqrt(slice_bytes / SLICE_BYTES)))
    most = max(1, ALL_BYTES * thin**2 // slice_bytes)
    wanted = _first_places(nz, most) if in_order else _halved_distances(nz, most)
    places, values = _read_while(source, wanted, thin, time.monotonic() + seconds)
    size = np.asarray(source.voxel_size, float) * np.array([nx, ny, nz]) / values.shape
    if in_order:
        size[2] = np.asarray(source.voxel_size, float)[2] * places.step
    return Volume(values, size, source.kind, source.name)


def _read_while(
    source: SliceSource, wanted: Iterator[range], thin: int, end: float
) -> tuple[range, NDArray[Any]]:
    """The last of the runs of places whose slices could all be read until `end`, at least the first run."""
    read: dict[int, NDArray[Any]] = {}
    places = range(0)
    for run in wanted:
        for z in run:
            if places and time.monotonic() > end:
                break
            if z not in read:
                read[z] = source.read(z, z + 1)[::thin, ::thin, 0]
        else:
            places = run
            continue
        break
    return places, np.stack([read[z] for z in places], axis=2)


def _halved_distances(count: int, most: int) -> Iterator[range]:
    """The middle of `count` places, then all at a distance that is halved each time, at most `most`."""
    distance = 1 << max(count - 1, 1).bit_length()
    while distance >= 1 and len(run := range(count // 2 % distance, count, distance)) <= most:
        yield run
        distance //= 2


def _first_places(count: int, most: int) -> Iterator[range]:
    for stop in range(1, min(count, most) + 1):
        yield range(stop)
