"""A surface moved until it looks, through the scanner's blur, as the grain does.

A contour of blurred grey values has lost its edges. The mesh is therefore scanned in its turn: shares of
voxels, blurred as the grain was. Where the grain is brighter than that the surface moves outward, where it
is darker inward, and after each step it is smoothed as much as the noise demands. Since a mesh is inside or
outside and nothing between, far less of the noise comes with the edges than if the image were sharpened.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from regolith_studio.geometry.arrays import BoolArray, FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.imaging.coverage import coverage
from regolith_studio.imaging.smoothing import LowPass

_BOX = 1.0 / 12.0
"""Variance that a voxel's own width adds to the blur of an edge."""
_REACH = 0.8
"""Voxels over which what is missing is averaged, so that noise of single voxels moves nothing."""
_FARTHEST = 0.3
"""Voxels that a corner moves at most in a step."""
_EAGERNESS = 1.6
"""Share of the way to where a flat surface would explain the voxels that is gone in a step."""


@dataclass(frozen=True)
class FitSettings:
    """How often the surface moves, and the pass band that smooths it after each step.

    Parameters
    ----------
    steps
        How often.
    iterations, pass_band
        Of the smoothing (:func:`~regolith_studio.imaging.smoothing.windowed_sinc`).
    """

    steps: int
    iterations: int
    pass_band: float


def fitted(mesh: Mesh, share: NDArray[np.float32], rim: BoolArray, blur: float, how: FitSettings) -> Mesh:
    """The mesh, in voxels, moved to where it explains the shares best.

    Parameters
    ----------
    share
        Share of the grain in each voxel, blurred and noisy.
    rim
        Voxels that count.
    blur
        Standard deviation of the blur as an edge shows it, in voxels, the voxel's own width in it.
    """
    point_spread = float(np.sqrt(max(blur**2 - _BOX, 0.0)))
    slope = 1.0 / np.sqrt(2.0 * np.pi * (blur**2 + _REACH**2))
    smooth = LowPass(mesh.faces, len(mesh.vertices), how.iterations, how.pass_band)
    for _ in range(how.steps):
        seen = ndimage.gaussian_filter(coverage(mesh, _shape(share)).astype(np.float32), point_spread)
        missing = ndimage.gaussian_filter(np.where(rim, share - seen, 0.0), _REACH)
        there = ndimage.map_coordinates(missing, mesh.vertices.T, order=1)
        away = np.clip(_EAGERNESS * there / slope, -_FARTHEST, _FARTHEST)
        mesh = Mesh(smooth(mesh.vertices + away[:, None] * _normals(mesh)), mesh.faces)
    return mesh


def _normals(mesh: Mesh) -> FloatArray:
    """Unit normals of the corners: sums of those of the faces about them, weighted by area."""
    corners = mesh.faces.ravel(order="F")
    areas = np.tile(mesh.face_area_vectors, (3, 1))
    total = np.stack([np.bincount(corners, axis, len(mesh.vertices)) for axis in areas.T], axis=1)
    return np.asarray(total / np.maximum(np.linalg.norm(total, axis=1), 1e-300)[:, None])


def _shape(array: NDArray[np.float32]) -> tuple[int, int, int]:
    nx, ny, nz = array.shape
    return nx, ny, nz
