from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from matplotlib.colors import to_hex
from scipy.stats import wasserstein_distance

from regolith_studio.errors import InputError
from regolith_studio.harmonics.coefficients import degrees, orders
from regolith_studio.harmonics.io import from_complex_rows
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.realizations import Realizations
from regolith_studio.shape_models.sample import Sample
from regolith_studio.studies import StudyProgress
from regolith_studio.studies.figures.population import (
    components_figure,
    density_figure,
    quantile_figure,
    write_population_study,
)
from regolith_studio.studies.population import (
    KEYS,
    PopulationStudy,
    default_settings,
    descriptors_of,
    population_study,
)
from regolith_studio.studies.population_distances import PopulationDistances, distances
from regolith_studio.studies.population_tables import (
    distance_table,
    pair_table,
    ranking_table,
    target_table,
)
from tests.steps import played

SMALL_MODELS = ("gaussian_field", "gaussian_mixture", "sample_matched")
SMALL = {"l_max": 4, "n_draws": 20, "n_splits": 2, "n_repeats": 2, "level": 2}


def rough_sample(n: int, l_max: int = 4) -> Sample:
    rng = np.random.default_rng(0)
    degree = degrees((l_max + 1) ** 2)
    rows = rng.normal(size=(n, (l_max + 1) ** 2)) * 0.3 * np.maximum(degree, 1.0) ** -2
    rows[:, 0] = np.sqrt(4 * np.pi)
    return Sample(rows * 10 * np.exp(0.3 * rng.normal(size=(n, 1))))


def run(*arguments: object, **options: object) -> tuple[list[StudyProgress], PopulationStudy]:
    return played(population_study(*arguments, **options))  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def small() -> tuple[list[StudyProgress], PopulationStudy]:
    return run(rough_sample(40), SMALL_MODELS, **SMALL)


def test_that_every_table_has_a_row_for_each_case(
    small: tuple[list[StudyProgress], PopulationStudy],
) -> None:
    _, study = small
    assert study.measured.shape == (40, len(KEYS))
    assert len(distance_table(study).rows) == 3 * 2 * len(KEYS)
    assert len(pair_table(study).rows) == 3 * 10
    assert set(ranking_table(study).column("model")) == set(SMALL_MODELS)
    assert all(np.isfinite(value) for value in distance_table(study).column("wasserstein_in_floors"))


def test_that_every_split_is_drawn_from_several_times(
    small: tuple[list[StudyProgress], PopulationStudy],
) -> None:
    steps, study = small
    for model in study.models:
        assert model.distances.wasserstein.shape == (4, 2, len(KEYS))
        assert model.novelty.shape == (2,)
    partial = [step.partial for step in steps if step.partial is not None]
    assert [len(each.models[0].distances.accuracy) for each in partial] == [2, 4]
    assert partial[-1] is study


def test_that_intervals_hold_the_mean_distance(small: tuple[list[StudyProgress], PopulationStudy]) -> None:
    for model in small[1].models:
        for found, ends in (
            (model.distances.wasserstein, model.intervals.wasserstein),
            (model.distances.kolmogorov, model.intervals.kolmogorov),
        ):
            assert (ends[0] <= found.mean(axis=0)).all()
            assert (found.mean(axis=0) <= ends[1]).all()


def test_that_the_number_of_parts_is_shown_with_its_criterion(
    small: tuple[list[StudyProgress], PopulationStudy],
) -> None:
    figure = components_figure(small[1])
    assert figure is not None
    curve = small[1].models[1].criterion
    heights = figure.axes[0].lines[0].get_ydata()
    np.testing.assert_allclose(heights, np.array(curve) - min(curve))
    without = replace(small[1], models=small[1].models[:1])
    assert components_figure(without) is None


