"""Particles rounder than any polyhedron with so many facets: the rest is kept, and said."""

import pytest

from regolith_studio.coarsening.bounds import greatest_sphericity
from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.loss import loss
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.geometry.directions import icosphere
from regolith_studio.geometry.mesh import Mesh

REST = ("volume", "min_diameter", "max_diameter", "aspect_ratio")


def egg(*axes: float) -> Mesh:
    return Mesh(icosphere(4).vertices * axes, icosphere(4).faces)


@pytest.mark.parametrize("n_faces", [12, 20, 50])
def test_that_a_ball_becomes_nearly_as_round_as_goldberg_allows(n_faces: int) -> None:
    found = coarsen(egg(1.0, 0.99, 0.98), n_faces, "exact")
    most = greatest_sphericity(n_faces)
    assert 0.99 * most < found.achieved["sphericity"] <= most
    assert max(found.errors[key] for key in REST) <= 1e-6
    assert found.n_faces == n_faces
    assert found.reason is not None
    assert f"with {n_faces} the most is {most:.3f}" in found.reason


def test_that_a_ball_is_given_up_after_one_start() -> None:
    assert coarsen(egg(1.0, 0.95, 0.9), 20, "exact").steps["starts"] == 1


def test_that_an_egg_whose_sphericity_can_just_be_reached_is_met() -> None:
    found = coarsen(egg(1.0, 0.8, 0.6), 100, "exact")
    assert max(found.errors[key] for key in (*REST, "sphericity")) <= 1e-6
    assert found.n_faces == 100
    assert found.reason is None


def test_that_what_cannot_be_met_ends_at_the_least_loss_that_was_shown() -> None:
    weights = LossWeights.from_preset("all")
    found = coarsen(egg(1.0, 0.9, 0.8), 20, "exact", weights)
    assert found.loss == pytest.approx(loss(weights, found.errors, found.jaccard_distance))
    assert found.loss == pytest.approx(min(found.loss_history), abs=2e-3)
