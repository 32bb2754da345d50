"""Raw voxels without a header; the caller gives their shape and type."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.header import VoxelHeader, format_shape, three_dimensions, voxel_type
from regolith_studio.readers.voxels.stored import PlainVoxels

SUFFIXES = (".raw", ".vol", ".bin", ".dat")


def open_raw(path: Path, options: Mapping[str, Any]) -> PlainVoxels:
    """The voxels of a file that ``options["raw"]`` describes: shape (nx, ny, nz), dtype, offset.

    Raises
    ------
    FileError
        If no layout is given, or the file has not just the bytes that it needs.
    """
    given = options.get("raw")
    if given is None:
        raise FileError("is a raw file, which has no header: give its shape and voxel type.")
    nx, ny, nz = given["shape"]
    stored = np.dtype(str(given["dtype"]))
    shape = three_dimensions((nz, ny, nx))
    header = VoxelHeader(shape, voxel_type(stored))
    offset, there = int(given["offset"]), path.stat().st_size
    needed = offset + math.prod(shape) * stored.itemsize
    if there != needed:
        raise FileError(
            f"has {there:,} bytes, but {format_shape((nx, ny, nz))} voxels of {stored.name} after {offset:,} "
            f"bytes of header make {needed:,}."
        )
    return PlainVoxels(path, offset, header, stored)


FORMAT = VolumeFormat("raw", "raw voxels", SUFFIXES, lambda _head: False, open_raw)
