"""NPY: numpy's own files; never a pickle."""

import warnings
from collections.abc import Mapping
from pathlib import Path
from tokenize import TokenError
from typing import Any

import numpy as np
from numpy.lib import format as npy

from regolith_studio.errors import FileError
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.header import VoxelHeader, stated_axes, three_dimensions, voxel_type
from regolith_studio.readers.voxels.stored import PlainVoxels, TransposedVoxels

MAX_HEADER_BYTES = 10_000
_NONSENSE = (ValueError, TypeError, SyntaxError, KeyError, EOFError, RecursionError, MemoryError, TokenError)
"""What numpy's parser of Python's literals raises."""
_HEADERS: dict[tuple[int, int], Any] = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}


def open_npy(path: Path, options: Mapping[str, Any]) -> PlainVoxels | TransposedVoxels:
    """A three-dimensional array whose first index counts the slices, or with the axes ``options["axes"]``."""
    with path.open("rb") as file, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # numpy's, about files that Python 2 wrote
        try:
            version = npy.read_magic(file)
            if version not in _HEADERS:
                raise FileError(f"is an NPY file of version {version[0]}.{version[1]}, not 1.0 or 2.0.")
            shape, fortran, dtype = _HEADERS[version](file, max_header_size=MAX_HEADER_BYTES)
        except _NONSENSE:
            raise FileError("is a broken NPY file: its header is invalid; save it again.") from None
        offset = file.tell()
    if not options.get("axes"):
        three = three_dimensions(shape)
        return PlainVoxels(path, offset, VoxelHeader(three, voxel_type(dtype)), dtype, bool(fortran))
    return _transposed(path, offset, str(options["axes"]), tuple(map(int, shape)), dtype, bool(fortran))


def _transposed(
    path: Path, offset: int, axes: str, shape: tuple[int, ...], dtype: np.dtype[Any], fortran: bool
) -> PlainVoxels | TransposedVoxels:
    edges = dict(zip(stated_axes(axes, len(shape)), shape, strict=True))
    if any(edge != 1 for axis, edge in edges.items() if axis in "tc"):
        raise FileError("holds several channels or times; save one of them.")
    three = three_dimensions((edges["z"], edges["y"], edges["x"]))
    order = "".join(axis for axis in (reversed(edges) if fortran else edges) if axis in "zyx")
    header = VoxelHeader(three, voxel_type(dtype))
    if order in ("zyx", "xyz"):
        return PlainVoxels(path, offset, header, dtype, order == "xyz")
    return TransposedVoxels(path, offset, header, dtype, order)


FORMAT = VolumeFormat("npy", "an NPY array", (".npy",), lambda head: head.startswith(b"\x93NUMPY"), open_npy)
