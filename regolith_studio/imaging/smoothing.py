"""Windowed-sinc smoothing of contoured masks: a low-pass filter on the mesh that does not shrink it much."""

from typing import Any

import numpy as np
import pyvista as pv

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.mesh import Mesh


def windowed_sinc(mesh: Mesh, iterations: int = 20, pass_band: float = 0.13) -> Mesh:
    """Smooth by the polynomial low-pass filter of Taubin, Zhang and Golub (1996), as VTK has it.

    The filter acts on each coordinate alone, so that it commutes with stretching along the axes:
    anisotropic voxels need no special care.

    Parameters
    ----------
    iterations
        Degree of the polynomial; 0 leaves the mesh as it is.
    pass_band
        Share of the mesh's frequencies that stay, 0 to 2; the smaller, the smoother.
    """
    if iterations == 0:
        return mesh
    triangles: Any = np.array(mesh.faces)
    surface = pv.PolyData.from_regular_faces(np.array(mesh.vertices), triangles)
    smooth = surface.smooth_taubin(
        n_iter=iterations, pass_band=pass_band, normalize_coordinates=True, non_manifold_smoothing=True
    )
    return Mesh(np.asarray(smooth.points), mesh.faces)


def with_volume(mesh: Mesh, volume: float) -> Mesh:
    """The mesh scaled about its centroid to enclose `volume`.

    Raises
    ------
    GeometryError
        If the mesh encloses no volume.
    """
    if not mesh.volume > 0.0:
        raise GeometryError(f"The surface encloses no volume (its signed volume is {mesh.volume:.3g}).")
    centre = mesh.centroid
    scaled = mesh.moved(shift=-centre, scale=(volume / mesh.volume) ** (1 / 3))
    return scaled.moved(shift=centre)
