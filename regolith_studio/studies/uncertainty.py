"""Budget of uncertainty from the scan to the angle of repose: what each step contributes.

A step has equally probable levels, of which the first is the present setting. For descriptors, rows of
levels are drawn as Saltelli's pairs of samples, and the shares of the variance follow from them (Saltelli et
al., *Comput. Phys. Commun.* 181 (2010) 259; total shares by Jansen). For the angle, one step at a time is
changed in heaps of the same seeds.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from scipy.special import fdtri, stdtrit
from scipy.stats.qmc import Sobol

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.io.tables import Column, Table
from regolith_studio.messages import N_

KEYS = ("volume", "surface_area", "sphericity", "aspect_ratio")
UNITS = {"volume": "um^3", "surface_area": "um^2"}
STAGES = ("grains", "polyhedra")
OUTPUTS = tuple((stage, key) for stage in STAGES for key in KEYS)
"""Means of the grains as measured, and of the simulated polyhedra with their sizes."""
MIN_GRAINS = 20
"""Below, a bootstrap does not carry an interval."""
RESAMPLES = 64
"""Bootstrap samples of the grains, each of them a level."""
RESAMPLED = "representatives"
"""Key of the step whose levels are bootstrap samples."""
FILLING = "filling"
EVALUATION = "evaluation"
"""Key of the step whose heaps are those of the present settings."""
CONFIDENCE = 0.95
N_BOOTSTRAP = 500
MAX_PAIRS = 10_000
"""Numbers of pairs of heaps beyond are stated as more than this."""


@dataclass(frozen=True)
class ChainStep:
    """A step of the chain.

    ``levels``: what it is set to, the present setting first; all are equally probable. ``missing``: why it
    is not counted, if it is not.
    """

    key: str
    label: str
    levels: tuple[str, ...] = ()
    missing: str = ""


def check_count(n_grains: int) -> None:
    """Refuse samples that are too small.

    Raises InputError if there are fewer than :data:`MIN_GRAINS` grains.
    """
    if n_grains < MIN_GRAINS:
        raise InputError(
            f"An interval needs {MIN_GRAINS} grains or more, {MIN_GRAINS - n_grains} more than the "
            f"{n_grains} that there are."
        )


def saltelli_rows(steps: Sequence[ChainStep], base: int, seed: int) -> IntArray:
    """Levels of the steps, shape (d + 2, base, d): samples A and B, and A with each column of B.

    ``base``: a power of two.
    """
    d = len(steps)
    unit = Sobol(2 * d, scramble=True, seed=np.random.default_rng(seed)).random(base)
    pair = np.floor(unit.reshape(base, 2, d) * [len(step.levels) for step in steps]).astype(np.int64)
    a, b = pair[:, 0], pair[:, 1]
    mixed = np.repeat(a[None], d, axis=0)
    for k in range(d):
        mixed[k, :, k] = b[:, k]
    return np.concatenate([a[None], b[None], mixed])


def sobol_shares(results: FloatArray) -> tuple[FloatArray, FloatArray]:
    """First-order and total shares of the steps, shapes (s, d), of results of the shape (d + 2, n, s)."""
    a, b, mixed = results[0], results[1], results[2:]
    variance = np.concatenate([a, b]).var(axis=0)
    safe = np.where(variance > 0.0, variance, np.inf)
    # Less the mean: the estimate stays unbiased, and its noise would grow with the mean.
    first = ((b - results[:2].mean(axis=(0, 1))) * (mixed - a)).mean(axis=1) / safe
    total = 0.5 * ((a - mixed) ** 2).mean(axis=1) / safe
    return first.T, total.T


@dataclass(frozen=True, eq=False)
class DescriptorBudget:
    """Means of descriptors over a design.

    - ``steps``: those that vary.
    - ``nominal``: means of the present settings, in the order of :data:`OUTPUTS`.
    - ``results``: of all rows of :func:`saltelli_rows`, shape (d + 2, n, outputs); NaN where not known.
    - ``n_grains``: of the present settings.
    - ``note``: why rows are not known, or what counts as measured; none if empty.
    """

    steps: tuple[ChainStep, ...]
    nominal: FloatArray
    results: FloatArray
    n_grains: int
    note: str = ""

    @property
    def known(self) -> FloatArray:
        """Logarithms of the results, shape (d + 2, m, outputs), of the points that are complete."""
        complete = np.isfinite(self.results).all(axis=(0, 2))
        return np.log(self.results[:, complete])

    @property
    def relative_deviation(self) -> FloatArray:
        """Standard deviation of the logarithms over both samples; NaN where fewer than two rows are known."""
        rows = self._logarithms
        return rows.std(axis=0, ddof=1) if len(rows) > 1 else np.full(len(OUTPUTS), np.nan)

    @property
    def _logarithms(self) -> FloatArray:
        """Of the known rows of both samples."""
        rows: FloatArray = np.log(self.results[:2].reshape(-1, len(OUTPUTS)))
        return rows[np.isfinite(rows).all(axis=1)]

    @property
    def intervals(self) -> FloatArray:
        """Ends for each output, shape (outputs, 2), about the mean of the logarithms of all rows.

        The present settings need not be in the middle: levels are on one side of them, and the errors of
        digitised grains have a mean.
        """
        logs = self._logarithms
        freedom = max(min(self.n_grains, len(logs)) - 1, 1)
        factor = _student(freedom) * np.sqrt(1 + 1 / max(len(logs), 1))
        half = factor * self.relative_deviation
        centre = logs.mean(axis=0) if len(logs) else np.full(len(OUTPUTS), np.nan)
        return np.asarray(np.exp(np.column_stack([centre - half, centre + half])))

    @cached_property
    def shares(self) -> tuple[FloatArray, FloatArray] | None:
        """First-order and total shares with the ends of their intervals, shapes (outputs, d, 3).

        Bootstrap over the points of the design; ``None`` before four of them are complete.
        """
        known = self.known
        n = known.shape[1]
        if n < 4:
            return None
        rng = np.random.default_rng(0)
        drawn = [sobol_shares(known[:, rng.integers(0, n, n)]) for _ in range(N_BOOTSTRAP)]
        ends = [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2]
        pair = [
            np.stack([value, *np.quantile([each[k] for each in drawn], ends, axis=0)], axis=-1)
            for k, value in enumerate(sobol_shares(known))
        ]
        return pair[0], pair[1]


@dataclass(frozen=True)
class AngleEffect:
    """What a level of a step does to the angle, in degrees.

    - ``change``, ``low``, ``high``: difference of heaps of the same seeds, and its interval; of the bootstrap
      the standard deviation that it adds.
    - ``n``: pairs of heaps.
    - ``decided``: whether the interval excludes 0.
    - ``heaps_needed``: pairs that would decide it if it is as large as it seems; ``None`` if it is decided,
      or if the heaps are those of the present settings.
    """

    step: ChainStep
    level: str
    change: float
    low: float
    high: float
    n: int
    decided: bool
    heaps_needed: int | None

    @property
    def far_end(self) -> float:
        """The end of the interval that is farther from 0."""
        return max(self.low, self.high, key=abs)


@dataclass(frozen=True, eq=False)
class AngleBudget:
    """Angles of heaps, in degrees; NaN where there is no pile.

    - ``steps``: those that were changed, one at a time.
    - ``nominal``: of the present settings, by seed.
    - ``changed``: of each level, by seed, by the key of its step and its name.
    - ``notes``: on the engines.
    """

    steps: tuple[ChainStep, ...]
    nominal: FloatArray
    changed: Mapping[tuple[str, str], FloatArray]
    notes: tuple[str, ...] = ()

    @property
    def value(self) -> float:
        """Mean of the heaps of the present settings."""
        piles = self.nominal[np.isfinite(self.nominal)]
        return float(piles.mean()) if len(piles) else np.nan

    @property
    def filling_variance(self) -> float:
        """Of the mean, by the seeds of the filling."""
        return float(self._of_a_heap[0] / max(np.isfinite(self.nominal).sum(), 1))

    @cached_property
    def _of_a_heap(self) -> tuple[float, float]:
        """Variance of a heap and its degrees of freedom, by the heaps of all levels that scatter alike."""
        piles, fit = self.nominal[np.isfinite(self.nominal)], self._pool[1]
        if len(piles) < 2:
            return np.nan, np.nan
        return (float(piles.var(ddof=1)), len(piles) - 1.0) if fit is None else fit.of_a_heap

    @cached_property
    def _pairs(self) -> dict[tuple[ChainStep, str], FloatArray]:
        """Angles of the present settings and of each level for the seeds that have both, if two or more."""
        pairs = {}
        for step in self.steps:
            for level in step.levels[1:]:
                both = np.column_stack([self.nominal, self.changed[step.key, level]])
                both = both[np.isfinite(both).all(axis=1)]
                if len(both) > 1:
                    pairs[step, level] = both
        return pairs

    @cached_property
    def _pool(self) -> "tuple[list[tuple[ChainStep, str]], _BlockFit | None]":
        """Levels whose heaps scatter like those of the present settings, and all of these heaps together."""
        rows = [row for row, pairs in self._pairs.items() if _has_own_noise(row[0], pairs)]
        angles = np.array([self.nominal, *(self.changed[step.key, level] for step, level in rows)])
        scattered = _scattered_rows(angles) if rows else set()
        kept = [k for k in range(1, len(angles)) if k not in scattered]
        if 0 in scattered or not kept:
            return [], None
        return [rows[k - 1] for k in kept], _BlockFit.of(angles[[0, *kept]])

    @cached_property
    def effects(self) -> tuple[AngleEffect, ...]:
        """Of the levels with two pairs of heaps or more."""
        rows, fit = self._pool
        effects = []
        for (step, level), pairs in self._pairs.items():
            if fit is not None and (step, level) in rows:
                effects.append(fit.effect(rows.index((step, level)), step, level, len(pairs)))
            elif step.key == RESAMPLED:
                effects.append(_added_spread(step, level, self.changed[step.key, level], *self._of_a_heap))
            else:
                effects.append(_difference(step, level, pairs))
        return tuple(effects)

    def step_variances(self, with_undecided: bool = False) -> dict[str, float]:
        """By key: of equally probable levels, or of the bootstrap; undecided changes are 0, or far ends."""
        changes: dict[str, list[float]] = {}
        for effect in self.effects:
            undecided = effect.far_end if with_undecided else 0.0
            changes.setdefault(effect.step.key, []).append(effect.change if effect.decided else undecided)
        return {
            key: values[0] ** 2 if key == RESAMPLED else float(np.var([0.0, *values]))
            for key, values in changes.items()
        }

    @property
    def variance(self) -> float:
        """Of the value: that of the filling and of the levels that are decided."""
        return self.filling_variance + sum(self.step_variances().values())

    @property
    def half_width(self) -> float:
        """Of the interval of the value, which holds the levels that are decided."""
        return self._half_width(self.variance)

    @property
    def half_width_with_undecided(self) -> float:
        """The same if each undecided level changed the angle by the far end of its interval."""
        return self._half_width(self.filling_variance + sum(self.step_variances(True).values()))

    def _half_width(self, variance: float) -> float:
        return float(_student(self._of_a_heap[1]) * variance**0.5)


@dataclass(frozen=True, eq=False)
class _BlockFit:
    """Least squares of angles by level (rows, the present one first) and seed; NaN where there is no heap.

    A heap has the effect of its level, that of its seed and noise: a randomised block design. With one other
    level the change is Student's paired difference.

    - ``changes``: of the other levels from the first; ``factors``: their variances over that of the noise.
    - ``squares``, ``freedom``: sum of the squared residuals, and its degrees of freedom.
    - ``by_seed``: by how much the sum is larger without effects of the seeds; ``seeds``, ``heaps``: numbers.
    """

    changes: FloatArray
    factors: FloatArray
    squares: float
    freedom: int
    by_seed: float
    seeds: int
    heaps: int

    @property
    def variance(self) -> float:
        """Of the noise."""
        return self.squares / self.freedom

    @property
    def of_a_heap(self) -> tuple[float, float]:
        """Variance of a heap of a level by seed and noise, and its degrees of freedom (Satterthwaite)."""
        # The mean square by seed holds the noise, and so often the variance of the seeds.
        times = (self.heaps - len(self.changes) - 1) / (self.seeds - 1)
        parts = np.array([self.by_seed / (self.seeds - 1) / times, self.variance * (1 - 1 / times)])
        shares = parts**2 / (self.seeds - 1, self.freedom)
        whole = float(parts.sum())
        return whole, whole**2 / float(shares.sum()) if whole > 0.0 else self.seeds - 1.0

    def effect(self, k: int, step: ChainStep, level: str, n: int) -> AngleEffect:
        """Of the other level of number `k`, with `n` pairs."""

        def half(count: int) -> float:
            quantile = _student(self.freedom + len(self.changes) * (count - n))
            return float(quantile * np.sqrt(self.variance * self.factors[k] * n / count))

        return _effect(step, level, float(self.changes[k]), n, half)

    @classmethod
    def of(cls, angles: FloatArray) -> "_BlockFit":
        level, seed = np.nonzero(np.isfinite(angles))
        known, n = angles[level, seed], len(angles) - 1
        columns = level[:, None] == np.arange(1, n + 1), seed[:, None] == np.arange(angles.shape[1])
        design = np.hstack(columns).astype(float)
        inverse = np.linalg.pinv(design.T @ design)
        effects = inverse @ (design.T @ known)
        freedom = len(known) - int(np.linalg.matrix_rank(design))
        squares = float(((known - design @ effects) ** 2).sum())
        levels = angles[np.isfinite(angles).any(axis=1)]
        without = float(np.nansum((levels - np.nanmean(levels, axis=1, keepdims=True)) ** 2))
        seeds = len(np.unique(seed))
        return cls(effects[:n], np.diag(inverse)[:n], squares, freedom, without - squares, seeds, len(known))


def _scattered_rows(angles: FloatArray) -> set[int]:
    """Rows that scatter more than all others together, by F-tests at 5 % for all rows together.

    One that scatters less is no reason to take it out: its interval would be too narrow by chance.
    """
    whole, scattered = _BlockFit.of(angles), set()
    for k in range(len(angles)):
        rest = _BlockFit.of(np.delete(angles, k, axis=0))
        freedom = whole.freedom - rest.freedom
        if rest.freedom > 0 and freedom > 0:
            bound = fdtri(freedom, rest.freedom, 1 - (1 - CONFIDENCE) / len(angles))
            if (whole.squares - rest.squares) / freedom > bound * rest.variance:
                scattered.add(k)
    return scattered


def _student(freedom: float) -> float:
    """Half width of an interval in standard deviations."""
    return float(stdtrit(freedom, (1 + CONFIDENCE) / 2))


def _has_own_noise(step: ChainStep, pairs: FloatArray) -> bool:
    """Whether heaps of a level are others than those of the present settings, of the same grains."""
    return step.key not in (RESAMPLED, EVALUATION) and bool((pairs[:, 0] != pairs[:, 1]).any())


def _difference(step: ChainStep, level: str, pairs: FloatArray) -> AngleEffect:
    """By Student's interval of the pairs alone."""
    change = pairs[:, 1] - pairs[:, 0]
    spread = float(change.std(ddof=1))

    def half(count: int) -> float:
        return float(_student(count - 1) * spread / count**0.5)

    return _effect(step, level, float(change.mean()), len(change), half)


