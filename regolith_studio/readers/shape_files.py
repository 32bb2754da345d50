"""Files that virtual particles can be drawn from: a fitted sample, a fitted model, a material card."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator

from regolith_studio.errors import FileError, InputError, format_validation_error
from regolith_studio.harmonics import io as fit_io
from regolith_studio.harmonics.coefficients import CONVENTION, ShCoefficients
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.sphere_grid import sphere_grid
from regolith_studio.harmonics.synthesis import radii
from regolith_studio.io.atomic import check_listed, listed_hashes
from regolith_studio.io.own_files import arrays_from
from regolith_studio.readers.error_messages import lower_first, message_about, printable
from regolith_studio.readers.sandbox.parent import read_bytes
from regolith_studio.readers.settings import unit_factor
from regolith_studio.shape_models import models as model_io
from regolith_studio.shape_models.materials import MaterialCard, card_from, materials
from regolith_studio.shape_models.protocol import FittedModel
from regolith_studio.shape_models.sample import Sample

MAX_TEXT_BYTES = 512 * 1024**2
REFERENCE_DEGREE = 60
"""Degree of the grid on which a radius is put together that was expanded over an ellipsoid's."""

_NO_SOURCE = (
    "is not a fit, a model of shapes or a material card; “regolith-studio fit” makes a fit of meshes."
)


@dataclass(frozen=True)
class ShapeSource:
    """What particles can be drawn from.

    - ``content``: a sample (to fit a model to), a fitted model, or a card.
    - ``name``: short, for people and for provenance.
    - ``sha256``: of the file's bytes; empty where there is no file.
    - ``notes``: sentences about the source for the user.
    """

    content: Sample | FittedModel | MaterialCard
    name: str
    sha256: str = ""
    notes: tuple[str, ...] = ()


def is_shape_source(text: str) -> bool:
    """Whether this names a shipped material, or a file that :func:`read_shape_source` may read."""
    path = Path(text)
    if path.is_dir():
        return False
    if path.suffix == ".json" or path.exists():
        return path.suffix == ".json"
    return Path(f"{text}.json").is_file() or text in materials()


def read_shape_source(text: str) -> ShapeSource:
    """The fit, model or card whose file, stem or name this is; files come first.

    Raises FileError with one sentence if there is nothing of that name, or it is broken.
    """
    path = _text_file(Path(text))
    if not path.exists() and text in materials():
        return ShapeSource(materials()[text], text)
    content = read_bytes(path, MAX_TEXT_BYTES)
    digest = hashlib.sha256(content).hexdigest()
    check_listed(path.name, digest, listed_hashes(path.parent))
    document = _document(path, content)
    kind = document.get("format")
    try:
        if kind == fit_io.FORMAT:
            return _sample(path, document, digest)
        if kind == model_io.FORMAT:
            return ShapeSource(_model(path, document), path.stem, digest)
        if "relative_amplitudes" in document:
            return ShapeSource(_in_micrometres(card_from(content, path.name)), path.stem, digest)
    except FileError:
        raise
    except InputError as error:
        raise FileError(message_about(path, f"cannot be used: {lower_first(str(error))}")) from None
    raise FileError(message_about(path, _NO_SOURCE))


def radius_of(fit: HarmonicFit) -> ShCoefficients:
    """Coefficients of the radius itself, also of a fit that was expanded over an ellipsoid's radius."""
    if fit.reference is None:
        return fit.coefficients
    grid = sphere_grid(max(REFERENCE_DEGREE, 2 * fit.l_max), fit.l_max)
    return ShCoefficients(grid.expanded(radii(fit, grid.directions)[None])[0])


def _text_file(path: Path) -> Path:
    return path if path.suffix == ".json" else Path(f"{path}.json")


def _document(path: Path, content: bytes) -> Mapping[str, Any]:
    if not content:
        raise FileError(message_about(path, "is empty: it has no bytes at all."))
    try:
        document = json.loads(content)
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        raise FileError(message_about(path, f"is not JSON, or is cut short: it breaks in {place}.")) from None
    except (ValueError, RecursionError):
        raise FileError(message_about(path, "is not JSON.")) from None
    if not isinstance(document, dict):
        raise FileError(message_about(path, _NO_SOURCE))
    return document


