"""Choose particles that represent a population, with their weights and sizes (section 2.5).

They are k-medoids, the k points with the minimum sum of distances of all points to the nearest of them: BUILD
(Kaufman and Rousseeuw 1990) finds a start, eager swaps (FasterPAM, Schubert and Rousseeuw 2021) improve it,
each candidate's gain against all medoids at once in one pass over the points.
"""

from collections.abc import Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.distance import cdist

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.schema import Representation
from regolith_studio.dataset.size_distributions import DiscreteSizeDistribution, ShapeClass, Weighting
from regolith_studio.descriptors.describe import describe
from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import inner_kernel, kernel
from regolith_studio.io.tables import Column, Table

NEEDED = ("volume", "sphericity", "aspect_ratio", "min_diameter", "convex_hull_volume")
"""Descriptors that the choice requires."""

LENGTHS = ("min_diameter", "max_diameter")
"""Compared descriptors that scale with the particle."""


@dataclass(frozen=True, eq=False)
class RepresentativeSelection:
    """Chosen particles of a population of n.

    - ``chosen``: their indices in ascending order, shape (k,).
    - ``labels``: for each particle the position of its representative in `chosen`, shape (n,).
    - ``classes``: weight, sizes and number of members of each, in the order of `chosen`.
    - ``weighting``: what weights and sizes count.
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
) -> RepresentativeSelection:
    """The `n` particles that represent a population best, by k-medoids on standardised shape features.

    - ``population``: descriptors of each particle, with at least the keys :data:`NEEDED`; micrometres.
    - ``weighting``: ``number``: every particle counts the same, a class weighs its share of particles and
      F_i is the distribution of its diameters. ``volume``: everything counts by volume.
    - ``size_importance``: weight of a standard deviation of ln d relative to one of a shape feature; 0
      leaves the size to F_i.
    - ``seed``: used only for populations too large for a table of distances.

    Raises InputError if there are fewer than `n` particles, or a descriptor is missing or not positive.
    """
    return next(
        representative_series(
            population, (n,), weighting=weighting, size_importance=size_importance, seed=seed
        )
    )


def representative_series(
    population: Sequence[Mapping[str, float]],
    counts: Sequence[int],
    *,
    weighting: Weighting = "number",
    size_importance: float = 0.0,
    seed: int = 0,
) -> Iterator[RepresentativeSelection]:
    """As :func:`choose_representatives` for each number of `counts`, with one table of distances.

    Raises InputError as there.
    """
    features = shape_features(population)
    diameters = equivalent_diameters(population)
    if size_importance > 0.0:
        features = np.column_stack([features, size_importance * _standardised(np.log(diameters))])
    counted = np.ones(len(diameters)) if weighting == "number" else (diameters / diameters.max()) ** 3
    for chosen, labels in medoid_series(features, counts, counted, seed):
        classes = tuple(
            _shape_class(diameters[labels == index], counted[labels == index], weighting)
            for index in range(len(chosen))
        )
        yield RepresentativeSelection(chosen, labels, classes, weighting)


def equivalent_diameters(population: Sequence[Mapping[str, float]]) -> FloatArray:
    """Diameter of the ball of each particle's volume, in micrometres, shape (n,)."""
    return np.asarray(np.cbrt(6 / np.pi * _column(population, "volume")))