def _effect(step: ChainStep, level: str, change: float, n: int, half: Callable[[int], float]) -> AngleEffect:
    """``half``: half width of the interval of so many pairs."""
    decided, same_heaps = abs(change) > half(n), half(n) == 0.0
    needed = None if decided or same_heaps else _first(lambda count: half(count) < abs(change), n)
    return AngleEffect(step, level, change, change - half(n), change + half(n), n, decided, needed)


def _added_spread(
    step: ChainStep, level: str, angles: FloatArray, same: float, freedom: float
) -> AngleEffect:
    """Standard deviation that another sample of grains in each heap adds, by the ratio of variances.

    ``same``, ``freedom``: variance of heaps of the same grains, and its degrees of freedom.
    """
    piles = angles[np.isfinite(angles)]
    n, other = len(piles), float(piles.var(ddof=1))
    ends = (1 + CONFIDENCE) / 2, (1 - CONFIDENCE) / 2
    ratio = other / same if same > 0.0 else np.inf

    def quotient(quantile: float, count: int) -> float:
        return float(fdtri(count - 1, freedom * count / n, quantile))

    low, high = (float(np.sqrt(max(other / quotient(end, n) - same, 0.0))) for end in ends)
    decided = low > 0.0
    needed = None if decided else _first(lambda count: ratio > quotient(ends[0], count), n)
    return AngleEffect(step, level, float(np.sqrt(max(other - same, 0.0))), low, high, n, decided, needed)


