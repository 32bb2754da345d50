"""Parametric model with facets: a Gaussian field about an ellipsoid that is moved towards its convex hull.

Fields with random phases are too concave for their roughness: the facets and edges of real grains are in the
phases. Here a rough isotropic field in ln r about an ellipsoid is moved most of the way to its convex hull,
which makes facets; its degrees are scaled to their power; it is moved towards or away from its hull until it
fills the wanted share of it; and it is stretched until its ellipsoid of inertia is the wanted one. Degrees
above the tenth are added with the power that goes with these features, and random phases. Size,
elongation, flatness, the power of each degree and the share of the hull come from a Gaussian copula. How far
the first move goes (the faceting), and the offset of what is asked for, are calibrated so that the result has
the sample's extents, sphericities and shares. No measured particle is stored; sizes beyond the sample get the
shapes of its ends.

Calibration of the hull field: which features to ask for so that drawn particles have those of the sample.

Moving a surface towards its hull and cutting it at l_max shift the features of
:mod:`~regolith_studio.shape_models.shape_features`, so that others have to be asked for. The powers from the
third degree on are shifted together until the mean sphericity is the sample's; between them, and in their
deviations, they follow the sample's powers. Those of the first two degrees belong to the star point and the
ellipsoid and stay as they are, as does the form, which is set exactly.

Gaussian copula: a joint distribution of d numbers from their quantiles and correlations.

Sklar (1959): a joint distribution is its marginal distributions and a copula. The marginals are tables of
quantiles with linear interpolation; the copula is that of a normal law with the correlations of the sample's
normal scores. Realizations are conditional on the first number, which is given.

Degrees above those of a hull field: power by a particle's features, with random phases.

Size, form, roughness and hull ratio of a particle tell most of the power of its higher degrees: ln P_l is
linear in the features, and what is left is a normal law over the degrees, correlated.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from scipy.special import ndtr, ndtri

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray, LockedRecord, locked_floats
from regolith_studio.messages import N_, Message
from regolith_studio.settings import setting
from regolith_studio.shape_models.chunked_sampling import CHUNK, SizedSampler
from regolith_studio.shape_models.inertia_ellipsoid import log_ellipsoids, with_forms
from regolith_studio.shape_models.sample import Sample, log_shapes
from regolith_studio.shape_models.shape_features import (
    CONVEXITY,
    FORM,
    MIN_POWER,
    POWERS,
    SPHERICITY,
    log_shape_features,
    outer_features_of_log_radii,
    outer_features_of_radii,
    powers,
    shape_features,
    shape_grid,
    whole_features_of_log_radii,
    whole_features_of_radii,
    with_powers,
)
from regolith_studio.shape_models.size_law import SIZE_LAWS, LogNormalSizes, size_law_from

RIDGE = 0.1
"""Of the regression, as a share of the number of particles, on standardised features."""


@dataclass(frozen=True, eq=False)
class FineDegrees(LockedRecord):
    """ln P_l of the degrees above the hull field's: offset + slopes features + factor normal numbers.

    - ``offset``: shape (m,), one for each degree.
    - ``slopes``: shape (m, d).
    - ``factor``: lower triangular, of the covariance that is left, shape (m, m).

    Raises InputError if a number is not finite.
    """

    offset: FloatArray
    slopes: FloatArray
    factor: FloatArray

    def __post_init__(self) -> None:
        m = len(self.offset)
        for name, shape in (("offset", (m,)), ("slopes", (m, None)), ("factor", (m, m))):
            values = locked_floats(getattr(self, name), shape, name)
            if not np.isfinite(values).all():
                raise InputError(f"The {name} of the fine degrees must be finite.")
            object.__setattr__(self, name, values)

    def __len__(self) -> int:
        return len(self.offset)

    @classmethod
    def of(cls, rows: FloatArray, equivalent_radii: FloatArray, base: int) -> "FineDegrees":
        """From expansions of ln r of measured particles, shape (n, (l_max + 1)^2), above degree `base`."""
        table = log_shape_features(rows[:, : (base + 1) ** 2], equivalent_radii)
        fine = np.log(np.maximum(powers(rows)[:, base + 1 :], MIN_POWER))
        # Of a feature that all particles share the deviation is 0.
        middle, spread = table.mean(axis=0), np.maximum(table.std(axis=0), 1e-9)
        standard = (table - middle) / spread
        normal = standard.T @ standard + RIDGE * len(table) * np.eye(table.shape[1])
        slopes = np.linalg.solve(normal, standard.T @ (fine - fine.mean(axis=0))).T / spread
        left = fine - table @ slopes.T
        # np.cov makes a number of a single degree, and a singular matrix of fewer particles than degrees,
        # which has no Cholesky factor.
        covariance = np.cov(left.T).reshape(2 * [fine.shape[1]]) + 1e-9 * np.eye(fine.shape[1])
        return cls(left.mean(axis=0), slopes, np.asarray(np.linalg.cholesky(covariance), dtype=np.float64))

    def first(self, count: int) -> "FineDegrees":
        """The lowest `count` of the degrees, at least one."""
        return FineDegrees(self.offset[:count], self.slopes[:count], self.factor[:count, :count])

    def scaled(self, change: float) -> "FineDegrees":
        """The same with ln P_l larger by `change` at all degrees."""
        return replace(self, offset=np.asarray(self.offset) + change)

    def added(self, rows: FloatArray, equivalent_radii: FloatArray, rng: np.random.Generator) -> FloatArray:
        """Expansions of ln r of the lower degrees (n, k) with the higher ones."""
        n, base = len(rows), round(rows.shape[1] ** 0.5) - 1
        normal = rng.standard_normal((n, len(self)))
        wanted = log_shape_features(rows, equivalent_radii) @ self.slopes.T + normal @ self.factor.T
        field = rng.standard_normal((n, (base + len(self) + 1) ** 2))
        field[:, : rows.shape[1]] = rows
        power = np.hstack([powers(rows), np.exp(wanted + self.offset)])
        return with_powers(field, power)

    def stored(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {name: getattr(self, name).tolist() for name in self.__dataclass_fields__}

    @classmethod
    def restored(cls, values: Mapping[str, Any]) -> "FineDegrees":
        """From its stored values."""
        return cls(*(np.array(values[name], dtype=np.float64) for name in cls.__dataclass_fields__))


N_QUANTILES = 65
REACH = 3.2
"""Normal score of the outermost quantile in the tables."""


@dataclass(frozen=True, eq=False)
class GaussianCopula(LockedRecord):
    """The joint distribution of d numbers.

    ``quantiles``: of each number at even normal scores from -3.2 to 3.2, ascending, shape (q, d).
    ``correlations``: of the normal scores, positive definite, shape (d, d).

    Raises InputError if the numbers do not define a distribution.
    """

    quantiles: FloatArray
    correlations: FloatArray

    def __post_init__(self) -> None:
        quantiles = locked_floats(self.quantiles, (None, None), "quantiles")
        shape = (quantiles.shape[1], quantiles.shape[1])
        correlations = locked_floats(self.correlations, shape, "correlations")
        if len(quantiles) < 2 or not np.isfinite(quantiles).all() or (np.diff(quantiles, axis=0) < 0).any():
            raise InputError("Quantiles must be finite and ascend.")
        if not (np.isfinite(correlations).all() and np.linalg.eigvalsh(correlations).min() > 0):
            raise InputError("Correlations must be a positive definite matrix.")
        object.__setattr__(self, "quantiles", quantiles)
        object.__setattr__(self, "correlations", correlations)

    @classmethod
    def of(cls, table: FloatArray) -> "GaussianCopula":
        """Fit to a table (n, d), n >= 2.

        Correlations are shrunk towards zero by d / (n + d), so that few particles are enough.
        """
        n, d = table.shape
        ranks = np.argsort(np.argsort(table, axis=0, kind="stable"), axis=0, kind="stable")
        scores = ndtri((ranks + 0.5) / n)
        # All columns hold the same n scores in other orders, so that one sum of squares divides them all.
        correlations = np.clip(scores.T @ scores / (scores[:, 0] @ scores[:, 0]), -1.0, 1.0)
        shrunk = (n * correlations + d * np.eye(d)) / (n + d)
        return cls(np.quantile(table, ndtr(_places(N_QUANTILES)), axis=0), shrunk)

    def draw(self, first: FloatArray, rng: np.random.Generator) -> FloatArray:
        """A row of numbers for each given first one, shape (n, d).

        First numbers beyond the table are treated as its outermost ones.
        """
        places = _places(len(self.quantiles))
        normal = rng.standard_normal((len(first), len(self.correlations)))
        # Equal sizes have equal quantiles, and np.interp needs places that ascend.
        normal[:, 0] = np.interp(first, _rising(self.quantiles[:, 0]), places)
        scores = normal @ self._factor.T
        columns = [np.interp(scores[:, j], places, self.quantiles[:, j]) for j in range(1, scores.shape[1])]
        return np.column_stack([first, *columns])

    @cached_property
    def _factor(self) -> FloatArray:
        scale = np.sqrt(np.diag(self.correlations))
        return np.asarray(np.linalg.cholesky(self.correlations / np.outer(scale, scale)))

    def stored(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {"quantiles": self.quantiles.tolist(), "correlations": self.correlations.tolist()}


def _places(count: int) -> FloatArray:
    return np.linspace(-REACH, REACH, count)


def _rising(values: FloatArray) -> FloatArray:
    """The values, made strictly ascending by negligible steps."""
    step = 1e-12 * max(float(np.abs(values).max()), 1.0)
    return values + step * np.arange(len(values))


RATE = 0.8
"""Share of a difference that is corrected in each round."""
SPHERICITY_RATE = 3.0
"""Change of ln P_l for a difference in ln(s / (1 - s)) of the sphericity."""
MAX_SHIFT = 2.0
SPREADS = (0.5, 2.0)
_ROUGHNESS = slice(POWERS.start + 2, POWERS.stop)
_QUANTILES = np.linspace(0.01, 0.99, 50)


@dataclass(frozen=True, eq=False)
class CalibrationOffset:
    """Features to ask for instead of drawn ones: median + shift + spread (drawn - median).

    ``shift``, ``spread``: shape (d,).
    """

    shift: FloatArray
    spread: FloatArray


@dataclass(frozen=True, eq=False)
class CalibrationTarget:
    """Features that drawn particles should have.

    ``mean``, ``deviation``: of the features, shape (d,). ``outer``: outer features of the measured
    particles, shape (n, 3).
    """

    mean: FloatArray
    deviation: FloatArray
    outer: FloatArray

    @classmethod
    def of(cls, coefficients: FloatArray, numbers: FloatArray) -> "CalibrationTarget":
        """From measured particles: radius functions (n, (l_max + 1)^2) and their features (n, d)."""
        return cls(
            numbers.mean(axis=0),
            numbers.std(axis=0),
            outer_features_of_radii(coefficients, numbers[:, CONVEXITY]),
        )

    def distance(self, outer: FloatArray) -> float:
        """Mean difference of quantiles over the standard deviation, summed over the outer features."""
        wanted, quantiles = (np.quantile(table, _QUANTILES, axis=0) for table in (self.outer, outer))
        return float((np.abs(quantiles - wanted).mean(axis=0) / (self.outer.std(axis=0) + 1e-9)).sum())

    def corrected(
        self, offset: CalibrationOffset, numbers: FloatArray, outer: FloatArray
    ) -> CalibrationOffset:
        """The next offset, where the last one gave features (m, d) and outer features (m, 3)."""
        shift = RATE * (self.mean - numbers.mean(axis=0))
        too_round = outer[:, SPHERICITY].mean() - self.outer[:, SPHERICITY].mean()
        # Between the degrees the shift follows the powers of the sample, in its mean the sphericity instead.
        shift[_ROUGHNESS] += SPHERICITY_RATE * too_round - shift[_ROUGHNESS].mean()
        ratio = ((self.deviation + 1e-9) / (numbers.std(axis=0) + 1e-9)) ** RATE
        shift[: _ROUGHNESS.start], ratio[: _ROUGHNESS.start], ratio[CONVEXITY] = 0.0, 1.0, 1.0
        return CalibrationOffset(
            np.clip(offset.shift + shift, -MAX_SHIFT, MAX_SHIFT), np.clip(offset.spread * ratio, *SPREADS)
        )


def measured_features(rows: FloatArray, equivalent_radii: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Features (m, d) and outer features (m, 3) of drawn particles: expansions of ln r with these sizes."""
    numbers = log_shape_features(rows, equivalent_radii)
    return numbers, outer_features_of_log_radii(rows, numbers[:, CONVEXITY])


