"""Fit on one half of a sample, judge on the other, beside the noise of sampling (section 3.1, Figs. 4 to 6).

The floor is the distance between random halves of the measured sample. A model whose distance to the half
that it has not seen is no larger cannot be told from the sample by that descriptor and sample size.
"""

from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from regolith_studio.descriptors.describe import describe
from regolith_studio.errors import InputError, RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.model.draws import Draws, virtual_mesh
from regolith_studio.model.judging import (
    classifier_accuracy,
    energy_distance,
    kolmogorov_smirnov,
    novelty,
    pairs_of,
    relative_wasserstein,
)
from regolith_studio.model.models import MODELS
from regolith_studio.model.sample import Sample
from regolith_studio.studies.progress import StudyProgress

KEYS = ("equivalent_radius", "surface_area", "aspect_ratio", "sphericity", "convexity")
"""Those of Fig. 4 and two more."""
WEIGHTINGS = ("number", "volume")
N_FLOOR_SPLITS = 30
LEVEL = 3
"""Icosphere level of the meshes that are measured: 642 vertices, and the exact volume of the series."""
FEWEST = 20
STEP = 50

Mapper = Callable[[Callable[[int], "tuple[float, ...]"], Iterable[int]], Iterable["tuple[float, ...]"]]
"""Anything that maps a picklable function in order: ``map``, or ``imap`` of a process pool."""


