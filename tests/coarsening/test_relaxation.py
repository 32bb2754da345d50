"""Particles rounder or rougher than any polyhedron with so many facets: the rest is kept, and said."""

import itertools

import numpy as np
import pytest

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.loss import loss
from regolith_studio.coarsening.lower_bounds import max_sphericity
from regolith_studio.coarsening.reasons import reason_for
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere

REST = ("volume", "min_diameter", "max_diameter", "aspect_ratio")


def egg(*axes: float) -> Mesh:
    return Mesh(icosphere(4).vertices * axes, icosphere(4).faces)


def urchin() -> Mesh:
    """A ball with 60 narrow spines: more than twice the surface of its hull, at the same volume."""
    ball = icosphere(4)
    spines = np.random.default_rng(4).normal(size=(60, 3))
    spines /= np.linalg.norm(spines, axis=1)[:, None]
    nearest = (ball.vertices @ spines.T).max(axis=1)
    return Mesh(ball.vertices * (1.0 + 0.8 * np.exp(-400.0 * (1.0 - nearest)))[:, None], ball.faces)


@pytest.mark.slow
@pytest.mark.parametrize("n_facets", [12, 20, 50])
def test_that_a_ball_becomes_nearly_as_round_as_goldberg_allows(n_facets: int) -> None:
    found = coarsen(egg(1.0, 0.99, 0.98), n_facets, "exact")
    most = max_sphericity(n_facets)
    assert 0.99 * most < found.achieved["sphericity"] <= most
    assert max(found.errors[key] for key in REST) <= 1e-6
    assert found.n_facets == n_facets
    assert found.reason is not None
    assert f"with {n_facets} the most is {most:.3f}" in found.reason
    assert f"misses sphericity by {100 * found.errors['sphericity']:.2g} %" in found.reason


@pytest.mark.parametrize(
    ("axes", "n_facets"),
    [
        ((1.25, 1.1, 1.0), 20),
        ((1.3, 1.0, 0.9), 30),
        ((1.0, 0.9, 0.8), 30),
    ],
)
@pytest.mark.slow
def test_that_no_box_is_overlooked_where_the_sphericity_cannot_be_met(
    axes: tuple[float, float, float], n_facets: int
) -> None:
    """Another box was the least, up to 14 per cent off in the aspect ratio; which, is a matter of rounding.

    So are facets that are too small to count: without them a corner stands out of the box by 2e-5. A descent
    that ends by its number of steps may find a smaller box last: 7e-6 for one of these twelve.
    """
    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    shape, worst = egg(*axes), []
    for seed in range(4):
        found = coarsen(Mesh(shape.vertices @ turn, shape.faces), n_facets, seed=seed)
        worst.append(max(found.errors[key] for key in REST))
    assert sorted(worst)[-2] <= 1e-6
    assert max(worst) <= 1e-5


@pytest.mark.slow
def test_that_an_egg_whose_sphericity_can_just_be_reached_is_met() -> None:
    found = coarsen(egg(1.0, 0.8, 0.6), 100, "exact")
    assert max(found.errors[key] for key in (*REST, "sphericity")) <= 1e-6
    assert found.n_facets == 100
    assert found.reason is None


def test_that_what_cannot_be_met_ends_at_the_least_loss_that_was_shown() -> None:
    weights = LossWeights.from_preset("all")
    found = coarsen(egg(1.0, 0.9, 0.8), 20, "exact", weights)
    assert found.loss == pytest.approx(loss(weights, found.errors, found.jaccard_distance))
    assert found.loss == pytest.approx(min(found.loss_history), abs=2e-3)


@pytest.mark.parametrize(
    ("n_facets", "seed"),
    [
        (12, 0),
        (20, 1),
        *(pytest.param(*each, marks=pytest.mark.slow) for each in ((12, 2), (30, 2), (50, 2))),
    ],
)
def test_that_an_urchin_keeps_its_volume_nearly_and_all_that_is_missed_is_named(
    n_facets: int, seed: int
) -> None:
    mesh = urchin()
    found = coarsen(mesh, n_facets, "exact", seed=seed)
    assert found.achieved["surface_area"] < describe(mesh)["surface_area"]
    assert found.errors["volume"] <= 5e-3
    assert max(found.errors[key] for key in ("min_diameter", "max_diameter")) < 0.5
    assert found.reason is not None
    lacks = f"The result has {found.n_facets} facets instead of {n_facets}"
    assert found.n_facets == n_facets or lacks in found.reason
    missed = [
        key for key in ("volume", "sphericity", "min_diameter", "max_diameter") if found.errors[key] > 1e-6
    ]
    for key in missed:
        assert f"{key.replace('_', ' ')} by {100 * found.errors[key]:.2g} %" in found.reason
    assert "less surface" not in found.reason


def test_that_an_error_above_a_hundred_per_cent_is_written_in_full() -> None:
    target = Target.of(egg(1.0, 0.6, 0.3))
    found = dict(target.descriptors) | {"min_diameter": 2.234 * target.descriptors["min_diameter"]}
    reason = reason_for(target.descriptors, found, ("min_diameter",), 20, 20, 0.1)
    assert reason is not None
    assert "misses min diameter by 123 %" in reason


@pytest.mark.slow
def test_that_missing_facets_are_named_beside_the_descriptor_that_is_missed() -> None:
    ball, flat = Target.of(egg(1.0, 0.99, 0.98)), Target.of(egg(1.0, 0.6, 0.3))
    for target, words in ((ball, "the most is"), (flat, "volume by 1 %")):
        found = {key: value * (1.01 if "volume" in key else 1.0) for key, value in target.descriptors.items()}
        kept = LossWeights.from_preset("all").kept
        few, all_of_them = (
            reason_for(target.descriptors, found, kept, 20, n_real, 0.1) for n_real in (18, 20)
        )
        assert all_of_them is not None
        assert words in all_of_them
        assert few == f"{all_of_them} The result has 18 facets instead of 20."


def test_that_a_cube_cannot_have_twenty_facets_and_the_reason_says_that_it_has_six() -> None:
    corners = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
    cube = Mesh(corners, np.empty((0, 3), dtype=np.int64)).hull
    found = coarsen(cube, 20, settings={"retries": 0})
    assert found.reason is not None
    assert found.reason.startswith(
        "The result has 6 facets instead of 20: the particle is a convex polyhedron"
    )
    assert max(found.errors.values()) <= 1e-6
    assert found.jaccard_distance <= 1e-6
    assert coarsen(cube, 6).reason is None


def test_that_a_ball_keeps_its_size_where_only_its_sphericity_is_asked_for() -> None:
    found = coarsen(icosphere(3), 20, weights=LossWeights.of(sphericity=1.0))
    assert found.errors["volume"] <= 1e-6
    assert found.achieved["sphericity"] > 0.98 * max_sphericity(20)
    assert found.jaccard_distance < 0.1
