"""Surfaces rebuilt from coefficients: volumes and areas with closed forms, and the way back."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from scipy.special import elliprg

from regolith_studio.errors import GeometryError, InputError
from regolith_studio.geometry.sphere_points import fibonacci_directions, icosphere
from regolith_studio.harmonics import synthesis
from regolith_studio.harmonics.closed_surface import is_closed
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.fit import HarmonicFit, fit_harmonics
from regolith_studio.harmonics.icosphere_edges import icosphere_edges
from regolith_studio.harmonics.legendre import harmonics
from regolith_studio.harmonics.quadrature import _fill_fields, measure, measure_on_grid
from regolith_studio.harmonics.reference import Ellipsoid
from regolith_studio.harmonics.surface import (
    error_map,
    flat_volume,
    gallery,
    measures,
    radii,
    reconstruct,
)
from tests.filling import filled

UNIT_SPHERE = ShCoefficients([np.sqrt(4 * np.pi)])


def test_that_a_sphere_has_its_volume_and_area():
    sphere = measures(UNIT_SPHERE.scaled(2.0))
    assert sphere.volume == pytest.approx(32 / 3 * np.pi, rel=1e-13)
    assert sphere.surface_area == pytest.approx(16 * np.pi, rel=1e-13)
    assert reconstruct(UNIT_SPHERE, level=3).volume == pytest.approx(4 / 3 * np.pi, rel=1e-13)


def test_that_an_ellipsoid_as_reference_has_the_area_of_carlsons_integral():
    a, b, c = 3.0, 2.0, 1.2
    ellipsoid = Ellipsoid(np.eye(3), [a, b, c])
    found = measure(UNIT_SPHERE, ellipsoid)
    area = 4 * np.pi * elliprg(*[(a * b) ** 2, (a * c) ** 2, (b * c) ** 2])
    assert found.volume == pytest.approx(4 / 3 * np.pi * a * b * c, rel=1e-7)
    assert found.surface_area == pytest.approx(area, rel=1e-6)
    mesh = reconstruct(HarmonicFit(UNIT_SPHERE, np.zeros(3), reference=ellipsoid), level=5)
    assert mesh.surface_area == pytest.approx(area, rel=2e-3)


def test_that_the_gradient_of_an_ellipsoids_radius_is_that_of_finite_differences():
    turned = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    ellipsoid = Ellipsoid(turned, [3.0, 2.0, 1.2])
    directions = fibonacci_directions(40)
    aside = np.cross(directions, [0.3, -0.5, 0.8])
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    step = 1e-6
    ahead, behind = (np.cos(s) * directions + np.sin(s) * aside for s in (step, -step))
    slope = (ellipsoid.radii(ahead) - ellipsoid.radii(behind)) / (2 * step)
    gradient = ellipsoid.gradients(directions)
    np.testing.assert_allclose(np.einsum("ij,ij->i", gradient, aside), slope, atol=1e-8)
    np.testing.assert_allclose(np.einsum("ij,ij->i", gradient, directions), 0.0, atol=1e-12)


def test_that_the_volume_is_exact_at_one_and_a_half_times_the_degree(rough):
    particle = rough(10)
    exact = measure_on_grid(particle, 60)[0]
    assert measure_on_grid(particle, 15)[0] == pytest.approx(exact, rel=1e-13)
    assert measure_on_grid(particle, 10)[0] != pytest.approx(exact, rel=1e-9)


def test_that_the_area_converges_and_agrees_with_ever_finer_meshes(rough):
    particle = rough(8)
    found = measures(particle)
    assert found.area_change < 1e-6
    gaps = [abs(reconstruct(particle, level=k).surface_area / found.surface_area - 1) for k in (3, 4, 5)]
    assert gaps[2] < 1e-3
    assert gaps[0] / gaps[1] == pytest.approx(4.0, rel=0.35)
    assert gaps[1] / gaps[2] == pytest.approx(4.0, rel=0.25)


def test_that_a_surface_is_closed_and_has_the_volume_of_the_quadrature(rough):
    for l_max in (0, 1, 7, 30):
        surface = reconstruct(rough(30), l_max, level=3)
        assert is_closed(surface)
        assert surface.volume == pytest.approx(measures(rough(30), l_max).volume, rel=1e-12)


@pytest.mark.parametrize("seed", range(3))
def test_that_coefficients_survive_the_way_through_a_mesh(rough, seed):
    """At l = 10 within 1e-3 with the default mesh, and by the square of the edge length with refinement."""
    particle = rough(10, seed, strength=0.4)
    errors = []
    for level in (3, 4, 5):
        surface = reconstruct(particle, level=level)
        again = fit_harmonics(surface, 10, star_point=(0, 0, 0)).coefficients
        errors.append(np.linalg.norm(again.values - particle.values) / np.linalg.norm(particle.values))
    assert errors[1] < 1e-3
    assert errors[0] > 12.0 * errors[2]
    assert errors[1] > 2.0 * errors[2]


def test_that_a_negative_radius_is_reported_and_never_meshed():
    values = np.zeros(9)
    values[0], values[6] = np.sqrt(4 * np.pi), 4.0
    with pytest.raises(
        GeometryError, match=r"up to l = 2 has a negative radius in \d+ of 2562 directions \(lowest -"
    ):
        reconstruct(ShCoefficients(values))
    assert measures(ShCoefficients(values)).lowest_radius < 0
    assert dict(gallery(ShCoefficients(values), [0, 2], level=2))[2] is None


def test_that_a_gallery_shows_what_single_reconstructions_show(rough):
    for degree, surface in gallery(rough(30), [0, 1, 5, 10, 30], level=3):
        wanted = reconstruct(rough(30), degree, level=3)
        np.testing.assert_allclose(surface.vertices, wanted.vertices, atol=1e-12)


def test_that_a_surface_lies_in_the_frame_of_its_particle(ellipsoid):
    body = ellipsoid(2.0, 1.5, 1.0).moved(shift=(10.0, 20.0, 30.0))
    surface = reconstruct(fit_harmonics(body, 12, sampling_degree=30), level=3)
    np.testing.assert_allclose(surface.centroid, body.centroid, atol=5e-3)
    assert surface.volume == pytest.approx(body.volume, rel=5e-3)


def test_that_the_error_map_of_a_good_fit_is_small_and_of_a_bad_one_is_not(ellipsoid):
    body = ellipsoid(2.0, 1.5, 1.0, level=4)
    fit = fit_harmonics(body, 20)
    assert np.abs(error_map(fit, body, level=3)).max() < 0.01
    assert np.abs(error_map(fit, body, 1, level=3)).max() > 0.2


@pytest.mark.parametrize("l_max", [-1, 11])
def test_that_a_degree_out_of_range_is_refused(rough, l_max):
    with pytest.raises(InputError, match=r"l_max must be a whole number from 0 to 10"):
        reconstruct(rough(10), l_max)


@pytest.mark.parametrize(
    ("l_max", "level"), [(0, 2), (3, 2), (10, 2), (11, 2), (30, 2), (33, 2), (3, 6), (12, 6)]
)
def test_that_kept_and_direct_synthesis_agree_with_the_plain_sum(rough, l_max, level):
    directions = icosphere(level).vertices
    plain = rough(l_max).values @ harmonics(directions, l_max)
    np.testing.assert_allclose(synthesis.radii_on_icosphere(rough(l_max), level), plain, atol=1e-12)
    np.testing.assert_allclose(radii(rough(l_max), directions), plain, atol=1e-12)


def test_that_running_sums_are_the_expansions_cut_at_each_degree(rough):
    particle = rough(6)
    at_vertices, between = synthesis.radii_by_degree(particle, 2)
    for degree in range(7):
        wanted = synthesis.radii_on_icosphere(particle.truncated(degree), 2)
        np.testing.assert_allclose(at_vertices[degree], wanted, atol=1e-13)
        middle = radii(particle.truncated(degree), icosphere_edges(2).middles)
        np.testing.assert_allclose(between[degree], middle, atol=1e-6)


def test_that_threads_that_ask_at_once_get_the_same_surface(rough):
    synthesis.kept_harmonics.cache_clear()
    with ThreadPoolExecutor(4) as pool:
        surfaces = list(pool.map(lambda _: reconstruct(rough(10), level=2).vertices, range(8)))
    for vertices in surfaces[1:]:
        np.testing.assert_array_equal(vertices, surfaces[0])


def test_that_shortfalls_are_those_of_chords_under_the_unit_circle():
    edges = icosphere_edges(2)
    sphere = icosphere(2)
    shortfall = edges.shortfalls(np.ones(len(sphere.vertices)), np.ones(len(edges.ends)))
    chords = np.linalg.norm(sphere.vertices[edges.ends].mean(axis=1), axis=1)
    assert (1 - chords).min() <= shortfall.min() <= shortfall.max() <= (1 - chords).max()


def test_that_compiled_and_plain_kernels_agree(rough):
    particle = rough(3)
    cosines = np.array([-0.5, 0.2, 0.9])
    arguments, fields = (particle.values, 3, cosines), np.zeros((3, 3, 5))
    one, two = (filled(f, arguments, *fields)[:3] for f in (_fill_fields, _fill_fields.py_func))
    np.testing.assert_allclose(one, two, atol=1e-14)
    directions = fibonacci_directions(4)
    basis, values = harmonics(directions, 3), np.empty(4)
    arguments, nothing = (basis, particle.values), np.zeros(basis.shape[1])
    plain, _ = filled(synthesis._add_weighted.py_func, arguments, nothing)
    np.testing.assert_allclose(plain, particle.values @ basis)
    synthesis._evaluate.py_func(directions, particle.values, 3, values)
    np.testing.assert_allclose(values, particle.values @ basis, atol=1e-14)
    sphere = icosphere(1)
    assert flat_volume.py_func(sphere.vertices, sphere.faces) == pytest.approx(sphere.volume, rel=1e-13)
    sums, _ = filled(synthesis._fill_running_sums.py_func, arguments, np.zeros((4, basis.shape[1])))
    np.testing.assert_allclose(sums, synthesis.running_sums(basis, particle.values, 3), atol=1e-15)
