"""The paper's outlook taken literally (section 4): a mixture of its Gaussian fields of the radius.

Each component is a field of :mod:`~regolith_studio.shape_models.models.gaussian_field`: c_00 is N(mu_k,
s_k^2), c_lm is N(0, A_lk). The number of components is the one with the lowest information criterion of
Bayes. Draws whose radius is not positive are rejected and counted; ``mixture_field`` is the same for ln r,
where there are none.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray, locked_floats
from regolith_studio.harmonics.coefficients import degrees
from regolith_studio.messages import N_
from regolith_studio.shape_models.chunked_sampling import RejectionSampler
from regolith_studio.shape_models.mixture import (
    MixtureSettings,
    NamedComponents,
    chosen_mixture,
    restored_components,
)
from regolith_studio.shape_models.sample import Sample

KEY = "gaussian_mixture"


@dataclass(frozen=True, eq=False)
class GaussianMixture(NamedComponents, RejectionSampler):
    """A fitted mixture, the component with the largest share first.

    - ``weights``: shares by number, before draws are thrown away, shape (k,).
    - ``means``: mu_k, shape (k,).
    - ``spectra``: a_lk, with the variance of c_00 as A_0k, shape (k, l_max + 1).
    - ``unit``: length unit of the sample.
    - ``bic``: criterion for 1, 2, ... components; empty if the number was given.
    - ``names``: of the components, for display.
    - ``labels``: most probable component of each measured particle, shape (n,).

    Raises InputError if a share or variance is negative, or there are not as many names as components.
    """

    weights: FloatArray
    means: FloatArray
    spectra: FloatArray
    unit: str = "um"
    bic: tuple[float, ...] = ()
    names: tuple[str, ...] = ()
    labels: IntArray | None = None
    key: ClassVar[str] = KEY

    def __post_init__(self) -> None:
        k = len(self.weights)
        object.__setattr__(self, "weights", locked_floats(self.weights, (None,), "weights"))
        object.__setattr__(self, "means", locked_floats(self.means, (k,), "means"))
        self.check_components(k)
        if not ((self.weights >= 0).all() and self.weights.sum() > 0):
            raise InputError("Shares of a mixture must not be negative.")

    def __reduce__(self) -> tuple[Callable[..., "GaussianMixture"], tuple[Any, ...]]:
        fields = (self.weights, self.means, self.spectra, self.unit, self.bic, self.names, self.labels)
        return GaussianMixture, fields

    def relative_amplitudes(self) -> FloatArray:
        """Root of the mean over the components of A_lk / mu_k^2, shape (l_max,)."""
        shares = self.weights / self.weights.sum()
        return np.asarray(np.sqrt(shares @ (self.spectra[:, 1:] / self.means[:, None] ** 2)))

    def propose(self, rng: np.random.Generator, n: int) -> FloatArray:
        """Coefficients of `n` draws, and the component of each in a last column."""
        component = rng.choice(len(self.weights), n, p=self.weights / self.weights.sum())
        length = (self.l_max + 1) ** 2
        rows = rng.standard_normal((n, length)) * np.sqrt(self.spectra)[component][:, degrees(length)]
        rows[:, 0] += self.means[component]
        return np.column_stack([rows, component])

    def stored(self) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
        """Plain values for JSON; the labels of the measured particles."""
        values, arrays = self.stored_components()
        return {"weights": self.weights.tolist(), "means": self.means.tolist(), **values}, arrays


class GaussianMixtureModel:
    """Expectation and maximisation on c_00 and the power of each degree."""

    key = KEY
    label = N_("Mixture of Gaussian fields")
    summary = N_("A mixture of components, each with its own sizes and spectrum, in the radius itself.")
    Settings = MixtureSettings

    def fit(self, sample: Sample, settings: MixtureSettings | None = None) -> GaussianMixture:
        """The mixture of a sample.

        Raises InputError if there are fewer than four particles for each component, or the sample is not
        expanded so far.
        """
        chosen = settings or MixtureSettings()
        rows = sample.truncated(chosen.l_max).coefficients
        # The lowest deviation of a component is a share of the mean.
        scale = float(rows[:, 0].mean())
        powers = np.add.reduceat((rows / scale) ** 2, np.arange(chosen.l_max + 1) ** 2, axis=1)
        powers[:, 0] = 0.0
        sizes = rows[:, 0] / scale
        best, curve = chosen_mixture(sizes, powers, chosen)
        spectra = best.spectra * scale**2
        spectra[:, 0] = (best.deviations * scale) ** 2
        labels = best.responsibilities(sizes, powers).argmax(axis=1)
        return GaussianMixture(best.weights, best.means * scale, spectra, sample.unit, curve, labels=labels)

    def restored(self, values: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> GaussianMixture:
        """The mixture from its stored values."""
        return GaussianMixture(
            values["weights"],
            values["means"],
            *restored_components(values, arrays),
        )


MODEL = GaussianMixtureModel()
