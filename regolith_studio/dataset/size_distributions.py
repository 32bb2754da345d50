"""Size distributions F_i of section 2.5: of equivalent diameters, in micrometres, also from one line of text.

Shares count either particles (``number``) or their volume (``volume``; at one density the same as mass).
The two differ by a factor d^3; ``weighted`` converts.
"""

from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import ArrayLike
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator
from scipy.special import gamma, gammainc, gammaincc, ndtr, ndtri

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray

Weighting = Literal["number", "volume"]
Diameter = Annotated[float, Field(gt=0.0, le=1e12, description="Equivalent diameter in micrometres.")]
Share = Annotated[float, Field(ge=0.0, le=1.0)]

PAPER_CLASSES_UM = (25.0, 37.0, 56.0, 84.0, 125.0)
"""Particle sizes of the paper's Table 1."""

WEIGHT_TOLERANCE = 1e-12
"""Tolerance of a sum of shares."""


class SizeDistribution(BaseModel):
    """A distribution of equivalent diameters."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)

    weighting: Weighting = Field("number", description="What a share counts: particles, or their volume.")

    @abstractmethod
    def cdf(self, diameters: ArrayLike) -> FloatArray:
        """Share at or below each diameter (µm), of any shape."""

    @abstractmethod
    def quantile(self, probabilities: ArrayLike) -> FloatArray:
        """Smallest diameter (µm) with at least each share at or below it."""

    @abstractmethod
    def moment(self, power: float) -> float:
        """Mean of d^power, in µm^power."""

    @abstractmethod
    def _by_cube(self, power: int, weighting: Weighting) -> "SizeDistribution":
        """The distribution whose density is proportional to d^power times this one's."""

    def weighted(self, weighting: Weighting) -> "SizeDistribution":
        """The same particles, counted by number or by volume.

        Raises InputError if the conversion has no finite answer.
        """
        if weighting == self.weighting:
            return self
        return self._by_cube(3 if weighting == "volume" else -3, weighting)

    def mean_cube(self) -> float:
        """Mean of d^3 over particles, in µm^3."""
        return self.moment(3) if self.weighting == "number" else 1.0 / self.moment(-3)


class DiscreteSizeDistribution(SizeDistribution):
    """Certain diameters with their shares: measured particles, or the classes of the paper's Table 1."""

    type: Literal["discrete"] = "discrete"
    diameters_um: tuple[Diameter, ...] = Field(min_length=1, description="Strictly ascending.")
    shares: tuple[Share, ...] = Field(description="Share of each diameter; the sum is 1.")

    @model_validator(mode="after")
    def _fits(self) -> Self:
        _check_ascending(self.diameters_um)
        _check_shares(self.shares, len(self.diameters_um))
        return self

    @classmethod
    def empirical(cls, diameters: ArrayLike) -> "DiscreteSizeDistribution":
        """By number, of measured diameters (µm), each with the same share; equal ones are joined."""
        values, counts = np.unique(np.asarray(diameters, dtype=np.float64), return_counts=True)
        return cls.of(values, counts)

    @classmethod
    def of(
        cls, diameters: ArrayLike, amounts: ArrayLike, weighting: Weighting = "number"
    ) -> "DiscreteSizeDistribution":
        """Of ascending diameters (µm) and amounts that need not add up to 1."""
        values = np.asarray(diameters, dtype=np.float64).tolist()
        return cls(weighting=weighting, diameters_um=tuple(values), shares=normalised_shares(amounts))

    def cdf(self, diameters: ArrayLike) -> FloatArray:
        place = np.searchsorted(self.diameters_um, np.asarray(diameters, dtype=np.float64), side="right")
        return np.asarray(np.concatenate([[0.0], _rising(self.shares)])[place])

    def quantile(self, probabilities: ArrayLike) -> FloatArray:
        place = np.searchsorted(_rising(self.shares), np.asarray(probabilities, dtype=np.float64))
        return np.asarray(np.array(self.diameters_um)[np.minimum(place, len(self.shares) - 1)])

    def moment(self, power: float) -> float:
        return float(np.array(self.diameters_um) ** power @ np.array(self.shares))

    def _by_cube(self, power: int, weighting: Weighting) -> "DiscreteSizeDistribution":
        scaled = np.array(self.diameters_um) / max(self.diameters_um)
        return DiscreteSizeDistribution.of(
            self.diameters_um, np.array(self.shares) * scaled**power, weighting
        )


