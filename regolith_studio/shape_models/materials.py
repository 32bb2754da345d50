"""Material cards: a whole model of a material in one small JSON file.

A card holds the relative amplitudes sqrt(A_l) / mu of a size-normalised angular power spectrum and a
log-normal law of sizes: what publications print. The model of such numbers is a field in ln r. To first order
ln(r / mean) = r / mean - 1, so that A_l of ln r is 4 pi times the squared relative amplitude.

Random phases are not the shape of a real material. The card of a sample therefore also holds the numbers of
its hull field with all degrees of the sample, which is then the card's model, and how far 1,000 draws of it
are from the sample.
"""

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, Self

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from regolith_studio.errors import FileError, InputError, format_validation_error, os_error_reason
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.own_files import json_bytes
from regolith_studio.messages import N_, Message, Number, join_messages
from regolith_studio.resources import resource
from regolith_studio.shape_models.goodness_of_fit import relative_wasserstein
from regolith_studio.shape_models.models.hull_field import DEGREES, HullField, HullFieldSettings
from regolith_studio.shape_models.models.hull_field import MODEL as HULL_FIELD_MODEL
from regolith_studio.shape_models.models.log_field import LogField, LogFieldModel, LogFieldSettings
from regolith_studio.shape_models.protocol import FittedModel
from regolith_studio.shape_models.sample import Sample
from regolith_studio.shape_models.shape_features import whole_features_of_log_radii, whole_features_of_radii
from regolith_studio.shape_models.size_law import LogNormalSizes

LARGEST_CARD = 1_000_000
LOG_FIELD, HULL_FIELD = "log_field", "hull_field"
FIELD_DEGREE = 10
"""Of fields in ln r, unless another is asked for, as in section 3.1."""
N_EVALUATED = 1000
EVALUATED = ("equivalent_radius", "aspect_ratio", "sphericity", "convexity")
SPECTRUM_ALONE = N_(
    "Draws differ from their material, those of a card of cement by about 6 % in AR, 9 % in S and 4 % in "
    "V/CH (l_max = 10): the card has a power spectrum and no phases."
)
Amplitude = Annotated[float, Field(ge=0.0, le=1.0)]


