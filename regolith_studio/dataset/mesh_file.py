"""Reads back the STL files of a dataset, and only those: binary, of a size that their header foretells."""

import numpy as np

from regolith_studio.errors import DatasetError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.io.stl import stl_triangles


def mesh_of_stl(content: bytes, where: str) -> Mesh:
    """The mesh of binary STL bytes, equal corners joined.

    Raises
    ------
    DatasetError
        If the bytes are no binary STL, or a coordinate is not finite.
    """
    try:
        corners = stl_triangles(content).reshape(-1, 3)
    except ValueError as error:
        raise DatasetError(f"{where} {error}.") from error
    vertices, index = np.unique(corners, axis=0, return_inverse=True)
    return Mesh(vertices, index.reshape(-1, 3))
