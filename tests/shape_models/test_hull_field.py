"""Hulls on a grid, the copula, and the field that is drawn to its hull."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.spatial import ConvexHull
from scipy.stats import spearmanr

from regolith_studio.descriptors.describe import describe
from regolith_studio.errors import InputError
from regolith_studio.shape_models.inertia_ellipsoid import forms, log_ellipsoids, with_forms
from regolith_studio.shape_models.materials import materials
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.models.hull_field import (
    FineDegrees,
    GaussianCopula,
    HullFieldSettings,
    features_and_target,
    measured_features,
)
from regolith_studio.shape_models.realizations import Realizations, virtual_mesh
from regolith_studio.shape_models.sample import Sample, log_shapes
from regolith_studio.shape_models.shape_features import (
    CONVEXITY,
    FORM,
    POWERS,
    ROWS,
    SPHERICITY,
    hull_grid,
    outer_features_of_radii,
    powers,
    shape_features,
    shape_grid,
    supports,
)
from tests.filling import filled

MODEL = MODELS["hull_field"]


def _dented(n: int, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    rows = 0.05 * rng.normal(size=(n, 49))
    rows[:, 0] = 0.0
    return np.asarray(hull_grid(14, 6).grid.values(rows))


def test_that_an_ellipsoid_has_the_axes_asked_for() -> None:
    directions = np.vstack([np.eye(3), -np.eye(3)])
    short, middle, long = np.exp(log_ellipsoids(directions, np.array([[0.3, 0.2]]), np.eye(3)[None]))[0, :3]
    assert long / middle == pytest.approx(np.exp(0.3))
    assert middle / short == pytest.approx(np.exp(0.2))
    assert short * middle * long == pytest.approx(1.0)


def test_that_hulls_on_the_grid_hold_the_hull_of_its_points() -> None:
    shapes = hull_grid(14, 6)
    radii = np.exp(_dented(5))
    hulls = shapes.hulls(radii)
    for radius, hull in zip(radii, hulls, strict=True):
        planes = ConvexHull(radius[:, None] * shapes.grid.directions).equations
        heights = shapes.grid.directions @ planes[:, :3].T
        exact = np.where(heights > 1e-9, -planes[:, 3] / np.maximum(heights, 1e-9), np.inf).min(axis=1)
        assert (hull >= exact * (1 - 1e-5)).all()
        assert (hull / exact - 1).mean() < 0.03


def test_that_the_support_of_a_hull_is_the_farthest_of_its_points() -> None:
    shapes = hull_grid(5, 2)
    radii = np.exp(_dented(3)[:, : len(shapes.grid.weights)]).astype(np.float32)
    arguments, nothing = (radii, shapes.cosines, shapes.reaches), np.zeros_like(radii)
    found, *_ = filled(supports, arguments, nothing)
    np.testing.assert_array_equal(found, (radii[:, :, None] * shapes.cosines).max(axis=1))
    assert len(shapes.cosines) % ROWS, "the last directions are fewer than a group"


def test_that_a_surface_drawn_to_its_hull_fills_the_share_asked_for() -> None:
    shapes = hull_grid(14, 6)
    logs = _dented(40)
    before = shapes.convexities(np.exp(logs))
    wanted = np.clip(before + np.linspace(-0.03, 0.05, 40), 0.0, 0.98)
    np.testing.assert_allclose(
        shapes.convexities(np.exp(shapes.with_convexities(logs, wanted))), wanted, atol=2e-4
    )
    np.testing.assert_allclose(np.exp(shapes.drawn(logs, 1.0)), shapes.hulls(np.exp(logs)), rtol=1e-5)


def test_that_a_copula_keeps_ranks_and_marginals() -> None:
    rng = np.random.default_rng(3)
    normal = rng.multivariate_normal([0, 0, 0], [[1, 0.6, -0.3], [0.6, 1, 0], [-0.3, 0, 1]], size=4000)
    table = np.column_stack([normal[:, 0], np.exp(normal[:, 1]), normal[:, 2] ** 3])
    copula = GaussianCopula.of(table)
    drawn = copula.draw(rng.permutation(table[:, 0]), rng)
    np.testing.assert_allclose(spearmanr(drawn).statistic, spearmanr(table).statistic, atol=0.05)
    np.testing.assert_allclose(np.percentile(drawn, [10, 50, 90], axis=0)[:, 1],
                               np.percentile(table, [10, 50, 90], axis=0)[:, 1], rtol=0.06)  # fmt: skip


def test_that_a_first_number_beyond_the_tables_goes_with_the_outermost() -> None:
    x = np.linspace(0.0, 1.0, 500)
    copula = GaussianCopula.of(np.column_stack([x, 2 * x]))
    drawn = copula.draw(np.full(200, 50.0), np.random.default_rng(0))
    assert drawn[:, 0].min() == 50.0
    assert 1.5 < drawn[:, 1].mean() <= 2.0


def test_that_numbers_that_are_no_distribution_are_refused() -> None:
    with pytest.raises(InputError, match="finite and ascend"):
        GaussianCopula(np.array([[1.0], [0.0]]), np.eye(1))
    with pytest.raises(InputError, match="positive definite"):
        GaussianCopula(np.array([[0.0, 0.0], [1.0, 1.0]]), np.ones((2, 2)))


def test_that_the_numbers_of_an_ellipsoid_are_its_own() -> None:
    shapes = shape_grid(10)
    logs = log_ellipsoids(shapes.grid.directions, np.array([[0.25, 0.15]]), np.eye(3)[None])
    found = shape_features(shapes.grid.expanded(7 * np.exp(logs)))[0]
    assert np.exp(found[0]) == pytest.approx(7.0, rel=1e-3)
    np.testing.assert_allclose(found[FORM], [0.25, 0.15], atol=2e-3)
    assert found[POWERS].max() < -10
    assert found[CONVEXITY] > 4


def test_that_fine_degrees_have_the_power_that_goes_with_the_particles(
    rough_sample: Callable[..., Sample],
) -> None:
    shapes = log_shapes(rough_sample(200, 9))
    fine = FineDegrees.of(shapes.coefficients, shapes.equivalent_radii, 6)
    base = shapes.coefficients[:, :49]
    rows = fine.added(base, shapes.equivalent_radii, np.random.default_rng(1))
    np.testing.assert_allclose(rows[:, :49], base, rtol=1e-12)
    measured, drawn = (np.log(powers(each)[:, 7:]) for each in (shapes.coefficients, rows))
    error = measured.std(axis=0) * np.sqrt(2 / 200)
    assert (np.abs(drawn.mean(axis=0) - measured.mean(axis=0)) < 4 * error).all()
    np.testing.assert_allclose(drawn.std(axis=0), measured.std(axis=0), rtol=0.25)


@pytest.mark.slow
def test_that_draws_with_fine_degrees_fill_their_hulls_and_are_as_round_as_the_sample() -> None:
    """Of meshes, the hull by scipy; a sample cut at the tenth degree would be rounder than its particles."""
    card = materials()["ma165"].model(14).draw(100, 0)
    sample = Sample(np.stack([card.particle(index).values for index in range(100)]))
    fitted = MODEL.fit(sample, HullFieldSettings(l_max=14))

    def seen(draws: Realizations) -> np.ndarray:
        meshes = [virtual_mesh(draws, index, level=3) for index in range(100)]
        rows = (
            [(36 * np.pi * mesh.volume**2) ** (1 / 3) / mesh.surface_area for mesh in meshes],
            [mesh.volume / ConvexHull(mesh.vertices).volume for mesh in meshes],
        )
        return np.array(rows)

    measured = seen(Realizations(sample.coefficients, "radius", "measured", 0))
    drawn = seen(fitted.draw(100, 3))
    error = measured.std(axis=1) * np.sqrt(2 / 100)
    assert (np.abs(drawn.mean(axis=1) - measured.mean(axis=1)) < 3 * error).all()
    cut = seen(Realizations(sample.truncated(10).coefficients, "radius", "cut", 0))
    assert (cut.mean(axis=1) > measured.mean(axis=1) + error).all()


@pytest.mark.slow
def test_that_a_field_cut_at_a_degree_draws_the_first_degrees_of_the_same_particles(
    rough_sample: Callable[..., Sample],
) -> None:
    whole = MODEL.fit(rough_sample(20, 13), HullFieldSettings(13, "log_normal"))
    rows = whole.draw(5, 1).coefficients
    for degree in (10, 13):
        cut = whole.truncated(degree)
        assert cut.l_max == degree
        np.testing.assert_allclose(
            cut.draw(5, 1).coefficients[:, 1:], rows[:, 1 : (degree + 1) ** 2], rtol=1e-12
        )
    assert np.isfinite(whole.truncated(12).draw(5, 1).coefficients).all()
    for degree in (9, 14):
        with pytest.raises(InputError, match=f"with l_max from 10 to 13, got l_max = {degree}"):
            whole.truncated(degree)


@pytest.mark.parametrize("l_max", [2, 31])
def test_that_a_degree_that_has_no_facets_or_too_many_is_refused(
    l_max: int, rough_sample: Callable[..., Sample]
) -> None:
    with pytest.raises(InputError, match=f"has l_max 3 to 30, got {l_max}"):
        MODEL.fit(rough_sample(10, 31), HullFieldSettings(l_max=l_max))


def test_that_an_unknown_law_of_sizes_is_refused(rough_sample: Callable[..., Sample]) -> None:
    with pytest.raises(InputError, match="size law must be one of"):
        MODEL.fit(rough_sample(10), HullFieldSettings(4, "even"))


def test_that_a_body_gets_the_form_wanted() -> None:
    grid = shape_grid(6).grid
    rng = np.random.default_rng(4)
    rough = rng.normal(size=(30, 49)) * 0.04
    wanted = rng.uniform(0.0, 0.5, size=(30, 2))
    once, twice = (forms(with_forms(grid.values(rough), wanted, grid, steps), grid)[0] for steps in (1, 2))
    assert np.abs(once - wanted).max() < 0.1
    assert np.abs(twice - wanted).max() < 0.3 * np.abs(once - wanted).max()


def test_that_the_form_on_the_grid_is_that_of_the_solid() -> None:
    coefficients = np.zeros((1, 121))
    coefficients[0, [0, 4, 6, 8, 20]] = 10.0, 0.3, 0.8, -0.5, 0.4
    grid = shape_grid(10).grid
    on_grid, _ = forms(np.log(grid.values(coefficients)), grid)
    np.testing.assert_allclose(on_grid, shape_features(coefficients)[:, FORM], atol=1e-6)
    mesh = virtual_mesh(Realizations(coefficients, "radius", "measured", 0), 0, 5)
    second = np.linalg.eigvalsh(np.trace(mesh.inertia) / 2 * np.eye(3) - mesh.inertia)
    np.testing.assert_allclose(on_grid[0], np.diff(0.5 * np.log(second))[::-1], atol=2e-3)


def test_that_outer_numbers_are_those_of_meshes(cement: Sample) -> None:
    few = cement.truncated(10).chosen(range(12))
    found = outer_features_of_radii(few.coefficients, np.zeros(12))
    draws = Realizations(few.coefficients, "radius", "measured", 0)
    sphericities = [describe(virtual_mesh(draws, i, 4), ["sphericity"])["sphericity"] for i in range(12)]
    np.testing.assert_allclose(1 / (1 + np.exp(-found[:, SPHERICITY])), sphericities, atol=4e-3)


@pytest.mark.slow
def test_that_drawn_particles_have_the_outer_numbers_of_real_ones(cement: Sample) -> None:
    cut = cement.truncated(10).coefficients
    measured, aim = features_and_target(cut)
    fitted: Any = MODEL.fit(cement.truncated(10))
    drawn = fitted.draw(500, 2)
    numbers, outer = measured_features(drawn.coefficients, drawn.equivalent_radii())
    gap = np.abs(numbers.mean(axis=0) - measured.mean(axis=0)) / measured.std(axis=0)
    assert gap[:3].max() < 0.1
    assert gap.max() < 0.6
    assert fitted.faceting >= 0.9
    np.testing.assert_allclose(numbers.std(axis=0) / measured.std(axis=0), 1.0, atol=0.2)
    assert aim.distance(outer) < 0.35
    plain = MODELS["log_field"].fit(cement.truncated(10)).draw(500, 2)
    assert aim.distance(measured_features(plain.coefficients, plain.equivalent_radii())[1]) > 0.6
    real = _mean_share_of_hull(Realizations(cut, "radius", "measured", 0))
    assert abs(_mean_share_of_hull(drawn) - real) < 0.012
    assert abs(_mean_share_of_hull(plain) - real) > 0.02


@pytest.mark.slow
def test_that_the_faceting_follows_the_sample() -> None:
    soft = materials()["ma165"].model(10).draw(200, 0)
    rows = np.stack([soft.particle(i).values for i in range(200)])
    fitted: Any = MODEL.fit(Sample(rows))
    assert fitted.faceting <= 0.8
    assert MODEL.restored(*fitted.stored()).faceting == fitted.faceting


def _mean_share_of_hull(draws: Realizations) -> float:
    meshes = (virtual_mesh(draws, i, 3) for i in range(150))
    return float(np.mean([mesh.volume / ConvexHull(mesh.vertices).volume for mesh in meshes]))
