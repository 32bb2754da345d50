"""The low-pass filter that is prepared once, against VTK's and against what any such filter must do."""

import numpy as np
import pytest
import pyvista as pv

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.imaging.contours import LowPass, _series, windowed_sinc

SPHERE = icosphere(4)
LOW_PASS = LowPass(SPHERE.faces, len(SPHERE.vertices), 20)


def roughness(vertices: np.ndarray) -> float:
    return float(np.linalg.norm(vertices, axis=1).std())


def test_that_where_a_mesh_lies_does_not_matter() -> None:
    moved = SPHERE.vertices * [1, 2, 3] + [5, -2, 1]
    straight = LOW_PASS(SPHERE.vertices, 0.13)
    assert LOW_PASS(moved, 0.13) == pytest.approx(straight * [1, 2, 3] + [5, -2, 1], abs=1e-9)


def test_that_long_waves_stay_and_short_ones_vanish_as_under_vtk() -> None:
    """Noise of neighbouring corners; and z^2, which hardly changes from one corner to the next."""
    noise = 1.0 + 0.02 * np.random.default_rng(0).standard_normal((len(SPHERE.vertices), 1))
    surface = pv.PolyData.from_regular_faces(SPHERE.vertices * noise, np.array(SPHERE.faces))
    by_vtk = np.asarray(surface.smooth_taubin(n_iter=20, pass_band=0.13, normalize_coordinates=True).points)
    assert roughness(LOW_PASS(SPHERE.vertices * noise, 0.13)) < roughness(by_vtk) < 0.5 * 0.02
    wave = Mesh(SPHERE.vertices * (1 + 0.1 * SPHERE.vertices[:, 2:] ** 2), SPHERE.faces)
    smooth = windowed_sinc(wave, 20, 0.13)
    assert (smooth.volume, smooth.surface_area) == pytest.approx((wave.volume, wave.surface_area), rel=0.01)


def test_that_no_iteration_leaves_a_mesh_as_it_is() -> None:
    assert np.array_equal(windowed_sinc(SPHERE, 0).vertices, SPHERE.vertices)


def test_that_the_filter_is_the_series_of_chebyshev_polynomials_of_the_mean_of_neighbours() -> None:
    """On a tetrahedron the mean of neighbours has the eigenvalues 1 and -1/3, and the filter 1/3 of these."""
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    corners = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    faces.setflags(write=False)  # as those of a mesh, for which the filter is compiled
    series = _series(7, 0.4)
    factor = np.polynomial.chebyshev.chebval((1 - 1 / 3) / 2, series)
    assert LowPass(faces, 4, 7)(corners, 0.4) == pytest.approx(factor * corners, abs=1e-12)
    assert series.sum() == pytest.approx(1.0)