def test_that_figures_show_every_model_in_a_colour_of_its_own(
    small: tuple[list[StudyProgress], PopulationStudy],
) -> None:
    study = replace(small[1], models=tuple(replace(small[1].models[0], key=key) for key in MODELS))
    for figure in (density_figure(study), quantile_figure(study)):
        handles, labels = figure.axes[0].get_legend_handles_labels()
        colours = {
            str(to_hex(handle.get_edgecolor() if hasattr(handle, "get_edgecolor") else handle.get_color()))
            for handle, label in zip(handles, labels, strict=True)
            if label in {model.label for model in MODELS.values()}
        }
        assert len(colours) == len(MODELS)


@pytest.mark.slow
def test_that_a_study_becomes_tables_and_pictures(
    small: tuple[list[StudyProgress], PopulationStudy], tmp_path: Path
) -> None:
    files = write_population_study(replace(small[1], models=small[1].models[1:2]), tmp_path)
    assert all(path.stat().st_size > 200 for path in files)
    assert {path.suffix for path in files} == {".csv", ".json", ".png", ".svg"}
    picture = matplotlib.image.imread(tmp_path / "population_pairs.png")
    assert picture.std() > 0.02


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"models": ["wavelets"]}, "got wavelets"),
        ({"models": []}, "got none"),
        ({"n_draws": 5}, "at least 20 draws, one split and one drawing, got 5, 1 and"),
        ({"n_splits": 0}, "one split"),
        ({"n_repeats": 0}, "one split"),
        ({"keys": ["charm"]}, "got charm"),
        ({"keys": ["sphericity"]}, "name two, got only sphericity"),
        ({"l_max": 9}, "no l_max = 9"),
    ],
)
def test_that_a_study_that_cannot_be_made_is_refused(changes: dict[str, object], words: str) -> None:
    options = {"models": ["gaussian_field"], "l_max": 4, "n_draws": 20, "n_splits": 1, "level": 2} | changes
    with pytest.raises(InputError, match=words):
        run(rough_sample(20), **options)


def test_that_a_small_sample_is_told_how_many_particles_it_needs() -> None:
    with pytest.raises(InputError, match=r"at least 20 particles.* this sample has 12\.$"):
        run(rough_sample(12), models=["gaussian_field"], l_max=4, n_draws=20, n_splits=1)


@pytest.mark.slow
def test_that_the_default_model_reaches_the_noise_of_sampling(real_data: Callable[[str], Path]) -> None:
    """Held-out halves of 600 real particles, one split; the paper's field is there for comparison."""
    with np.load(real_data("cement140/coefficients.npz")) as stored:
        table = stored["anm"][:600, :441]
    degree, order = degrees(441), orders(441)
    particles = [from_complex_rows(np.column_stack([degree, order, row.real, row.imag])) for row in table]
    _, study = run(
        Sample.of(particles), ["gaussian_field", "sample_matched"], n_draws=500, n_splits=2, n_repeats=1
    )
    paper, matched = (model.distances for model in study.models)
    aspect, convexity = KEYS.index("aspect_ratio"), KEYS.index("convexity")
    assert matched.wasserstein[:, 0, aspect].mean() < paper.wasserstein[:, 0, aspect].mean() / 3
    assert matched.kolmogorov[:, 0, convexity].mean() < 2 * study.floor.kolmogorov[:, 0, convexity].mean()
    assert matched.accuracy.mean() < 0.56 < 0.8 < paper.accuracy.mean()
    assert study.models[1].rejected.max() == 0.0
    assert study.models[1].novelty.min() > 0.6


