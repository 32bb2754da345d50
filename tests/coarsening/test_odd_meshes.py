"""What people and programs write: a polyhedron that meets all, one with reasons, or one sentence."""

import re

import numpy as np
import pytest

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.methods import METHODS
from regolith_studio.coarsening.result import CoarseningResult
from regolith_studio.coarsening.target import Target
from regolith_studio.errors import InputError, RegolithError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from tests.coarsening.odd_meshes import KINDS, odd_mesh

CONDITIONS = ("volume", "sphericity", "min_diameter", "max_diameter", "aspect_ratio")


def attempted(mesh: Mesh | Target, n_facets: int, method: str, number: int) -> CoarseningResult | str:
    """The result, or the sentence that refuses it."""
    try:
        return coarsen(mesh, n_facets, method, seed=number)
    except RegolithError as error:
        return str(error)


def outcome(number: int, n_facets: int) -> str:
    """``sentence``, ``reason`` or ``met`` by the exact method; fails for anything else, by any method."""
    kind, mesh = odd_mesh(number)
    answer = ""
    for method in METHODS:
        made = attempted(mesh, n_facets, method, number)
        if isinstance(made, str):
            assert made.endswith("."), kind
            answer = "sentence" if method == "exact" else answer
            continue
        assert np.isfinite([*made.errors.values(), *made.achieved.values(), made.jaccard_distance]).all()
        if method == "exact":
            met = max(made.errors[key] for key in CONDITIONS) <= 1e-6
            assert (met and made.n_facets == n_facets) != bool(made.reason), kind
            answer = "met" if met else "reason"
    return answer


@pytest.mark.parametrize("number", range(2 * len(KINDS), 3 * len(KINDS)))
def test_that_any_mesh_gives_a_result_a_reason_or_a_sentence(number: int) -> None:
    expected = {"broken": {"sentence"}, "convex": {"met", "reason"}}
    assert outcome(number, 8) in expected.get(odd_mesh(number)[0], {"met", "reason", "sentence"})


@pytest.mark.slow
@pytest.mark.parametrize(("number", "n_facets"), [(5276, 12), (6008, 5), (6164, 5)])
def test_that_boxes_that_tie_and_near_misses_lead_to_another_start(number: int, n_facets: int) -> None:
    assert outcome(number, n_facets) == "met"


@pytest.mark.slow
def test_that_hundreds_of_meshes_give_results_reasons_or_sentences() -> None:
    found = [outcome(number, (8, 12, 20)[number % 3]) for number in range(100, 200)]
    assert found.count("met") > 30


@pytest.mark.parametrize(("size", "said"), [(1e150, "1e+150"), (1e-150, "1e-150")])
def test_that_a_size_whose_fifth_power_is_no_number_is_one_sentence(size: float, said: str) -> None:
    sphere = icosphere(2)
    mesh = Mesh(sphere.vertices * size * (1.3, 1.0, 0.2), sphere.faces)
    with pytest.raises(
        InputError, match=re.escape(f"between 1e-50 and 1e+50, got {said}; use another unit.")
    ):
        coarsen(mesh, 12, "quadric")
