"""Facets from triangles, and the fewest facets below an error."""

import pytest

from regolith_studio.coarsening.coarsen import coarsen, facets_for_triangles, facets_for_vertices
from regolith_studio.coarsening.stopping_criteria import Trial, coarsen_below, fewest_facets
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.errors import InputError
from regolith_studio.geometry.mesh import Mesh


@pytest.mark.parametrize(("triangles", "facets"), [(8, 5), (67, 19), (68, 20), (10_000, 500)])
def test_that_a_budget_of_triangles_is_never_exceeded(triangles: int, facets: int) -> None:
    assert facets_for_triangles(triangles) == facets
    assert min(4 * facets - 12, 788) <= triangles


@pytest.mark.parametrize(("vertices", "facets"), [(6, 5), (8, 6), (64, 34), (128, 66), (10_000, 500)])
def test_that_a_budget_of_vertices_allows_the_facets_of_a_simple_polyhedron(
    vertices: int, facets: int
) -> None:
    assert facets_for_vertices(vertices) == facets


@pytest.mark.parametrize("vertices", [8, 19])
def test_that_a_budget_of_vertices_is_never_exceeded(particle: Mesh, vertices: int) -> None:
    done = coarsen(particle, max_vertices=vertices)
    assert vertices - 2 <= done.n_vertices <= vertices


def test_that_too_few_triangles_are_refused() -> None:
    with pytest.raises(InputError, match="7 triangles are too few"):
        facets_for_triangles(7)
    with pytest.raises(InputError, match="5 vertices are too few: 5 facets have up to 6"):
        facets_for_vertices(5)


@pytest.mark.parametrize("triangles", [8.5, True])
def test_that_triangles_are_counted_in_whole_numbers(triangles: float) -> None:
    with pytest.raises(InputError, match="whole number"):
        facets_for_triangles(triangles)  # type: ignore[arg-type]


@pytest.mark.slow
def test_that_the_fewest_facets_meet_the_limit_and_one_less_does_not(particle: Mesh) -> None:
    steps = fewest_facets(particle, 0.01, settings={"retries": 1})
    tried, counted = [], []
    while True:
        try:
            step = next(steps)
        except StopIteration as end:
            found = end.value
            break
        if isinstance(step, Trial):
            tried.append(step)
        else:
            counted.append(step.step)
    failed = [trial.n_facets for trial in tried if trial.largest_error > 0.01]
    assert found.n_facets_asked not in failed
    assert found.n_facets_asked == 5 or found.n_facets_asked - 1 in failed
    assert coarsen(particle, found.n_facets_asked, settings={"retries": 1}).errors == found.errors
    assert coarsen_below(particle, 0.01, settings={"retries": 1}).errors == found.errors
    assert counted == sorted(counted)


def test_that_a_limit_out_of_reach_gives_the_least_error_and_says_so(particle: Mesh) -> None:
    weights = LossWeights.of(volume=1.0, sphericity=1.0)
    found = coarsen_below(particle, 1e-9, method="quadric", weights=weights)
    assert found.reason is not None
    begun = "No polyhedron was found whose errors are all below 1e-07 %, with up to 500 facets: the least is "
    assert found.reason.startswith(begun)
    assert f" %, with {found.n_facets_asked} facets." in found.reason
    for n_facets in (5, 20, 200):
        other = coarsen(particle, n_facets, "quadric", weights)
        assert max(other.errors["volume"], other.errors["sphericity"]) >= max(
            found.errors["volume"] - found.bounds["volume"], found.errors["sphericity"]
        )


@pytest.mark.parametrize("limit", [0.0, -1.0, float("nan"), float("inf")])
def test_that_a_limit_must_be_positive(particle: Mesh, limit: float) -> None:
    with pytest.raises(InputError, match="above 0"):
        next(fewest_facets(particle, limit))