@dataclass(frozen=True, eq=False)
class Distances:
    """Distances over rounds (splits of the sample).

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


@dataclass(frozen=True, eq=False)
class JudgedModel:
    """One model over the rounds.

    Parameters
    ----------
    key
        Of ``MODELS``.
    distances
        To the half that the model has not seen.
    novelty
        Median over the draws of each round, shape (rounds,).
    rejected
        Draws thrown away, as a share of all, shape (rounds,).
    table
        Descriptors of the first round's draws, shape (n_draws, keys).
    """

    key: str
    distances: Distances
    novelty: FloatArray
    rejected: FloatArray
    table: FloatArray


@dataclass(frozen=True, eq=False)
class PopulationStudy:
    """Measured against virtual.

    Parameters
    ----------
    keys
        Descriptors, in the order of all tables.
    l_max
        Degree of measured and of drawn particles.
    unit
        Of length.
    measured
        Descriptors of the sample's particles, shape (n, keys).
    floor
        Distances between random halves.
    models
        In the order asked for.
    n_draws, seed
        Of each round.
    left_out
        Particles whose series has a negative radius at this degree.
    """

    keys: tuple[str, ...]
    l_max: int
    unit: str
    measured: FloatArray
    floor: Distances
    models: tuple[JudgedModel, ...]
    n_draws: int
    seed: int
    left_out: int = 0

    @property
    def pairs(self) -> list[tuple[str, str]]:
        """Pairs of descriptors, as in the energy distances."""
        return [(self.keys[i], self.keys[j]) for i, j in pairs_of(len(self.keys))]


def population_study(
    sample: Sample,
    models: Sequence[str] | None = None,
    *,
    l_max: int = 10,
    n_draws: int = 1000,
    n_splits: int = 5,
    keys: Sequence[str] = KEYS,
    level: int = LEVEL,
    settings: Mapping[str, Any] | None = None,
    mapper: Mapper = map,
    seed: int = 0,
) -> Generator[StudyProgress, None, PopulationStudy]:
    """Judge models on held-out halves of a sample.

    Yields a :class:`StudyProgress` every 50 particles measured, and returns the study.

    Parameters
    ----------
    models
        Keys of ``MODELS``; all if ``None``.
    l_max
        Degree at which measured and drawn particles are compared; the models see all that the sample has.
    settings
        Settings by model key; by default the models' own with this `l_max`.
    mapper
        ``map``, or the ordered lazy map of a process pool.

    Raises
    ------
    InputError
        If a model or the degree is unknown, there are fewer than 20 particles or draws.
    """
    chosen = tuple(MODELS) if models is None else tuple(models)
    _check(sample, chosen, n_draws, n_splits)
    measure = partial(_measured, keys=tuple(keys), level=level, mapper=mapper)
    total = len(sample) + len(chosen) * n_splits * n_draws
    known = Draws(sample.truncated(l_max).coefficients, "radius", "measured", seed, sample.unit)
    table = yield from measure(known, 0, total, "measured particles")
    keep = np.flatnonzero(np.isfinite(table).all(axis=1))
    if len(keep) < FEWEST:
        raise InputError(f"Only {len(keep)} particles bound a solid at l_max = {l_max}; {FEWEST} are needed.")
    usable, table = sample.chosen(keep), table[keep]
    rounds: dict[str, list[tuple[Distances, float, float, FloatArray]]] = {key: [] for key in chosen}
    done = len(sample)
    for split in range(n_splits):
        train, test = usable.halves(seed + split)
        for key in chosen:
            options = (settings or {}).get(key) or MODELS[key].Settings(l_max=l_max)
            draws = MODELS[key].fit(usable.chosen(train), options).draw(n_draws, seed + split)
            drawn = yield from measure(draws, done, total, f"{MODELS[key].label}, split {split + 1}")
            drawn = drawn[np.isfinite(drawn).all(axis=1)]
            far = novelty(known.coefficients[keep][train], _radius_rows(draws, l_max))
            apart = _distances([(table[test], drawn)], seed + split, _sizes(keys))
            rounds[key].append((apart, float(np.median(far)), 1 - draws.acceptance, drawn))
            done += n_draws
    return PopulationStudy(
        tuple(keys),
        l_max,
        sample.unit,
        table,
        _floor(usable, table, seed, _sizes(keys)),
        tuple(_judged(key, rounds[key]) for key in chosen),
        n_draws,
        seed,
        len(sample) - len(usable),
    )


def _check(sample: Sample, models: tuple[str, ...], n_draws: int, n_splits: int) -> None:
    unknown = [key for key in models if key not in MODELS]
    if unknown or not models:
        raise InputError(f"The models are {', '.join(MODELS)}; got {', '.join(unknown) or 'none'}.")
    if len(sample) < FEWEST or n_draws < FEWEST or n_splits < 1:
        raise InputError(
            f"Judging models needs at least {FEWEST} particles, {FEWEST} draws and one split, got "
            f"{len(sample)}, {n_draws} and {n_splits}."
        )


def _measured(
    draws: Draws, done: int, total: int, message: str, *, keys: tuple[str, ...], level: int, mapper: Mapper
) -> Generator[StudyProgress, None, FloatArray]:
    """Descriptors of every particle, shape (n, keys); NaN where its series bounds no solid."""
    rows = []
    for row in mapper(partial(descriptors_of, draws=draws, keys=keys, level=level), range(len(draws))):
        rows.append(row)
        if len(rows) % STEP == 0 or len(rows) == len(draws):
            yield StudyProgress(done + len(rows), total, message)
    return np.array(rows, dtype=np.float64).reshape(len(draws), len(keys))


def descriptors_of(index: int, draws: Draws, keys: tuple[str, ...], level: int) -> tuple[float, ...]:
    """Descriptors of one drawn particle; NaN if its series bounds no solid."""
    try:
        found = describe(virtual_mesh(draws, index, level), keys)
    except RegolithError:
        return (np.nan,) * len(keys)
    return tuple(found[key] for key in keys)


def _sizes(keys: Sequence[str]) -> int | None:
    """Column of the equivalent radius, whose cube weighs by volume."""
    return list(keys).index("equivalent_radius") if "equivalent_radius" in keys else None


def _distances(
    halves: Iterable[tuple[FloatArray, FloatArray]], seed: int, size_column: int | None
) -> Distances:
    """Between each pair of tables; by volume too if there is a column of equivalent radii."""
    near, gaps, energies, accuracies = [], [], [], []
    for number, (one, two) in enumerate(halves):
        pairs = [(_weights(one, kind, size_column), _weights(two, kind, size_column)) for kind in WEIGHTINGS]
        columns = range(one.shape[1])
        near.append([[relative_wasserstein(one[:, j], two[:, j], *pair) for j in columns] for pair in pairs])
        gaps.append([[kolmogorov_smirnov(one[:, j], two[:, j], *pair) for j in columns] for pair in pairs])
        energies.append([energy_distance(one[:, [i, j]], two[:, [i, j]]) for i, j in pairs_of(one.shape[1])])
        rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(number,)))
        accuracies.append(classifier_accuracy(one, two, rng))
    return Distances(*map(np.array, (near, gaps, energies, accuracies)))


def _weights(table: FloatArray, weighting: str, size_column: int | None) -> FloatArray:
    if weighting == "number" or size_column is None:
        return np.ones(len(table))
    return np.asarray(table[:, size_column] ** 3)


def _floor(sample: Sample, table: FloatArray, seed: int, size_column: int | None) -> Distances:
    halves = (sample.halves(seed + split) for split in range(N_FLOOR_SPLITS))
    return _distances(((table[test], table[train]) for train, test in halves), seed, size_column)


def _judged(key: str, rounds: list[tuple[Distances, float, float, FloatArray]]) -> JudgedModel:
    parts = [each[0] for each in rounds]
    joined = Distances(
        *(np.concatenate([getattr(part, name) for part in parts]) for name in Distances.__annotations__)
    )
    news, refused = np.array([each[1] for each in rounds]), np.array([each[2] for each in rounds])
    return JudgedModel(key, joined, news, refused, rounds[0][3])


def _radius_rows(draws: Draws, l_max: int) -> FloatArray:
    """Coefficients of the radius of every draw, shape (n, (l_max + 1)^2)."""
    if draws.scale == "radius" and draws.l_max == l_max:
        return draws.coefficients
    return np.stack([draws.particle(index, l_max).values for index in range(len(draws))])
