"""A mixture of Gaussian fields, which the paper names as future work (sections 3.1 and 4).

Each part has a log-normal law of sizes and a spectrum of ln(r / r_eq): the constituents of a mixed material,
or size classes of different shape. In ln r, so that no draw has a negative radius. The number of parts is the
one with the lowest information criterion of Bayes.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray, locked_floats
from regolith_studio.harmonics.coefficients import degrees
from regolith_studio.model.chunks import CHUNK, chunks, joined
from regolith_studio.model.draws import Draws
from regolith_studio.model.log_shapes import log_shapes, sized
from regolith_studio.model.mixture import Mixture, fit_mixture
from regolith_studio.model.protocol import SizeRange
from regolith_studio.model.sample import Sample
from regolith_studio.model.size_law import LogNormalSizes, checked_bounds

KEY = "mixture_field"


@dataclass(frozen=True)
class MixtureFieldSettings:
    """Parameters
    ----------
    l_max
        Degree of ln r.
    n_components
        Number of parts, or ``None`` for the best by the criterion.
    most_components
        Highest number tried.
    n_starts
        Starts for each number; the most likely one is kept.
    seed
        Of the starts.
    """

    l_max: int = 10
    n_components: int | None = None
    most_components: int = 8
    n_starts: int = 2
    seed: int = 0


@dataclass(frozen=True, eq=False)
class MixtureField:
    """The parts, the largest share first.

    Parameters
    ----------
    sizes
        Log-normal laws of the parts with their shares by number.
    spectra
        A_l of ln r, shape (k, l_max + 1).
    unit
        Length unit of the sample.
    bic
        Criterion for 1, 2, ... parts; empty if the number was given.
    names
        Of the parts, for people.
    labels
        Most probable part of each measured particle that was used, shape (n,).
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
        names = tuple(self.names) or tuple(f"part {i + 1}" for i in range(k))
        object.__setattr__(self, "names", names)
        if len(names) != k:
            raise ValueError(f"{k} parts cannot have {len(names)} names")

    def __reduce__(self) -> tuple[Callable[..., "MixtureField"], tuple[Any, ...]]:
        fields = (self.sizes, self.spectra, self.unit, self.bic, self.names, self.labels)
        return MixtureField, fields

    @property
    def l_max(self) -> int:
        """Degree of ln r."""
        return int(self.spectra.shape[1]) - 1

    @property
    def n_components(self) -> int:
        """Number of parts."""
        return len(self.spectra)

    def renamed(self, names: Sequence[str]) -> "MixtureField":
        """The same mixture with other names for its parts."""
        return replace(self, names=tuple(names))

    def draw(self, n: int, seed: int, size_range: SizeRange | None = None) -> Draws:
        """`n` particles; `components` of the draws tells the part of each.

        Raises
        ------
        InputError
            If `n` is negative or the range is none.
        """
        bounds, parts = checked_bounds(size_range), []
        length = (self.l_max + 1) ** 2
        for rng, wanted in chunks(n, seed):
            radii, component = self.sizes.draw(CHUNK, rng, bounds)
            scales = np.sqrt(self.spectra[component])[:, degrees(length)]
            rows = sized(rng.standard_normal((CHUNK, length)) * scales, radii)[:wanted]
            parts.append(Draws(rows, "log_radius", KEY, seed, self.unit, components=component[:wanted]))
        return joined(parts, Draws(np.empty((0, length)), "log_radius", KEY, seed, self.unit))

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
    label = "Mixture of fields"
    summary = "Constituents with sizes and spectra of their own; their number by Bayes' criterion."
    Settings = MixtureFieldSettings

    def fit(self, sample: Sample, settings: MixtureFieldSettings | None = None) -> MixtureField:
        """The mixture of a sample.

        Raises
        ------
        InputError
            If there are fewer than four particles for each part, the sample is not expanded so far, or fewer
            than two particles have a positive radius.
        """
        chosen = settings or MixtureFieldSettings()
        if chosen.l_max < 1:
            raise InputError(
                f"A mixture tells parts by their spectra and needs l_max of at least 1, got {chosen.l_max}."
            )
        shapes = log_shapes(sample.truncated(chosen.l_max))
        logs, powers = np.log(shapes.equivalent_radii), shapes.powers
        numbers = self._numbers(len(logs), chosen)
        fits = [_best_start(logs, powers, k, chosen) for k in numbers]
        bic = [fit.bic(len(logs)) for fit in fits]
        best = fits[int(np.argmin(bic))]
        labels = best.responsibilities(logs, powers).argmax(axis=1)
        curve = tuple(bic) if chosen.n_components is None else ()
        sizes = LogNormalSizes(best.weights, best.means, best.deviations)
        return MixtureField(sizes, best.spectra, sample.unit, curve, labels=labels)

    def _numbers(self, n: int, chosen: MixtureFieldSettings) -> list[int]:
        if chosen.n_components is None:
            return list(range(1, max(1, min(chosen.most_components, n // 4)) + 1))
        if not 1 <= chosen.n_components <= max(1, n // 4):
            raise InputError(
                f"{n} particles are enough for 1 to {max(1, n // 4)} parts, got {chosen.n_components}: four "
                "particles are needed for each."
            )
        return [chosen.n_components]

    def restored(self, values: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> MixtureField:
        """The mixture from what it stored."""
        return MixtureField(
            LogNormalSizes(**values["sizes"]),
            values["spectra"],
            str(values["unit"]),
            tuple(values["bic"]),
            tuple(values["names"]),
            arrays.get("labels"),
        )


def _best_start(logs: FloatArray, powers: FloatArray, k: int, chosen: MixtureFieldSettings) -> Mixture:
    starts = 1 if k == 1 else chosen.n_starts
    generators = [
        np.random.default_rng(np.random.SeedSequence(chosen.seed, spawn_key=(k, i))) for i in range(starts)
    ]
    return max((fit_mixture(logs, powers, k, rng) for rng in generators), key=lambda fit: fit.log_likelihood)


MODEL = MixtureFieldModel()
