"""What a field drawn to its hull should come to, and what to ask of it so that it does.

Drawing and cutting shift the numbers of :mod:`~regolith_studio.shape_models.shape_features`, so that
others are asked for.
The powers from the third degree on go up and down together until the mean sphericity is the sample's;
between them, and in their deviations, they follow the sample's powers. Those of the first two degrees belong
to the star point and the ellipsoid and are left alone, as is the form, which is set exactly.
"""

from dataclasses import dataclass

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.shape_models.shape_features import (
    CONVEXITY,
    POWERS,
    SPHERICITY,
    log_shape_features,
    outer_features_of_log_radii,
    outer_features_of_radii,
    shape_features,
)

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
    """What is asked for in place of drawn numbers: median + shift + spread (drawn - median).

    Parameters
    ----------
    shift, spread
        Shape (d,).
    """

    shift: FloatArray
    spread: FloatArray


@dataclass(frozen=True, eq=False)
class CalibrationTarget:
    """What particles should come to.

    Parameters
    ----------
    mean, deviation
        Of the numbers, shape (d,).
    outer
        Outer numbers of the measured particles, shape (n, 3).
    """

    mean: FloatArray
    deviation: FloatArray
    outer: FloatArray

    @classmethod
    def of(cls, coefficients: FloatArray, numbers: FloatArray) -> "CalibrationTarget":
        """That of measured particles, radius functions (n, (l_max + 1)^2) with their numbers (n, d)."""
        return cls(
            numbers.mean(axis=0),
            numbers.std(axis=0),
            outer_features_of_radii(coefficients, numbers[:, CONVEXITY]),
        )

    def distance(self, outer: FloatArray) -> float:
        """Mean difference of quantiles over the standard deviation, summed over the outer numbers."""
        wanted, found = (np.quantile(table, _QUANTILES, axis=0) for table in (self.outer, outer))
        return float((np.abs(found - wanted).mean(axis=0) / (self.outer.std(axis=0) + 1e-9)).sum())

    def corrected(
        self, request: CalibrationOffset, numbers: FloatArray, outer: FloatArray
    ) -> CalibrationOffset:
        """What to ask for next, where the last request came to these numbers (m, d) and (m, 3)."""
        shift = RATE * (self.mean - numbers.mean(axis=0))
        too_round = outer[:, SPHERICITY].mean() - self.outer[:, SPHERICITY].mean()
        shift[_ROUGHNESS] += SPHERICITY_RATE * too_round - shift[_ROUGHNESS].mean()
        ratio = ((self.deviation + 1e-9) / (numbers.std(axis=0) + 1e-9)) ** RATE
        shift[: _ROUGHNESS.start], ratio[: _ROUGHNESS.start], ratio[CONVEXITY] = 0.0, 1.0, 1.0
        return CalibrationOffset(
            np.clip(request.shift + shift, -MAX_SHIFT, MAX_SHIFT), np.clip(request.spread * ratio, *SPREADS)
        )


def measured_features(rows: FloatArray, equivalent_radii: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Numbers (m, d) and outer numbers (m, 3) of drawn particles, expansions of ln r with these sizes."""
    numbers = log_shape_features(rows, equivalent_radii)
    return numbers, outer_features_of_log_radii(rows, numbers[:, CONVEXITY])


def features_and_target(coefficients: FloatArray) -> tuple[FloatArray, CalibrationTarget]:
    """The numbers (n, d) of measured particles, and the aim that they set."""
    numbers = shape_features(coefficients)
    return numbers, CalibrationTarget.of(coefficients, numbers)
