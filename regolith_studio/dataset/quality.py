"""Error of a set of representatives over their number, compared with the sampling noise of the population.

How well the shapes of a dataset stand for the population that they were chosen from.
"""

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.representatives import (
    LENGTHS,
    RepresentativeSelection,
    compared_values,
    representation_error,
    representative_series,
    sampling_noise,
)
from regolith_studio.dataset.schema import Representation
from regolith_studio.dataset.size_distributions import Weighting
from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.io.tables import Column, Table

N_QUANTILES = 200
"""Of each descriptor of the population, at even shares; as many of the sizes of each class."""
SHARES = (np.arange(N_QUANTILES) + 0.5) / N_QUANTILES


def representation_of(
    population: Sequence[Mapping[str, float]], representatives: RepresentativeSelection
) -> Representation:
    """How well measured particles represent the population that they were chosen from.

    The errors of what is made of them are added by :func:`polyhedra_errors` once there is a dataset.
    """
    weighting = representatives.weighting
    values, counted = compared_values(population, weighting)
    return Representation(
        n_particles=len(population),
        errors={},
        source_errors=representation_error(population, representatives),
        sampling_noise=sampling_noise(population, weighting) if len(population) > 1 else {},
        population={key: tuple(_quantiles(each, counted).tolist()) for key, each in values.items()},
        deviations={key: float(each.std()) for key, each in values.items()},
    )


def polyhedra_errors(dataset: Dataset, representation: Representation) -> dict[str, float]:
    """Wasserstein distance between population and dataset, per descriptor, in standard deviations.

    The population is that of the quantiles which `representation` keeps; the dataset its shapes with their
    weights and sizes, counted as its weighting says.
    """
    from scipy.stats import wasserstein_distance  # imports 30 MB, which a dataset alone does not need

    weights = np.repeat(dataset.class_weights(dataset.weighting) / N_QUANTILES, N_QUANTILES)
    sizes = [one.sizes.weighted(dataset.weighting).quantile(SHARES) for one in dataset.representatives]
    lengths = (np.pi / 6) ** (1 / 3) * np.array(sizes)
    keys = ("aspect_ratio", "sphericity", "convexity", "min_diameter", "max_diameter")
    shapes = [describe(one.shape, keys) for one in dataset.representatives]
    errors = {}
    for key in keys:
        of_shape = np.array([shape[key] for shape in shapes])[:, None]
        values = of_shape * (lengths if key in LENGTHS else np.ones_like(lengths))
        apart = wasserstein_distance(values.ravel(), representation.population[key], weights)
        errors[key] = float(apart) / max(representation.deviations[key], 1e-300)
    return errors


def _quantiles(values: FloatArray, counted: FloatArray) -> FloatArray:
    """Weighted quantiles at :data:`SHARES`."""
    order = np.argsort(values)
    rising = np.cumsum(counted[order]) / counted.sum()
    return values[order][np.minimum(np.searchsorted(rising, SHARES), len(values) - 1)]


COUNTS = (1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 40, 50, 70, 100, 140, 200)
"""Numbers of representatives of a curve; the paper has 10."""


@dataclass(frozen=True)
class QualityPoint:
    """Error for one number of representatives: Wasserstein distance by descriptor, in standard deviations."""

    count: int
    errors: Mapping[str, float]

    @property
    def mean(self) -> float:
        """Over the descriptors."""
        return float(np.mean(list(self.errors.values())))


@dataclass(frozen=True)
class QualityCurve:
    """Error over the number of representatives.

    - ``points``: by ascending number.
    - ``noise``: expected distance between the population and its material: below it, more representatives
      reproduce the sample and no longer the material.
    - ``n_particles``: of the population.
    """

    points: tuple[QualityPoint, ...]
    noise: Mapping[str, float]
    n_particles: int
    weighting: Weighting = "number"
    choices: tuple[RepresentativeSelection, ...] = field(default=(), compare=False, repr=False)

    @property
    def noise_mean(self) -> float:
        """Over the descriptors."""
        return float(np.mean(list(self.noise.values())))

    @property
    def sufficient_count(self) -> int | None:
        """Minimum number with a mean error of at most the noise; ``None`` if there is none."""
        return next((point.count for point in self.points if point.mean <= self.noise_mean), None)


def curve_counts(n_particles: int, count: int | None = None) -> tuple[int, ...]:
    """Numbers of representatives for a curve of a population, including `count`."""
    fitting = {count for count in COUNTS if count <= n_particles}
    return tuple(sorted(fitting | ({count} if count else set())))


def quality_steps(
    population: Sequence[Mapping[str, float]],
    counts: Sequence[int],
    *,
    weighting: Weighting = "number",
    size_importance: float = 0.0,
    seed: int = 0,
) -> Generator[QualityPoint, None, QualityCurve]:
    """Choose representatives for each number and measure them; yields each point, returns the curve.

    Raises InputError if a number is larger than the population, or descriptors are missing.
    """
    ascending = sorted(set(counts))
    points, choices = [], []
    series = representative_series(
        population, ascending, weighting=weighting, size_importance=size_importance, seed=seed
    )
    for representatives in series:
        errors = representation_error(population, representatives)
        points.append(QualityPoint(len(representatives.chosen), errors))
        choices.append(representatives)
        yield points[-1]
    noise = sampling_noise(population, weighting, seed=seed)
    return QualityCurve(tuple(points), noise, len(population), weighting, tuple(choices))


def quality_curve(
    population: Sequence[Mapping[str, float]],
    counts: Sequence[int] | None = None,
    *,
    weighting: Weighting = "number",
    size_importance: float = 0.0,
    seed: int = 0,
) -> QualityCurve:
    """As :func:`quality_steps`, at once; by default for :func:`curve_counts`."""
    steps = quality_steps(
        population,
        counts or curve_counts(len(population)),
        weighting=weighting,
        size_importance=size_importance,
        seed=seed,
    )
    while True:
        try:
            next(steps)
        except StopIteration as end:
            curve: QualityCurve = end.value
            return curve


def quality_table(curve: QualityCurve) -> Table:
    """Errors over the number of representatives; the row whose number is missing is the sampling noise."""
    keys = tuple(curve.points[0].errors)
    rows = [(point.count, point.mean, *(float(point.errors[key]) for key in keys)) for point in curve.points]
    noise = (None, curve.noise_mean, *(float(curve.noise[key]) for key in keys))
    enough = (
        "no number looked at"
        if curve.sufficient_count is None
        else f"{curve.sufficient_count} representatives"
    )
    return Table(
        f"Wasserstein distance between {curve.n_particles} particles and their representatives",
        (Column("representatives"), Column("mean"), *(Column(key) for key in keys)),
        (*rows, noise),
        (
            "In standard deviations of each descriptor. Last row: the sampling noise, the same between these "
            "particles and all of their material, estimated from random halves.",
            f"The mean error falls to that noise at {enough}; weighted by {curve.weighting}.",
        ),
    )
