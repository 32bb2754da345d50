"""NPY: numpy's own files; never a pickle."""

import warnings
from collections.abc import Mapping
from pathlib import Path
from tokenize import TokenError
from typing import Any

from numpy.lib import format as npy

from regolith_studio.errors import FileError
from regolith_studio.readers.plain_voxels import PlainVoxels
from regolith_studio.readers.volume_format import VolumeFormat, VoxelHeader, three_dimensions, voxel_type

LONGEST_HEADER = 10_000
_NONSENSE = (ValueError, TypeError, SyntaxError, KeyError, EOFError, RecursionError, MemoryError, TokenError)
"""What numpy's parser of Python's literals raises."""
_HEADERS: dict[tuple[int, int], Any] = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}


def open_npy(path: Path, _options: Mapping[str, Any]) -> PlainVoxels:
    """A three-dimensional array whose first index counts the slices.

    Raises
    ------
    FileError
        If the header is broken, the array holds objects or has another number of dimensions.
    """
    with path.open("rb") as file, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # numpy's, about files that Python 2 wrote
        try:
            version = npy.read_magic(file)
            if version not in _HEADERS:
                raise FileError(f"is an NPY file of version {version[0]}.{version[1]}, not 1.0 or 2.0.")
            shape, fortran, dtype = _HEADERS[version](file, max_header_size=LONGEST_HEADER)
        except _NONSENSE:
            raise FileError("is a broken NPY file: its header makes no sense; save it again.") from None
        offset = file.tell()
    three = three_dimensions(shape)
    return PlainVoxels(path, offset, VoxelHeader(three, voxel_type(dtype)), dtype, bool(fortran))


FORMAT = VolumeFormat("npy", "an NPY array", (".npy",), lambda head: head.startswith(b"\x93NUMPY"), open_npy)
