"""A mixture of Gaussian fields, which the paper names as future work (sections 3.1 and 4).

Each component has a log-normal law of sizes and a spectrum of ln(r / r_eq): the constituents of a mixed
material, or size classes of different shape. In ln r, so that no draw has a negative radius. The number of
components is the one with the lowest information criterion of Bayes.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray, locked_floats
from regolith_studio.harmonics.coefficients import degrees
from regolith_studio.messages import N_
from regolith_studio.shape_models.chunked_sampling import CHUNK, ChunkedSampler, chunks
from regolith_studio.shape_models.log_radius import log_shapes, sized
from regolith_studio.shape_models.mixture import (
    MixtureSettings,
    NamedComponents,
    chosen_mixture,
    component_names,
)
from regolith_studio.shape_models.protocol import SizeRange
from regolith_studio.shape_models.realizations import Realizations
from regolith_studio.shape_models.sample import Sample
from regolith_studio.shape_models.size_law import LogNormalSizes, checked_bounds

KEY = "mixture_field"


@dataclass(frozen=True, eq=False)
class MixtureField(NamedComponents, ChunkedSampler):
    """A fitted mixture, the component with the largest share first.

    Parameters
    ----------
    sizes
        Log-normal laws of the components with their shares by number.
    spectra
        A_l of ln r, shape (k, l_max + 1).
    unit
        Length unit of the sample.
    bic
        Criterion for 1, 2, ... components; empty if the number was given.
    names
        Of the components, for display.
    labels
        Most probable component of each measured particle that was used, shape (n,).
    """

    sizes: LogNormalSizes
    spectra: FloatArray
    unit: str = "um"
    bic: tuple[float, ...] = ()
    names: tuple[str, ...] = ()
    labels: IntArray | None = None
    key: ClassVar[str] = KEY

    def __post_init__(self) -> None:
        k = len(self.sizes.weights)
        object.__setattr__(self, "spectra", locked_floats(self.spectra, (k, None), "spectra"))
        if not (self.spectra >= 0).all():
            raise InputError("A spectrum needs one variance A_l for each degree, none of them negative.")
        object.__setattr__(self, "bic", tuple(float(value) for value in self.bic))
        object.__setattr__(self, "names", component_names(self.names, k))

    def __reduce__(self) -> tuple[Callable[..., "MixtureField"], tuple[Any, ...]]:
        fields = (self.sizes, self.spectra, self.unit, self.bic, self.names, self.labels)
        return MixtureField, fields

    def draw_chunks(self, n: int, seed: int, size_range: SizeRange | None = None) -> Iterator[Realizations]:
        """`n` particles; `components` of the draws holds the component of each.

        Raises
        ------
        InputError
            If `n` is negative or the range is none.
        """
        bounds = checked_bounds(size_range)
        length = (self.l_max + 1) ** 2
        for rng, wanted in chunks(n, seed):
            radii, component = self.sizes.draw(CHUNK, rng, bounds)
            scales = np.sqrt(self.spectra[component])[:, degrees(length)]
            rows = sized(rng.standard_normal((CHUNK, length)) * scales, radii)[:wanted]
            yield Realizations(rows, "log_radius", KEY, seed, self.unit, components=component[:wanted])

    def stored(self) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
        """Plain values for JSON; the labels of the measured particles."""
        values = {
            "sizes": {name: getattr(self.sizes, name).tolist() for name in self.sizes.__dataclass_fields__},
            "spectra": self.spectra.tolist(),
            "unit": self.unit,
            "bic": list(self.bic),
            "names": list(self.names),
        }
        return values, {} if self.labels is None else {"labels": self.labels}


class MixtureFieldModel:
    """Expectation and maximisation on ln r_eq and the power of each degree."""

    key = KEY
    label = N_("Mixture of fields")
    summary = N_("Constituents with sizes and spectra of their own; their number by Bayes' criterion.")
    Settings = MixtureSettings

    def fit(self, sample: Sample, settings: MixtureSettings | None = None) -> MixtureField:
        """The mixture of a sample.

        Raises
        ------
        InputError
            If there are fewer than four particles for each component, the sample is not expanded so far, or
            fewer than two particles have a positive radius.
        """
        chosen = settings or MixtureSettings()
        shapes = log_shapes(sample.truncated(chosen.l_max))
        logs, powers = np.log(shapes.equivalent_radii), shapes.powers
        best, curve = chosen_mixture(logs, powers, chosen)
        labels = best.responsibilities(logs, powers).argmax(axis=1)
        sizes = LogNormalSizes(best.weights, best.means, best.deviations)
        return MixtureField(sizes, best.spectra, sample.unit, curve, labels=labels)

    def restored(self, values: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> MixtureField:
        """The mixture from its stored values."""
        return MixtureField(
            LogNormalSizes(**values["sizes"]),
            values["spectra"],
            str(values["unit"]),
            tuple(values["bic"]),
            tuple(values["names"]),
            arrays.get("labels"),
        )


MODEL = MixtureFieldModel()