def shape_features(population: Sequence[Mapping[str, float]]) -> FloatArray:
    """Standardised ln AR, ln(1 - S), ln(1 - V/CH) and ln(Dmin / d), shape (n, 4).

    1 - S and 1 - V/CH are at least 1e-3; below they are numerical noise.
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
    population: Sequence[Mapping[str, float]], representatives: RepresentativeSelection
) -> dict[str, float]:
    """Wasserstein distance between population and representatives, per descriptor, in standard deviations.

    Ratios are compared with those of the chosen particles by their weights; lengths with those that the
    particles have if each takes the shape of its representative and keeps its equivalent diameter. Both are
    weighted as in the choice.
    """
    values, counted = compared_values(population, representatives.weighting)
    weights = [one.weight for one in representatives.classes]
    chosen, diameters = representatives.chosen, equivalent_diameters(population)
    errors = {}
    for key, each in values.items():
        if key in LENGTHS:
            stands = (each / diameters)[chosen][representatives.labels] * diameters
            errors[key] = _distance(each, stands, counted, counted)
        else:
            errors[key] = _distance(each, each[chosen], counted, weights)
    return errors


HALVINGS = 20
"""Random divisions in two that the noise of sampling is the mean of."""


def sampling_noise(
    population: Sequence[Mapping[str, float]],
    weighting: Weighting = "number",
    *,
    seed: int = 0,
) -> dict[str, float]:
    """Expected distance between the population and the material that it was taken from, by descriptor.

    Weighted and in standard deviations as in :func:`representation_error`; an error below it describes the
    sample and no longer the material. Distances of samples of n and m particles are proportional to
    sqrt(1/n + 1/m): of n against the whole material they are half of those between halves of the n.
    """
    generator = np.random.default_rng(np.random.SeedSequence(seed))
    values, counted = compared_values(population, weighting)
    total = dict.fromkeys(values, 0.0)
    for _ in range(HALVINGS):
        order = generator.permutation(len(counted))
        one, other = order[: len(order) // 2], order[len(order) // 2 :]
        for key, each in values.items():
            total[key] += _distance(each[one], each[other], counted[one], counted[other], each)
    return {key: distance / (2 * HALVINGS) for key, distance in total.items()}


def compared_values(
    population: Sequence[Mapping[str, float]], weighting: Weighting
) -> tuple[dict[str, FloatArray], FloatArray]:
    """Values of the compared descriptors, and the weight of each particle."""
    volume = _column(population, "volume")
    values = {key: _column(population, key) for key in ("aspect_ratio", "sphericity")}
    values["convexity"] = volume / _column(population, "convex_hull_volume")
    values["min_diameter"] = _column(population, "min_diameter")
    values["max_diameter"] = values["min_diameter"] * values["aspect_ratio"]
    return values, np.ones(len(volume)) if weighting == "number" else volume


def _distance(
    values: FloatArray,
    chosen: FloatArray,
    counted: FloatArray,
    weights: Sequence[float] | FloatArray,
    spread_of: FloatArray | None = None,
) -> float:
    """Wasserstein distance over the spread of all values."""
    from scipy.stats import wasserstein_distance  # imports 30 MB, which the start of the window does not need

    apart = float(wasserstein_distance(values, chosen, counted, weights))
    return apart / _spread(values if spread_of is None else spread_of)


def _spread(values: FloatArray) -> float:
    return max(float(values.std()), 1e-300)


def _shape_class(diameters: FloatArray, counted: FloatArray, weighting: Weighting) -> ShapeClass:
    distinct, place = np.unique(diameters, return_inverse=True)
    amounts = np.bincount(place, weights=counted)
    return ShapeClass(
        float(counted.sum()), DiscreteSizeDistribution.of(distinct, amounts, weighting), len(diameters)
    )


def _column(population: Sequence[Mapping[str, float]], key: str) -> FloatArray:
    try:
        values = np.array([particle[key] for particle in population], dtype=np.float64)
    except KeyError as error:
        raise InputError(f"Representatives cannot be chosen without the descriptor {key}.") from error
    if not np.isfinite(values).all() or not (values > 0).all():
        bad = int(np.flatnonzero(~(np.isfinite(values) & (values > 0)))[0])
        raise InputError(
            f"Particle {bad + 1} of the population has the {key} {values[bad]}; it must be positive."
        )
    return values


def _standardised(values: FloatArray) -> FloatArray:
    # What all particles share tells none apart: its rounding must not become a feature.
    deviation = float(values.std())
    return np.asarray((values - values.mean()) / (deviation if deviation > 1e-12 else 1.0))


# 5,000^2 distances of 8 bytes are 200 MB.
MAX_TABLE_SIZE = 5000
"""Maximum number of points in the table of distances; larger populations are searched on a random subset."""


def medoid_series(
    points: FloatArray, counts: Sequence[int], weights: FloatArray | None = None, seed: int = 0
) -> Iterator[tuple[IntArray, IntArray]]:
    """Medoids and the class of each point for each k of `counts`, by one table of distances and one BUILD.

    - ``points``: shape (n, d); distances are Euclidean.
    - ``counts``: numbers of medoids, 1 to n.
    - ``weights``: weight of each point, shape (n,); 1 by default.
    - ``seed``: of the random subset of populations beyond :data:`MAX_TABLE_SIZE`; unused otherwise.

    Returns indices of the medoids in ascending order, shape (k,), and for each point the position of its
    nearest medoid, shape (n,).

    Raises InputError if a count is not between 1 and n.
    """
    n = len(points)
    for k in counts:
        if not 1 <= k <= n:
            raise InputError(f"Between 1 and {n} representatives can be chosen from {n} particles, got {k}.")
    counted = np.ones(n) if weights is None else np.asarray(weights, dtype=np.float64)
    subset = np.arange(n)
    if n > MAX_TABLE_SIZE:
        generator = np.random.default_rng(np.random.SeedSequence(seed))
        subset = np.sort(generator.choice(n, max(MAX_TABLE_SIZE, *counts), replace=False))
    table = cdist(points[subset], points[subset])
    built = np.empty(max(counts), dtype=np.int64)
    build_medoids(table, counted[subset], built)
    for k in counts:
        chosen = built[:k].copy()
        if 1 < k < len(subset):
            swap_medoids(table, counted[subset], chosen)
        medoids = np.sort(subset[chosen])
        nearest = cdist(points, points[medoids]).argmin(axis=1)
        nearest[medoids] = np.arange(k)
        yield medoids.astype(np.int64), nearest.astype(np.int64)


@kernel
def build_medoids(table: FloatArray, weights: FloatArray, chosen: IntArray) -> None:
    """BUILD: fill `chosen` (k,) with the points that lower the weighted sum of distances most, in turn."""
    n = len(table)
    nearest = np.full(n, np.inf)
    taken = np.zeros(n, dtype=np.bool_)
    for step in range(len(chosen)):
        best, best_total = -1, np.inf
        for candidate in range(n):
            if taken[candidate]:
                continue
            total = 0.0
            for point in range(n):
                total += weights[point] * min(nearest[point], table[candidate, point])
            if best < 0 or total < best_total:
                best, best_total = candidate, total
        chosen[step] = best
        taken[best] = True
        for point in range(n):
            nearest[point] = min(nearest[point], table[best, point])


@kernel
def swap_medoids(table: FloatArray, weights: FloatArray, chosen: IntArray) -> int:
    """Swap medoids of `chosen` (in place) for better points until there are none; the number of swaps."""
    n, k = len(table), len(chosen)
    first, second = np.empty(n), np.empty(n)
    owner = np.empty(n, dtype=np.int64)
    loss, change = np.empty(k), np.empty(k)
    _two_nearest(table, weights, chosen, first, second, owner, loss)
    scale = max(np.sum(weights * first), 1e-300)
    swaps, quiet, candidate = 0, 0, 0
    while quiet < n and swaps < 100 * n:
        shared = 0.0
        change[:] = loss
        for point in range(n):
            distance, mine = table[candidate, point], owner[point]
            if distance < first[point]:
                shared += weights[point] * (distance - first[point])
                change[mine] += weights[point] * (first[point] - second[point])
            elif distance < second[point]:
                change[mine] += weights[point] * (distance - second[point])
        best = np.argmin(change)
        quiet += 1
        # By rounding, two equally good medoids would be swapped for each other for ever.
        if change[best] + shared < -1e-12 * scale:
            chosen[best] = candidate
            _two_nearest(table, weights, chosen, first, second, owner, loss)
            swaps, quiet = swaps + 1, 0
        candidate = (candidate + 1) % n
    return swaps


@inner_kernel
def _two_nearest(
    table: FloatArray,
    weights: FloatArray,
    chosen: IntArray,
    first: FloatArray,
    second: FloatArray,
    owner: IntArray,
    loss: FloatArray,
) -> None:
    """Distances to each point's two nearest medoids, the nearest one, and the loss of removing each."""
    loss[:] = 0.0
    for point in range(len(table)):
        first[point] = second[point] = np.inf
        owner[point] = 0
        for medoid in range(len(chosen)):
            distance = table[chosen[medoid], point]
            if distance < first[point]:
                second[point] = first[point]
                first[point] = distance
                owner[point] = medoid
            elif distance < second[point]:
                second[point] = distance
        loss[owner[point]] += weights[point] * (second[point] - first[point])


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
