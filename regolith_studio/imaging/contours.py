"""Contours of voxels, their smoothing, and how deep each voxel lies in a mask.

Contours are smoothed by a windowed sinc: a low-pass filter on the mesh that does not shrink it much.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from skimage import measure

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.imaging.connected_components import largest_component, pores_filled

_marching_cubes: Any = measure.marching_cubes
MAX_DEPTH = 4
"""Distance in voxels at which depths are cut off."""


def contour(values: NDArray[Any], level: float, spacing: Sequence[float]) -> Mesh:
    """Surface where `values`, higher inside, cross `level` (marching cubes, Lewiner's table).

    ``values``: samples on a grid, shape (nx, ny, nz), below `level` all over the border of the grid.
    ``spacing``: distance of samples along each axis; the first sample lies at the origin.

    Raises ValueError if no value lies above `level` or none below, or the surface encloses no volume.
    """
    vertices, faces, _, _ = _marching_cubes(
        values, level, spacing=tuple(float(step) for step in spacing), gradient_direction="ascent"
    )
    mesh = Mesh(vertices, np.asarray(faces, dtype=np.int64))
    if not mesh.volume > 0.0:
        raise ValueError("the values must be higher inside, and lower all over the border of the grid")
    return mesh


def body_at_half(share: NDArray[np.float32]) -> BoolArray:
    """The largest body of voxels with a share of one half and more, with what it encloses."""
    body, _ = largest_component(np.ascontiguousarray(share >= 0.5))
    return pores_filled(body)


def body_contour(share: NDArray[np.float32]) -> Mesh:
    """Contour at one half of the largest body, without what it encloses."""
    body = body_at_half(share)
    # Filled pores and other bodies go to the other side of the level; not onto it, where marching cubes would
    # put several corners of a triangle into one place.
    one = np.where(body, np.maximum(share, 0.501), np.minimum(share, 0.499))
    mesh = contour(np.pad(one, 1).astype(np.float32), 0.5, (1.0, 1.0, 1.0))
    return mesh.moved(shift=np.full(3, -1.0))


def depth(mask: BoolArray) -> NDArray[np.float32]:
    """Distance of each voxel of a mask to the nearest one outside, at most :data:`MAX_DEPTH`; 0 outside.

    In voxels, between their centres, and exact below :data:`MAX_DEPTH`; beyond the array there is nothing.
    """
    squared = np.full(mask.shape, MAX_DEPTH * MAX_DEPTH, dtype=np.int32)
    _fill_squared(np.ascontiguousarray(mask), MAX_DEPTH, squared)
    return np.asarray(np.sqrt(squared), dtype=np.float32)


@kernel
def _fill_squared(mask: BoolArray, deepest: int, squares: NDArray[np.int32]) -> None:
    """Squared distances: along z, then the least over y, then over x; `squares` begins at the largest."""
    nx, ny, nz = mask.shape
    most = np.int32(deepest * deepest)
    along = np.empty((nx, ny, nz), dtype=np.int32)
    for i in range(nx):
        for j in range(ny):
            run = deepest
            for k in range(nz):
                run = min(run + 1, deepest) if mask[i, j, k] else 0
                along[i, j, k] = run
            run = deepest
            for k in range(nz - 1, -1, -1):
                run = min(run + 1, deepest) if mask[i, j, k] else 0
                nearest = min(run, along[i, j, k])
                along[i, j, k] = nearest * nearest
    across = np.full((nx, ny, nz), most, dtype=np.int32)
    for i in range(nx):
        for j in range(ny):
            for other in range(max(j - deepest + 1, 0), min(j + deepest, ny)):
                added = np.int32((other - j) ** 2)
                for k in range(nz):
                    across[i, j, k] = min(across[i, j, k], along[i, other, k] + added)
    for i in range(nx):
        for other in range(max(i - deepest + 1, 0), min(i + deepest, nx)):
            added = np.int32((other - i) ** 2)
            for j in range(ny):
                for k in range(nz):
                    squares[i, j, k] = min(squares[i, j, k], across[other, j, k] + added)


class LowPass:
    """The polynomial low-pass filter of Taubin, Zhang and Golub (1996) for meshes with the same faces.

    A Chebyshev series of the ideal low-pass filter with a Hamming window, scaled so that what is constant
    stays, of the mean of each corner's neighbours. It acts on each coordinate alone, so that it commutes with
    stretching along the axes: anisotropic voxels need no special care. VTK's filter of this name shifts the
    pass band, so that it lets more through.

    - ``faces``: triangles, shape (m, 3).
    - ``n_vertices``: corners of the mesh.
    - ``iterations``: degree of the polynomial; 0 leaves the mesh as it is.
    """

    def __init__(self, faces: IntArray, n_vertices: int, iterations: int) -> None:
        first, stop = np.zeros(n_vertices + 1, dtype=np.int64), np.empty(n_vertices, dtype=np.int64)
        others = np.empty(6 * len(faces), dtype=np.int64)
        _fill_links(faces, first, stop, others)
        self._links = first, stop, others
        self._iterations = iterations

    def __call__(self, vertices: FloatArray, pass_band: float) -> FloatArray:
        """Smoothed corners, shape (n, 3).

        ``vertices``: shape (n, 3). ``pass_band``: share of the mesh's frequencies that stay, 0 to 2; the
        smaller, the smoother.
        """
        if self._iterations == 0:
            return vertices
        smoothed = np.empty(vertices.shape)
        _filter(*self._links, _series(self._iterations, pass_band), vertices, smoothed)
        return smoothed


def windowed_sinc(mesh: Mesh, iterations: int = 20, pass_band: float = 0.13) -> Mesh:
    """The mesh smoothed by :class:`LowPass`."""
    return Mesh(LowPass(mesh.faces, len(mesh.vertices), iterations)(mesh.vertices, pass_band), mesh.faces)


def with_volume(mesh: Mesh, volume: float) -> Mesh:
    """The mesh scaled about its centroid to enclose `volume`.

    Raises GeometryError if the mesh encloses no volume.
    """
    if not mesh.volume > 0.0:
        raise GeometryError(f"The surface encloses no volume (its signed volume is {mesh.volume:.3g}).")
    centre = mesh.centroid
    scaled = mesh.moved(shift=-centre, scale=(volume / mesh.volume) ** (1 / 3))
    return scaled.moved(shift=centre)


def _series(iterations: int, pass_band: float) -> FloatArray:
    """Chebyshev coefficients, shape (iterations + 1,)."""
    order = np.arange(1, iterations + 1)
    # The series is in M = 1 - L / 2 with the frequencies, 0 to 2, of the umbrella Laplacian L.
    angle = np.arccos(1.0 - pass_band / 2.0)
    window = 0.54 + 0.46 * np.cos(np.pi * order / (iterations + 1))
    series = np.concatenate([[angle / np.pi], 2.0 * window * np.sin(order * angle) / (order * np.pi)])
    return np.asarray(series / series.sum())


@kernel
def _fill_links(faces: IntArray, first: IntArray, stop: IntArray, others: IntArray) -> None:
    """Neighbours of each corner: ``others[first[i]:stop[i]]``, each once; `first` is 0 before."""
    n_vertices = len(stop)
    for face in range(len(faces)):
        for corner in range(3):
            first[faces[face, corner] + 1] += 2
    for corner in range(n_vertices):
        first[corner + 1] += first[corner]
    stop[:] = first[:-1]
    for face in range(len(faces)):
        for corner in range(3):
            one = faces[face, corner]
            for turn in range(1, 3):
                other, known = faces[face, (corner + turn) % 3], False
                for at in range(first[one], stop[one]):
                    known = known or others[at] == other
                if not known:
                    others[stop[one]] = other
                    stop[one] += 1


@kernel
def _filter(
    first: IntArray,
    stop: IntArray,
    others: IntArray,
    series: FloatArray,
    vertices: FloatArray,
    total: FloatArray,
) -> None:
    """Sum of series[k] T_k(M) x: M is the mean of a corner and of the mean of its neighbours."""
    count = len(vertices)
    before, now, later = vertices.copy(), np.empty((count, 3)), np.empty((count, 3))
    total[:] = np.multiply(series[0], vertices)
    for degree in range(1, len(series)):
        source, weight = (before, 0.5) if degree == 1 else (now, 1.0)
        for corner in range(count):
            x, y, z = 0.0, 0.0, 0.0
            for at in range(first[corner], stop[corner]):
                other = others[at]
                x += source[other, 0]
                y += source[other, 1]
                z += source[other, 2]
            share = weight / max(stop[corner] - first[corner], 1)
            a = weight * source[corner, 0] + share * x
            b = weight * source[corner, 1] + share * y
            c = weight * source[corner, 2] + share * z
            if degree > 1:
                a -= before[corner, 0]
                b -= before[corner, 1]
                c -= before[corner, 2]
            later[corner, 0], later[corner, 1], later[corner, 2] = a, b, c
            total[corner, 0] += series[degree] * a
            total[corner, 1] += series[degree] * b
            total[corner, 2] += series[degree] * c
        if degree > 1:
            before, now, later = now, later, before
        else:
            now, later = later, now