class SieveSizeDistribution(SizeDistribution):
    """Shares between neighbouring sieve openings, even within each class: F is piecewise linear."""

    type: Literal["sieve"] = "sieve"
    openings_um: tuple[Diameter, ...] = Field(min_length=2, description="Strictly ascending.")
    shares: tuple[Share, ...] = Field(description="Share between each opening and the next; the sum is 1.")

    @model_validator(mode="after")
    def _fits(self) -> Self:
        _check_ascending(self.openings_um)
        _check_shares(self.shares, len(self.openings_um) - 1)
        return self

    @classmethod
    def of(
        cls, openings: ArrayLike, amounts: ArrayLike, weighting: Weighting = "number"
    ) -> "SieveSizeDistribution":
        """Of ascending openings (µm) and amounts that need not add up to 1."""
        values = np.asarray(openings, dtype=np.float64).tolist()
        return cls(weighting=weighting, openings_um=tuple(values), shares=normalised_shares(amounts))

    def cdf(self, diameters: ArrayLike) -> FloatArray:
        return np.asarray(
            np.interp(
                np.asarray(diameters, dtype=np.float64),
                self.openings_um,
                np.concatenate([[0.0], _rising(self.shares)]),
            )
        )

    def quantile(self, probabilities: ArrayLike) -> FloatArray:
        rising, openings = np.concatenate([[0.0], _rising(self.shares)]), np.array(self.openings_um)
        target = np.asarray(probabilities, dtype=np.float64)
        upper = np.clip(np.searchsorted(rising, target), 1, len(openings) - 1)
        step = np.maximum(rising[upper] - rising[upper - 1], np.finfo(float).tiny)
        share = np.clip((target - rising[upper - 1]) / step, 0.0, 1.0)
        return np.asarray(openings[upper - 1] + share * (openings[upper] - openings[upper - 1]))

    def moment(self, power: float) -> float:
        return float(_interval_means(np.array(self.openings_um), power) @ np.array(self.shares))

    def refined(self, parts: int) -> "SieveSizeDistribution":
        """The same distribution with each class cut into `parts`, evenly in ln d."""
        pairs = zip(self.openings_um[:-1], self.openings_um[1:], strict=True)
        inner = [np.geomspace(low, high, parts, endpoint=False)[1:] for low, high in pairs]
        openings = np.sort(np.concatenate([self.openings_um, *inner]))
        return SieveSizeDistribution.of(openings, np.diff(self.cdf(openings)), self.weighting)

    def _by_cube(self, power: int, weighting: Weighting) -> "SieveSizeDistribution":
        """What is even within a class is not even in the other count: the classes are cut finer first."""
        fine = self.refined(24) if len(self.shares) < 200 else self
        openings = np.array(fine.openings_um)
        means = _interval_means(openings / openings[-1], power)
        return SieveSizeDistribution.of(openings, np.array(fine.shares) * means, weighting)


class LogNormalSizeDistribution(SizeDistribution):
    """Normal distribution of ln d."""

    type: Literal["log-normal"] = "log-normal"
    median_um: Diameter
    log_deviation: Annotated[float, Field(gt=0.0, le=5.0, description="Standard deviation of ln d.")]

    def cdf(self, diameters: ArrayLike) -> FloatArray:
        values = np.maximum(np.asarray(diameters, dtype=np.float64), 0.0)
        with np.errstate(divide="ignore"):
            return np.asarray(ndtr(np.log(values / self.median_um) / self.log_deviation))

    def quantile(self, probabilities: ArrayLike) -> FloatArray:
        return np.asarray(
            self.median_um * np.exp(self.log_deviation * ndtri(np.asarray(probabilities, dtype=np.float64)))
        )

    def moment(self, power: float) -> float:
        return float(self.median_um**power * np.exp((power * self.log_deviation) ** 2 / 2))

    def _by_cube(self, power: int, weighting: Weighting) -> "LogNormalSizeDistribution":
        """Hatch and Choate: the median moves by exp(power sigma^2), sigma stays."""
        median = self.median_um * float(np.exp(power * self.log_deviation**2))
        return LogNormalSizeDistribution(
            weighting=weighting, median_um=median, log_deviation=self.log_deviation
        )


