"""Distances between tables of descriptors, by number and by volume, and how sure they are."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.shape_models.goodness_of_fit import (
    classifier_accuracy,
    energy_distance,
    kolmogorov_smirnov,
    pairs_of,
    relative_wasserstein,
    resampled_distances,
)

WEIGHTINGS = ("number", "volume")
CONFIDENCE = 0.95
N_RESAMPLES = 200
MAX_PAIRED = 5
"""Descriptors, the first of a study, whose pairs are compared: their number grows with the square."""


@dataclass(frozen=True, eq=False)
class PopulationDistances:
    """Distances over rounds (draws from a model fitted to a half, or random halves).

    Parameters
    ----------
    wasserstein, kolmogorov
        Share of the mean, and share of all, shape (rounds, weightings, keys).
    energy
        Of pairs of descriptors, number-weighted, shape (rounds, pairs).
    accuracy
        Of the classifier, shape (rounds,).
    """

    wasserstein: FloatArray
    kolmogorov: FloatArray
    energy: FloatArray
    accuracy: FloatArray

    @classmethod
    def joined(cls, parts: Sequence["PopulationDistances"]) -> "PopulationDistances":
        """All rounds of several."""
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in cls.__annotations__))


@dataclass(frozen=True, eq=False)
class Intervals:
    """Between which values the distance of one round lies, by resampling measured and drawn particles.

    Shapes (2, weightings, keys): lower and upper ends at :data:`CONFIDENCE`, each the mean over the rounds.
    Resampling adds noise and so distance; the intervals are shifted back to have the distance as their mean.
    """

    wasserstein: FloatArray
    kolmogorov: FloatArray


def distances(
    pairs: Iterable[tuple[FloatArray, FloatArray]], seed: int, size_column: int | None, first: int = 0
) -> PopulationDistances:
    """Between each pair of tables; by volume too if there is a column of equivalent radii.

    `first` is the number of the first pair, for the generators of the classifiers.
    """
    near, gaps, energies, accuracies = [], [], [], []
    for number, (one, two) in enumerate(pairs, first):
        weights = [
            (class_weights(one, w, size_column), class_weights(two, w, size_column)) for w in WEIGHTINGS
        ]
        columns = range(one.shape[1])
        near.append(
            [[relative_wasserstein(one[:, j], two[:, j], *pair) for j in columns] for pair in weights]
        )
        gaps.append([[kolmogorov_smirnov(one[:, j], two[:, j], *pair) for j in columns] for pair in weights])
        energies.append(
            [energy_distance(one[:, [i, j]], two[:, [i, j]]) for i, j in paired_columns(one.shape[1])]
        )
        rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(number,)))
        accuracies.append(classifier_accuracy(one, two, rng))
    return PopulationDistances(*map(np.array, (near, gaps, energies, accuracies)))


def intervals(
    measured: FloatArray, drawn: FloatArray, found: PopulationDistances, seed: int, size_column: int | None
) -> Intervals:
    """Of one round, whose distances are `found`, by :data:`N_RESAMPLES` resamples of the particles."""
    rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(1,)))
    counts = [rng.multinomial(len(t), np.full(len(t), 1 / len(t)), N_RESAMPLES) for t in (measured, drawn)]
    shape = (2, len(WEIGHTINGS), measured.shape[1])
    near, gaps = np.empty(shape), np.empty(shape)
    for w, weighting in enumerate(WEIGHTINGS):
        pair = [class_weights(table, weighting, size_column) for table in (measured, drawn)]
        for j in range(measured.shape[1]):
            far, gap = resampled_distances(
                measured[:, j], drawn[:, j], pair[0] * counts[0], pair[1] * counts[1], pair[0]
            )
            near[:, w, j] = _interval(far, found.wasserstein[0, w, j])
            gaps[:, w, j] = _interval(gap, found.kolmogorov[0, w, j])
    return Intervals(near, gaps)


def paired_columns(n_columns: int) -> list[tuple[int, int]]:
    """Which columns are compared in pairs: those of the first :data:`MAX_PAIRED`."""
    return pairs_of(min(n_columns, MAX_PAIRED))


def class_weights(table: FloatArray, weighting: str, size_column: int | None) -> FloatArray:
    """Weight of each particle: one, or the cube of its equivalent radius, shape (n,)."""
    if weighting == "number" or size_column is None:
        return np.ones(len(table))
    return np.asarray(table[:, size_column] ** 3)


def _interval(resampled: FloatArray, found: float) -> FloatArray:
    low, high = np.quantile(resampled, [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])
    return np.asarray(np.maximum(np.array([low, high]) - (resampled.mean() - found), 0.0))
