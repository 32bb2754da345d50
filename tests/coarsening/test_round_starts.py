"""Particles nearly as round as Goldberg allows: starts that are round already."""

import numpy as np
import pytest
from scipy.special import sph_harm_y

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.core.polyhedron_measures import polyhedron_of
from regolith_studio.coarsening.lower_bounds import max_sphericity
from regolith_studio.coarsening.optimiser.starts import round_start
from regolith_studio.coarsening.target import Target
from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere


def potato(seed: int, sphericity: float) -> Mesh:
    """A ball with waves of degrees 2 to 4, as high as its sphericity says."""
    ball, rng = icosphere(4), np.random.default_rng(seed)
    x, y, z = ball.vertices.T
    polar, azimuth = np.arccos(np.clip(z, -1.0, 1.0)), np.arctan2(y, x)
    waves = np.zeros(len(z))
    for degree in range(2, 5):
        for order in range(degree + 1):
            even, odd = rng.normal(size=2) * degree**-1.5
            wave = sph_harm_y(degree, order, polar, azimuth)
            waves += even * wave.real + odd * wave.imag
    low, high = 0.0, 1.0 / waves.std()
    for _ in range(40):
        middle = (low + high) / 2
        body = Mesh(ball.vertices * np.exp(middle * waves)[:, None], ball.faces)
        found = np.pi ** (1 / 3) * (6 * body.volume) ** (2 / 3) / body.surface_area
        low, high = (middle, high) if found > sphericity else (low, middle)
    return body


@pytest.mark.slow
def test_that_a_sphericity_of_98_per_cent_of_the_bound_is_met_from_every_seed() -> None:
    target = Target.of(potato(4007, 0.98 * max_sphericity(20)))
    for seed in range(6):
        found = coarsen(target, 20, seed=seed)
        assert found.reason is None
        assert found.n_facets == 20


@pytest.mark.slow
@pytest.mark.parametrize("share_of_bound", [1.005, 1.04])
def test_that_the_least_miss_of_a_sphericity_out_of_reach_hangs_little_on_the_seed(
    share_of_bound: float,
) -> None:
    target = Target.of(potato(4007, share_of_bound * max_sphericity(20)))
    missed = [coarsen(target, 20, seed=seed).errors["sphericity"] for seed in range(5)]
    assert max(missed) - min(missed) < 6e-3  # measured: .0046 and .0024
    assert min(missed) >= 1.0 - 1.0 / share_of_bound - 1e-6


@pytest.mark.parametrize("n_facets", [12, 20, 50])
def test_that_round_half_spaces_of_a_ball_are_nearly_as_round_as_goldberg_allows(n_facets: int) -> None:
    target, rng = Target.of(icosphere(3)), np.random.default_rng(1)
    solid = polyhedron_of(round_start(target, n_facets, rng))
    assert 0.985 * max_sphericity(n_facets) < describe(solid)["sphericity"] <= max_sphericity(n_facets)
