"""How well the shapes of a dataset stand for the population that they were chosen from."""

from collections.abc import Mapping, Sequence

import numpy as np

from regolith_studio.dataset.dataset import Dataset, Representation
from regolith_studio.dataset.representatives import (
    LENGTHS,
    RepresentativeSelection,
    compared_values,
    representation_error,
    sampling_noise,
)
from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry.arrays import FloatArray

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
