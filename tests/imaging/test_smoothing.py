"""The low-pass filter that is prepared once, against VTK's and against what any such filter must do."""

import numpy as np
import pytest

from regolith_studio.geometry.directions import icosphere
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.imaging.smoothing import LowPass, windowed_sinc

SPHERE = icosphere(4)
LOW_PASS = LowPass(SPHERE.faces, len(SPHERE.vertices), 20, 0.13)


def roughness(vertices: np.ndarray) -> float:
    return float(np.linalg.norm(vertices, axis=1).std())


def test_that_where_a_mesh_lies_does_not_matter() -> None:
    moved = SPHERE.vertices * [1, 2, 3] + [5, -2, 1]
    assert LOW_PASS(moved) == pytest.approx(LOW_PASS(SPHERE.vertices) * [1, 2, 3] + [5, -2, 1], abs=1e-9)


def test_that_long_waves_stay_and_short_ones_vanish_as_under_vtk() -> None:
    """Noise of neighbouring corners; and z^2, which hardly changes from one corner to the next."""
    noise = 1.0 + 0.02 * np.random.default_rng(0).standard_normal((len(SPHERE.vertices), 1))
    by_vtk = windowed_sinc(Mesh(SPHERE.vertices * noise, SPHERE.faces), 20, 0.13).vertices
    assert roughness(LOW_PASS(SPHERE.vertices * noise)) < roughness(by_vtk) < 0.5 * 0.02
    wave = Mesh(SPHERE.vertices * (1 + 0.1 * SPHERE.vertices[:, 2:] ** 2), SPHERE.faces)
    smooth = Mesh(LOW_PASS(wave.vertices), wave.faces)
    assert (smooth.volume, smooth.surface_area) == pytest.approx((wave.volume, wave.surface_area), rel=0.01)
