"""Windowed-sinc smoothing of contoured masks: a low-pass filter on the mesh that does not shrink it much."""

from typing import Any

import numpy as np
import pyvista as pv
from scipy import sparse

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import FloatArray, IntArray
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


class LowPass:
    """The filter of :func:`windowed_sinc` for closed meshes that are smoothed again and again.

    What depends on the faces alone is worked out once, while VTK looks the neighbours up each time. The
    polynomial is Taubin, Zhang and Golub's: a Chebyshev series of the ideal low-pass filter with a Hamming
    window, scaled so that what is constant stays. VTK shifts its pass band, so that it lets more through.

    Parameters
    ----------
    faces
        Triangles, shape (m, 3).
    n_vertices
        Corners of the mesh.
    iterations, pass_band
        As for :func:`windowed_sinc`; at least one iteration.
    """

    def __init__(self, faces: IntArray, n_vertices: int, iterations: int, pass_band: float) -> None:
        edges = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        ones, shape = np.ones(len(edges)), (n_vertices, n_vertices)
        linked = sparse.csr_array((ones, (edges[:, 0], edges[:, 1])), shape=shape)
        linked = ((linked + linked.T) > 0).astype(np.float64)
        count = np.maximum(linked.sum(axis=1), 1.0)
        self._average = sparse.csr_array(
            (sparse.eye_array(n_vertices) + sparse.diags_array(1.0 / count) @ linked) / 2
        )
        order = np.arange(1, iterations + 1)
        angle = np.arccos(1.0 - pass_band / 2.0)
        window = 0.54 + 0.46 * np.cos(np.pi * order / (iterations + 1))
        series = np.concatenate([[angle / np.pi], 2.0 * window * np.sin(order * angle) / (order * np.pi)])
        self._series: FloatArray = series / series.sum()

    def __call__(self, vertices: FloatArray) -> FloatArray:
        """Smoothed corners, shape (n, 3)."""
        before: FloatArray = vertices
        now = np.asarray(self._average @ before)
        total: FloatArray = self._series[0] * before + self._series[1] * now
        for factor in self._series[2:]:
            before, now = now, 2.0 * np.asarray(self._average @ now) - before
            total = total + factor * now
        return total
