"""The paper's model: an isotropic Gaussian random field on the sphere (section 2.3).

c_00 is N(mu, A_0), c_lm is N(0, A_l), all independent. Nothing keeps the radius positive: draws whose
radius is not are thrown away and counted, which the paper does not mention.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, LockedRecord, locked_floats
from regolith_studio.harmonics.coefficients import degrees
from regolith_studio.messages import N_
from regolith_studio.shape_models.chunked_sampling import RejectionSampler
from regolith_studio.shape_models.protocol import checked_amplitudes
from regolith_studio.shape_models.sample import Sample

KEY = "gaussian_field"


@dataclass(frozen=True)
class GaussianFieldSettings:
    """Settings of the Gaussian field.

    ``l_max``: degree of the particles; the paper's is 10 (section 3.1).
    """

    l_max: int = 10


@dataclass(frozen=True, eq=False)
class GaussianField(RejectionSampler, LockedRecord):
    """The field's numbers.

    The draws that are kept are larger and rounder than the field (:meth:`rejection_bias`).

    - ``mean``: mu, the mean of c_00.
    - ``spectrum``: A_0 .. A_l_max, shape (l_max + 1,): variance of c_00, and of each c_lm.
    - ``unit``: length unit of the sample.

    Raises InputError if mu is not positive or a variance is negative or not finite.
    """

    mean: float
    spectrum: FloatArray
    unit: str = "um"
    key: ClassVar[str] = KEY

    def __post_init__(self) -> None:
        values = np.asarray(self.spectrum, dtype=np.float64)
        if not (self.mean > 0 and np.isfinite(self.mean)):
            raise InputError(f"The mean of c_00 must be positive, got {self.mean:g}.")
        if values.ndim != 1 or not len(values) or not (np.isfinite(values).all() and (values >= 0).all()):
            raise InputError("A spectrum needs one variance A_l for each degree, none of them negative.")
        object.__setattr__(self, "spectrum", locked_floats(values, (None,), "spectrum"))

    @property
    def l_max(self) -> int:
        """Degree of the particles it draws."""
        return len(self.spectrum) - 1

    def relative_amplitudes(self) -> FloatArray:
        """sqrt(A_l) / mu, shape (l_max,)."""
        return np.asarray(np.sqrt(self.spectrum[1:]) / self.mean)

    def with_amplitudes(self, amplitudes: ArrayLike) -> "GaussianField":
        """The field with another spectrum; A_0 stays."""
        values = checked_amplitudes(amplitudes, self.l_max)
        return replace(self, spectrum=np.concatenate([self.spectrum[:1], (self.mean * values) ** 2]))

    def propose(self, rng: np.random.Generator, n: int) -> FloatArray:
        """Coefficients of `n` draws, and a last column of zeros: the field has one component."""
        length = (self.l_max + 1) ** 2
        rows = rng.standard_normal((n, length)) * np.sqrt(self.spectrum)[degrees(length)]
        rows[:, 0] += self.mean
        return np.column_stack([rows, np.zeros(n)])  # components travel with the rows through rejection

    def stored(self) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
        """Plain values for JSON, no arrays."""
        return {"mean": self.mean, "spectrum": self.spectrum.tolist(), "unit": self.unit}, {}


class GaussianRadiusModel:
    """Unbiased estimates: mu = mean of c_00, A_0 its variance (n - 1), A_l = mean of c_lm^2."""

    key = KEY
    label = N_("Gaussian field")
    summary = N_("Independent normal coefficients; draws with a negative radius are rejected.")
    Settings = GaussianFieldSettings

    def fit(self, sample: Sample, settings: GaussianFieldSettings | None = None) -> GaussianField:
        """The field of a sample; the mean of c_lm for l >= 1 is zero by the model and not subtracted."""
        rows = sample.truncated((settings or GaussianFieldSettings()).l_max).coefficients
        l_max = round(rows.shape[1] ** 0.5) - 1
        sums = np.add.reduceat((rows**2).mean(axis=0), np.arange(l_max + 1) ** 2)
        spectrum = sums / (2 * np.arange(l_max + 1) + 1)
        spectrum[0] = rows[:, 0].var(ddof=1)
        return GaussianField(float(rows[:, 0].mean()), spectrum, sample.unit)

    def restored(self, values: Mapping[str, Any], _arrays: Mapping[str, NDArray[Any]]) -> GaussianField:
        """The field from its stored values."""
        return GaussianField(float(values["mean"]), values["spectrum"], str(values["unit"]))


MODEL = GaussianRadiusModel()
