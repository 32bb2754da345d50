"""Chooses the particles that stand for a population, with their shares and sizes (section 2.5)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import wasserstein_distance

from regolith_studio.dataset.build import ShapeClass
from regolith_studio.dataset.medoids import k_medoids
from regolith_studio.dataset.size_distribution import DiscreteSizes, Weighting
from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray

NEEDED = ("volume", "sphericity", "aspect_ratio", "min_diameter", "convex_hull_volume")
"""Descriptors that the choice looks at."""

COMPARED = ("aspect_ratio", "sphericity", "convexity")
"""Dimensionless descriptors of the quality figure."""


@dataclass(frozen=True, eq=False)
class Representatives:
    """Chosen particles of a population of n.

    Parameters
    ----------
    chosen
        Their indices in ascending order, shape (k,).
    labels
        For each particle the position of its representative in `chosen`, shape (n,).
    classes
        Weight, sizes and number of members of each, in the order of `chosen`.
    weighting
        What weights and sizes count.
    """

    chosen: IntArray
    labels: IntArray
    classes: tuple[ShapeClass, ...]
    weighting: Weighting


def choose_representatives(
    population: Sequence[Mapping[str, float]],
    n: int,
    *,
    weighting: Weighting = "number",
    size_importance: float = 0.0,
    seed: int = 0,
) -> Representatives:
    """The `n` particles that stand for a population best: k-medoids on standardised shape features.

    Parameters
    ----------
    population
        Descriptors of each particle, with at least the keys :data:`NEEDED`; micrometres.
    weighting
        ``number``: every particle counts the same, a class weighs its share of particles and F_i is the
        distribution of its diameters. ``volume``: everything counts by volume.
    size_importance
        How much a standard deviation of ln d counts against one of a shape feature: 0 leaves size to F_i.
    seed
        Only for populations too large for a table of distances.

    Raises
    ------
    InputError
        If there are fewer than `n` particles, or a descriptor is missing or makes no sense.
    """
    features = shape_features(population)
    diameters = np.cbrt(6 / np.pi * _column(population, "volume"))
    if size_importance > 0.0:
        features = np.column_stack([features, size_importance * _standardised(np.log(diameters))])
    counted = np.ones(len(diameters)) if weighting == "number" else (diameters / diameters.max()) ** 3
    chosen, labels = k_medoids(features, n, counted, seed)
    classes = tuple(
        _shape_class(diameters[labels == index], counted[labels == index], weighting)
        for index in range(len(chosen))
    )
    return Representatives(chosen, labels, classes, weighting)


def shape_features(population: Sequence[Mapping[str, float]]) -> FloatArray:
    """Standardised ln AR, ln(1 - S), ln(1 - V/CH) and ln(Dmin / d), shape (n, 4).

    Distances from the ball and from convexity are floored at 1e-3, where they are numerical noise.
    """
    volume = _column(population, "volume")
    features = (
        np.log(_column(population, "aspect_ratio")),
        np.log(np.maximum(1 - _column(population, "sphericity"), 1e-3)),
        np.log(np.maximum(1 - volume / _column(population, "convex_hull_volume"), 1e-3)),
        np.log(_column(population, "min_diameter") / np.cbrt(6 / np.pi * volume)),
    )
    return np.column_stack([_standardised(feature) for feature in features])


def representation_error(
    population: Sequence[Mapping[str, float]], representatives: Representatives
) -> dict[str, float]:
    """Wasserstein distance between population and its representatives, per descriptor, in its deviations.

    Each descriptor of the population is compared with that of the chosen particles by their weights,
    both counted as the choice was.
    """
    volume = _column(population, "volume")
    values = {key: _column(population, key) for key in ("aspect_ratio", "sphericity")}
    values["convexity"] = volume / _column(population, "convex_hull_volume")
    counted = np.ones(len(volume)) if representatives.weighting == "number" else volume
    weights = [one.weight for one in representatives.classes]
    return {
        key: float(
            wasserstein_distance(values[key], values[key][representatives.chosen], counted, weights)
            / max(values[key].std(), 1e-300)
        )
        for key in COMPARED
    }


def _shape_class(diameters: FloatArray, counted: FloatArray, weighting: Weighting) -> ShapeClass:
    distinct, place = np.unique(diameters, return_inverse=True)
    amounts = np.bincount(place, weights=counted)
    return ShapeClass(float(counted.sum()), DiscreteSizes.of(distinct, amounts, weighting), len(diameters))


def _column(population: Sequence[Mapping[str, float]], key: str) -> FloatArray:
    try:
        values = np.array([particle[key] for particle in population], dtype=np.float64)
    except KeyError as error:
        raise InputError(f"Representatives cannot be chosen without the descriptor {key}.") from error
    if not np.isfinite(values).all() or not (values > 0).all():
        bad = int(np.flatnonzero(~(np.isfinite(values) & (values > 0)))[0])
        raise InputError(
            f"Particle {bad + 1} of the population has the {key} {values[bad]}, which is no measure."
        )
    return values


def _standardised(values: FloatArray) -> FloatArray:
    deviation = float(values.std())
    return np.asarray((values - values.mean()) / (deviation if deviation > 1e-12 else 1.0))
