"""Surfaces reconstructed from coefficients: volumes and areas of closed forms, and the way back."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from scipy.special import elliprg

from regolith_studio.errors import GeometryError, InputError
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics import synthesis
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.fit import HarmonicFit, fit_harmonics
from regolith_studio.harmonics.radius_function import Ellipsoid, is_closed, sample_radius
from regolith_studio.harmonics.sphere_grid import harmonics
from regolith_studio.harmonics.synthesis import (
    enclosed_volume,
    gallery,
    icosphere_edges,
    radii,
    reconstruct,
)
from regolith_studio.harmonics.transform import evaluate_on_grid, ray_grid

UNIT_SPHERE = ShCoefficients([np.sqrt(4 * np.pi)])


def test_that_an_ellipsoid_as_reference_has_its_volume_and_the_area_of_carlsons_integral():
    a, b, c = 3.0, 2.0, 1.2
    ellipsoid = Ellipsoid(np.eye(3), [a, b, c])
    area = 4 * np.pi * elliprg(*[(a * b) ** 2, (a * c) ** 2, (b * c) ** 2])
    assert enclosed_volume(UNIT_SPHERE, ellipsoid) == pytest.approx(4 / 3 * np.pi * a * b * c, rel=1e-7)
    mesh = reconstruct(HarmonicFit(UNIT_SPHERE, np.zeros(3), reference=ellipsoid), level=5)
    assert mesh.surface_area == pytest.approx(area, rel=2e-3)


def test_that_the_volume_is_the_integral_of_r_cubed_over_three(rough):
    particle, grid = rough(10), ray_grid(60)
    exact = 4 * np.pi / 3 * grid.mean(evaluate_on_grid(grid, particle) ** 3)
    assert enclosed_volume(particle) == pytest.approx(exact, rel=1e-13)
    unit_ball = Ellipsoid(np.eye(3), [1.0, 1.0, 1.0])
    assert enclosed_volume(particle, unit_ball) == pytest.approx(exact, rel=1e-13)


def test_that_the_area_of_ever_finer_meshes_converges(rough):
    areas = [reconstruct(rough(8), level=k).surface_area for k in (3, 4, 5)]
    assert areas[2] == pytest.approx(areas[1], rel=4e-3)
    assert (areas[1] - areas[0]) / (areas[2] - areas[1]) == pytest.approx(4.0, rel=0.35)


def test_that_a_surface_is_closed_and_has_the_volume_of_the_quadrature(rough):
    for l_max in (0, 1, 7, 30):
        surface = reconstruct(rough(30), l_max, level=3)
        assert is_closed(surface)
        assert surface.volume == pytest.approx(enclosed_volume(rough(30).truncated(l_max)), rel=1e-12)


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


def test_that_the_radial_error_of_a_good_fit_is_small_and_of_a_bad_one_is_not(ellipsoid):
    body = ellipsoid(2.0, 1.5, 1.0, level=4)
    fit, directions = fit_harmonics(body, 20), icosphere(3).vertices
    wanted = sample_radius(body, fit.star_point, directions).radii
    assert np.abs(radii(fit, directions) - wanted).max() < 0.01
    assert np.abs(radii(fit, directions, 1) - wanted).max() > 0.2


@pytest.mark.parametrize("l_max", [-1, 11])
def test_that_a_degree_out_of_range_is_refused(rough, l_max):
    with pytest.raises(InputError, match=r"l_max must be a whole number from 0 to 10"):
        reconstruct(rough(10), l_max)


@pytest.mark.parametrize(
    ("l_max", "level"), [(0, 2), (3, 2), (10, 2), (11, 2), (30, 2), (33, 2), (3, 6), (12, 6)]
)
def test_that_cached_and_direct_synthesis_agree_with_the_plain_sum(rough, l_max, level):
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
    synthesis.cached_harmonics.cache_clear()
    with ThreadPoolExecutor(4) as pool:
        surfaces = list(pool.map(lambda _: reconstruct(rough(10), level=2).vertices, range(8)))
    for vertices in surfaces[1:]:
        np.testing.assert_array_equal(vertices, surfaces[0])


def test_that_shortfalls_are_those_of_chords_under_the_unit_circle():
    edges = icosphere_edges(2)
    sphere = icosphere(2)
    chord_error = edges.chord_errors(np.ones(len(sphere.vertices)), np.ones(len(edges.ends)))
    chords = np.linalg.norm(sphere.vertices[edges.ends].mean(axis=1), axis=1)
    assert (1 - chords).min() <= chord_error.min() <= chord_error.max() <= (1 - chords).max()
