"""Calibration of the hull field: which features to ask for so that drawn particles have those of the sample.

Moving a surface towards its hull and cutting it at l_max shift the features of
:mod:`~regolith_studio.shape_models.shape_features`, so that others have to be asked for. The powers from the
third degree on are shifted together until the mean sphericity is the sample's; between them, and in their
deviations, they follow the sample's powers. Those of the first two degrees belong to the star point and the
ellipsoid and stay as they are, as does the form, which is set exactly.
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
    """Features to ask for instead of drawn ones: median + shift + spread (drawn - median).

    Parameters
    ----------
    shift, spread
        Shape (d,).
    """

    shift: FloatArray
    spread: FloatArray


@dataclass(frozen=True, eq=False)
class CalibrationTarget:
    """Features that drawn particles should have.

    Parameters
    ----------
    mean, deviation
        Of the features, shape (d,).
    outer
        Outer features of the measured particles, shape (n, 3).
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
        wanted, found = (np.quantile(table, _QUANTILES, axis=0) for table in (self.outer, outer))
        return float((np.abs(found - wanted).mean(axis=0) / (self.outer.std(axis=0) + 1e-9)).sum())

    def corrected(
        self, offset: CalibrationOffset, numbers: FloatArray, outer: FloatArray
    ) -> CalibrationOffset:
        """The next offset, where the last one gave features (m, d) and outer features (m, 3)."""
        shift = RATE * (self.mean - numbers.mean(axis=0))
        too_round = outer[:, SPHERICITY].mean() - self.outer[:, SPHERICITY].mean()
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
