"""Judging models for the window: the curves of its figures."""

import numpy as np
import pytest

from regolith_studio.jobs.events import Partial, Progress, Started, Step
from regolith_studio.jobs.model_jobs import GenerationRequest, ModelEvaluationResult, draw, evaluate_models
from regolith_studio.shape_models.materials import materials
from regolith_studio.shape_models.sample import Sample
from regolith_studio.steps import result_of
from regolith_studio.studies.population_tables import CONTAINED, common_grid, contours, pair_density
from tests.steps import played


@pytest.fixture(scope="module")
def job_steps() -> tuple[list[Step], ModelEvaluationResult]:
    draws = materials()["ma165"].model(3).draw(24, 0)
    sample = Sample(np.stack([draws.particle(i).values for i in range(24)]))
    return played(evaluate_models(sample, ("log_field",), l_max=3, n_splits=1, n_repeats=1, level=1))


def test_that_a_judgement_has_its_figures(job_steps: tuple[list[Step], ModelEvaluationResult]) -> None:
    _, evaluated = job_steps
    panels = evaluated.panels
    assert set(panels) == {"number", "volume", "pairs", "quantiles", "components"}
    assert not panels["components"]
    assert [panel.x for panel in panels["number"]] == list(evaluated.study.keys)
    assert all(panel.curves[0].source == "measured" for panel in panels["pairs"])
    assert evaluated.study.models[0].key == "log_field"


def test_that_half_of_the_particles_lie_inside_the_contour_that_says_so() -> None:
    """Counted by matplotlib's test of points in a polygon, for a normal cloud."""
    from matplotlib.path import Path

    cloud = np.random.default_rng(1).normal(size=(1200, 2)) * [1.0, 3.0]
    x, y = common_grid([cloud])
    values, levels = pair_density(cloud, x, y)
    for level, share in zip(levels, sorted(CONTAINED, reverse=True), strict=True):
        across, up = contours(values, np.array([level]), x, y)
        outline = Path(np.stack([across, up], axis=1)[1:-1])
        assert outline.contains_points(cloud).mean() == pytest.approx(share, abs=0.02)


def test_that_it_can_be_stopped_between_figures_and_never_goes_back(
    job_steps: tuple[list[Step], ModelEvaluationResult],
) -> None:
    steps, _ = job_steps
    progress = [step for step in steps if isinstance(step, Progress)]
    assert [step.done for step in progress] == sorted(step.done for step in progress)
    figures = [step for step in progress if step.message == "figures"]
    partials = [step for step in steps if isinstance(step, Partial)]
    n_histograms, n_densities = 1, 3 * 2
    assert len(figures) == (n_histograms + n_densities) * (len(partials) + 1)
    assert {step.done for step in figures} == {figures[0].total}


def test_that_drawing_can_be_stopped_between_chunks_and_says_how_far_it_is() -> None:
    model = materials()["ma165"].model(3)
    steps = draw(model, GenerationRequest(n=1203, seed=2))
    reported = [next(steps) for _ in range(3)]
    assert reported == [Started("Drawing", 1203), Progress(500, 1203), Progress(1000, 1203)]
    steps.close()
    draws = result_of(draw(model, GenerationRequest(n=1203, seed=2)))
    assert draws.coefficients.tobytes() == model.draw(1203, 2).coefficients.tobytes()
