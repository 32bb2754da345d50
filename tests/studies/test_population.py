from collections.abc import Callable
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest

from regolith_studio.errors import InputError
from regolith_studio.harmonics.coefficient_tables import from_complex_rows
from regolith_studio.harmonics.coefficients import degrees, orders
from regolith_studio.model.sample import Sample
from regolith_studio.studies.population import KEYS, PopulationStudy, population_study
from regolith_studio.studies.population_figures import write_population_study
from regolith_studio.studies.population_tables import distance_table, pair_table, ranking_table
from regolith_studio.studies.progress import StudyProgress


def rough_sample(n: int, l_max: int = 4) -> Sample:
    rng = np.random.default_rng(0)
    degree = degrees((l_max + 1) ** 2)
    rows = rng.normal(size=(n, (l_max + 1) ** 2)) * 0.3 * np.maximum(degree, 1.0) ** -2
    rows[:, 0] = np.sqrt(4 * np.pi)
    return Sample(rows * 10 * np.exp(0.3 * rng.normal(size=(n, 1))))


def run(*arguments: object, **options: object) -> tuple[list[StudyProgress], PopulationStudy]:
    steps, study = [], population_study(*arguments, **options)  # type: ignore[arg-type]
    while True:
        try:
            steps.append(next(study))
        except StopIteration as end:
            return steps, end.value


@pytest.fixture(scope="module")
def small() -> tuple[list[StudyProgress], PopulationStudy]:
    return run(
        rough_sample(60), ["gaussian_field", "sample_matched"], l_max=4, n_draws=60, n_splits=2, level=2
    )


def test_that_progress_rises_to_the_end(small: tuple[list[StudyProgress], PopulationStudy]) -> None:
    steps, _ = small
    done = [step.done for step in steps]
    assert done == sorted(done)
    assert steps[-1].share == 1.0


def test_that_every_table_has_a_row_for_each_case(
    small: tuple[list[StudyProgress], PopulationStudy],
) -> None:
    _, study = small
    assert study.measured.shape == (60, len(KEYS))
    assert len(distance_table(study).rows) == 2 * 2 * len(KEYS)
    assert len(pair_table(study).rows) == 2 * 10
    assert set(ranking_table(study).column("model")) == {"gaussian_field", "sample_matched"}
    assert all(np.isfinite(value) for value in distance_table(study).column("wasserstein_in_floors"))


def test_that_the_same_seed_gives_the_same_study(
    small: tuple[list[StudyProgress], PopulationStudy],
) -> None:
    _, again = run(
        rough_sample(60), ["gaussian_field", "sample_matched"], l_max=4, n_draws=60, n_splits=2, level=2
    )
    for one, two in zip(small[1].models, again.models, strict=True):
        np.testing.assert_array_equal(one.table, two.table)
        np.testing.assert_array_equal(one.distances.energy, two.distances.energy)


def test_that_a_study_becomes_tables_and_pictures(
    small: tuple[list[StudyProgress], PopulationStudy], tmp_path: Path
) -> None:
    files = write_population_study(small[1], tmp_path)
    assert all(path.stat().st_size > 200 for path in files)
    assert {path.suffix for path in files} == {".csv", ".json", ".png", ".svg"}
    picture = matplotlib.image.imread(tmp_path / "population_pairs.png")
    assert picture.std() > 0.02


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"models": ["wavelets"]}, "got wavelets"),
        ({"models": []}, "got none"),
        ({"n_draws": 5}, "at least 20 particles, 20 draws and one split"),
        ({"n_splits": 0}, "one split"),
        ({"l_max": 9}, "no l_max = 9"),
    ],
)
def test_that_a_study_that_cannot_be_made_is_refused(changes: dict[str, object], words: str) -> None:
    options = {"models": ["gaussian_field"], "l_max": 4, "n_draws": 20, "n_splits": 1} | changes
    with pytest.raises(InputError, match=words):
        run(rough_sample(20), **options)


@pytest.mark.slow
def test_that_the_default_model_reaches_the_noise_of_sampling(real_data: Callable[[str], Path]) -> None:
    """Held-out halves of 600 real particles, one split; the paper's field is there for comparison."""
    with np.load(real_data("cement140/coefficients.npz")) as stored:
        table = stored["anm"][:600, :441]
    degree, order = degrees(441), orders(441)
    particles = [from_complex_rows(np.column_stack([degree, order, row.real, row.imag])) for row in table]
    _, study = run(Sample.of(particles), ["gaussian_field", "sample_matched"], n_draws=600, n_splits=2)
    paper, matched = (model.distances for model in study.models)
    aspect, convexity = KEYS.index("aspect_ratio"), KEYS.index("convexity")
    assert matched.wasserstein[:, 0, aspect].mean() < paper.wasserstein[:, 0, aspect].mean() / 3
    assert matched.kolmogorov[:, 0, convexity].mean() < 2 * study.floor.kolmogorov[:, 0, convexity].mean()
    assert matched.accuracy.mean() < 0.56 < 0.8 < paper.accuracy.mean()
    assert study.models[1].rejected.max() == 0.0
    assert study.models[1].novelty.min() > 0.6
