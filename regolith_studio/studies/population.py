"""Evaluates shape models on held-out halves of a sample (section 3.1, Figs. 4 to 6).

The floor is the distance between random halves of the measured sample. A model whose distance to the half
that it has not seen is no larger cannot be told from the sample by that descriptor and sample size.
"""

from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.descriptors.describe import describe
from regolith_studio.errors import InputError, RegolithError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.messages import N_, Message
from regolith_studio.shape_models.goodness_of_fit import distances_among, nearest_over_rotations
from regolith_studio.shape_models.inertia_ellipsoid import canonical
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.realizations import Realizations, virtual_mesh
from regolith_studio.shape_models.sample import Sample
from regolith_studio.studies import Mapper, StudyProgress
from regolith_studio.studies.population_distances import (
    Intervals,
    PopulationDistances,
    distances,
    intervals,
    paired_columns,
)

MESH_LEVEL = 4
"""Icosphere level of the meshes that are measured: 2,562 vertices, and the exact volume of the series."""
PAPER_DEGREE = 10
"""Of the paper's model (section 3.1)."""
FRAME_DEGREE = 10
"""Degree at which drawn and measured particles are compared one by one."""
MEASURE_BATCH = 25
"""Particles that one process measures at a time."""
N_NOVEL = 100
"""Draws of each fit, and measured particles of each half, whose nearest particle is looked for."""
NOVEL_BATCH = 10
FRAME_BATCH = 100
"""Particles that one process turns into the frame of their axes at a time."""


@dataclass(frozen=True, eq=False)
class FitTask:
    """A model to be fitted and drawn from several times: the argument of :func:`fit_and_draw`.

    - ``key``: of ``MODELS``.
    - ``options``: settings of the model.
    - ``sample``: fitted to.
    - ``n_draws``: of each drawing.
    - ``seeds``: of the drawings.
    """

    key: str
    options: Any
    sample: Sample
    n_draws: int
    seeds: tuple[int, ...]


def fit_and_draw(task: FitTask) -> tuple[tuple[Realizations, ...], tuple[float, ...]]:
    """Drawings from a fitted model, and Bayes' criterion of its parts if it has one."""
    fitted = MODELS[task.key].fit(task.sample, task.options)
    drawn = tuple(fitted.draw(task.n_draws, seed) for seed in task.seeds)
    return drawn, tuple(getattr(fitted, "bic", ()))


class StudyExecutor:
    """Runs the parts of a study through a mapper and counts measured particles for the progress."""

    def __init__(self, keys: tuple[str, ...], level: int, mapper: Mapper, total: int) -> None:
        self.keys, self.level, self.mapper, self.total = keys, level, mapper, total
        self.done = 0
        self.size_column = keys.index("equivalent_radius") if "equivalent_radius" in keys else None

    def progress(self, message: str) -> StudyProgress:
        """How far the study is."""
        return StudyProgress(self.done, self.total, message)

    def measured(self, draws: Realizations, message: str) -> Generator[StudyProgress, None, FloatArray]:
        """Descriptors of every particle, shape (n, keys); NaN where its series bounds no solid."""
        tables = [np.empty((0, len(self.keys)))]
        measure = partial(descriptors_of, keys=self.keys, level=self.level)
        for table in self.mapper(measure, _batches(draws, MEASURE_BATCH)):
            if table is not None:
                tables.append(table)
                self.done += len(table)
            yield self.progress(message)
        return np.concatenate(tables)

    def framed(
        self, draws: Realizations, l_max: int, message: str
    ) -> Generator[StudyProgress, None, FloatArray]:
        """Every particle in the frame of its axes, shape (n, (l_max + 1)^2)."""
        batches = _batches(draws, FRAME_BATCH)
        rows = yield from self.gathered(partial(frames_of, l_max=l_max), batches, message)
        return np.concatenate([np.empty((0, (l_max + 1) ** 2)), *rows])

    def gathered(
        self, work: Callable[[Any], Any], parts: Iterable[Any], message: str
    ) -> Generator[StudyProgress, None, list[Any]]:
        """The result of each part, in order."""
        results = []
        for result in self.mapper(work, parts):
            if result is not None:
                results.append(result)
            yield self.progress(message)
        return results


def descriptors_of(draws: Realizations, keys: tuple[str, ...], level: int = MESH_LEVEL) -> FloatArray:
    """Descriptors of each particle, shape (n, keys); NaN where its series bounds no solid."""
    rows = [_descriptor_row(draws, index, keys, level) for index in range(len(draws))]
    return np.array(rows, dtype=np.float64).reshape(len(draws), len(keys))