class RosinRammlerSizeDistribution(SizeDistribution):
    """F(d) = 1 - exp(-(d / scale)^shape), truncated at a minimum and a maximum diameter."""

    type: Literal["rosin-rammler"] = "rosin-rammler"
    scale_um: Diameter = Field(description="Diameter below which 63.2 % lie, before truncation.")
    shape: Annotated[float, Field(gt=0.0, le=100.0)]
    min_um: Diameter
    max_um: Diameter

    @model_validator(mode="after")
    def _fits(self) -> Self:
        _check_ascending((self.min_um, self.max_um))
        low, high = self._limits
        if not high - low > 1e-9:
            raise ValueError("hardly any particles lie between the minimum and the maximum diameter")
        return self

    def cdf(self, diameters: ArrayLike) -> FloatArray:
        low, high = self._limits
        inside = np.clip(np.asarray(diameters, dtype=np.float64), self.min_um, self.max_um)
        return np.asarray((self._untruncated(inside) - low) / (high - low))

    def quantile(self, probabilities: ArrayLike) -> FloatArray:
        low, high = self._limits
        share = low + np.asarray(probabilities, dtype=np.float64) * (high - low)
        # A share of 1 has an infinite logarithm; its diameter is cut off at the maximum anyway.
        values = self.scale_um * (-np.log1p(-np.minimum(share, 1 - 1e-16))) ** (1 / self.shape)
        return np.asarray(np.clip(values, self.min_um, self.max_um))

    def moment(self, power: float) -> float:
        """By the incomplete gamma function; by a fine sum where its argument is not positive."""
        low, high = self._limits
        order = 1 + power / self.shape
        if order <= 0:
            return self.as_classes(4000).moment(power)
        a, b = ((d / self.scale_um) ** self.shape for d in (self.min_um, self.max_um))
        # In the upper tail both lower functions are nearly 1, and their difference would be rounding.
        between = (
            gammainc(order, b) - gammainc(order, a)
            if a < order
            else gammaincc(order, a) - gammaincc(order, b)
        )
        return float(self.scale_um**power * gamma(order) * between / (high - low))

    def as_classes(self, count: int = 400) -> SieveSizeDistribution:
        """The same distribution as sieve classes between evenly spaced logarithms of the diameter."""
        openings = np.geomspace(self.min_um, self.max_um, count + 1)
        return SieveSizeDistribution.of(openings, np.diff(self.cdf(openings)), self.weighting)

    def _by_cube(self, power: int, weighting: Weighting) -> SieveSizeDistribution:
        """No closed form: as 400 sieve classes."""
        return self.as_classes()._by_cube(power, weighting)

    def _untruncated(self, diameters: ArrayLike) -> FloatArray:
        return np.asarray(-np.expm1(-((np.asarray(diameters) / self.scale_um) ** self.shape)))

    @property
    def _limits(self) -> tuple[float, float]:
        low, high = self._untruncated([self.min_um, self.max_um])
        return float(low), float(high)


AnySizes = Annotated[
    DiscreteSizeDistribution
    | SieveSizeDistribution
    | LogNormalSizeDistribution
    | RosinRammlerSizeDistribution,
    Field(discriminator="type"),
]
"""Every kind of size distribution, distinguished by ``type``."""


def normalised_shares(amounts: ArrayLike) -> tuple[float, ...]:
    """Amounts divided by their sum, which then is 1 within :data:`WEIGHT_TOLERANCE`.

    Raises InputError if an amount is negative or all are zero.
    """
    values = np.asarray(amounts, dtype=np.float64)
    if not np.isfinite(values).all() or (values < 0).any() or not values.sum() > 0:
        raise InputError("Weights must not be negative, and at least one must be positive.")
    # The second division takes out the rounding of the first, which grows with the number of shares.
    shares = values / values.sum()
    return tuple((shares / shares.sum()).tolist())


def equivalent_diameter(volume: float) -> float:
    """Diameter of the sphere of `volume`."""
    return float((6.0 * volume / np.pi) ** (1 / 3))


def _rising(shares: Sequence[float]) -> FloatArray:
    """Cumulative shares that end at exactly 1."""
    total = np.cumsum(shares)
    total[-1] = 1.0
    # By rounding an earlier sum may be above 1, so that the sums would not ascend.
    return np.asarray(np.minimum(total, 1.0))


