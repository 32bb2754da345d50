"""Reads back the STL files of a dataset, and only those: binary, of a size that their header foretells."""

import numpy as np

from regolith_studio.errors import DatasetError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.imaging.stl import RECORD


def mesh_of_stl(content: bytes, where: str) -> Mesh:
    """The mesh of binary STL bytes, equal corners joined.

    Raises
    ------
    DatasetError
        If the bytes are no binary STL, or a coordinate is not finite.
    """
    count = int.from_bytes(content[80:84], "little")
    if len(content) < 84 or len(content) != 84 + RECORD.itemsize * count:
        raise DatasetError(f"{where} is no complete binary STL.")
    corners = np.frombuffer(content, dtype=RECORD, offset=84)["corners"].reshape(-1, 3).astype(np.float64)
    if not np.isfinite(corners).all():
        raise DatasetError(f"{where} holds a coordinate that is not finite.")
    vertices, index = np.unique(corners, axis=0, return_inverse=True)
    return Mesh(vertices, index.reshape(-1, 3))