def test_that_targets_compare_with_the_papers_model_and_the_noise(
    small: tuple[list[StudyProgress], PopulationStudy],
) -> None:
    study = small[1]
    table = target_table(study)
    assert {row[0] for row in table.rows} == {model.key for model in study.models}
    model = next(each for each in study.models if each.key != "gaussian_field")
    rows = {row[1]: row for row in table.rows if row[0] == model.key}
    thrown = rows["rejected draws [%]"]
    assert (thrown[5] == "yes") == (model.rejected.sum() == 0)
    column = study.keys.index("convexity")
    ratio = model.distances.kolmogorov[:, 0, column].mean() / study.floor.kolmogorov[:, 0, column].mean()
    found = rows["V/CH: Kolmogorov-Smirnov distance over the sampling noise"]
    assert found[2] == pytest.approx(ratio)
    assert found[4] == "at most 2"
    halves = study.floor.kolmogorov[:, 0, column]
    assert found[3] == pytest.approx(np.median(halves / halves.mean()))
    decidable = np.mean(halves / halves.mean() <= 2) >= 0.9
    assert found[5] == ("yes" if ratio <= 2 else "no" if decidable else "not decidable with so few")


def test_that_a_target_that_random_halves_miss_as_often_is_not_decidable(
    small: tuple[list[StudyProgress], PopulationStudy],
) -> None:
    """The worst of eight distances over the 95th percentile of each exceeds 1 more often than once in ten."""
    study = small[1]
    far = replace(study.models[0].distances, wasserstein=study.models[0].distances.wasserstein + 10)
    table = target_table(replace(study, models=(replace(study.models[0], distances=far),)))
    rows = {row[1]: row for row in table.rows}
    assert (
        rows["r_eq, A, AR, S: the worst, over the 95th percentile of noise"][5] == "not decidable with so few"
    )


def test_that_waiting_for_results_changes_nothing_and_lets_the_study_be_stopped() -> None:
    def slow(function, items):  # type: ignore[no-untyped-def]
        for item in items:
            yield None
            yield function(item)

    options = {"l_max": 2, "n_draws": 20, "n_splits": 1, "n_repeats": 1, "level": 1}
    steps, waited = run(rough_sample(24), ["log_field"], mapper=slow, **options)
    np.testing.assert_array_equal(
        waited.models[0].table, run(rough_sample(24), ["log_field"], **options)[1].models[0].table
    )
    assert steps[0].done == 0


def test_that_distances_do_not_depend_on_how_pairs_are_shared_out() -> None:
    rng = np.random.default_rng(0)
    pairs = [(rng.normal(size=(40, 3)) + 5, rng.normal(size=(40, 3)) + 5) for _ in range(3)]
    whole = distances(pairs, 7, None)
    parts = PopulationDistances.joined([distances([pair], 7, None, first=i) for i, pair in enumerate(pairs)])
    for name in PopulationDistances.__annotations__:
        np.testing.assert_array_equal(getattr(whole, name), getattr(parts, name))


def test_that_draws_are_compared_with_the_particles_and_not_with_the_sample_cut_at_their_degree() -> None:
    sample = rough_sample(40, 8)
    _, study = run(sample, ["gaussian_field"], l_max=2, n_draws=20, n_splits=1, n_repeats=1, level=2)
    whole = descriptors_of(realizations(sample), ("sphericity",), 2)
    cut = descriptors_of(realizations(sample.truncated(2)), ("sphericity",), 2)
    column = KEYS.index("sphericity")
    np.testing.assert_allclose(study.measured[:, [column]], whole)
    np.testing.assert_allclose(study.cut[:, [column]], cut)
    table = distance_table(study)
    row = table.column("descriptor").index("sphericity")
    gap = 100 * wasserstein_distance(whole[:, 0], cut[:, 0]) / whole.mean()
    assert table.column("cut_sample")[row] == pytest.approx(gap)


def test_that_models_are_drawn_at_their_own_degree_where_the_sample_has_it() -> None:
    assert default_settings("sample_matched", rough_sample(5, 12)).l_max == 12
    assert default_settings("gaussian_field", rough_sample(5, 12)).l_max == 10
    assert default_settings("gaussian_field", rough_sample(5, 7)).l_max == 7


def realizations(sample: Sample) -> Realizations:
    return Realizations(sample.coefficients, "radius", "measured", 0)
