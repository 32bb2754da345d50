"""Laws of particle size: how equivalent radii are distributed, counted by number.

A mixture of log-normals is the log-normal law (one component), a kernel estimate in ln r (one component a
particle) and a fitted mixture.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import log_ndtr, logsumexp, ndtr, ndtri

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray, LockedRecord, locked_floats

Bounds = tuple[float, float] | None
MAX_MODES = 6
MAX_RADIUS = 1e12
FEWEST_A_MODE = 10
"""Particles for each part of a mixture of log-normal laws."""
NARROWEST = 0.05
_STEPS = 500


def checked_bounds(bounds: Bounds) -> Bounds:
    """The range itself, if it is one.

    Raises InputError if an end is not positive or above 1e12, or they are not in order.
    """
    if bounds is None:
        return None
    low, high = float(bounds[0]), float(bounds[1])
    if not 0 < low < high <= MAX_RADIUS:
        raise InputError(
            f"A range of sizes needs two positive radii, the smaller first, got {low:g} to {high:g}."
        )
    return low, high


@dataclass(frozen=True, eq=False)
class LogNormalSizes(LockedRecord):
    """Mixture of normal distributions of ln r.

    ``weights``, ``means``, ``deviations``: of the components, shape (k,); means and standard deviations of
    ln r, r in the sample's unit. ``limits``: radii to which the law is cut where no other range is asked
    for.
    """

    weights: FloatArray
    means: FloatArray
    deviations: FloatArray
    limits: Bounds = None

    def __post_init__(self) -> None:
        for name in ("weights", "means", "deviations"):
            object.__setattr__(self, name, locked_floats(getattr(self, name), (None,), name))
        if not len(self.weights) == len(self.means) == len(self.deviations) or not len(self.weights):
            raise ValueError("weights, means and deviations must have one length")
        checked_bounds(self.limits)
        if not (self.deviations > 0).all() or not (self.weights >= 0).all() or not self.weights.sum() > 0:
            raise ValueError("deviations must be positive, weights not negative and not all zero")

    @classmethod
    def log_normal(cls, radii: FloatArray) -> "LogNormalSizes":
        """One log-normal law, by mean and standard deviation of ln r."""
        logs = np.log(radii)
        return cls(np.ones(1), logs[None].mean(axis=1), _deviation(logs)[None])

    @classmethod
    def kernel(cls, radii: FloatArray, width: float | None = None) -> "LogNormalSizes":
        """A kernel estimate in ln r: a component a particle.

        `width` is its standard deviation in ln r; by default Silverman's (1986, Eq. 3.31), the smaller
        of the standard deviation and the interquartile range / 1.34 times 0.9 n^(-1/5).
        """
        logs = np.log(radii)
        n = len(logs)
        if width is None:
            # Where half of the sizes are equal, the quartiles are, too, and say nothing of the width.
            quarter = float(np.subtract(*np.percentile(logs, [75, 25]))) / 1.34
            width = 0.9 * min(float(_deviation(logs)), quarter or np.inf) * n**-0.2
        return cls(np.full(n, 1 / n), logs, np.full(n, max(width, 1e-9)))

    @classmethod
    def mixture(cls, radii: FloatArray) -> "LogNormalSizes":
        """Several log-normal laws, 1 to :data:`MAX_MODES` of them by Bayes' criterion.

        Expectation and maximisation, from parts of equal numbers in the order of size; no part is narrower
        than a twentieth of the whole.
        """
        logs = np.log(radii)
        most = max(1, min(MAX_MODES, len(logs) // FEWEST_A_MODE))
        fits = [_modes(logs, k) for k in range(1, most + 1)]
        # k means, k deviations and k - 1 shares.
        criterion = [(3 * k - 1) * np.log(len(logs)) - 2 * fit[1] for k, fit in enumerate(fits, start=1)]
        return fits[int(np.argmin(criterion))][0]

    def draw(self, n: int, rng: np.random.Generator, bounds: Bounds = None) -> tuple[FloatArray, IntArray]:
        """Exactly `n` radii from the law cut to `bounds`, whatever its share there.

        Components are stratified: in the order of size one from each n-th part of the law, so that few
        radii stand for it better than independent ones would. Where the law holds less than 1e-300 inside
        the bounds, radii are even in ln r and components those nearest to the range.
        """
        picks, shares = rng.permutation((np.arange(n) + rng.random(n)) / max(n, 1)), rng.random(n)
        limits = checked_bounds(bounds) or self.limits
        if limits is None:
            component = self._picked(self.weights, picks)
            return np.exp(self.means[component] + self.deviations[component] * ndtri(shares)), component
        low, high = np.log(limits[0]), np.log(limits[1])
        below, above = (low - self.means) / self.deviations, (high - self.means) / self.deviations
        mass = self.weights * _mass(below, above)
        if not mass.sum() > 1e-300:
            nearest = np.abs(np.clip(self.means, low, high) - self.means)
            component = np.argsort(nearest, kind="stable")[(picks * min(20, len(nearest))).astype(np.int64)]
            return np.exp(low + shares * (high - low)), component
        component = self._picked(mass, picks)
        standard = _truncated(below[component], above[component], shares)
        logs = self.means[component] + self.deviations[component] * standard
        # Twice, as exp(ln r) may round to a number beyond r.
        return np.clip(np.exp(np.clip(logs, low, high)), *limits), component

    def _picked(self, weights: FloatArray, shares: FloatArray) -> IntArray:
        """Components at shares of the sum of the weights, in the order of size."""
        order = np.argsort(self.means, kind="stable")
        rising = np.cumsum(weights[order])
        place = np.searchsorted(rising / rising[-1], shares, side="right")
        return order[np.minimum(place, len(weights) - 1)].astype(np.int64)

    def stored(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "type": "log_normal_mixture",
            "weights": self.weights.tolist(),
            "means": self.means.tolist(),
            "deviations": self.deviations.tolist(),
            "limits": None if self.limits is None else list(self.limits),
        }


SIZE_LAWS: Mapping[str, Callable[[FloatArray], LogNormalSizes]] = {
    "kernel": LogNormalSizes.kernel,
    "log_normal": LogNormalSizes.log_normal,
    "log_normal_mixture": LogNormalSizes.mixture,
}
"""What a law can be fitted as, from equivalent radii (n,)."""


def size_law_from(values: Mapping[str, Any]) -> LogNormalSizes:
    """A law from what it stored.

    Raises InputError if the values are no law.
    """
    try:
        if values["type"] == "log_normal_mixture":
            limits = values["limits"] and (float(values["limits"][0]), float(values["limits"][1]))
            return LogNormalSizes(values["weights"], values["means"], values["deviations"], limits)
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(f"The size distribution is invalid: {error}.") from error
    raise InputError(f"There is no size distribution called {values['type']!r}.")


def _modes(logs: FloatArray, k: int) -> tuple[LogNormalSizes, float]:
    """The mixture of `k` normal laws, and its log-likelihood."""
    # Without a lowest width a component shrinks to one particle, where the likelihood has no bound.
    floor = float(_deviation(logs)) * (NARROWEST if k > 1 else 1e-9)
    rank = np.argsort(np.argsort(logs, kind="stable"), kind="stable")
    shares = 0.9 * np.eye(k)[rank * k // len(logs)] + 0.1 / k
    before = now = -np.inf
    for _ in range(_STEPS):
        members = np.maximum(shares.sum(axis=0), 1e-3)
        means = shares.T @ logs / members
        variances = (shares * (logs[:, None] - means) ** 2).sum(axis=0) / members
        widths = np.maximum(np.sqrt(variances), max(floor, 1e-9))
        weights = members / members.sum()
        joint = np.log(weights) - ((logs[:, None] - means) / widths) ** 2 / 2 - np.log(widths)
        total = logsumexp(joint, axis=1, keepdims=True)
        shares, now = np.exp(joint - total), float(total.sum()) - len(logs) * np.log(2 * np.pi) / 2
        if now - before < 1e-9 * abs(now):
            break
        before = now
    return LogNormalSizes(weights, means, widths), now


def _deviation(logs: FloatArray) -> FloatArray:
    """Standard deviation of ln r (unbiased variance), at least 1e-9: sizes may be equal."""
    return np.asarray(np.maximum(logs.std(ddof=1), 1e-9))


def _mass(below: FloatArray, above: FloatArray) -> FloatArray:
    """Share of the standard normal law between two values, accurate in both tails."""
    flipped = below > 0
    low, high = np.where(flipped, -above, below), np.where(flipped, -below, above)
    return np.asarray(np.exp(log_ndtr(high)) - np.exp(log_ndtr(low)))


def _truncated(below: FloatArray, above: FloatArray, shares: FloatArray) -> FloatArray:
    """Quantiles of the standard normal law cut to [below, above]."""
    flipped = below > 0
    low, high = np.where(flipped, -above, below), np.where(flipped, -below, above)
    # In the upper tail ndtr is 1 to the last digit: ranges there are mirrored to the lower one.
    first, last = ndtr(low), ndtr(high)
    values = ndtri(first + shares * (last - first))
    return np.asarray(np.clip(np.where(flipped, -values, values), below, above))