def _descriptor_row(draws: Realizations, index: int, keys: tuple[str, ...], level: int) -> tuple[float, ...]:
    try:
        descriptors = describe(virtual_mesh(draws, index, level), keys)
    except RegolithError:
        return (np.nan,) * len(keys)
    return tuple(descriptors[key] for key in keys)


def frames_of(draws: Realizations, l_max: int) -> FloatArray:
    """The radius of every particle in the frame of its axes, shape (n, (l_max + 1)^2)."""
    if draws.scale == "radius" and draws.l_max >= l_max:
        return canonical(draws.coefficients[:, : (l_max + 1) ** 2])
    return canonical(np.stack([draws.particle(index, l_max).values for index in range(len(draws))]))


def _batches(draws: Realizations, size: int) -> Iterable[Realizations]:
    return (draws.chosen(range(i, min(i + size, len(draws)))) for i in range(0, len(draws), size))


KEYS = ("equivalent_radius", "surface_area", "aspect_ratio", "sphericity", "convexity")
"""Those of Fig. 4 and two more."""
N_FLOOR_SPLITS = 30
MIN_PARTICLES = 20
MAX_DRAWS = 1000


@dataclass(frozen=True, eq=False)
class ModelEvaluation:
    """One model over the rounds.

    - ``key``: of ``MODELS``.
    - ``l_max``: degree of its draws.
    - ``distances``: to the half that the model has not seen.
    - ``intervals``: of the distances of one round.
    - ``novelty``: median over the first draws of each split of the distance to the nearest measured particle
      over all rotations, over that among measured ones, shape (splits,).
    - ``near_parents``: share of these draws whose nearest particle is the one that they were made from,
      shape (splits,).
    - ``rejected``: draws thrown away, as a share of all, shape (rounds,).
    - ``table``: descriptors of the first round's draws, shape (n_draws, keys).
    - ``criterion``: bayes' criterion for 1, 2, ... parts in the first fit of a mixture; else empty.
    """

    key: str
    l_max: int
    distances: PopulationDistances
    intervals: Intervals
    novelty: FloatArray
    near_parents: FloatArray
    rejected: FloatArray
    table: FloatArray
    criterion: tuple[float, ...] = ()


@dataclass(frozen=True, eq=False)
class PopulationStudy:
    """Measured against virtual.

    - ``keys``: descriptors, in the order of all tables.
    - ``l_max``: degree of the measured particles, and so of the comparison.
    - ``unit``: of length.
    - ``measured``: descriptors of the sample's particles with all their degrees, shape (n, keys).
    - ``cut_degree``, ``cut``: degree of the paper's model, or the one asked for, and descriptors of the
      particles cut at it, shape (m, keys).
    - ``floor``: PopulationDistances between random halves.
    - ``models``: in the order asked for.
    - ``n_draws``: of each round.
    - ``n_repeats``: rounds of each split.
    - ``seed``: of splits and draws.
    - ``left_out``: particles whose series has a negative radius.
    """

    keys: tuple[str, ...]
    l_max: int
    unit: str
    measured: FloatArray
    cut_degree: int
    cut: FloatArray
    floor: PopulationDistances
    models: tuple[ModelEvaluation, ...]
    n_draws: int
    n_repeats: int
    seed: int
    left_out: int = 0

    @property
    def pairs(self) -> list[tuple[str, str]]:
        """Pairs of descriptors, as in the energy distances."""
        return [(self.keys[i], self.keys[j]) for i, j in paired_columns(len(self.keys))]


