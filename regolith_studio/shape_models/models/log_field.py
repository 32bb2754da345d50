"""A Gaussian field in the logarithm of the radius, times a law of sizes.

Muinonen's Gaussian random sphere (1996), size-normalised: the radius is positive by construction, so that
nothing is thrown away, and size and shape extrapolate apart. The exponential couples the degrees, which
brings the elongated particles that an isotropic field in r cannot make.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray, LockedRecord, locked_floats
from regolith_studio.harmonics.coefficients import degrees
from regolith_studio.messages import N_
from regolith_studio.settings import setting
from regolith_studio.shape_models.chunked_sampling import SizedSampler
from regolith_studio.shape_models.protocol import checked_amplitudes
from regolith_studio.shape_models.sample import Sample, directed, log_shapes
from regolith_studio.shape_models.size_law import SIZE_LAWS, LogNormalSizes, size_law_from

KEY = "log_field"
SPECTRA = (N_("resampled"), N_("pooled"))
NEIGHBOURS_IN_SIZE = 20
"""A resampled spectrum comes from one of so many measured particles nearest in size."""
SPECTRUM_JITTER = 0.1
"""Standard deviation in ln P_l of the power of a resampled degree."""


@dataclass(frozen=True)
class LogFieldSettings:
    """Settings of the field of ln r.

    - ``l_max``: degree of ln r.
    - ``spectrum``: ``resampled``: each particle has the power per degree of a measured one of its size;
      ``pooled``: one spectrum for all, which can be edited and written on a material card.
    - ``size_law``: key of ``SIZE_LAWS``.
    - ``size_dependent``: whether the pooled spectrum follows a power of size, fitted degree by degree.
    """

    l_max: int = 10
    spectrum: str = setting("resampled", N_("Spectrum"), choices=SPECTRA)
    size_law: str = setting("kernel", N_("Size distribution"), choices=tuple(SIZE_LAWS))
    size_dependent: bool = setting(True, N_("Spectrum depends on size"))


@dataclass(frozen=True, eq=False)
class LogField(SizedSampler, LockedRecord):
    """The field's numbers.

    - ``spectrum``: a_l of ln r, shape (l_max + 1,), A_0 = 0; at `reference_radius`.
    - ``sizes``: law of equivalent radii.
    - ``unit``: length unit of the sample.
    - ``reference_radius``: where the spectrum holds if it depends on size.
    - ``exponents``: a_l is proportional to r_eq to this power, shape (l_max + 1,); zero for none.
    - ``powers``, ``radii``: sum of squares per degree (n, l_max + 1) and equivalent radius (n,) of the
      measured particles, ascending in size, if the spectrum is resampled.

    Raises InputError if a variance is negative or not finite, or the numbers do not go together.
    """

    spectrum: FloatArray
    sizes: LogNormalSizes
    unit: str = "um"
    reference_radius: float = 1.0
    exponents: FloatArray | None = None
    powers: FloatArray | None = None
    radii: FloatArray | None = None
    key: ClassVar[str] = KEY

    def __post_init__(self) -> None:
        values = np.asarray(self.spectrum, dtype=np.float64)
        if values.ndim != 1 or not len(values) or not (np.isfinite(values).all() and (values >= 0).all()):
            raise InputError("A spectrum needs one variance A_l for each degree, none of them negative.")
        object.__setattr__(self, "spectrum", locked_floats(values, (None,), "spectrum"))
        exponents = np.zeros(len(values)) if self.exponents is None else self.exponents
        object.__setattr__(self, "exponents", locked_floats(exponents, values.shape, "exponents"))
        if self.powers is not None and self.radii is not None:
            object.__setattr__(self, "powers", locked_floats(self.powers, (None, len(values)), "powers"))
            object.__setattr__(self, "radii", locked_floats(self.radii, (len(self.powers),), "radii"))

    @property
    def l_max(self) -> int:
        """Degree of ln r."""
        return len(self.spectrum) - 1

    @property
    def resampled(self) -> bool:
        """Whether each particle has the spectrum of a measured one."""
        return self.powers is not None and self.radii is not None

    def relative_amplitudes(self) -> FloatArray:
        """sqrt(A_l / 4 pi), shape (l_max,)."""
        return np.asarray(np.sqrt(self.spectrum[1:] / (4 * np.pi)))

    def with_amplitudes(self, amplitudes: ArrayLike) -> "LogField":
        """The field with one spectrum for all particles: those of measured ones are not resampled."""
        squares = 4 * np.pi * checked_amplitudes(amplitudes, self.l_max) ** 2
        spectrum = np.concatenate([self.spectrum[:1], squares])
        return replace(self, spectrum=spectrum, powers=None, radii=None)

    def shapes(
        self, radii: FloatArray, _components: IntArray, rng: np.random.Generator
    ) -> tuple[FloatArray, dict[str, IntArray]]:
        """Fields with the pooled spectrum, or with those of parents, measured particles of like size."""
        if self.powers is not None and self.radii is not None:
            count = min(NEIGHBOURS_IN_SIZE, len(self.radii))
            first = np.searchsorted(self.radii, radii) - count // 2
            first = np.clip(first, 0, len(self.radii) - count)
            parents = first + rng.integers(count, size=len(radii))
            jitter = np.exp(SPECTRUM_JITTER * rng.standard_normal((len(radii), self.l_max + 1)))
            return directed(self.powers[parents] * jitter, rng), {"parents": parents}
        length = (self.l_max + 1) ** 2
        relative = np.log(radii / self.reference_radius)
        variances = self.spectrum * np.exp(relative[:, None] * self.exponents)
        return rng.standard_normal((len(radii), length)) * np.sqrt(variances)[:, degrees(length)], {}

    def stored(self) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
        """Plain values for JSON, and the measured spectra if there are any."""
        values = {
            "spectrum": self.spectrum.tolist(),
            "sizes": self.sizes.stored(),
            "unit": self.unit,
            "reference_radius": self.reference_radius,
            "exponents": None if self.exponents is None else self.exponents.tolist(),
        }
        if self.powers is None or self.radii is None:
            return values, {}
        return values, {"powers": self.powers, "radii": self.radii}


class LogFieldModel:
    """Pooled or resampled spectrum of ln(r / r_eq), and a law of r_eq."""

    key = KEY
    label = N_("Field in log r")
    summary = N_(
        "Positive by construction; size and spectrum are modelled separately, so that it extrapolates."
    )
    Settings = LogFieldSettings

    def fit(self, sample: Sample, settings: LogFieldSettings | None = None) -> LogField:
        """The field of a sample."""
        chosen = settings or LogFieldSettings()
        if chosen.spectrum not in SPECTRA:
            raise InputError(f"The spectrum must be one of {', '.join(SPECTRA)}, got {chosen.spectrum!r}.")
        if chosen.size_law not in SIZE_LAWS:
            raise InputError(f"The size law must be one of {', '.join(SIZE_LAWS)}, got {chosen.size_law!r}.")
        shapes = log_shapes(sample.truncated(chosen.l_max))
        radii, powers = shapes.equivalent_radii, shapes.powers
        reference = float(np.exp(np.log(radii).mean()))
        exponents = _exponents(powers, radii / reference) if chosen.size_dependent else None
        scales = np.exp(np.log(radii / reference)[:, None] * (0.0 if exponents is None else exponents))
        spectrum = (powers / scales).mean(axis=0) / (2 * np.arange(chosen.l_max + 1) + 1)
        sizes = SIZE_LAWS[chosen.size_law](radii)
        field = LogField(spectrum, sizes, sample.unit, reference, exponents)
        if chosen.spectrum == "pooled":
            return field
        order = np.argsort(radii, kind="stable")  # neighbours in size are neighbours in the arrays
        return replace(field, powers=powers[order], radii=radii[order])

    def restored(self, values: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> LogField:
        """The field from its stored values."""
        return LogField(
            values["spectrum"],
            size_law_from(values["sizes"]),
            str(values["unit"]),
            float(values["reference_radius"]),
            values["exponents"],
            arrays.get("powers"),
            arrays.get("radii"),
        )


def _exponents(powers: FloatArray, relative: FloatArray) -> FloatArray:
    """Slopes of ln P_l over ln r_eq by least squares, shape (l_max + 1,); zero where there is no power.

    Limited to a slope of 4 either way, and zero if the sizes hardly differ.
    """
    logs = np.log(relative) - np.log(relative).mean()
    # Particles of one size leave the slope to rounding.
    if not logs.std() > 1e-3:
        return np.zeros(powers.shape[1])
    floor = np.maximum(powers.mean(axis=0) * 1e-9, 1e-300)
    heights = np.log(np.maximum(powers, floor))
    slopes = logs @ (heights - heights.mean(axis=0)) / (logs @ logs)
    slopes[0] = 0.0
    # A few particles of extreme size can give slopes that make draws beyond the sample explode.
    return np.asarray(np.clip(slopes, -4.0, 4.0))


MODEL = LogFieldModel()
