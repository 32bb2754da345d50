"""Three numbers and a sentence for a polyhedron."""

from dataclasses import replace

import numpy as np
import pytest

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.result import CoarseningResult
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs.coarsening_jobs import ParticleComparison
from regolith_studio.session.assessment import assess_polyhedron, redundant_planes

MET = dict.fromkeys(LOSS_KEYS, 1e-7)
NO_BOUNDS = dict.fromkeys((*LOSS_KEYS, "jaccard_distance"), 0.0)
ALL = LossWeights.from_preset("all")


@pytest.fixture(scope="module")
def coarsened() -> CoarseningResult:
    return coarsen(icosphere(2), 12, "quadric")


def test_that_the_error_is_the_root_mean_square_of_the_weighted_descriptors(
    coarsened: CoarseningResult,
) -> None:
    found = replace(
        coarsened, errors=MET | {"volume": 0.03, "sphericity": 0.04, "aspect_ratio": 0.5}, bounds=NO_BOUNDS
    )
    assessment = assess_polyhedron(found, LossWeights.of(volume=1.0, sphericity=2.0, jaccard_distance=1.0))
    assert assessment.rmsre == pytest.approx(np.sqrt((0.03**2 + 0.04**2) / 2))
    assert "4 %, of S" in assessment.sentence
    assert assessment.loss == coarsened.loss
    assert np.isnan(assess_polyhedron(found, LossWeights.of(jaccard_distance=1.0)).rmsre)


def test_that_what_no_convex_polyhedron_can_meet_is_no_fault_of_this_one(coarsened: CoarseningResult) -> None:
    bounds = NO_BOUNDS | {"convex_hull_volume": 0.2}
    found = replace(coarsened, errors=MET | {"convex_hull_volume": 0.2}, bounds=bounds)
    assert "Exact except CH" in assess_polyhedron(found, ALL).sentence
    everything = replace(coarsened, errors=MET, bounds=NO_BOUNDS)
    assert assess_polyhedron(everything, ALL).sentence == "All weighted descriptors are met within 0.1 %."


def test_that_facets_are_counted_where_planes_bound_none(coarsened: CoarseningResult) -> None:
    assert redundant_planes(coarsened) is None
    found = redundant_planes(replace(coarsened, n_facets_asked=20))
    assert found == "The result has 12 facets instead of 20: the other planes bound none."


def test_that_the_particle_itself_and_fewer_facets_are_named(coarsened: CoarseningResult) -> None:
    found = replace(coarsened, errors=MET, bounds=NO_BOUNDS)
    comparison = ParticleComparison(MET | {"max_diameter": 0.17}, 0.21)
    sentence = assess_polyhedron(found, ALL, comparison, (12, 0.632)).sentence
    assert "D_max 17 %, Jaccard distance 21 %" in sentence
    assert "12 facets had a loss of 0.632" in sentence
