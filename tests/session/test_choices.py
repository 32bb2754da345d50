"""Choices check themselves and say in one sentence what is wrong."""

from typing import Any

import pytest

from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.errors import InputError
from regolith_studio.session.choices import Choices


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"l_max": 31}, "from 0 to 30, got 31"),
        ({"l_max": -1}, "from 0 to 30, got -1"),
        ({"l_max": 3.5}, "whole number"),
        ({"l_max": True}, "whole number"),
        ({"n_facets": 4}, "from 5 to 500, got 4"),
        ({"n_triangles": 7}, "n_triangles must be a whole number from 8"),
        ({"n_triangles": 70.5}, "whole number"),
        ({"largest_error": 0.0}, "above 0 per cent"),
        ({"largest_error": float("nan")}, "must be a number"),
        ({"stop_at": "midnight"}, "'midnight'"),
        ({"seed": -1}, "seed"),
        ({"target": "moon"}, "'moon'"),
        ({"box_metric": "sphere"}, "'sphere'"),
        ({"method": "magic"}, "'magic'"),
        ({"settings": (("colour", 3),)}, "'colour'"),
        ({"preset": "favourites"}, "'favourites'"),
        ({"colour": 3}, "colour"),
        ({"unit": "furlong"}, "furlong"),
    ],
)
def test_that_a_bad_choice_is_one_plain_sentence(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        Choices().replaced(**changes)
    assert str(caught.value).endswith(".")


def test_that_a_preset_brings_its_weights_and_a_moved_weight_marks_it_modified() -> None:
    chosen = Choices().replaced(preset="all")
    assert not chosen.preset_modified
    moved = chosen.replaced(weights=LossWeights.of(volume=0.3))
    assert moved.preset_modified
    assert moved.replaced(preset="all") == chosen


@pytest.mark.parametrize(
    ("stop", "facets", "error", "most", "words"),
    [
        ("facets", 12, None, 12, "12 facets"),
        ("vertices", 21, None, 21, "21 facets"),  # 21 facets have up to 38 vertices, 22 have 40
        ("triangles", 17, None, 17, "17 facets"),  # 17 facets have up to 56 triangles, 18 have 60
        ("error", 12, 0.025, 500, "the fewest facets whose errors are all below 2.5 %"),
    ],
)
def test_that_one_of_four_numbers_says_how_fine_a_polyhedron_is(
    stop: str, facets: int, error: float | None, most: int, words: str
) -> None:
    choices = Choices(stop_at=stop, n_facets=12, n_triangles=59, n_vertices=39, largest_error=0.025)
    request = choices.coarsening_request
    assert (request.n_facets, request.largest_error, request.max_facets, request.stopping_criterion) == (
        *(facets, error, most),
        words,
    )