def _first(enough: Any, n: int) -> int:
    """The first number of pairs that suffices, in steps of a twentieth; at most :data:`MAX_PAIRS` + 1."""
    while n <= MAX_PAIRS and not enough(n):
        n += max(1, n // 20)
    return min(n, MAX_PAIRS + 1)


@dataclass(frozen=True, eq=False)
class UncertaintyBudget:
    """What is known of descriptors and angle.

    ``not_counted``: steps that the input lacks, with the reasons. ``recipe``: settings, as JSON.
    """

    descriptors: DescriptorBudget
    angle: AngleBudget | None = None
    not_counted: tuple[ChainStep, ...] = ()
    recipe: Mapping[str, Any] = field(default_factory=dict)


def values_table(budget: UncertaintyBudget) -> Table:
    """One row a quantity: its value and interval."""
    found = budget.descriptors
    rows: list[tuple[Any, ...]] = [
        (f"{key}, {stage}", UNITS.get(key, ""), *map(_number, (found.nominal[k], *found.intervals[k])))
        for k, (stage, key) in enumerate(OUTPUTS)
    ]
    if (angle := budget.angle) is not None:
        ends = angle.value, angle.value - angle.half_width, angle.value + angle.half_width
        rows.append(("angle_of_repose", "deg", *map(_number, ends)))
    columns = (Column("quantity"), Column("unit"), Column("value"), Column("low"), Column("high"))
    return Table(N_("Values with intervals"), columns, tuple(rows))


def steps_table(budget: UncertaintyBudget) -> Table:
    """One row a quantity and step: its shares of the variance, or what it does to the angle."""
    names = ("first_order", "first_low", "first_high", "total", "total_low", "total_high")
    columns = (
        *(Column("quantity"), Column("step"), Column("levels"), *map(Column, names)),
        *(Column("change", "deg"), Column("change_low", "deg"), Column("change_high", "deg")),
        *(Column("share"), Column("pairs"), Column("pairs_to_decide")),
    )
    rows: list[tuple[Any, ...]] = []
    if (shares := budget.descriptors.shares) is not None:
        for k, (stage, key) in enumerate(OUTPUTS):
            for d, step in enumerate(budget.descriptors.steps):
                numbers = map(_number, (*shares[0][k, d], *shares[1][k, d]))
                rows.append((f"{key}, {stage}", step.key, _levels(step), *numbers, *(None,) * 6))
    rows += [] if budget.angle is None else _angle_rows(budget.angle)
    rows += [("", step.key, f"not counted: {step.missing}", *(None,) * 12) for step in budget.not_counted]
    return Table(N_("Shares of the steps"), columns, tuple(rows))


def _angle_rows(angle: AngleBudget) -> list[tuple[Any, ...]]:
    whole = angle.variance
    rows: list[tuple[Any, ...]] = []
    seeds = len(angle.nominal)
    share = _number(angle.filling_variance / whole if whole > 0.0 else np.nan)
    rows.append(("angle_of_repose", FILLING, f"{seeds} seeds", *(None,) * 9, share, seeds, None))
    variances = angle.step_variances()
    for each in angle.effects:
        numbers = map(_number, (each.change, each.low, each.high))
        variance = variances.pop(each.step.key, None) if each.decided else None  # of the step, once
        share = None if variance is None else _number(variance / whole)
        cells = (*(None,) * 6, *numbers, share, each.n, each.heaps_needed)
        rows.append(("angle_of_repose", each.step.key, f"{each.step.levels[0]} | {each.level}", *cells))
    return rows


def _levels(step: ChainStep) -> str:
    return f"{RESAMPLES} bootstrap samples" if step.key == RESAMPLED else " | ".join(step.levels)


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def budget_document(budget: UncertaintyBudget) -> dict[str, Any]:
    """The budget as plain JSON, with the recipe that gave it."""
    angle = budget.angle
    tables = {
        name: [dict(zip([column.name for column in table.columns], row, strict=True)) for row in table.rows]
        for name, table in (("values", values_table(budget)), ("steps", steps_table(budget)))
    }
    document: dict[str, Any] = {
        "format": "regolith-studio-uncertainty",
        "schema_version": 1,
        "confidence": CONFIDENCE,
        "n_grains": budget.descriptors.n_grains,
        "design_points": int(budget.descriptors.known.shape[1]),
        "design_points_asked": int(budget.descriptors.results.shape[1]),
        "note": budget.descriptors.note,
        **tables,
        "recipe": dict(budget.recipe),
    }
    if angle is not None:
        half = _number(angle.half_width_with_undecided)
        document |= {"angle_half_width_with_undecided_deg": half, "engine_notes": list(angle.notes)}
    return document
