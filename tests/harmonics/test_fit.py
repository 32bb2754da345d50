"""Fits of shapes with closed forms, their warnings, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from regolith_studio.errors import GeometryError, InputError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.fit import HarmonicFit, fit_harmonics
from regolith_studio.harmonics.fit_options import DEFAULT_FIT_OPTIONS, FitOptions
from regolith_studio.harmonics.star_point import hidden_surface_share
from regolith_studio.harmonics.synthesis import reconstruct


def test_that_a_sphere_has_one_coefficient():
    fit = fit_harmonics(icosphere(5).moved(shift=(3.0, 1.0, -2.0), scale=7.0), 10)
    np.testing.assert_allclose(fit.star_point, [21.0, 7.0, -14.0], atol=1e-9)
    assert fit.coefficients.mean_radius == pytest.approx(7.0, rel=1e-3)
    assert np.abs(fit.coefficients.values[1:]).max() < 1e-3 * fit.coefficients.values[0]
    assert fit.star_shaped
    assert fit.warnings == ()


def test_that_a_sphere_off_centre_has_the_coefficients_of_its_closed_form():
    """r(t) = -d cos t + sqrt(1 - d^2 sin^2 t) about a point d above the centre."""
    d = 0.3
    fit = fit_harmonics(icosphere(5), 6, star_point=(0.0, 0.0, d))
    for degree in range(5):
        legendre = np.polynomial.legendre.Legendre.basis(degree)

        def integrand(z, legendre=legendre):
            return legendre(z) * (-d * z + np.sqrt(1 - d**2 * (1 - z**2)))

        wanted = 2 * np.pi * np.sqrt((2 * degree + 1) / (4 * np.pi)) * quad(integrand, -1, 1)[0]
        assert fit.coefficients.values[degree**2 + degree] == pytest.approx(wanted, abs=3e-3)


def test_that_an_ellipsoid_of_revolution_has_the_mean_radius_of_its_closed_form():
    """Mean over the sphere of (sin^2 t + cos^2 t / c^2)^-1/2 = asinh(e) / e with e^2 = 1 / c^2 - 1."""
    sphere = icosphere(5)
    fit = fit_harmonics(Mesh(sphere.vertices * [1.0, 1.0, 0.5], sphere.faces), 20)
    e = np.sqrt(3.0)
    assert fit.coefficients.mean_radius == pytest.approx(np.arcsinh(e) / e, rel=1e-3)


def test_that_fits_do_not_depend_on_where_the_particle_lies_or_on_its_unit(ellipsoid):
    body = ellipsoid(1.5, 1.2, 1.0)
    here = fit_harmonics(body, 8, sampling_degree=20)
    for scale in (1e-6, 1e6):
        there = fit_harmonics(body.moved(shift=(5.0, -3.0, 2.0), scale=scale), 8, sampling_degree=20)
        np.testing.assert_allclose(there.coefficients.values / scale, here.coefficients.values, atol=1e-9)


def test_that_a_fit_finds_the_coefficients_of_its_surface(rough):
    surface = reconstruct(rough(8), level=4)
    fit = fit_harmonics(surface, 8, star_point=(0, 0, 0), sampling_degree=40)
    error = np.linalg.norm(fit.coefficients.values - rough(8).values)
    assert error < 1e-3 * np.linalg.norm(rough(8).values)


def test_that_a_ring_is_fitted_from_inside_its_tube_with_a_warning(torus):
    fit = fit_harmonics(torus(2.0, 0.8), 10, sampling_degree=30)
    assert "centre of mass lies outside" in fit.warnings[0]
    assert "Hidden from the star point" in fit.warnings[1]
    assert fit.hidden_surface_share > 0.1
    assert fit.unrepresentable_volume_share > 0.1


def test_that_the_shares_of_a_bracket_are_reported(bracket):
    fit = fit_harmonics(bracket, 10, star_point=(0.5, 2.0, 0.5), sampling_degree=40)
    assert fit.hidden_surface_share == hidden_surface_share(bracket, fit.star_point)
    assert not fit.star_shaped
    footprint = 0.5 * (2.0 + 1.5) * 1.0
    assert fit.unrepresentable_volume_share == pytest.approx(footprint / 5.0, abs=0.02)


def test_that_a_flat_grain_is_missed_and_an_ellipsoid_as_reference_comes_closer(ellipsoid):
    flat = ellipsoid(4.0, 3.0, 0.6, level=4)
    about_sphere = fit_harmonics(flat, 10)
    about_ellipsoid = fit_harmonics(flat, 10, reference="ellipsoid")
    assert about_sphere.radial_error > 0.05
    assert f"{about_sphere.radial_error:.1%}" in about_sphere.warnings[0]
    assert "an ellipsoid as reference" in about_sphere.warnings[0]
    assert "at most" in about_sphere.warnings[0]
    assert about_ellipsoid.radial_error < about_sphere.radial_error / 5
    assert about_ellipsoid.warnings == ()
    unusable = replace(about_sphere, radial_error=37.323).warnings
    assert unusable[-1] == "RMS radius error up to l = 10: 3,732%, so that the fit cannot be used."


def test_that_a_truncated_fit_has_the_error_of_a_fit_to_that_degree(ellipsoid):
    flat = ellipsoid(4.0, 3.0, 0.6, level=4)
    cut = fit_harmonics(flat, 30).truncated(6)
    direct = fit_harmonics(flat, 6)
    assert cut.radial_error == pytest.approx(direct.radial_error, rel=1e-2)
    assert "up to l = 6" in cut.warnings[0]
    assert cut.truncated(6) is cut
    with pytest.raises(InputError, match=r"0 to 6, got 7"):
        cut.truncated(7)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"l_max": 31, "sampling_degree": 30}, r"l_max must be a whole number from 0 to 30, got 31\."),
        ({"l_max": -1}, r"from 0 to 60, got -1"),
        ({"star_point": (9.0, 0.0, 0.0)}, r"star point \(9, 0, 0\) lies outside"),
        ({"star_point": "nose"}, r"centre_of_mass, kernel_centre, least_hidden_volume, got 'nose'"),
        ({"rule": "mean"}, r"volume, outermost, first, got 'mean'"),
        ({"reference": "cube"}, r"sphere, ellipsoid, got 'cube'"),
    ],
)
def test_that_bad_settings_are_refused_in_one_sentence(ellipsoid, change, sentence):
    with pytest.raises(InputError, match=sentence):
        fit_harmonics(ellipsoid(2.0, 1.0, 1.0, level=1), **({"l_max": 4} | change))


def test_that_an_open_mesh_is_refused(ellipsoid):
    body = ellipsoid(2.0, 1.0, 1.0, level=1)
    with pytest.raises(GeometryError, match=r"The mesh is open"):
        fit_harmonics(Mesh(body.vertices, body.faces[:-1]), 4)


def test_that_star_points_are_chosen_by_name(bracket):
    fit = fit_harmonics(bracket, 4, star_point="kernel_centre", sampling_degree=10)
    np.testing.assert_allclose(fit.star_point, 0.5, atol=1e-9)
    assert fit.star_shaped


@pytest.mark.real_data
@pytest.mark.parametrize("name", ["cement140-anm-00012", "cement140-anm-00142"])
def test_that_fits_of_voxel_grains_keep_their_volume(real_data, name):
    import trimesh

    loaded = trimesh.load(real_data(f"cement140/voxel/{name}.stl"))
    grain = Mesh(loaded.vertices, loaded.faces)
    fit = fit_harmonics(grain)
    assert 0.0 < fit.hidden_surface_share < 0.05
    assert fit.unrepresentable_volume_share < 0.001
    assert reconstruct(fit, 30).volume == pytest.approx(grain.volume, rel=1e-3)
    assert reconstruct(fit, 10).volume == pytest.approx(grain.volume, rel=6e-3)


@pytest.fixture(scope="module")
def spheroid() -> Mesh:
    ball = icosphere(3)
    return Mesh(ball.vertices * (1.0, 1.0, 0.25), ball.faces)


def test_that_the_usual_expansion_is_that_of_a_bare_fit(spheroid: Mesh) -> None:
    bare, usual = fit_harmonics(spheroid, 12), DEFAULT_FIT_OPTIONS.fit(spheroid, 12)
    assert np.array_equal(bare.coefficients.values, usual.coefficients.values)


def test_that_an_ellipsoid_divided_by_itself_has_one_coefficient(spheroid: Mesh) -> None:
    assert _largest_share(FitOptions(reference="ellipsoid").fit(spheroid, 12)) < 1e-3
    assert _largest_share(DEFAULT_FIT_OPTIONS.fit(spheroid, 12)) > 0.3


def _largest_share(fit: HarmonicFit) -> float:
    values = np.abs(fit.coefficients.values)
    return float(values[1:].max() / values[0])


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"star_point": "middle"}, "The setting star_point must be one of centre_of_mass"),
        ({"rule": "second"}, "The setting rule must be one of volume"),
        ({"reference": "cube"}, "The setting reference must be one of sphere"),
    ],
)
def test_that_an_unknown_choice_is_refused_with_what_there_is(changes: dict[str, str], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        FitOptions(**changes)
