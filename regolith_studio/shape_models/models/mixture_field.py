"""A mixture of Gaussian fields, which the paper names as future work (sections 3.1 and 4).

Each component has a log-normal law of sizes and a spectrum of ln(r / r_eq): the constituents of a mixed
material, or size classes of different shape. In ln r, so that no draw has a negative radius. The number of
components is the one with the lowest information criterion of Bayes.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.harmonics.coefficients import degrees
from regolith_studio.messages import N_
from regolith_studio.shape_models.chunked_sampling import SizedSampler
from regolith_studio.shape_models.models.gaussian_mixture import (
    MixtureSettings,
    NamedComponents,
    chosen_mixture,
    restored_components,
)
from regolith_studio.shape_models.sample import Sample, log_shapes
from regolith_studio.shape_models.size_law import LogNormalSizes

KEY = "mixture_field"


@dataclass(frozen=True, eq=False)
class MixtureField(NamedComponents, SizedSampler):
    """A fitted mixture, the component with the largest share first.

    - ``sizes``: log-normal laws of the components with their shares by number.
    - ``spectra``: a_l of ln r, shape (k, l_max + 1).
    - ``unit``: length unit of the sample.
    - ``bic``: criterion for 1, 2, ... components; empty if the number was given.
    - ``names``: of the components, for display.
    - ``labels``: most probable component of each measured particle that was used, shape (n,).
    """

    sizes: LogNormalSizes
    spectra: FloatArray
    unit: str = "um"
    bic: tuple[float, ...] = ()
    names: tuple[str, ...] = ()
    labels: IntArray | None = None
    key: ClassVar[str] = KEY

    def __post_init__(self) -> None:
        self.check_components(len(self.sizes.weights))

    def __reduce__(self) -> tuple[Callable[..., "MixtureField"], tuple[Any, ...]]:
        fields = (self.sizes, self.spectra, self.unit, self.bic, self.names, self.labels)
        return MixtureField, fields

    def relative_amplitudes(self) -> FloatArray:
        """Root of the mean over the components of A_lk / 4 pi, shape (l_max,)."""
        shares = self.sizes.weights / self.sizes.weights.sum()
        return np.asarray(np.sqrt(shares @ self.spectra[:, 1:] / (4 * np.pi)))

    def shapes(
        self, radii: FloatArray, components: IntArray, rng: np.random.Generator
    ) -> tuple[FloatArray, dict[str, IntArray]]:
        """Fields with the spectra of their components."""
        length = (self.l_max + 1) ** 2
        scales = np.sqrt(self.spectra[components])[:, degrees(length)]
        return rng.standard_normal((len(radii), length)) * scales, {"components": components}

    def stored(self) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
        """Plain values for JSON; the labels of the measured particles."""
        values, arrays = self.stored_components()
        return {"sizes": self.sizes.stored(), **values}, arrays


class MixtureFieldModel:
    """Expectation and maximisation on ln r_eq and the power of each degree."""

    key = KEY
    label = N_("Mixture of fields")
    summary = N_(
        "A mixture of components, each with its own sizes and spectrum; their number by the Bayesian "
        "information criterion."
    )
    Settings = MixtureSettings

    def fit(self, sample: Sample, settings: MixtureSettings | None = None) -> MixtureField:
        """The mixture of a sample."""
        chosen = settings or MixtureSettings()
        shapes = log_shapes(sample.truncated(chosen.l_max))
        logs, powers = np.log(shapes.equivalent_radii), shapes.powers
        best, curve = chosen_mixture(logs, powers, chosen)
        labels = best.responsibilities(logs, powers).argmax(axis=1)
        sizes = LogNormalSizes(best.weights, best.means, best.deviations)
        return MixtureField(sizes, best.spectra, sample.unit, curve, labels=labels)

    def restored(self, values: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> MixtureField:
        """The mixture from its stored values."""
        return MixtureField(LogNormalSizes.restored(values["sizes"]), *restored_components(values, arrays))


MODEL = MixtureFieldModel()
