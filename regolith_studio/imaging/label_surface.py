"""Surfaces of all labels at once, coarse and quick: for a picture of a segmentation, not for particles."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.geometry.arrays import FloatArray, IntArray

MAX_EDGE = 128
"""Voxels along the longest edge that are contoured."""


@dataclass(frozen=True, eq=False)
class LabelSurface:
    """Triangles between labels and what has none.

    - ``vertices``: in micrometres from the corner of the volume, shape (n, 3).
    - ``faces``: shape (m, 3).
    - ``labels``: of each face, shape (m,).
    """

    vertices: FloatArray
    faces: IntArray
    labels: IntArray


def label_surface(labels: NDArray[Any], voxel_size: FloatArray, max_edge: int = MAX_EDGE) -> LabelSurface:
    """Surfaces of labels by surface nets (VTK), of every n-th voxel of a large volume.

    - ``labels``: 0 and less between grains, shape (nx, ny, nz).
    - ``voxel_size``: edges of a voxel along x, y and z, in micrometres, shape (3,).
    - ``max_edge``: voxels along the longest edge that are contoured.
    """
    import pyvista

    step = max(1, -(-max(labels.shape) // max_edge))
    coarse = np.pad(np.maximum(labels[::step, ::step, ::step], 0), 1)  # also makes a single slice a volume
    present, compact = np.unique(coarse, return_inverse=True)
    spacing = np.asarray(voxel_size, float) * step
    # The padding puts the first sample half a voxel before the corner of the volume.
    image: Any = pyvista.ImageData(dimensions=coarse.shape, spacing=spacing, origin=-spacing / 2)
    image.point_data["labels"] = compact.reshape(coarse.shape).astype(np.int32).ravel(order="F")
    contour: Any = image.contour_labels(
        boundary_style="external",
        scalars="labels",
        output_mesh_type="triangles",
        pad_background=False,
        progress_bar=False,
    )
    if not contour.n_cells:
        return LabelSurface(np.zeros((0, 3)), np.zeros((0, 3), np.int64), np.zeros(0, np.int64))
    # External faces have the background, 0, on one side.
    sides = np.asarray(contour.cell_data["boundary_labels"]).reshape(contour.n_cells, -1)
    return LabelSurface(
        np.asarray(contour.points, dtype=np.float64),
        np.asarray(contour.regular_faces, dtype=np.int64),
        np.asarray(present[sides.max(axis=1).astype(np.int64)], dtype=np.int64),
    )
