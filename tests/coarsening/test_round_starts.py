"""Particles nearly as round as Goldberg allows: starts that are round already."""

import numpy as np
import pytest
from scipy.special import sph_harm_y

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.core.box_search import FINE_ANGLE
from regolith_studio.coarsening.exact.constraint_selection import ConstraintRequest
from regolith_studio.coarsening.exact.constraints import measure
from regolith_studio.coarsening.exact.initial_planes import round_planes
from regolith_studio.coarsening.exact.roundest import turned_to_particle
from regolith_studio.coarsening.lower_bounds import max_sphericity
from regolith_studio.coarsening.polyhedra import polyhedron_of
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry.half_spaces import HalfSpaces
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


@pytest.mark.parametrize("n_facets", [12, 20, 50])
def test_that_round_half_spaces_of_a_ball_are_nearly_as_round_as_goldberg_allows(n_facets: int) -> None:
    target, rng = Target.of(icosphere(3)), np.random.default_rng(1)
    for around_hull in (False, True):
        solid = polyhedron_of(HalfSpaces(*round_planes(target, n_facets, rng, around_hull)))
        sphericity = describe(solid)["sphericity"]
        assert 0.985 * max_sphericity(n_facets) < sphericity <= max_sphericity(n_facets)


def test_that_round_half_spaces_touch_an_ellipsoid_of_unit_volume() -> None:
    ball = icosphere(3)
    target = Target.of(Mesh(ball.vertices * (3.0, 2.0, 1.0), ball.faces))
    normals, offsets = round_planes(target, 20, np.random.default_rng(2), around_hull=False)
    radii = target.box.extents / 2
    support = np.linalg.norm(normals @ target.box.axes.T * radii, axis=1)
    assert 4.0 / 3.0 * np.pi * radii.prod() == pytest.approx(1.0, abs=0.01)
    assert offsets == pytest.approx(support, rel=5e-3)


@pytest.mark.slow
def test_that_a_sphericity_of_98_per_cent_of_the_bound_is_met_from_every_seed() -> None:
    target = Target.of(potato(4007, 0.98 * max_sphericity(20)))
    for seed in range(6):
        found = coarsen(target, 20, seed=seed)
        assert found.reason is None
        assert found.n_facets == 20


@pytest.mark.slow
@pytest.mark.parametrize("share_of_bound", [1.005, 1.04])
def test_that_the_least_miss_of_a_sphericity_out_of_reach_does_not_hang_on_the_seed(
    share_of_bound: float,
) -> None:
    target = Target.of(potato(4007, share_of_bound * max_sphericity(20)))
    missed = [coarsen(target, 20, seed=seed).errors["sphericity"] for seed in range(5)]
    assert max(missed) - min(missed) < 1e-3
    assert min(missed) >= 1.0 - 1.0 / share_of_bound - 1e-6


def test_that_a_polyhedron_is_turned_to_the_particle_and_keeps_its_descriptors() -> None:
    ball = icosphere(3)
    target = Target.of(Mesh(ball.vertices * (1.4, 1.2, 1.0), ball.faces))
    turn = np.linalg.qr(np.random.default_rng(6).normal(size=(3, 3)))[0]
    normals, offsets = round_planes(target, 14, np.random.default_rng(1), around_hull=True)
    moved = normals @ turn, offsets + normals @ turn @ (0.1, -0.05, 0.02)
    problem = ConstraintRequest.of(target, LossWeights.from_preset("all")).problem(target.rays, FINE_ANGLE)
    turned = HalfSpaces(*turned_to_particle(target, measure(problem, *moved)))
    before, after = (describe(polyhedron_of(each)) for each in (HalfSpaces(*moved), turned))
    assert dict(after) == pytest.approx(dict(before), rel=1e-6)
    back, aside_too = (target.jaccard_distance(HalfSpaces(*each)) for each in ((normals, offsets), moved))
    assert target.jaccard_distance(turned) <= back + 0.02 < aside_too
