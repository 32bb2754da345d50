"""Evaluates shape models against a sample: studies with their figures, distributions side by side."""

from collections.abc import Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.jobs.compile_kernels import compile_first
from regolith_studio.jobs.events import Job, Partial, Progress, Started, Step, Steps
from regolith_studio.jobs.executor import Executor, open_executor, value_of
from regolith_studio.jobs.study_jobs import study_population
from regolith_studio.messages import N_
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.protocol import SizeRange
from regolith_studio.shape_models.realizations import Realizations
from regolith_studio.shape_models.sample import Sample
from regolith_studio.studies.population import (
    KEYS,
    MEASURE_BATCH,
    MESH_LEVEL,
    PopulationStudy,
    default_draws,
    descriptors_of,
)
from regolith_studio.studies.population_distances import WEIGHTINGS, DistributionComparison
from regolith_studio.studies.population_tables import (
    PopulationPanel,
    components_panels,
    density_panels,
    pair_panels,
    quantile_panels,
)

MIN_FOR_PROCESSES = 400
"""Particles to be measured beyond which processes are started: some seconds of work, and fits that this
process could not be stopped at."""


@dataclass(frozen=True, eq=False)
class ModelEvaluationResult:
    """A study, and the panels of its figures by name: number, volume, pairs, quantiles, components."""

    study: PopulationStudy
    panels: Mapping[str, tuple[PopulationPanel, ...]]


def evaluate_models(sample: Sample, models: Sequence[str] | None, **options: Any) -> Steps:
    """Evaluate models; partial results and the result are :class:`ModelEvaluationResult`.

    Long studies use one process a core. The options are those of
    :func:`~regolith_studio.studies.population.population_study`.
    """
    rounds = options.get("n_splits", 5) * options.get("n_repeats", 5) * len(models or MODELS)
    n_measured = len(sample) + rounds * default_draws(len(sample))
    steps = study_population(sample, models, 0 if n_measured > MIN_FOR_PROCESSES else 1, **options)
    shown = Progress(0, n_measured, "")
    while True:
        try:
            step: Step = next(steps)
        except StopIteration as end:
            return (yield from evaluation_panels(end.value, shown))
        if isinstance(step, Progress):
            shown = step
        if isinstance(step, Partial):
            step = Partial((yield from evaluation_panels(step.value, shown)))
        yield step


def evaluation_panels(
    study: PopulationStudy, shown: Progress
) -> Generator[Step, None, ModelEvaluationResult]:
    """The study with the panels of its figures; how far the work is stays as `shown`."""
    at_figures = replace(shown, message="figures")
    panels = {name: density_panels(study, name) for name in WEIGHTINGS}
    panels |= {"quantiles": quantile_panels(study), "components": components_panels(study)}
    yield at_figures
    pairs = pair_panels(study)
    while True:
        try:
            next(pairs)
        except StopIteration as end:
            return ModelEvaluationResult(study, panels | {"pairs": end.value})
        yield at_figures


MAX_COMPARED = 300
"""Particles of either kind that are measured at most: ten seconds of work for rough ones."""
_SMOOTH_DEGREE = 10
"""Up to this degree meshes one level coarser are measured: boxes of fine smooth ones take a second each."""


def compare_distributions(
    sample: Sample | None,
    draws: Realizations,
    size_range: SizeRange | None = None,
    workers: int | Executor = 1,
) -> Steps:
    """Measure drawn and measured particles, these with all their degrees and at that of the draws. A job.

    Measured particles are taken from all over the sample, those of the range of sizes. Returns
    :class:`~regolith_studio.studies.population_distances.DistributionComparison`.
    """
    kinds = [draws.chosen(range(min(len(draws), MAX_COMPARED)))]
    if sample is not None:
        kinds += _measured_kinds(sample, draws, size_range)
    total = sum(len(each) for each in kinds)
    level = MESH_LEVEL - (max(each.l_max for each in kinds) <= _SMOOTH_DEGREE)
    yield from compile_first("describe")
    yield Started(N_("Comparing distributions"), total)
    tables, done = [], 0
    with open_executor(workers) as executor:
        for each in kinds:
            tables.append((yield from _descriptor_table(each, level, (done, total), executor)))
            done += len(each)
    drawn, measured, cut = (*tables, *(np.empty((0, len(KEYS))),) * 2)[:3]
    degree = draws.l_max if sample is None else sample.l_max
    return DistributionComparison(KEYS, measured, drawn, cut, draws.model, draws.l_max, degree)


def _measured_kinds(
    sample: Sample, draws: Realizations, size_range: SizeRange | None
) -> Iterator[Realizations]:
    """The sample's particles, and cut at the degree of the draws where that is lower."""
    low, high = size_range or (0.0, np.inf)
    inside = np.flatnonzero((sample.equivalent_radii >= low) & (sample.equivalent_radii <= high))
    places = np.linspace(0, len(inside) - 1, min(len(inside), MAX_COMPARED)).astype(np.int64)
    rows = sample.coefficients[inside[np.unique(places)]]
    yield Realizations(rows, "radius", "measured", draws.seed, sample.unit)
    if draws.l_max < sample.l_max:
        cut = rows[:, : (draws.l_max + 1) ** 2]
        yield Realizations(cut, "radius", "measured", draws.seed, sample.unit)


def _descriptor_table(
    draws: Realizations, level: int, place: tuple[int, int], executor: Executor
) -> Generator[Step, None, FloatArray]:
    batches = (range(i, min(i + MEASURE_BATCH, len(draws))) for i in range(0, len(draws), MEASURE_BATCH))
    jobs = (Job(_measure_batch, (draws.chosen(batch), level)) for batch in batches)
    tables = [np.empty((0, len(KEYS)))]
    for result in executor.results(jobs):
        if result is not None:
            tables.append(value_of(result))
        yield Progress(place[0] + sum(map(len, tables)), place[1])
    table = np.concatenate(tables)
    return table[np.isfinite(table).all(axis=1)]


def _measure_batch(draws: Realizations, level: int) -> Steps:
    yield Started(N_("Comparing distributions"), len(draws))
    return descriptors_of(draws, KEYS, level)
