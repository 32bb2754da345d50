"""Raw voxels; the caller gives their shape and type, or a scanner's header beside them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.header import VoxelHeader, three_dimensions, voxel_type
from regolith_studio.readers.voxels.scanner_headers import header_beside, open_described
from regolith_studio.readers.voxels.stored import PlainVoxels, exact_voxels

SUFFIXES = (".raw", ".vol", ".bin", ".dat")


def open_raw(path: Path, options: Mapping[str, Any]) -> PlainVoxels:
    """The voxels of a file that ``options["raw"]`` describes: shape (nx, ny, nz), dtype, offset,
    or that a scanner's header beside it describes.
    """
    given = options.get("raw")
    if given is None:
        described = header_beside(path)
        if described is None:
            raise FileError("is a raw file, which has no header: give its shape and voxel type.")
        return open_described(described)
    nx, ny, nz = given["shape"]
    stored = np.dtype(str(given["dtype"]))
    header = VoxelHeader(three_dimensions((nz, ny, nx)), voxel_type(stored))
    return exact_voxels(path, int(given["offset"]), header, stored)


FORMAT = VolumeFormat("raw", "raw voxels", SUFFIXES, lambda _head: False, open_raw)
