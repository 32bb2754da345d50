"""What must stand in the JSON of a fitted sample and of a fitted model before it is believed."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator

from regolith_studio.errors import FileError, InputError, of_the_entry
from regolith_studio.harmonics.coefficients import CONVENTION
from regolith_studio.readers.sentences import printable, sentence_about
from regolith_studio.readers.units import unit_factor

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
    """The JSON of a fitted sample; its NPZ holds the coefficients."""

    l_max: Annotated[int, Field(ge=0)]
    particles: list[_Grain]

    @field_validator("particles")
    @classmethod
    def _have_their_own_names(cls, particles: list[_Grain]) -> list[_Grain]:
        seen: set[str] = set()
        for each in particles:
            if each.name in seen:
                raise ValueError(f"two of them are called “{printable(each.name)[:40]}”")
            seen.add(each.name)
        return particles


class _Arrays(_Document):
    sha256: Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]


class ModelDocument(_Coefficients):
    """The JSON of a fitted model; its NPZ holds what does not fit into text."""

    model: str
    values: dict[str, Any]
    arrays: _Arrays


def check_document(
    kind: type[FitDocument | ModelDocument], document: Mapping[str, Any], path: Path, called: str
) -> None:
    """Look whether everything is there, of its type and within its limits.

    Raises
    ------
    FileError
        With one sentence: that this is a broken `called`, and the first entry that is wrong.
    """
    try:
        kind.model_validate(document)
    except ValidationError as error:
        reason = of_the_entry(error.errors(include_url=False))
        raise FileError(sentence_about(path, f"is a broken {called}: {reason}.")) from None
