"""A surface moved until it looks, through the scanner's blur, as the grain does.

A contour of blurred grey values has lost its edges, and one of a mask shows steps. The mesh is therefore
scanned in its turn. Where the grain is brighter than that scan the surface moves outward, where it is darker
inward, and after each step it is smoothed as much as the noise demands. Since a mesh is inside or outside and
nothing between, far less of the noise comes with the edges than if the image were sharpened. A mask says of
each voxel only on which side of its centre the surface lies: what is on its side moves nothing, so that the
surface comes to lie smoothly between the centres.

What the smoothing still takes from edges is given back by twicing (Tukey, Exploratory Data Analysis, 1977):
the surface is smoothed once more, and what that takes is added.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from regolith_studio.geometry.arrays import BoolArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.imaging.coverage import coverage
from regolith_studio.imaging.crossings import corner_normals
from regolith_studio.imaging.smoothing import LowPass

Floats = NDArray[np.float32]

_BOX = 1.0 / 12.0
"""Variance that a voxel's own width adds to the blur of an edge."""
_REACH, _REACH_OF_MASKS = 0.8, 0.5
"""Voxels over which what is missing is averaged, so that noise of single voxels moves nothing."""
_FARTHEST = 0.3
"""Voxels that a corner moves at most in a step."""
_EAGERNESS = 1.6
"""Share of the way to where a flat surface would explain the voxels that is gone in a step."""
_COLUMNS, _COLUMNS_OF_MASKS = 3, 2
"""Columns along the edge of a voxel that its share is measured by."""

_NARROWING = 0.38
"""Pass band of the smoothing whose effect the twicing adds, as a share of that of the fit."""


@dataclass(frozen=True)
class FitSettings:
    """How often the surface moves, and what smooths it.

    Parameters
    ----------
    steps
        How often.
    iterations, pass_band
        Of the smoothing after each step (:class:`~regolith_studio.imaging.smoothing.LowPass`).
    twicing
        At the end, what one more and stronger smoothing takes is added so many times.
    """

    steps: int
    iterations: int
    pass_band: float
    twicing: float = 0.0


def fitted(mesh: Mesh, share: Floats, rim: BoolArray, blur: float, how: FitSettings) -> Mesh:
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

    def missing(mesh: Mesh) -> Floats:
        seen = ndimage.gaussian_filter(coverage(mesh, _shape(share), _COLUMNS), point_spread)
        return np.asarray(np.where(rim, share - seen, np.float32(0.0)))

    return _moved(mesh, missing, blur, _REACH, how)


def fitted_to_mask(mesh: Mesh, mask: BoolArray, how: FitSettings) -> Mesh:
    """The mesh, in voxels, moved so that the centres of a mask's voxels lie within it and no others."""
    side = np.where(mask, np.float32(0.5), np.float32(-0.5))

    def missing(mesh: Mesh) -> Floats:
        """Voxels more than half covered are inside; only those on the wrong side miss something."""
        beyond = 0.5 - coverage(mesh, _shape(mask), _COLUMNS_OF_MASKS)
        return np.asarray(np.where(beyond * side > 0.0, beyond, np.float32(0.0)))

    return _moved(mesh, missing, _BOX**0.5, _REACH_OF_MASKS, how)


def _moved(
    mesh: Mesh, missing: Callable[[Mesh], Floats], blur: float, reach: float, how: FitSettings
) -> Mesh:
    """The mesh after all steps and the twicing; an edge that `blur` has widened tells how far to go."""
    pace = _EAGERNESS * float(np.sqrt(2.0 * np.pi * (blur**2 + reach**2)))
    smooth = LowPass(mesh.faces, len(mesh.vertices), how.iterations)
    for _ in range(how.steps):
        lacking = ndimage.gaussian_filter(missing(mesh), reach)
        there = ndimage.map_coordinates(lacking, mesh.vertices.T, order=1)
        away = np.clip(pace * there.astype(np.float64), -_FARTHEST, _FARTHEST)
        outward = corner_normals(mesh.vertices, mesh.faces)
        mesh = Mesh(smooth(mesh.vertices + away[:, None] * outward, how.pass_band), mesh.faces)
    taken = mesh.vertices - smooth(mesh.vertices, _NARROWING * how.pass_band)
    return Mesh(mesh.vertices + how.twicing * taken, mesh.faces)


def _shape(array: Floats | BoolArray) -> tuple[int, int, int]:
    nx, ny, nz = array.shape
    return nx, ny, nz
