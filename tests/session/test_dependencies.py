"""What a change of choices makes necessary, without any session, thread or window."""

import itertools
from typing import Any

import pytest

from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.session.choices import LIVE, Choices, Kind, dependencies, depends, inputs, needs, plan

HERE = Choices(selected="a", target="fit")
FIT, SURFACE, DESCRIPTORS, COARSENING, COMPARISON = LIVE


def kinds(before: Choices | None, after: Choices, is_fitted: bool = True) -> list[Kind]:
    return [request.kind for request in plan(before, after, is_fitted)]


def test_that_nothing_is_planned_without_a_particle() -> None:
    assert plan(None, Choices()) == ()
    assert plan(HERE, HERE.replaced(selected="")) == ()


def test_that_the_first_particle_makes_everything_necessary() -> None:
    assert kinds(None, HERE, False) == list(LIVE)


def test_that_equal_choices_make_nothing_necessary() -> None:
    assert kinds(HERE, Choices(selected="a", target="fit")) == []


def test_that_a_particle_is_not_fitted_twice() -> None:
    assert kinds(HERE, HERE.replaced(selected="b"), False) == list(LIVE)
    assert kinds(HERE, HERE.replaced(selected="b"), True) == [
        SURFACE,
        DESCRIPTORS,
        COARSENING,
        COMPARISON,
    ]


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"l_max": 4}, [SURFACE, DESCRIPTORS, COARSENING, COMPARISON]),
        ({"star_point": "kernel_centre"}, list(LIVE)),
        ({"rule": "outermost"}, list(LIVE)),
        ({"reference": "ellipsoid"}, list(LIVE)),
        ({"level": 3}, [SURFACE, DESCRIPTORS, COARSENING, COMPARISON]),
        ({"box_metric": "trimesh"}, [DESCRIPTORS, COMPARISON]),
        ({"n_facets": 30}, [COARSENING, COMPARISON]),
        ({"n_triangles": 30}, []),
        ({"stop_at": "triangles", "n_triangles": 71}, []),  # 20 facets, as before
        ({"stop_at": "triangles", "n_triangles": 72}, [COARSENING, COMPARISON]),
        ({"stop_at": "vertices", "n_vertices": 37}, []),
        ({"stop_at": "vertices", "n_vertices": 38}, [COARSENING, COMPARISON]),
        ({"stop_at": "error"}, [COARSENING, COMPARISON]),
        ({"largest_error": 0.5}, []),
        ({"seed": 7}, [COARSENING, COMPARISON]),
        ({"weights": LossWeights.of(volume=3.0)}, [COARSENING, COMPARISON]),
        ({"target": "particle"}, [COARSENING]),
        ({"unit": "mm"}, []),
    ],
)
def test_that_a_choice_remakes_what_depends_on_it(changes: dict[str, Any], expected: list[Kind]) -> None:
    assert kinds(HERE, HERE.replaced(**changes), False) == expected


@pytest.mark.parametrize("kind", LIVE)
def test_that_a_cached_result_is_found_only_while_all_that_it_depends_on_is_the_same(kind: Kind) -> None:
    after: dict[str, Any] = {"selected": "b", "l_max": 4, "level": 3, "rule": "outermost", "seed": 7}
    after |= {"reference": "ellipsoid", "star_point": "kernel_centre", "box_metric": "trimesh"}
    after |= {"n_facets": 30, "target": "particle", "method": "quadric", "unit": "mm"}
    for name, value in after.items():
        other = HERE.replaced(**{name: value})
        same_key = inputs(HERE, dependencies(kind, HERE)) == inputs(other, dependencies(kind, other))
        assert same_key != depends(kind, HERE, other), name


def test_that_l_max_leaves_the_coarsening_of_the_particle_itself_alone() -> None:
    here = HERE.replaced(target="particle")
    assert kinds(here, here.replaced(l_max=3)) == [SURFACE, DESCRIPTORS]


def test_that_a_plan_and_its_reverse_redo_the_same_work() -> None:
    variants = [HERE, HERE.replaced(l_max=2), HERE.replaced(seed=3), HERE.replaced(n_facets=9, level=2)]
    for one, other in itertools.permutations(variants, 2):
        assert kinds(one, other) == kinds(other, one)


def test_that_requests_come_after_what_they_need() -> None:
    for target in ("fit", "particle"):
        seen: set[Kind] = set()
        for request in plan(None, HERE.replaced(target=target)):
            assert set(request.needs) <= seen
            seen.add(request.kind)


def test_that_the_particle_itself_is_coarsened_without_waiting_for_a_fit() -> None:
    assert needs(COARSENING, HERE) == (SURFACE,)
    assert needs(COARSENING, HERE.replaced(target="particle")) == ()


def test_that_a_polyhedron_of_the_fit_is_compared_with_the_particle_when_both_are_measured() -> None:
    assert set(needs(COMPARISON, HERE)) == {DESCRIPTORS, COARSENING}
    assert COMPARISON not in kinds(None, HERE.replaced(target="particle"))


def test_that_studies_know_which_choices_they_were_made_for() -> None:
    assert depends(Kind.COARSENING_STUDY, HERE, HERE.replaced(n_facets=30))
    assert depends(Kind.COARSENING_STUDY, HERE, HERE.replaced(l_max=3))
    assert not depends(Kind.COARSENING_STUDY, HERE, HERE.replaced(selected="b"))
    assert not depends(Kind.LMAX_STUDY, HERE, HERE.replaced(l_max=3))
