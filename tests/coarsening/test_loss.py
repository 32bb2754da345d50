"""The loss of half-spaces against Eq. 9 written out from the public descriptors."""

import subprocess
import sys

import numpy as np
import pytest

from regolith_studio.coarsening.core.polyhedron_measures import measure_polyhedron
from regolith_studio.coarsening.decimated_hull import decimated_hull
from regolith_studio.coarsening.loss import LossFunction, box_extents
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.oriented_box import minimum_volume_box
from tests.geometry.solids import rough_stone


def planes_of(target: Target, n_facets: int) -> HalfSpaces:
    """Planes of the decimated hull with its ties broken."""
    planes = decimated_hull(target, n_facets).half_spaces
    return HalfSpaces(
        planes.normals, planes.offsets * (1 + 1e-6 * np.random.default_rng(0).random(len(planes)))
    )


@pytest.mark.parametrize("seed", range(4))
def test_that_the_loss_is_the_weighted_sum_of_the_public_errors(seed: int) -> None:
    target = Target.of(rough_stone(seed))
    planes = planes_of(target, 20)
    weights = LossWeights.of(**{key: 0.5 + k for k, key in enumerate((*LOSS_KEYS, "jaccard_distance"))})
    found = describe(ConvexPolyhedron.from_half_spaces(planes))
    wanted = sum(
        weights[key] * abs(found[key] - target.descriptors[key]) / target.descriptors[key]
        for key in LOSS_KEYS
    )
    wanted += weights["jaccard_distance"] * target.jaccard_distance(planes)
    loss = LossFunction(target, weights)
    evaluation = loss(planes.normals, planes.offsets)
    assert evaluation is not None
    assert evaluation.loss == pytest.approx(wanted, rel=5e-3)
    assert loss.value(planes.normals, planes.offsets) == pytest.approx(evaluation.loss, rel=1e-12)


def test_that_half_spaces_that_bound_nothing_have_an_infinite_loss() -> None:
    loss = LossFunction(Target.of(rough_stone(0)), LossWeights.from_preset("all"))
    assert loss.value(np.eye(3), np.ones(3)) == np.inf
    assert loss(np.eye(3), np.ones(3)) is None


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("n_facets", [6, 12, 20, 60])
def test_that_the_least_box_is_the_public_one(n_facets: int, seed: int) -> None:
    target = Target.of(rough_stone(seed))
    planes = planes_of(target, n_facets)
    # a corner is cut so little that some edges are too short to have a direction
    solid = ConvexPolyhedron.from_half_spaces(planes)
    corner = solid.vertices[seed]
    normal = corner / np.linalg.norm(corner)
    reach = float((solid.vertices @ normal).max())
    normals = np.vstack([planes.normals, normal])
    offsets = np.append(planes.offsets, reach - 1e-10)
    extents = box_extents(measure_polyhedron(normals, offsets))
    assert np.sort(extents) == pytest.approx(np.sort(minimum_volume_box(solid).extents), rel=1e-7)


ELONGATION = """
from regolith_studio.descriptors import catalogue
catalogue.LOSS_KEYS += ("elongation",)
from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.errors import InputError
from tests.geometry.solids import rough_stone
weights, stone = LossWeights.of(elongation=1.0), rough_stone(0)
short = coarsen(stone, 12, "annealing", weights, settings={"iterations": 5})
long = coarsen(stone, 12, "annealing", weights, settings={"iterations": 60, "best_so_far": True})
assert long.errors["elongation"] < short.errors["elongation"]
assert abs(long.loss - long.errors["elongation"]) < 1e-9
for method in ("exact", "compound"):
    try:
        coarsen(stone, 12, method, weights)
    except InputError as refusal:
        print(refusal)
"""


def test_that_any_descriptor_can_be_a_term_of_the_loss_or_is_refused_in_a_sentence() -> None:
    child = subprocess.run([sys.executable, "-c", ELONGATION], capture_output=True, text=True, check=True)
    assert child.stdout.splitlines() == [
        f"The method {method} does not know the term elongation; give it the weight 0, or take"
        " annealing, pchs, quadric."
        for method in ("exact", "compound")
    ]
