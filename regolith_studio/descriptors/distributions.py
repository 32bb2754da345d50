"""Distributions of a descriptor over a sample, each particle counting once or by its volume; classes of form.

``weighting="number"`` gives each particle the weight 1, ``"volume"`` its volume: a sieve weighs grains,
a picture counts them, and the two differ much where sizes do.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.geometry.arrays import FloatArray, LockedRecord, locked_floats

WEIGHTINGS = ("number", "volume")


@dataclass(frozen=True, eq=False)
class Distribution(LockedRecord):
    """Values with weights.

    ``values``: rising, shape (n,). ``weights``: share of the sample that each value stands for, sum 1, shape
    (n,).

    Raises ValueError if there are no values, a weight is negative or all are zero.
    """

    values: FloatArray
    weights: FloatArray

    def __post_init__(self) -> None:
        values = locked_floats(self.values, (None,), "values")
        weights = locked_floats(self.weights, (len(values),), "weights")
        if len(values) == 0 or (weights < 0.0).any() or not weights.sum() > 0.0:
            raise ValueError("a distribution needs values, and weights that are positive")
        order = np.argsort(values, kind="stable")
        object.__setattr__(self, "values", locked_floats(values[order], (None,), "values"))
        shares = weights[order] / weights.sum()
        object.__setattr__(self, "weights", locked_floats(shares, (None,), "weights"))

    @property
    def mean(self) -> float:
        """Weighted mean."""
        return float(self.weights @ self.values)

    @property
    def standard_deviation(self) -> float:
        """Weighted standard deviation of the sample."""
        return float(np.sqrt(self.weights @ (self.values - self.mean) ** 2))

    def ecdf(self, at: ArrayLike) -> FloatArray:
        """Share of the sample that is not above each of `at`."""
        cumulated = np.concatenate([[0.0], np.cumsum(self.weights)])
        # Their sum is 1 but for rounding.
        cumulated[-1] = 1.0
        return np.asarray(cumulated[np.searchsorted(self.values, at, side="right")])

    def quantile(self, shares: ArrayLike) -> FloatArray:
        """Smallest value that at least each of `shares` (0 to 1) of the sample is not above.

        Raises ValueError if a share lies outside 0 to 1.
        """
        wanted = np.asarray(shares, dtype=np.float64)
        if ((wanted < 0.0) | (wanted > 1.0)).any():
            raise ValueError(f"shares must lie between 0 and 1, got {wanted}")
        # Sums of weights end a rounding error beside a share: of ten equal ones .8 is reached by the eighth.
        rank = np.searchsorted(np.cumsum(self.weights), wanted - 1e-12, side="left")
        return np.asarray(self.values[np.minimum(rank, len(self.values) - 1)])

    def histogram(self, bins: int | Sequence[float] = 20) -> tuple[FloatArray, FloatArray]:
        """Share of the sample in each bin, shape (k,), and the k + 1 edges of the bins."""
        shares, edges = np.histogram(self.values, bins=bins, weights=self.weights)
        return shares, edges


def distribution(
    sample: Sequence[Mapping[str, float]],
    key: str,
    weighting: str = "number",
    multiplicity: Sequence[float] | None = None,
) -> Distribution:
    """How the descriptor `key` is distributed over a sample of descriptors.

    ``weighting``: ``number`` or ``volume``. ``multiplicity``: how many particles each of the sample stands
    for (Miles and Lantuejoul's weights); by default one.

    Raises ValueError if the sample is empty or the weighting is neither ``number`` nor ``volume``.
    """
    if weighting not in WEIGHTINGS:
        raise ValueError(f"weighting must be one of {WEIGHTINGS}, got {weighting!r}")
    weights = np.array([row["volume"] if weighting == "volume" else 1.0 for row in sample])
    if multiplicity is not None:
        weights = weights * np.asarray(multiplicity, dtype=np.float64)
    return Distribution(np.array([row[key] for row in sample]), weights)


def wasserstein_1(one: Distribution, other: Distribution) -> float:
    """Wasserstein-1 distance, in the unit of the values: the area between the two ECDFs."""
    from scipy.stats import wasserstein_distance  # 30 MB that a window need not hold from its start

    return float(wasserstein_distance(one.values, other.values, one.weights, other.weights))


def kolmogorov_smirnov_distance(one: Distribution, other: Distribution) -> float:
    """Largest difference of the two ECDFs, 0 to 1."""
    places = np.union1d(one.values, other.values)
    return float(np.abs(one.ecdf(places) - other.ecdf(places)).max())


THRESHOLD = 2 / 3
"""Where Zingg drew both lines."""


class ZinggClass(StrEnum):
    """Form of a particle by its three diameters."""

    EQUANT = "equant"
    DISC = "disc"
    ROD = "rod"
    BLADE = "blade"


def zingg_class(descriptors: Mapping[str, float]) -> ZinggClass:
    """Class from the keys ``elongation`` (I/L) and ``flatness`` (S/I)."""
    wide = descriptors["elongation"] >= THRESHOLD
    thick = descriptors["flatness"] >= THRESHOLD
    if wide:
        return ZinggClass.EQUANT if thick else ZinggClass.DISC
    return ZinggClass.ROD if thick else ZinggClass.BLADE
