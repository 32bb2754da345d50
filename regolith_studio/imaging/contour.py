"""Iso-surfaces of sampled functions, oriented outward."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from skimage import measure

from regolith_studio.geometry.mesh import Mesh

_marching_cubes: Any = measure.marching_cubes


def contour(values: NDArray[Any], level: float, spacing: Sequence[float]) -> Mesh:
    """Surface where `values`, higher inside, cross `level` (marching cubes, Lewiner's table).

    Parameters
    ----------
    values
        Samples on a grid, shape (nx, ny, nz), below `level` all over the border of the grid.
    spacing
        Distance of samples along each axis; the first sample lies at the origin.

    Raises
    ------
    ValueError
        If no value lies above `level` or none below, or the surface encloses no volume.
    """
    vertices, faces, _, _ = _marching_cubes(
        values, level, spacing=tuple(float(step) for step in spacing), gradient_direction="ascent"
    )
    mesh = Mesh(vertices, np.asarray(faces, dtype=np.int64))
    if not mesh.volume > 0.0:
        raise ValueError("the values must be higher inside, and lower all over the border of the grid")
    return mesh