def population_study(
    sample: Sample,
    models: Sequence[str] | None = None,
    *,
    l_max: int | None = None,
    n_draws: int | None = None,
    n_splits: int = 5,
    n_repeats: int = 5,
    keys: Sequence[str] = KEYS,
    level: int = MESH_LEVEL,
    settings: Mapping[str, Any] | None = None,
    mapper: Mapper = map,
    seed: int = 0,
) -> Generator[StudyProgress, None, PopulationStudy]:
    """Judge models on held-out halves of a sample.

    Each model is fitted to `n_splits` random halves, and `n_repeats` times `n_draws` particles are drawn from
    each fit. Yields a :class:`StudyProgress` every 25 particles measured, with the study so far after each
    split, and returns the study.

    - ``models``: keys of ``MODELS``; all if ``None``.
    - ``l_max``: degree of drawn particles and of the cut sample; by default that of each model's settings,
      and 10. Both are compared with the measured particles with all their degrees.
    - ``n_draws``: by default as many as the held-out half has, so that the noise is that of the floor; at
      most 1,000.
    - ``settings``: settings by model key; by default those of :func:`default_settings`.
    - ``mapper``: may yield ``None`` while a result is waited for, so that the study can be stopped.

    Raises InputError if a model, descriptor or the degree is unknown, there are fewer than 20 particles or
    draws.
    """
    chosen = tuple(MODELS) if models is None else tuple(models)
    drawn = default_draws(len(sample)) if n_draws is None else n_draws
    _check_arguments(sample, chosen, keys, (drawn, n_splits, n_repeats))
    cut_degree = min(PAPER_DEGREE, sample.l_max) if l_max is None else l_max
    n_measured = len(sample) * (1 + (cut_degree < sample.l_max))
    work = StudyExecutor(tuple(keys), level, mapper, n_measured + len(chosen) * n_splits * n_repeats * drawn)
    known = Realizations(sample.coefficients, "radius", "measured", seed, sample.unit)
    table = yield from work.measured(known, N_("measured particles"))
    keep = np.flatnonzero(np.isfinite(table).all(axis=1))
    if len(keep) < MIN_PARTICLES:
        raise InputError(
            f"Only {len(keep)} particles bound a solid at l_max = {sample.l_max}; {MIN_PARTICLES} are needed."
        )
    cut = table[keep]
    if cut_degree < sample.l_max:
        rows = sample.truncated(cut_degree).coefficients[keep]
        shorter = Realizations(rows, "radius", "measured", seed, sample.unit)
        cut = yield from work.measured(shorter, N_("measured particles"))
        cut = cut[np.isfinite(cut).all(axis=1)]
    frame_degree = min(FRAME_DEGREE, cut_degree)
    frames = yield from work.framed(known.chosen(keep), frame_degree, N_("measured particles"))
    half = _TrainTestSplit(sample.chosen(keep), table[keep], frames, work)
    floor = yield from half.floor(seed)
    rounds: dict[str, list[_Round]] = {key: [] for key in chosen}
    for split in range(n_splits):
        for key in chosen:
            options = (settings or {}).get(key) or default_settings(key, sample, l_max)
            rounds[key] += yield from half.rounds(key, options, split, (drawn, n_repeats, seed))
        evaluated = tuple(_evaluation_of(key, rounds[key]) for key in chosen)
        left_out = len(sample) - len(keep)
        study = PopulationStudy(
            tuple(keys),
            sample.l_max,
            sample.unit,
            half.table,
            cut_degree,
            cut,
            floor,
            evaluated,
            drawn,
            n_repeats,
            seed,
            left_out,
        )
        yield StudyProgress(
            work.done,
            work.total,
            Message(N_("split {split} of {total}"), split=split + 1, total=n_splits),
            study,
        )
    return study