def _sample(path: Path, document: Mapping[str, Any], digest: str) -> ShapeSource:
    check_document(FitDocument, document, path, "fit")
    try:
        fits = fit_io.fits_from(document, arrays_from(document["arrays"]))
    except FileError as error:
        raise FileError(message_about(path, f"is a broken fit: {lower_first(str(error))}")) from None
    except (KeyError, TypeError, ValueError):
        reason = "is a broken fit: its arrays are not of the shape or type that a fit has."
        raise FileError(message_about(path, reason)) from None
    if not fits:
        raise FileError(message_about(path, "is a fit without a particle."))
    reached, stated = next(iter(fits.values())).l_max, document["l_max"]
    if reached != stated:
        reason = f"is a broken fit: it states l_max = {stated}, and its coefficients reach up to {reached}."
        raise FileError(message_about(path, reason))
    rows = np.stack([radius_of(fit).values for fit in fits.values()]) * unit_factor(document["unit"])
    expanded = sum(fit.reference is not None for fit in fits.values())
    note = f"{expanded} of {len(fits)} fits are over an ellipsoid; their radii were expanded again."
    return ShapeSource(Sample(rows, tuple(fits)), path.stem, digest, (note,) if expanded else ())


def _model(path: Path, document: Mapping[str, Any]) -> FittedModel:
    check_document(ModelDocument, document, path, "model")
    try:
        model = model_io.model_from(document)
        unit_factor(model.unit)
    except InputError as error:
        raise FileError(message_about(path, f"is a broken model: {lower_first(str(error))}")) from None
    return model


def _in_micrometres(card: MaterialCard) -> MaterialCard:
    factor = unit_factor(card.unit)
    hull_field = card.hull_field if factor == 1 else None  # its numbers are in the unit of the card
    changes = {"median_radius": card.median_radius * factor, "unit": "um", "hull_field": hull_field}
    return card.model_copy(update=changes)


Share = Annotated[float, Field(ge=0.0, le=1.0)]
Positive = Annotated[float, Field(gt=0.0)]
Row = Annotated[list[float], Field(min_length=3, max_length=3)]


class _Document(BaseModel):
    model_config = ConfigDict(frozen=True, strict=True, extra="ignore", allow_inf_nan=False)


class _Ellipsoid(_Document):
    axes: Annotated[list[Row], Field(min_length=3, max_length=3)]
    semi_axes: Annotated[list[Positive], Field(min_length=3, max_length=3)]


class _Grain(_Document):
    name: str
    hidden_surface_share: Share
    unrepresentable_volume_share: Annotated[float, Field(ge=0.0)]
    radial_error: Annotated[float, Field(ge=0.0)]
    largest_radial_error: Annotated[float, Field(ge=0.0)] | None
    reference: _Ellipsoid | None
    rule: str
    sampling_degree: Annotated[int, Field(ge=0)]
    notes: list[str]


class _Array(_Document):
    dtype: str
    shape: list[Annotated[int, Field(ge=0)]]
    sha256: Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]
    base64: str


class _Coefficients(_Document):
    version: Literal[1]
    convention: str
    unit: str

    @field_validator("unit")
    @classmethod
    def _is_known(cls, unit: str) -> str:
        try:
            unit_factor(unit)
        except InputError as error:
            raise ValueError(str(error).rstrip(".")) from None
        return unit

    @field_validator("convention")
    @classmethod
    def _is_ours(cls, convention: str) -> str:
        if convention != CONVENTION:
            raise ValueError("the coefficients follow another one than this program's, which its fits quote")
        return convention


class FitDocument(_Coefficients):
    """A fitted sample."""

    l_max: Annotated[int, Field(ge=0)]
    particles: list[_Grain]
    arrays: dict[str, _Array]

    @field_validator("particles")
    @classmethod
    def _have_their_own_names(cls, particles: list[_Grain]) -> list[_Grain]:
        seen: set[str] = set()
        for each in particles:
            if each.name in seen:
                raise ValueError(f"two of them are called “{printable(each.name)[:40]}”")
            seen.add(each.name)
        return particles


class ModelDocument(_Coefficients):
    """A fitted model."""

    model: str
    values: dict[str, Any]
    arrays: dict[str, _Array]


def check_document(
    kind: type[FitDocument | ModelDocument], document: Mapping[str, Any], path: Path, called: str
) -> None:
    """Validate a document.

    Raises FileError with one sentence: that this is a broken `called`, and the first entry that is wrong.
    """
    try:
        kind.model_validate(document)
    except ValidationError as error:
        reason = format_validation_error(error.errors(include_url=False))
        raise FileError(message_about(path, f"is a broken {called}: {reason}.")) from None
