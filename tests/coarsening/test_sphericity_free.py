"""What an exact sphericity costs on rough particles."""

import numpy as np
import pytest

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.result import COSTLY_OVERLAP, CoarseningResult
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere


@pytest.fixture(scope="module")
def rough() -> Mesh:
    """An egg that is rough at the size of its triangles: a quarter more area than its hull."""
    ball = icosphere(3)
    noise = np.random.default_rng(1).normal(size=(len(ball.vertices), 1))
    return Mesh(ball.vertices * (1.0 + 0.06 * noise) * (1.3, 1.0, 0.8), ball.faces)


@pytest.fixture(scope="module")
def found(rough: Mesh) -> CoarseningResult:
    return coarsen(rough, 20)


def test_that_the_price_of_the_sphericity_is_what_the_preset_without_it_saves(
    rough: Mesh, found: CoarseningResult
) -> None:
    free = found.sphericity_free
    assert free is not None
    shape_first = coarsen(rough, 20, weights=LossWeights.from_preset("shape_first"))
    for key in ("volume", "min_diameter", "max_diameter", "aspect_ratio"):
        assert shape_first.errors[key] <= 1e-6
    assert free.jaccard_distance == pytest.approx(shape_first.jaccard_distance, abs=0.02)
    assert free.sphericity_error == pytest.approx(shape_first.errors["sphericity"], abs=0.02)
    assert shape_first.sphericity_free is None


def test_that_a_costly_sphericity_is_a_warning_with_both_distances(found: CoarseningResult) -> None:
    free = found.sphericity_free
    assert free is not None
    assert found.jaccard_distance > COSTLY_OVERLAP * free.jaccard_distance
    assert found.warning is not None
    assert f"the Jaccard distance is {found.jaccard_distance:.3f}" in found.warning
    assert f"it is {free.jaccard_distance:.3f}" in found.warning
    assert f"off by {100 * free.sphericity_error:.2g} %" in found.warning


def test_that_a_particle_nearly_as_smooth_as_its_hull_is_solved_once(particle: Mesh) -> None:
    found = coarsen(particle, 20, seed=1)
    assert found.reason is None
    assert found.sphericity_free is None
    assert found.warning is None
