"""Distances between tables of descriptors, by number and by volume, and how sure they are."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.descriptors.distributions import Distribution
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.io.tables import Column, Table
from regolith_studio.messages import N_, Message, Number
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

    - ``wasserstein``, ``kolmogorov``: share of the mean, and share of all, shape (rounds, weightings, keys).
    - ``energy``: of pairs of descriptors, number-weighted, shape (rounds, pairs).
    - ``accuracy``: of the classifier, shape (rounds,).
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
    measured: FloatArray,
    drawn: FloatArray,
    distances: PopulationDistances,
    seed: int,
    size_column: int | None,
) -> Intervals:
    """Of one round, whose distances are `distances`, by :data:`N_RESAMPLES` resamples of the particles."""
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
            near[:, w, j] = _interval(far, distances.wasserstein[0, w, j])
            gaps[:, w, j] = _interval(gap, distances.kolmogorov[0, w, j])
    return Intervals(near, gaps)


def paired_columns(n_columns: int) -> list[tuple[int, int]]:
    """Which columns are compared in pairs: those of the first :data:`MAX_PAIRED`."""
    return pairs_of(min(n_columns, MAX_PAIRED))


def class_weights(table: FloatArray, weighting: str, size_column: int | None) -> FloatArray:
    """Weight of each particle: one, or the cube of its equivalent radius, shape (n,)."""
    if weighting == "number" or size_column is None:
        return np.ones(len(table))
    return np.asarray(table[:, size_column] ** 3)


def _interval(resampled: FloatArray, estimate: float) -> FloatArray:
    low, high = np.quantile(resampled, [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])
    return np.asarray(np.maximum(np.array([low, high]) - (resampled.mean() - estimate), 0.0))


MIN_COMPARED = 20
"""Particles of either kind below which distances say nothing."""
_N_NOISE = 400
"""Random partitions that the sampling noise is computed from."""


@dataclass(frozen=True, eq=False)
class SamplingNoise:
    """Distances of two random parts of measured and drawn particles together, of the sizes of both.

    Where both have the same source, drawn ones are such a part.

    ``mean``: of both distances, Wasserstein and Kolmogorov-Smirnov, shape (2, weightings, keys). ``limit``:
    what the largest of all distances, each over its mean, exceeds in 5 % of the partitions.
    """

    mean: FloatArray
    limit: float


@dataclass(frozen=True, eq=False)
class DistributionComparison:
    """Descriptors of measured and of drawn particles.

    - ``keys``: of the columns.
    - ``measured``, ``drawn``: shape (n, keys), without particles that bound no solid; `measured` is empty
      where the source of a model holds no particles.
    - ``cut``: the measured ones cut at the degree of the draws, where it is lower; else empty.
    - ``model``: key of the model.
    - ``l_max``, ``sample_l_max``: degree of the draws and of the measured particles.
    """

    keys: tuple[str, ...]
    measured: FloatArray
    drawn: FloatArray
    cut: FloatArray
    model: str
    l_max: int
    sample_l_max: int

    def distributions(self, key: str, weighting: str = "number") -> tuple[Distribution | None, Distribution]:
        """One descriptor of the measured, if there are any, and of the drawn particles.

        ``weighting``: ``number``, or ``volume``: each particle counts by its volume.
        """
        drawn = self._distribution(self.drawn, key, weighting)
        return (self._distribution(self.measured, key, weighting) if len(self.measured) else None), drawn

    @property
    def comparable(self) -> bool:
        """Whether there are enough particles of both kinds."""
        return min(len(self.measured), len(self.drawn)) >= MIN_COMPARED

    @cached_property
    def noise(self) -> SamplingNoise:
        """What distances random parts of all particles have, as many as were measured and drawn."""
        rng = np.random.default_rng(0)
        pool, n = np.concatenate([self.measured, self.drawn]), len(self.measured)
        first = np.zeros((_N_NOISE, len(pool)))
        first[:, :n] = 1.0
        first = rng.permuted(first, axis=1)
        distances = np.empty((2, len(WEIGHTINGS), len(self.keys), _N_NOISE))
        for w, weighting in enumerate(WEIGHTINGS):
            weights = class_weights(pool, weighting, self._size_column)
            own = np.concatenate([weights[:n], np.zeros(len(self.drawn))])
            for k, column in enumerate(pool.T):
                # Weight 0 for particles of the other part: a column is sorted once for all partitions.
                parts = (weights * first, weights * (1.0 - first))
                distances[:, w, k] = resampled_distances(column, column, *parts, own)
        mean = distances.mean(axis=-1)
        largest = (distances / np.maximum(mean, 1e-300)[..., None]).max(axis=(0, 1, 2))
        return SamplingNoise(mean, float(np.quantile(largest, CONFIDENCE)))

    def in_noise(self, table: FloatArray | None = None) -> FloatArray:
        """Distances of the drawn, or of other particles, over their sampling noise, as its `mean`."""
        other = self.drawn if table is None else table
        return self._apart(other) / np.maximum(self.noise.mean, 1e-300)

    def table(self) -> Table:
        """Each descriptor by number and by volume, what is farthest in units of sampling noise first."""
        apart, ratios = self._apart(self.drawn), self.in_noise()
        rows = []
        for w, weighting in enumerate(WEIGHTINGS):
            for k, key in enumerate(self.keys):
                measured, drawn = self.distributions(key, weighting)
                means = (np.nan if measured is None else measured.mean, drawn.mean)
                shares = 100 * apart[0, w, k], 100 * self.noise.mean[0, w, k]
                rows.append((key, weighting, *means, *shares, *ratios[:, w, k]))
        columns = (
            *map(Column, ("descriptor", "weighting", "measured", "drawn")),
            *(Column(name, "%") for name in ("wasserstein", "floor")),
            *map(Column, ("wasserstein_in_floors", "kolmogorov_smirnov_in_floors")),
        )
        ranked = tuple(sorted(rows, key=lambda row: -max(row[-2:])))
        return Table("Drawn against measured particles", columns, ranked)

    def assessment(self) -> Message:
        """Whether the draws differ from the sample by more than sampling noise, and what would be nearer."""
        if not self.comparable:
            few = N_("Fewer than {least} drawn or measured particles of these sizes: they are not compared.")
            return Message(few, least=MIN_COMPARED)
        ratios, limit = self.in_noise(), self.noise.limit
        if ratios.max() <= limit:
            near = N_(
                "{drawn} draws differ from {measured} measured particles by no more than sampling noise."
            )
            return Message(near, drawn=len(self.drawn), measured=len(self.measured))
        worst = self.keys[int(np.unravel_index(ratios.argmax(), ratios.shape)[2])]
        far = N_("The draws are off: {descriptor} by {ratio} times the sampling noise. {remedy}")
        return Message(
            far,
            descriptor=Message(CATALOGUE[worst].label),
            ratio=Number(ratios.max(), ".2g"),
            remedy=self._remedy(),
        )

    def _remedy(self) -> Message:
        measured_surfaces = self.model in _MEASURED_SURFACES
        if len(self.cut) and (cut := self.in_noise(self.cut).max()) > self.noise.limit:
            words = N_("Measured particles cut at l_max = {degree} are off by {ratio}: {remedy}")
            whole = N_("draw with l_max {whole}.")
            other = N_("draw with l_max {whole}, from recombined or sample_matched.")
            remedy = Message(whole if measured_surfaces else other, whole=self.sample_l_max)
            return Message(words, degree=self.l_max, ratio=Number(cut, ".2g"), remedy=remedy)
        if measured_surfaces:
            return Message(N_("No other model is known to be nearer."))
        return Message(
            N_("Draws of recombined and sample_matched, which keep measured surfaces, are nearer as a rule.")
        )

    @property
    def _size_column(self) -> int | None:
        return self.keys.index("equivalent_radius") if "equivalent_radius" in self.keys else None

    def _apart(self, table: FloatArray) -> FloatArray:
        distances = np.empty((2, len(WEIGHTINGS), len(self.keys)))
        for w, weighting in enumerate(WEIGHTINGS):
            weights = [class_weights(each, weighting, self._size_column) for each in (self.measured, table)]
            for k in range(len(self.keys)):
                pair = (self.measured[:, k], table[:, k], *weights)
                distances[:, w, k] = relative_wasserstein(*pair), kolmogorov_smirnov(*pair)
        return distances

    def _distribution(self, table: FloatArray, key: str, weighting: str) -> Distribution:
        return Distribution(
            table[:, self.keys.index(key)], class_weights(table, weighting, self._size_column)
        )


_MEASURED_SURFACES = ("recombined", "sample_matched")
"""Models whose draws have the surfaces of measured particles."""