def _interval_means(openings: FloatArray, power: float) -> FloatArray:
    """Mean of d^power over each interval between openings."""
    low, high = openings[:-1], openings[1:]
    if power == -1:
        return np.asarray(np.log(high / low) / (high - low))
    return np.asarray((high ** (power + 1) - low ** (power + 1)) / (power + 1) / (high - low))


def _check_ascending(diameters: Sequence[float]) -> None:
    if not (np.diff(diameters) > 0).all():
        raise ValueError("diameters must be strictly ascending")


def _check_shares(shares: Sequence[float], count: int) -> None:
    if len(shares) != count:
        raise ValueError(f"{count} shares are needed, got {len(shares)}")
    if abs(sum(shares) - 1.0) > WEIGHT_TOLERANCE:
        raise ValueError(f"shares must add up to 1, they add up to {sum(shares)!r}")


QUANTILES = 20_000
"""Quantiles of a continuous distribution, as many by number as by volume."""


MAX_CLASSES = 16
"""Of diameters that represent a distribution for programs that know given sizes only."""


@dataclass(frozen=True, eq=False)
class SizeClasses:
    """A few diameters that represent a distribution.

    ``diameters``: ascending, in micrometres, shape (k,). ``number``, ``mass``: share of each by number and
    by mass (at one density), shape (k,); each adds up to 1.
    """

    diameters: FloatArray
    number: FloatArray
    mass: FloatArray


def size_classes(sizes: SizeDistribution) -> SizeClasses:
    """At most :data:`MAX_CLASSES` diameters with their shares by number and by mass.

    Discrete distributions of no more diameters are unchanged. Others are binned in ln d; the diameter
    of a bin has the mean volume of its particles, so that number and mass are both conserved.
    """
    diameters, number = _points(sizes)
    if len(diameters) > MAX_CLASSES:
        edges = np.geomspace(diameters[0], diameters[-1], MAX_CLASSES + 1)[1:-1]
        place = np.searchsorted(edges, diameters, side="right")
        shares = np.bincount(place, weights=number, minlength=MAX_CLASSES).astype(np.float64)
        cubes = np.bincount(place, weights=number * diameters**3, minlength=MAX_CLASSES).astype(np.float64)
        held = shares > 0.0
        diameters, number = np.cbrt(cubes[held] / shares[held]), shares[held]
    mass = number * (diameters / diameters[-1]) ** 3
    return SizeClasses(diameters, number / number.sum(), mass / mass.sum())


def _points(sizes: SizeDistribution) -> tuple[FloatArray, FloatArray]:
    """Diameters and number shares of a fine discretisation."""
    by_number = sizes.weighted("number")
    if isinstance(by_number, DiscreteSizeDistribution):
        shares = np.array(by_number.shares)
        return np.array(by_number.diameters_um)[shares > 0], shares[shares > 0]
    edges = np.linspace(0.0, 1.0, QUANTILES + 1)
    middle = (edges[1:] + edges[:-1]) / 2
    # By volume too: the few large particles that carry the mass lie within the last quantiles by number.
    limits = np.unique(
        np.concatenate([by_number.quantile(middle), sizes.weighted("volume").quantile(middle)])
    )
    rising = np.concatenate([[0.0], by_number.cdf(limits[1:-1]), [1.0]])
    return np.asarray(np.sqrt(limits[1:] * limits[:-1])), np.diff(rising)


@dataclass(frozen=True)
class ShapeClass:
    """The class of particles that a representative stands for.

    - ``weight``: any positive number; the weights of all classes are divided by their sum.
    - ``sizes``: f_i.
    - ``n_members``: number of particles in the class.
    """

    weight: float
    sizes: SizeDistribution
    n_members: int = 1


FORMS = (
    "measured",
    "classes:25,37,56,84,125",
    "fitted:log-normal",
    "discrete:25=85.5,37=12.6,56=1.7",
    "sieve:20,32,45,63=10,60,30",
    "log-normal:MEDIAN,SIGMA",
    "rosin-rammler:SCALE,SHAPE,MIN,MAX",
)
"""Valid forms; shares count particles, or volume with the suffix ``@volume``."""

SizeRule = Callable[[ShapeClass], SizeDistribution]
"""Function from a class with its measured sizes to its size distribution."""