def features_and_target(coefficients: FloatArray) -> tuple[FloatArray, CalibrationTarget]:
    """The features (n, d) of measured particles, and the calibration target that they define."""
    numbers = shape_features(coefficients)
    return numbers, CalibrationTarget.of(coefficients, numbers)


KEY = "hull_field"
DEGREES = (3, 30)
HULL_DEGREE = 10
"""Degrees above are added with random phases."""
FINE_ROUNDS = 4
"""Rounds of calibration of the degrees above."""
FINE_RATES = (1.2, 0.7)
"""Change of ln P_l, and of the hull ratio that is asked for, for a difference in ln(s / (1 - s)) of the
sphericity, and of the share of the hull."""
ROUGHNESS = 2.5
"""Amplitude of the field that is moved to its hull, over that of the finished surface."""
FACETINGS = (0.6, 0.7, 0.8, 0.9, 1.0)
"""Shares of the distance to the hull of the first move; the fit chooses one."""
DEFAULT_FACETING, MIN_TO_CHOOSE = 0.9, 50
"""Faceting of fits to fewer particles than the number to choose by."""
N_TRIED, N_COMPARED = CHUNK, 2 * CHUNK
"""Particles drawn in a round of calibration: to choose the faceting, and after."""
ROUNDS = 6
"""Rounds of calibration with each of the facetings, and after."""
FORM_STEPS = (1, 2)
"""Corrections of the form before and after the share of the hull is set."""