def default_draws(n_measured: int) -> int:
    """Particles of each drawing where no number is given: half of those measured, 20 to 1,000."""
    return max(MIN_PARTICLES, min(MAX_DRAWS, n_measured // 2))


def default_settings(key: str, sample: Sample, l_max: int | None = None) -> Any:
    """The settings of a model with the degree asked for, or its own where the sample has it."""
    settings = MODELS[key].Settings()
    return replace(settings, l_max=min(settings.l_max, sample.l_max) if l_max is None else l_max)


def _check_arguments(
    sample: Sample, models: tuple[str, ...], keys: Sequence[str], counts: tuple[int, int, int]
) -> None:
    unknown = [key for key in models if key not in MODELS]
    if unknown or not models:
        raise InputError(f"The models are {', '.join(MODELS)}; got {', '.join(unknown) or 'none'}.")
    wrong = [key for key in keys if key not in CATALOGUE]
    if wrong or not keys:
        raise InputError(f"The descriptors are {', '.join(CATALOGUE)}; got {', '.join(wrong) or 'none'}.")
    if len(keys) < 2:
        raise InputError(f"The study compares descriptors in pairs too; name two, got only {keys[0]}.")
    n_draws, n_splits, n_repeats = counts
    if len(sample) < MIN_PARTICLES:
        raise InputError(
            f"Evaluating models needs at least {MIN_PARTICLES} particles, half to fit and half to compare "
            f"with; this sample has {len(sample)}."
        )
    if n_draws < MIN_PARTICLES or n_splits < 1 or n_repeats < 1:
        raise InputError(
            f"Evaluating models needs at least {MIN_PARTICLES} draws, one split and one drawing, got "
            f"{n_draws}, {n_splits} and {n_repeats}."
        )


@dataclass(frozen=True, eq=False)
class _Round:
    """What one drawing from one fit came to; the novelty is worked out for the first drawing of each fit."""

    distances: PopulationDistances
    intervals: Intervals
    novelty: tuple[float, float] | None
    rejected: float
    table: FloatArray
    criterion: tuple[float, ...]
    l_max: int


@dataclass(frozen=True, eq=False)
class _TrainTestSplit:
    """The sample, its descriptors (n, keys) and its particles in the frame of their axes."""

    sample: Sample
    table: FloatArray
    frames: FloatArray
    work: StudyExecutor

    def floor(self, seed: int) -> Generator[StudyProgress, None, PopulationDistances]:
        """Distances between random halves of the sample."""
        rows = []
        for split in range(N_FLOOR_SPLITS):
            train, test = self.sample.halves(seed + split)
            pair = (self.table[test], self.table[train])
            rows.append(distances([pair], seed, self.work.size_column, first=split))
            yield self.work.progress(Message(N_("noise of sampling, split {split}"), split=split + 1))
        return PopulationDistances.joined(rows)

    def rounds(
        self, key: str, options: Any, split: int, plan: tuple[int, int, int]
    ) -> Generator[StudyProgress, None, list[_Round]]:
        """Fit to one half, draw, and judge on the other; `plan` is (draws, repeats, seed)."""
        n_draws, n_repeats, seed = plan
        train, test = self.sample.halves(seed + split)
        seeds = tuple(seed + split * n_repeats + repeat for repeat in range(n_repeats))
        label = {"name": Message(MODELS[key].label), "split": split + 1}
        task = FitTask(key, options, self.sample.chosen(train), n_draws, seeds)
        message = Message(N_("{name}, split {split}, fit"), **label)
        yield self.work.progress(message)
        ((drawn, criterion),) = yield from self.work.gathered(fit_and_draw, (task,), message)
        results = []
        for repeat, draws in enumerate(drawn):
            message = Message(N_("{name}, split {split}, draw {draw}"), draw=repeat + 1, **label)
            table = yield from self.work.measured(draws, message)
            table = table[np.isfinite(table).all(axis=1)]
            new = None if repeat else (yield from self._novelty(train, draws, message))
            apart = distances([(self.table[test], table)], seeds[repeat], self.work.size_column)
            yield self.work.progress(message)
            ends = intervals(self.table[test], table, apart, seeds[repeat], self.work.size_column)
            results.append(_Round(apart, ends, new, 1 - draws.acceptance, table, criterion, draws.l_max))
        return results

    def _novelty(
        self, train: IntArray, draws: Realizations, message: str
    ) -> Generator[StudyProgress, None, tuple[float, float]]:
        """Median novelty of the first draws, and the share of them that are nearest to their parents."""
        l_max, measured = round(self.frames.shape[1] ** 0.5) - 1, self.frames[train]
        first = draws.chosen(range(min(N_NOVEL, len(draws))))
        drawn = yield from self.work.framed(first, l_max, message)
        picks = np.unique(np.linspace(0, len(train) - 1, N_NOVEL).astype(np.int64))
        parts = [picks[i : i + NOVEL_BATCH] for i in range(0, len(picks), NOVEL_BATCH)]
        own = yield from self.work.gathered(partial(distances_among, measured), parts, message)
        rows = [drawn[i : i + NOVEL_BATCH] for i in range(0, len(drawn), NOVEL_BATCH)]
        novelty = yield from self.work.gathered(partial(nearest_over_rotations, measured), rows, message)
        distances, nearest = (np.concatenate([each[k] for each in novelty]) for k in (0, 1))
        ratio = float(np.median(distances)) / max(float(np.median(np.concatenate(own))), 1e-300)
        return ratio, float((nearest == np.asarray(first.parents)).mean())


def _evaluation_of(key: str, rounds: Sequence[_Round]) -> ModelEvaluation:
    ends = {
        name: np.mean([getattr(each.intervals, name) for each in rounds], axis=0)
        for name in Intervals.__annotations__
    }
    new, near_parents = np.array([each.novelty for each in rounds if each.novelty is not None]).T
    return ModelEvaluation(
        key,
        rounds[0].l_max,
        PopulationDistances.joined([each.distances for each in rounds]),
        Intervals(**ends),
        new,
        near_parents,
        np.array([each.rejected for each in rounds]),
        rounds[0].table,
        rounds[0].criterion,
    )
