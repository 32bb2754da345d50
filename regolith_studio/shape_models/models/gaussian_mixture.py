"""The paper's outlook taken literally (section 4): a mixture of its Gaussian fields of the radius.

Each component is a field of :mod:`~regolith_studio.shape_models.models.gaussian_field`: c_00 is N(mu_k,
s_k^2), c_lm is N(0, A_lk). The number of components is the one with the lowest information criterion of
Bayes. Draws whose radius is not positive are rejected and counted; ``mixture_field`` is the same for ln r,
where there are none.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray, locked_floats
from regolith_studio.harmonics.coefficients import degrees
from regolith_studio.messages import N_
from regolith_studio.shape_models.chunked_sampling import ChunkedSampler, accepted, chunks
from regolith_studio.shape_models.mixture import (
    MixtureSettings,
    NamedComponents,
    chosen_mixture,
    component_names,
)
from regolith_studio.shape_models.protocol import SizeRange
from regolith_studio.shape_models.realizations import Realizations, acceptable
from regolith_studio.shape_models.sample import Sample
from regolith_studio.shape_models.size_law import checked_bounds

KEY = "gaussian_mixture"


@dataclass(frozen=True, eq=False)
class GaussianMixture(NamedComponents, ChunkedSampler):
    """A fitted mixture, the component with the largest share first.

    Parameters
    ----------
    weights
        Shares by number, before draws are thrown away, shape (k,).
    means
        mu_k, shape (k,).
    spectra
        A_lk, with the variance of c_00 as A_0k, shape (k, l_max + 1).
    unit
        Length unit of the sample.
    bic
        Criterion for 1, 2, ... components; empty if the number was given.
    names
        Of the components, for display.
    labels
        Most probable component of each measured particle, shape (n,).

    Raises
    ------
    InputError
        If a share or variance is negative, or there are not as many names as components.
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
        object.__setattr__(self, "spectra", locked_floats(self.spectra, (k, None), "spectra"))
        if not ((self.spectra >= 0).all() and (self.weights >= 0).all() and self.weights.sum() > 0):
            raise InputError("Shares and variances of a mixture must not be negative.")
        object.__setattr__(self, "bic", tuple(float(value) for value in self.bic))
        object.__setattr__(self, "names", component_names(self.names, k))

    def __reduce__(self) -> tuple[Callable[..., "GaussianMixture"], tuple[Any, ...]]:
        fields = (self.weights, self.means, self.spectra, self.unit, self.bic, self.names, self.labels)
        return GaussianMixture, fields

    def draw_chunks(self, n: int, seed: int, size_range: SizeRange | None = None) -> Iterator[Realizations]:
        """`n` particles with a positive radius, and in the range of equivalent radii if given.

        Raises
        ------
        InputError
            If `n` is negative, the range is none, or hardly any draw is acceptable.
        """
        bounds = checked_bounds(size_range)
        for rng, wanted in chunks(n, seed):
            rows, rejected = accepted(partial(self._propose, rng), partial(_acceptable, bounds), wanted)
            component = rows[:, -1].astype(np.int64)
            yield Realizations(rows[:, :-1], "radius", KEY, seed, self.unit, rejected, components=component)

    def _propose(self, rng: np.random.Generator, n: int) -> FloatArray:
        """Coefficients, and the component of each in a last column."""
        component = rng.choice(len(self.weights), n, p=self.weights / self.weights.sum())
        length = (self.l_max + 1) ** 2
        rows = rng.standard_normal((n, length)) * np.sqrt(self.spectra)[component][:, degrees(length)]
        rows[:, 0] += self.means[component]
        return np.column_stack([rows, component])

    def stored(self) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
        """Plain values for JSON; the labels of the measured particles."""
        values = {
            "weights": self.weights.tolist(),
            "means": self.means.tolist(),
            "spectra": self.spectra.tolist(),
            "unit": self.unit,
            "bic": list(self.bic),
            "names": list(self.names),
        }
        return values, {} if self.labels is None else {"labels": self.labels}


def _acceptable(bounds: SizeRange | None, rows: FloatArray) -> BoolArray:
    return acceptable(bounds, np.ascontiguousarray(rows[:, :-1]))


class GaussianMixtureModel:
    """Expectation and maximisation on c_00 and the power of each degree."""

    key = KEY
    label = N_("Mixture of the paper's fields")
    summary = N_(
        "The paper's outlook: constituents with sizes and spectra of their own, in the radius itself."
    )
    Settings = MixtureSettings

    def fit(self, sample: Sample, settings: MixtureSettings | None = None) -> GaussianMixture:
        """The mixture of a sample.

        Raises
        ------
        InputError
            If there are fewer than four particles for each component, or the sample is not expanded so far.
        """
        chosen = settings or MixtureSettings()
        rows = sample.truncated(chosen.l_max).coefficients
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
            values["spectra"],
            str(values["unit"]),
            tuple(values["bic"]),
            tuple(values["names"]),
            arrays.get("labels"),
        )


MODEL = GaussianMixtureModel()