@dataclass(frozen=True)
class HullFieldSettings:
    """Settings of the hull field.

    - ``l_max``: degree of ln r, 3 to 30.
    - ``size_law``: key of ``SIZE_LAWS``.
    """

    l_max: int = 30
    size_law: str = setting("kernel", N_("Size distribution"), choices=tuple(SIZE_LAWS))


@dataclass(frozen=True, eq=False)
class HullField(SizedSampler, LockedRecord):
    """A fitted hull field.

    - ``numbers``: joint distribution of the columns of :mod:`~regolith_studio.shape_models.shape_features`,
      as measured.
    - ``sizes``: law of equivalent radii.
    - ``spectrum``: a_l of ln r of the measured particles, shape (l_max + 1,), A_0 = 0; for display only.
    - ``unit``: length unit of the sample.
    - ``shift``, ``spread``: features asked for are median + shift + spread (drawn - median), shapes (l_max +
      4,).
    - ``faceting``: share of the distance to its hull by which the rough field is moved, 0 to 1.
    - ``fine``: the degrees above :data:`HULL_DEGREE`, where there are any.
    """

    numbers: GaussianCopula
    sizes: LogNormalSizes
    spectrum: FloatArray
    unit: str = "um"
    shift: FloatArray | None = None
    spread: FloatArray | None = None
    faceting: float = DEFAULT_FACETING
    fine: FineDegrees | None = None
    key: ClassVar[str] = KEY

    def __post_init__(self) -> None:
        object.__setattr__(self, "spectrum", locked_floats(self.spectrum, (None,), "spectrum"))
        length = self._base + 4
        if len(self.numbers.correlations) != length:
            raise InputError(f"A field of degree {self._base} needs {length} numbers a particle.")
        if self.fine is not None and self.fine.slopes.shape[1] != length:
            raise InputError(f"Degrees above {self._base} need {length} slopes each.")
        for name, filler in (("shift", np.zeros), ("spread", np.ones)):
            given = getattr(self, name)
            values = filler(length) if given is None else given
            object.__setattr__(self, name, locked_floats(values, (length,), name))

    @property
    def l_max(self) -> int:
        """Degree of ln r."""
        return len(self.spectrum) - 1

    def relative_amplitudes(self) -> FloatArray:
        """sqrt(A_l / 4 pi) of the measured particles, shape (l_max,)."""
        return np.asarray(np.sqrt(self.spectrum[1:] / (4 * np.pi)))

    @property
    def _base(self) -> int:
        """Degree of what is moved to its hull."""
        return self.l_max - (0 if self.fine is None else len(self.fine))

    def truncated(self, l_max: int) -> "HullField":
        """The field without the degrees above `l_max`.

        Raises InputError if `l_max` is beyond the field, or below the degree of what is moved to its hull.
        """
        if not self._base <= l_max <= self.l_max:
            sentence = (
                N_("This hull field is drawn with l_max from {base} to {top}, got l_max = {l_max}.")
                if self.fine
                else N_("This hull field is drawn with l_max = {top} only, got l_max = {l_max}.")
            )
            raise InputError(Message(sentence, base=self._base, top=self.l_max, l_max=l_max))
        if l_max == self.l_max or self.fine is None:
            return self
        fine = self.fine.first(l_max - self._base) if l_max > self._base else None
        return replace(self, spectrum=np.asarray(self.spectrum)[: l_max + 1], fine=fine)

    def shapes(
        self, radii: FloatArray, _components: IntArray, rng: np.random.Generator
    ) -> tuple[FloatArray, dict[str, IntArray]]:
        """Surfaces drawn to their hulls, with numbers that go with these sizes."""
        rows = self._shapes(self.numbers.draw(np.log(radii), rng), rng)
        return (rows if self.fine is None else self.fine.added(rows, radii, rng)), {}

    def _shapes(self, numbers: FloatArray, rng: np.random.Generator) -> FloatArray:
        """Coefficients of ln r, up to size, of particles that come out with these numbers (n, d)."""
        shapes, wanted = shape_grid(self._base), self._with_offset(numbers)
        grid, form = shapes.grid, numbers[:, FORM]
        power = np.column_stack([np.zeros(len(wanted)), np.exp(wanted[:, POWERS])])
        # Four normal numbers make a uniformly random rotation.
        frames = Rotation.from_quat(rng.standard_normal((len(wanted), 4))).as_matrix()
        ellipsoids = log_ellipsoids(grid.directions, form, frames)
        field = rng.standard_normal((len(wanted), (self._base + 1) ** 2))
        field[:, 0] = 0.0
        rough = ellipsoids + grid.values(with_powers(field, ROUGHNESS**2 * power))
        surface = grid.expanded(shapes.drawn(rough, self.faceting) - ellipsoids)
        finished = ellipsoids + grid.values(with_powers(surface, power))
        shares = 1 / (1 + np.exp(-wanted[:, CONVEXITY]))
        filled = shapes.with_convexities(with_forms(finished, form, grid, FORM_STEPS[0]), shares)
        return grid.expanded(with_forms(filled, form, grid, FORM_STEPS[1]))

    def _with_offset(self, numbers: FloatArray) -> FloatArray:
        middle = self.numbers.quantiles[len(self.numbers.quantiles) // 2]
        return np.asarray(middle + self.shift + np.asarray(self.spread) * (numbers - middle))

    def corrected(self, target: CalibrationTarget, n: int) -> tuple["HullField", float]:
        """The field after a round of calibration, and the distance of its draws from the target."""
        rng = np.random.default_rng(np.random.SeedSequence(0))
        radii, _ = self.sizes.draw(n, rng)
        numbers, outer = measured_features(self._shapes(self.numbers.draw(np.log(radii), rng), rng), radii)
        offset = CalibrationOffset(np.asarray(self.shift), np.asarray(self.spread))
        better = target.corrected(offset, numbers, outer)
        return replace(self, shift=better.shift, spread=better.spread), target.distance(outer)

    def refined(self, usable: Sample) -> "HullField":
        """The field with all degrees of measured particles, whose mean sphericity and share of the hull its
        draws have."""
        shapes = log_shapes(usable)
        fine = FineDegrees.of(shapes.coefficients, shapes.equivalent_radii, self._base)
        spectrum = shapes.powers.mean(axis=0) / (2 * np.arange(usable.l_max + 1) + 1)
        field = replace(self, spectrum=spectrum, fine=fine)
        wanted = whole_features_of_radii(usable.coefficients).mean(axis=0)
        for _ in range(FINE_ROUNDS):
            # The same numbers each round: what changes from one to the next is the correction, not the noise.
            rng = np.random.default_rng(np.random.SeedSequence(0))
            radii, components = field.sizes.draw(N_COMPARED, rng)
            missing = wanted - whole_features_of_log_radii(field.shapes(radii, components, rng)[0]).mean(
                axis=0
            )
            shift = np.array(field.shift)
            shift[CONVEXITY] += FINE_RATES[1] * missing[CONVEXITY]
            fine = fine.scaled(-FINE_RATES[0] * float(missing[SPHERICITY]))
            field = replace(field, shift=shift, fine=fine)
        return field

    def stored(self) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
        """Plain values for JSON, no arrays."""
        values = {
            "numbers": self.numbers.stored(),
            "sizes": self.sizes.stored(),
            "spectrum": self.spectrum.tolist(),
            "unit": self.unit,
            "shift": np.asarray(self.shift).tolist(),
            "spread": np.asarray(self.spread).tolist(),
            "faceting": self.faceting,
            "fine": None if self.fine is None else self.fine.stored(),
        }
        return values, {}


class HullFieldModel:
    """Fits the features of a sample's particles, and calibrates what is asked for until draws have them."""

    key = KEY
    label = N_("Field drawn to its hull")
    summary = N_(
        "Parametric, with facets: size, form, roughness and hull ratio are correlated as in the sample."
    )
    Settings = HullFieldSettings

    def fit(self, sample: Sample, settings: HullFieldSettings | None = None) -> HullField:
        """The field of a sample."""
        chosen = settings or HullFieldSettings(min(DEGREES[1], sample.l_max))
        if chosen.size_law not in SIZE_LAWS:
            raise InputError(f"The size law must be one of {', '.join(SIZE_LAWS)}, got {chosen.size_law!r}.")
        cut = sample.truncated(chosen.l_max)
        if not DEGREES[0] <= chosen.l_max <= DEGREES[1]:
            sentence = N_("A field drawn to its hull has l_max {low} to {high}, got {l_max}.")
            low, high = DEGREES
            raise InputError(Message(sentence, low=low, high=high, l_max=chosen.l_max))
        whole = cut.star_shaped()
        # Once more: cut at the lower degree a radius may fall below zero.
        usable = whole.truncated(min(chosen.l_max, HULL_DEGREE)).star_shaped()
        table, target = features_and_target(usable.coefficients)
        mean_powers = log_shapes(usable).powers.mean(axis=0)
        sizes = SIZE_LAWS[chosen.size_law](usable.equivalent_radii)
        spectrum = mean_powers / (2 * np.arange(usable.l_max + 1) + 1)
        plain = HullField(GaussianCopula.of(table), sizes, spectrum, sample.unit)
        # The distances that the facetings are compared by are noise where there are few particles.
        if len(usable) < MIN_TO_CHOOSE:
            field = _calibrated(plain, target, N_COMPARED)[0]
        else:
            trials = [_calibrated(replace(plain, faceting=share), target, N_TRIED) for share in FACETINGS]
            field = _calibrated(min(trials, key=lambda each: each[1])[0], target, N_COMPARED)[0]
        return field if usable.l_max == chosen.l_max else field.refined(whole)

    def restored(self, values: Mapping[str, Any], _arrays: Mapping[str, NDArray[Any]]) -> HullField:
        """The field from its stored values."""
        numbers = values["numbers"]
        return HullField(
            GaussianCopula(np.array(numbers["quantiles"]), np.array(numbers["correlations"])),
            size_law_from(values["sizes"]),
            np.array(values["spectrum"]),
            str(values["unit"]),
            np.array(values["shift"]),
            np.array(values["spread"]),
            float(values["faceting"]),
            FineDegrees.restored(values["fine"]) if values.get("fine") else None,
        )


def _calibrated(field: HullField, target: CalibrationTarget, n: int) -> tuple[HullField, float]:
    """The field after all rounds of calibration, and its distance from the target in the last one."""
    distance = np.inf
    for _ in range(ROUNDS):
        field, distance = field.corrected(target, n)
    return field, distance


MODEL = HullFieldModel()
