"""Evaluates shape models against a sample: studies with their figures, distributions side by side."""

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from regolith_studio.descriptors.distributions import Distribution
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.jobs.compile_kernels import compile_first
from regolith_studio.jobs.events import Partial, Progress, Started, Step, Steps
from regolith_studio.jobs.study_jobs import study_population
from regolith_studio.messages import N_
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.realizations import Realizations
from regolith_studio.shape_models.sample import Sample
from regolith_studio.studies.population import (
    KEYS,
    MEASURE_BATCH,
    PopulationStudy,
    default_draws,
    descriptors_of,
)
from regolith_studio.studies.population_curves import (
    PopulationPanel,
    components_panels,
    density_panels,
    pair_panels,
    quantile_panels,
)
from regolith_studio.studies.population_distances import WEIGHTINGS

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


MAX_COMPARED = 1000
"""Particles of either kind that are measured at most."""


@dataclass(frozen=True, eq=False)
class DistributionComparison:
    """Descriptors of both kinds.

    Parameters
    ----------
    keys
        Of the columns.
    measured, drawn
        Shape (n, keys), without particles that bound no solid; `measured` is empty where the source of a
        model holds no particles.
    """

    keys: tuple[str, ...]
    measured: FloatArray
    drawn: FloatArray

    def distributions(self, key: str, weighting: str = "number") -> tuple[Distribution | None, Distribution]:
        """One descriptor of the measured, if there are any, and of the drawn particles.

        Parameters
        ----------
        weighting
            ``number``, or ``volume``: each particle counts by its volume.
        """
        drawn = self._distribution(self.drawn, key, weighting)
        return (self._distribution(self.measured, key, weighting) if len(self.measured) else None), drawn

    def _distribution(self, table: FloatArray, key: str, weighting: str) -> Distribution:
        sizes = table[:, self.keys.index("equivalent_radius")]
        weights = sizes**3 if weighting == "volume" else np.ones(len(table))
        return Distribution(table[:, self.keys.index(key)], weights)


def compare_distributions(sample: Sample | None, draws: Realizations) -> Steps:
    """Measure both, the sample with all its degrees; returns :class:`DistributionComparison`. A job."""
    kinds = [draws.chosen(range(min(len(draws), MAX_COMPARED)))]
    if sample is not None:
        rows = sample.coefficients[:MAX_COMPARED]
        kinds.append(Realizations(rows, "radius", "measured", draws.seed, sample.unit))
    total = sum(len(each) for each in kinds)
    yield from compile_first("describe")
    yield Started(N_("Comparing distributions"), total)
    tables, done = [], 0
    for each in kinds:
        tables.append((yield from _descriptor_table(each, done, total)))
        done += len(each)
    drawn, measured = tables[0], tables[1] if len(tables) > 1 else np.empty((0, len(KEYS)))
    return DistributionComparison(KEYS, measured, drawn)


def _descriptor_table(draws: Realizations, done: int, total: int) -> Generator[Progress, None, FloatArray]:
    tables = []
    for first in range(0, len(draws), MEASURE_BATCH):
        last = min(first + MEASURE_BATCH, len(draws))
        tables.append(descriptors_of(draws.chosen(range(first, last)), KEYS))
        yield Progress(done + last, total)
    table = np.concatenate(tables)
    return table[np.isfinite(table).all(axis=1)]