class MaterialCard(BaseModel):
    """One material; frozen, and the same in memory and in JSON."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)

    name: str = Field(min_length=1, pattern=r"^[a-z0-9_]+$")
    label: str = Field(min_length=1)
    origin: str = Field(min_length=1, description="Where the numbers come from, one sentence.")
    n_particles: int = Field(ge=2, description="Particles that the statistics were taken of.")
    unit: str = "um"
    median_radius: float = Field(ge=1e-12, le=1e12, description="Median equivalent radius, by number.")
    log_deviation: Annotated[float, Field(gt=0.0, le=5.0)] = Field(description="Of ln r_eq.")
    relative_amplitudes: tuple[Amplitude, ...] = Field(
        min_length=2, description="sqrt(A_l) / mu for l = 1, 2, ..., mu the mean of c_00."
    )

    hull_field: dict[str, Any] | None = Field(
        default=None, description="Numbers of the hull field of the sample; none for published statistics."
    )
    evaluation: dict[str, float] | None = Field(
        default=None,
        description="Wasserstein distance of draws of the hull field to the sample, percent of the mean.",
    )

    measured: tuple[str, ...] = Field(default=(), description="What is measured of the material.")
    assumed: tuple[str, ...] = Field(default=(), description="What is assumed, as it is not known.")
    stated: dict[str, tuple[float, float]] = Field(
        default_factory=dict,
        description="Mean, published or of the sample, and its spread by key of the catalogue, or S/L.",
    )
    drawn: dict[str, float] = Field(default_factory=dict, description="Means of draws, by the same keys.")

    @property
    def missed(self) -> str:
        """A sentence on the stated means that draws miss by more than their spread; empty if none is."""
        missed = [
            f"{key} = {self.drawn[key]:.4g} (stated {mean:g} ± {spread:g})"
            for key, (mean, spread) in self.stated.items()
            if key in self.drawn and abs(self.drawn[key] - mean) > spread
        ]
        sentence = N_("The card cannot be met within its own spread; draws have {means}.")
        return Message(sentence, means=", ".join(missed)) if missed else ""

    @property
    def l_max(self) -> int:
        """Highest degree that the card knows."""
        return len(self.relative_amplitudes)

    @property
    def key(self) -> str:
        """Of its model in ``MODELS``."""
        return LOG_FIELD if self.hull_field is None else HULL_FIELD

    @property
    def evaluated(self) -> str:
        """What the evaluation says and which means are missed, or what a spectrum alone lacks."""
        if self.hull_field is None:
            return SPECTRUM_ALONE
        if self.evaluation is None:
            return self.missed
        differs = Message(
            N_(
                "Draws differ from the sample of the card by {equivalent_radius} % in r_eq, {aspect_ratio} % "
                "in AR, {sphericity} % in S and {convexity} % in V/CH (Wasserstein distance over the mean)."
            ),
            **{key: Number(far, ".2g") for key, far in self.evaluation.items()},
        )
        return join_messages([each for each in (differs, self.missed) if each], " ")

    @classmethod
    def of(cls, sample: Sample, name: str, label: str, origin: str, l_max: int | None = None) -> Self:
        """The card of a sample: its statistics rounded to three digits, its hull field, and their evaluation.

        Samples below l = 3 have no hull field.

        Raises InputError if the sample has no such degree, or its amplitudes are those of no particles.
        """
        degree = sample.l_max if l_max is None else l_max
        settings = LogFieldSettings(degree, "pooled", "log_normal", size_dependent=False)
        field = LogFieldModel().fit(sample, settings)
        radii = sample.star_shaped().equivalent_radii
        hull = _evaluated_hull_field(sample.truncated(degree)) if degree >= DEGREES[0] else {}
        try:
            return cls(
                name=name,
                label=label,
                origin=origin,
                n_particles=len(radii),
                unit=sample.unit,
                median_radius=_rounded(float(np.exp(np.log(radii).mean()))),
                # A log-normal law has no deviation of 0, which particles of one size have.
                log_deviation=_rounded(max(float(np.log(radii).std(ddof=1)), 1e-9)),
                relative_amplitudes=tuple(
                    _rounded(float(value)) for value in np.sqrt(field.spectrum[1:] / (4 * np.pi))
                ),
                **hull,
            )
        except ValidationError as error:
            raise InputError(
                "No material card can be made of the sample: "
                f"{format_validation_error(error.errors(include_url=False))}."
            ) from error

    def model(self, l_max: int | None = None) -> FittedModel:
        """The hull field where the card has one, or else the field in ln r.

        ``l_max``: by default all degrees of the hull field, and up to 10 of the field in ln r.

        Raises InputError if the card does not have this degree.
        """
        if self.hull_field is None:
            return self.field(min(FIELD_DEGREE, self.l_max) if l_max is None else l_max)
        field: HullField = HULL_FIELD_MODEL.restored(self.hull_field, {})
        return field if l_max is None else field.truncated(l_max)

    def field(self, l_max: int = FIELD_DEGREE) -> LogField:
        """The field in ln r of the material.

        Raises InputError if the card does not reach `l_max`.
        """
        if not 1 <= l_max <= self.l_max:
            raise InputError(f"The card {self.name} reaches from l = 1 to {self.l_max}, got l_max = {l_max}.")
        amplitudes = np.array([0.0, *self.relative_amplitudes[:l_max]])
        sizes = LogNormalSizes(
            np.ones(1), np.array([np.log(self.median_radius)]), np.array([self.log_deviation])
        )
        return LogField(4 * np.pi * amplitudes**2, sizes, self.unit, self.median_radius)


def _evaluated_hull_field(sample: Sample) -> dict[str, Any]:
    """Fields of a card: the hull field of a sample, and how far its draws are from the sample.

    The spread of a mean is what 95 of 100 samples of these sizes would have between their means and that of
    their draws. Aspect ratio, sphericity and share of the hull are the outer features of
    :mod:`~regolith_studio.shape_models.shape_features`, on a grid of directions.
    """
    fitted = HULL_FIELD_MODEL.fit(sample, HullFieldSettings(sample.l_max, "log_normal_mixture"))
    draws = fitted.draw(N_EVALUATED, 0)
    measured = sample.star_shaped()
    tables = [
        np.column_stack([radii, np.exp(outer[:, 0]), 1 / (1 + np.exp(-outer[:, 1:]))])
        for radii, outer in (
            (measured.equivalent_radii, whole_features_of_radii(measured.coefficients)),
            (draws.equivalent_radii(), whole_features_of_log_radii(draws.coefficients)),
        )
    ]
    ones = [np.ones(len(table)) for table in tables]
    distances = [relative_wasserstein(*pair, *ones) for pair in zip(tables[0].T, tables[1].T, strict=True)]
    means, drawn = (table.mean(axis=0) for table in tables)
    spreads = 1.96 * np.sqrt(sum(table.var(axis=0, ddof=1) / len(table) for table in tables))
    return {
        "hull_field": fitted.stored()[0],
        "evaluation": {key: _rounded(100 * far) for key, far in zip(EVALUATED, distances, strict=True)},
        "stated": {
            k: (_rounded(m, 4), _rounded(s)) for k, m, s in zip(EVALUATED, means, spreads, strict=True)
        },
        "drawn": {key: _rounded(mean, 4) for key, mean in zip(EVALUATED, drawn, strict=True)},
    }


def materials() -> Mapping[str, MaterialCard]:
    """The shipped cards by name."""
    return MappingProxyType(_shipped())


@cache
def _shipped() -> dict[str, MaterialCard]:
    cards = [read_card(path) for path in sorted(resource("materials").glob("*.json"))]
    return {card.name: card for card in cards}


def read_card(path: Path) -> MaterialCard:
    """A card from its file.

    Raises FileError if the file cannot be read or is no card.
    """
    try:
        return card_from(path.read_bytes(), path.name)
    except OSError as error:
        raise FileError(f"{path.name} cannot be read: {os_error_reason(error)}.") from error


def card_from(content: bytes, name: str) -> MaterialCard:
    """A card from the bytes of the file called `name`.

    Raises FileError if it is no card.
    """
    if len(content) > LARGEST_CARD:
        raise FileError(f"{name} is larger than a material card can be.")
    try:
        return MaterialCard.model_validate_json(content)
    except ValidationError as error:
        raise FileError(
            f"{name} is no material card: {format_validation_error(error.errors(include_url=False))}."
        ) from error


def write_card(card: MaterialCard, path: Path) -> Path:
    """Write the card; the same card gives the same bytes."""
    write_bytes(path, json_bytes(card.model_dump()))
    return path


def _rounded(value: float, digits: int = 3) -> float:
    return float(f"{value:.{digits}g}")
