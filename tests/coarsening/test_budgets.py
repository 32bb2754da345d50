"""Faces from triangles, and the fewest faces below an error."""

import pytest

from regolith_studio.coarsening.budgets import faces_for_triangles, fewest_faces
from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.errors import InputError
from regolith_studio.geometry.mesh import Mesh


@pytest.mark.parametrize(("triangles", "faces"), [(8, 5), (67, 19), (68, 20), (10_000, 200)])
def test_that_a_budget_of_triangles_is_never_exceeded(triangles: int, faces: int) -> None:
    assert faces_for_triangles(triangles) == faces
    assert min(4 * faces - 12, 788) <= triangles


def test_that_too_few_triangles_are_refused() -> None:
    with pytest.raises(InputError, match="7 triangles are too few"):
        faces_for_triangles(7)


def test_that_the_fewest_faces_meet_the_limit_and_one_less_does_not(particle: Mesh) -> None:
    steps = fewest_faces(particle, 0.01, settings={"retries": 1})
    tried = []
    while True:
        try:
            tried.append(next(steps))
        except StopIteration as end:
            found = end.value
            break
    failed = [trial.n_faces for trial in tried if trial.largest_error > 0.01]
    assert found.n_faces_asked not in failed
    assert found.n_faces_asked == 5 or found.n_faces_asked - 1 in failed
    assert coarsen(particle, found.n_faces_asked, settings={"retries": 1}).errors == found.errors


def test_that_a_limit_must_be_positive(particle: Mesh) -> None:
    with pytest.raises(InputError, match="above 0"):
        next(fewest_faces(particle, 0.0))
