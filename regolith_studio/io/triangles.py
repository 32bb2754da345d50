"""Triangles by the numbers of their vertices, for processes that import little more than numpy."""

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def used_vertices(vertices: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    """The vertices that a face uses, in their order, and the faces by these; the same arrays if all are."""
    used = np.zeros(len(vertices), dtype=np.bool_)
    used[faces] = True
    if used.all():
        return vertices, faces
    return vertices[used], (np.cumsum(used) - 1)[faces]