def parse_sizes(text: str) -> SizeRule:
    """The rule that a text of :data:`FORMS` describes.

    ``measured`` keeps the members' diameters; ``classes`` rounds each to the nearest of these diameters (the
    paper's Table 1); ``fitted:log-normal`` has the mean and deviation of their ln d; the others are the same
    for every class. Diameters in micrometres.

    Raises InputError if the text has another form, or describes no distribution.
    """
    body, _, counted = text.strip().partition("@")
    if counted not in ("", "number", "volume"):
        raise InputError(f"@ must be followed by number or volume, got {counted!r}.")
    weighting: Weighting = "volume" if counted == "volume" else "number"
    kind, _, rest = body.partition(":")
    if kind in ("measured", "classes", "fitted"):
        if counted:
            raise InputError(f"{kind} sizes are weighted as the dataset is; remove @{counted}.")
        return _from_members(kind, rest)
    if kind not in {form.partition(":")[0] for form in FORMS}:
        raise InputError(_no_form(text))
    try:
        fixed = _fixed(kind, rest, weighting)
    except ValidationError as error:
        reason = error.errors(include_url=False)[0]
        place = ".".join(str(part) for part in reason["loc"])
        raise InputError(f"The sizes {text!r} describe no distribution: {place} {reason['msg']}.") from error
    return lambda _: fixed


def _from_members(kind: str, rest: str) -> SizeRule:
    if kind == "measured" and not rest:
        return lambda own: own.sizes
    if kind == "classes":
        classes = _numbers(rest) if rest else list(PAPER_CLASSES_UM)
        if sorted(set(classes)) != classes or classes[0] <= 0.0:
            raise InputError(f"Size classes must be positive and ascending, got {rest!r}.")
        return lambda own: _in_classes(own, classes)
    if kind == "fitted" and rest == "log-normal":
        return _fitted_log_normal
    raise InputError(_no_form(f"{kind}:{rest}"))


def _fixed(kind: str, rest: str, weighting: Weighting) -> SizeDistribution:
    if kind == "discrete":
        pairs = [pair.partition("=") for pair in rest.split(",")]
        diameters = _numbers(",".join(first for first, _, _ in pairs))
        amounts = _numbers(",".join(second or "1" for _, _, second in pairs))
        return DiscreteSizeDistribution.of(diameters, amounts, weighting)
    if kind == "sieve":
        openings, _, shares = rest.partition("=")
        return SieveSizeDistribution.of(_numbers(openings), _numbers(shares), weighting)
    numbers = _numbers(rest)
    if kind == "log-normal" and len(numbers) == 2:
        return LogNormalSizeDistribution(weighting=weighting, median_um=numbers[0], log_deviation=numbers[1])
    if kind == "rosin-rammler" and len(numbers) == 4:
        scale, shape, smallest, largest = numbers
        return RosinRammlerSizeDistribution(
            weighting=weighting, scale_um=scale, shape=shape, min_um=smallest, max_um=largest
        )
    raise InputError(_no_form(f"{kind}:{rest}"))


def _in_classes(own: ShapeClass, classes: Sequence[float]) -> DiscreteSizeDistribution:
    diameters, shares = _members(own)
    limits = np.sqrt(np.array(classes[:-1]) * np.array(classes[1:]))
    place = np.searchsorted(limits, diameters)
    amounts = np.bincount(place, weights=shares, minlength=len(classes))
    return DiscreteSizeDistribution.of(classes, amounts, own.sizes.weighting)


def _fitted_log_normal(own: ShapeClass) -> SizeDistribution:
    """The measured sizes if their deviation is zero."""
    diameters, shares = _members(own)
    logarithms = np.log(diameters)
    mean = float(shares @ logarithms)
    deviation = float(np.sqrt(shares @ (logarithms - mean) ** 2))
    if deviation < 1e-6:
        return own.sizes
    return LogNormalSizeDistribution(
        weighting=own.sizes.weighting, median_um=float(np.exp(mean)), log_deviation=deviation
    )


def _members(own: ShapeClass) -> tuple[FloatArray, FloatArray]:
    if not isinstance(own.sizes, DiscreteSizeDistribution):
        raise InputError("Only measured sizes can be moved into classes or fitted.")
    return np.array(own.sizes.diameters_um), np.array(own.sizes.shares)


def _numbers(text: str) -> list[float]:
    try:
        return [float(word) for word in text.split(",")]
    except ValueError:
        raise InputError(f"Numbers must be separated by commas, as 25,37,56; got {text!r}.") from None


def _no_form(text: str) -> str:
    return f"{text.strip(':')!r} is not a size distribution; write one of: {'; '.join(FORMS)}."
