"""Weights of Eq. 9 and the shipped sets of them."""

import math
import pickle

import pytest

from regolith_studio.coarsening.loss import loss
from regolith_studio.coarsening.reasons import kept_sentence
from regolith_studio.coarsening.weights import JACCARD, WEIGHT_KEYS, LossWeights, presets
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.errors import InputError
from regolith_studio.resources import guide_folder


def test_that_the_loss_has_the_terms_of_equation_9() -> None:
    assert WEIGHT_KEYS == (
        "jaccard_distance",
        "volume",
        "sphericity",
        "min_diameter",
        "max_diameter",
        "aspect_ratio",
        "convex_hull_volume",
    )


def test_that_the_loss_is_the_weighted_sum() -> None:
    weights = LossWeights.of(volume=2, aspect_ratio=3, jaccard_distance=0.5)
    errors = dict.fromkeys(LOSS_KEYS, 0.1)
    assert loss(weights, errors, 0.4) == pytest.approx(2 * 0.1 + 3 * 0.1 + 0.5 * 0.4)


def test_that_terms_without_weight_may_be_unknown() -> None:
    assert loss(LossWeights.of(volume=1), dict.fromkeys(LOSS_KEYS, 0.1), math.nan) == pytest.approx(0.1)


@pytest.mark.parametrize("value", [-1.0, math.nan, math.inf])
def test_that_a_weight_must_be_a_positive_number_or_zero(value: float) -> None:
    with pytest.raises(InputError, match="weight of volume"):
        LossWeights.of(volume=value)


def test_that_an_unknown_term_is_refused() -> None:
    with pytest.raises(InputError, match="'roundness'"):
        LossWeights.of(roundness=1.0)


def test_that_weights_travel_between_processes_and_compare_by_value() -> None:
    weights = LossWeights.from_preset("all")
    assert pickle.loads(pickle.dumps(weights)) == weights
    assert hash(weights) == hash(LossWeights.from_preset("all"))
    assert weights.replaced(volume=0.5) != weights


def test_that_the_rows_of_the_papers_figures_are_shipped() -> None:
    known = presets()
    assert known["quadric"].weights.all_zero
    assert set(known["all"].weights.values()) == {1.0}
    assert known["descriptors"].weights["jaccard_distance"] == 0.0
    assert [key for key, value in known["overlap"].weights.items() if value] == ["jaccard_distance"]
    assert all(preset.label and preset.origin for preset in known.values())


def test_that_an_unknown_preset_is_refused() -> None:
    with pytest.raises(InputError, match="no preset 'best'"):
        LossWeights.from_preset("best")


def test_that_the_guide_says_what_each_preset_keeps() -> None:
    symbols = {key: CATALOGUE[key].symbol for key in LOSS_KEYS} | {JACCARD: "Jaccard distance"}
    named = {}
    for line in guide_folder().joinpath("coarsening.md").read_text("utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 3 and (name := cells[0].split("`")[1:2]) and name[0] in presets():
            named[name[0]] = cells[1:]
    wanted = {}
    for name, preset in presets().items():
        kept, weights = preset.weights.kept, preset.weights
        weighed = [key for key in WEIGHT_KEYS if weights[key] and key not in kept]
        lists = ([key for key in WEIGHT_KEYS if key in kept], weighed)
        wanted[name] = [", ".join(symbols[key] for key in keys) or "none" for keys in lists]
    assert named == wanted


def test_that_a_sentence_says_what_weights_keep() -> None:
    assert kept_sentence(LossWeights.of(volume=1)) == "The exact method keeps volume."
    assert kept_sentence(LossWeights.of(jaccard_distance=1)) == "The exact method keeps no descriptor."
    both = LossWeights.of(volume=1, aspect_ratio=2).keeping(["volume"])
    assert kept_sentence(both) == "The exact method keeps volume; weighed: aspect ratio."
