"""Surface of one grain from its mask alone.

A contour of a mask runs in steps, which overstate the area by 7 to 9 % however fine the voxels are, and a
filter that takes the steps takes edges as well. What a mask does say is on which side of each voxel's centre
the surface lies. The contour is therefore moved to lie between the centres as smoothly as it can, and what
the smoothing takes from edges is given back (:mod:`~regolith_studio.imaging.surface_fit`). The volume is that
of the voxels, which counts right on average, whatever the shape.
"""

import numpy as np

from regolith_studio.geometry.arrays import BoolArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.imaging.contour import contour
from regolith_studio.imaging.crossings import LIGHTLY, uncrossed
from regolith_studio.imaging.smoothing import windowed_sinc, with_volume
from regolith_studio.imaging.surface_fit import FitSettings, fitted_to_mask

_MARGIN = 4
"""Voxels about the mask into which the surface may move."""
_STEPS = 8
"""Moves of the surface to its side of the centres."""
_WIDENING, _TWICING = 2.0, 1.4
"""Pass band of the smoothing after each move as a multiple of the usual, and how many times what one more
smoothing takes is added: chosen on balls, ellipsoids, polyhedra and rough grains of 24 to 48 voxels."""


def mask_mesh(body: BoolArray, iterations: int = 20, pass_band: float = 0.13) -> Mesh:
    """The surface of a mask, with the volume of its voxels, in voxels of the mask.

    Parameters
    ----------
    body
        The grain's voxels: of one piece.
    iterations, pass_band
        Of the smoothing; without any iteration the surface is the contour alone.
    """
    padded = np.pad(body, _MARGIN)
    rough = contour(padded.astype(np.float32), 0.5, (1.0, 1.0, 1.0))
    mesh = windowed_sinc(rough, iterations, pass_band)
    if iterations:
        wider = min(_WIDENING * pass_band, 2.0)
        fit = fitted_to_mask(mesh, padded, FitSettings(_STEPS, iterations, wider, _TWICING))
        mesh = uncrossed(fit, windowed_sinc(rough, iterations, min(LIGHTLY * pass_band, 2.0)))
    return with_volume(mesh, float(np.count_nonzero(body))).moved(shift=np.full(3, -float(_MARGIN)))
