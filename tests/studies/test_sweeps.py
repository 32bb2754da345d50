"""Error against faces, overlap against descriptors, sensitivity to weights."""

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from regolith_studio.coarsening.weights import JACCARD, LossWeights
from regolith_studio.errors import InputError
from regolith_studio.studies.coarsening import COLUMNS, CoarseningStudy
from regolith_studio.studies.figures.coarsening import write_sweep
from regolith_studio.studies.loss_variants import (
    LossVariant,
    facet_count_variants,
    loss_variants,
    losses,
    sensitivity_variants,
    tradeoff_variants,
)
from regolith_studio.studies.sweeps import (
    SWEEPS,
    descriptor_error,
    differences,
    pareto_front,
    parse_values,
    significant,
    sufficient_facets,
    tradeoff_table,
)

ALL = LossVariant("all", LossWeights.from_preset("all"))
ANNEALED = LossVariant("all", LossWeights.from_preset("all"), "annealing")


def made_up(errors: Any, rows: tuple[LossVariant, ...] | None = None) -> CoarseningStudy:
    """A study with these errors: particles, rows, columns."""
    table = np.asarray(errors, dtype=np.float64)
    labels = tuple(ALL.relabelled(f"row {r}", n_facets=8 + r) for r in range(table.shape[1]))
    names = tuple(f"grain {i}" for i in range(len(table)))
    return CoarseningStudy(rows or labels, names, table, n_unmet=(0,) * table.shape[1])


def table_of(*rows: tuple[float, float], n: int = 3) -> np.ndarray:
    """The same errors for `n` particles; a row is the error of all descriptors and the distance."""
    return np.array([[[error] * 6 + [distance] for error, distance in rows]] * n)


def test_that_faces_are_ascending_and_each_counts_once() -> None:
    assert [row.n_facets for row in facet_count_variants(ALL, (50, 8.0, 20, 8))] == [8, 20, 50]
    with pytest.raises(InputError, match=r"whole numbers, got 8\.5"):
        facet_count_variants(ALL, (8.5,))


def test_that_conditions_are_traded_one_choice_at_a_time() -> None:
    rows = tradeoff_variants(ALL)
    assert len(rows) == 8  # every subset of size, box, sphericity
    assert len({row.weights for row in rows}) == 8
    assert all(row.weights[JACCARD] == 1 for row in rows)
    assert sum(row.weights["sphericity"] > 0 for row in rows) == 4
    assert rows[-1].weights == ALL.weights


def test_that_weighed_terms_are_traded_by_a_factor() -> None:
    rows = tradeoff_variants(ANNEALED, (2, 0.5))
    assert [row.weights[JACCARD] for row in rows] == [0.5, 2, 1]
    assert [row.weights["volume"] for row in rows] == [1, 1, 0]


def test_that_each_weight_is_changed_alone() -> None:
    like = LossVariant("", LossWeights.of(volume=1, sphericity=2), "annealing")
    first, *others = sensitivity_variants(like, (0, 1, 3))
    assert first.weights == like.weights
    assert [(row.weights["volume"], row.weights["sphericity"]) for row in others] == [
        (0, 2),
        (3, 2),
        (1, 0),
        (1, 6),
    ]


def test_that_a_loss_is_never_left_without_a_weight() -> None:
    rows = sensitivity_variants(LossVariant("", LossWeights.of(volume=1), "annealing"), (0, 4))
    assert [row.weights["volume"] for row in rows] == [1, 4]


@pytest.mark.parametrize("rows", [tradeoff_variants, sensitivity_variants])
def test_that_what_cannot_be_varied_is_said(rows: Any) -> None:
    with pytest.raises(InputError, match="A baseline has no loss"):
        rows(LossVariant("", LossWeights.from_preset("all"), "quadric"))
    with pytest.raises(InputError, match="0 or a positive number, got -1"):
        rows(ANNEALED, (-1.0,))


def test_that_a_trade_needs_something_to_trade() -> None:
    with pytest.raises(InputError, match="at least one descriptor"):
        tradeoff_variants(LossVariant("", LossWeights.from_preset("overlap")))


def test_that_every_descriptor_can_be_a_loss_alone() -> None:
    rows = loss_variants(("overlap", "only_sphericity"), ALL)
    assert [sum(row.weights.values()) for row in rows] == [1, 1]
    assert rows[1].weights["sphericity"] == 1
    assert sum(name.startswith("only_") for name in losses()) == 6
    with pytest.raises(InputError, match="no loss called 'beauty'"):
        loss_variants(("beauty",), ALL)


def test_that_numbers_are_read_and_nothing_else() -> None:
    assert parse_values(" 8, 20.5 ,1e2,") == (8.0, 20.5, 100.0)
    for text in ("", "eight", "nan", "8;9", "inf"):
        with pytest.raises(InputError, match="Write numbers with commas"):
            parse_values(text)


def test_that_efficient_rows_are_those_that_none_beats_in_both() -> None:
    study = made_up(table_of((0.5, 0.1), (0.1, 0.2), (0.3, 0.3), (0.0, 0.4), (0.5, 0.15)))
    assert pareto_front(study) == (0, 1, 3)
    assert descriptor_error(study.rmsre) == pytest.approx([0.5, 0.1, 0.3, 0.0, 0.5])
    assert tradeoff_table(study).column("efficient") == ("yes", "yes", "no", "yes", "no")


def test_that_a_change_is_judged_on_the_same_particles() -> None:
    rng = np.random.default_rng(0)
    base = np.abs(rng.normal(0.1, 0.08, (200, 1, 7)))
    study = made_up(np.concatenate([base, base + 1e-3, base], axis=1))
    values, (low, high) = differences(study)
    rounding = 1e-15  # the Jaccard distance changes by the same in each resample
    assert (low <= values + rounding).all()
    assert (values <= high + rounding).all()
    assert significant(study)[0].all()  # the band of either row alone is many times as wide
    assert not significant(study)[1].any()
    assert np.ptp(study.bands[:, 0, -1]) > 5 * np.ptp([low[0, -1], high[0, -1]])


def test_that_differences_below_what_exact_means_are_no_news() -> None:
    study = made_up(table_of((0.0, 0.1), (5e-7, 0.1)))
    assert not significant(study).any()


@pytest.mark.parametrize(
    ("distances", "enough"),
    [
        ((0.3, 0.2, 0.1), 10),
        ((0.3, 0.2, 0.2), 9),
        ((0.3, 0.2, 0.1995), 9),
        ((0.2, 0.3, 0.2), 8),
        ((0.2, 0.3, 0.1), 10),
    ],
)
def test_that_facets_suffice_where_no_larger_number_lowers_an_error(distances, enough) -> None:
    assert sufficient_facets(made_up(table_of(*((0.0, each) for each in distances)))) == enough


def test_that_a_fall_that_may_be_chance_is_no_gain() -> None:
    errors = table_of((0.1, 0.2), (0.1, 0.2), n=40)
    noise = np.random.default_rng(1).normal(0.0, 0.05, 40)
    errors[:, 1, -1] += noise - noise.mean() - 0.004  # falls by .4 points with a scatter of 5
    assert sufficient_facets(made_up(errors)) == 8
    errors[:, 1, -1] = errors[:, 0, -1] - 0.004
    assert sufficient_facets(made_up(errors)) == 9


@pytest.mark.parametrize("key", SWEEPS)
def test_that_files_hold_the_numbers_with_units(key: str, tmp_path: Path) -> None:
    study = made_up(table_of((0.02, 0.2), (0.01, 0.25), (0.03, 0.1)))
    names = {path.name for path in write_sweep(key, study, tmp_path)}
    endings = ("csv", "json", "png", "svg")
    assert names >= {f"{key}.{ending}" for ending in endings}
    with (tmp_path / f"{key}.csv").open(newline="") as file:
        header, *lines = csv.reader(file)
    document = json.loads((tmp_path / f"{key}.json").read_text())
    assert len(document["rows"]) == len(lines)
    assert any("[%]" in cell for cell in header)
    assert any("3 particles" in note for note in document["notes"])
    found = [float(cell) for line in lines for cell in line if cell.replace(".", "").isdigit()]
    assert any(cell == pytest.approx(2.0) for cell in found)  # 0.02 in per cent
    assert len(COLUMNS) == 7


def test_that_a_study_without_particles_has_errors_and_bands_that_are_not_numbers() -> None:
    empty = made_up(np.empty((0, 3, 7)))
    assert np.isnan(empty.rmsre).all()
    assert np.isnan(empty.bands).all()
    assert empty.bands.shape == (2, 3, 7)
