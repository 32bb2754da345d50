"""The models of particle shape, one module each: their settings, and the file of a fitted one."""

from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from regolith_studio.errors import FileError, GeometryError, InputError
from regolith_studio.harmonics.coefficients import CONVENTION
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.own_files import arrays_document, arrays_from, json_bytes
from regolith_studio.registry import Registry
from regolith_studio.shape_models.protocol import FittedModel
from regolith_studio.shape_models.realizations import virtual_mesh

if TYPE_CHECKING:
    from regolith_studio.shape_models.protocol import ShapeModel


DEFAULT_MODEL = "recombined"
"""The model whose particles are new and have the descriptors of the sample; ``sample_matched`` gives the
sample again, ``log_field`` is the one to extrapolate with."""

MODELS: "Registry[ShapeModel]" = Registry(__name__, "MODEL", "shape_models", order=lambda model: model.key)
"""Every module of this folder that defines ``MODEL``, and entry points of other packages, by key."""


def model_settings(model: str = DEFAULT_MODEL, values: Mapping[str, Any] | None = None) -> Any:
    """The ``Settings`` of a model; what is not given is as the model has it.

    Raises InputError if there is no such model or setting, or a value is of the wrong kind.
    """
    if model not in MODELS:
        raise InputError(f"There is no model called {model!r}; the models are {', '.join(MODELS)}.")
    kind, given = MODELS[model].Settings, dict(values or {})
    names = [field.name for field in fields(kind)]
    unknown = [name for name in given if name not in names]
    if unknown:
        raise InputError(f"{model} has no setting {unknown[0]!r}; it has {', '.join(names)}.")
    try:
        return TypeAdapter(kind).validate_python(given)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(part) for part in first["loc"])
        raise InputError(
            f"The setting {place} of {model} cannot be {first['input']!r}: {first['msg']}."
        ) from None


FORMAT = "regolith-studio model"
N_TRIED, RADII = 50, (1e-9, 1e12)
"""Particles that are drawn of a model that is read, and the limits of their equivalent radii."""


def write_model(path: Path, model: FittedModel, provenance: Mapping[str, Any] | None = None) -> None:
    """Write a model in one step.

    Raises FileError if it cannot be written.
    """
    write_bytes(path, model_bytes(model, provenance))


def model_bytes(model: FittedModel, provenance: Mapping[str, Any] | None = None) -> bytes:
    """The file of a model; the same model gives the same bytes.

    ``provenance``: plain values that describe the sample and the settings of the fit.
    """
    values, arrays = model.stored()
    document = {
        "format": FORMAT,
        "version": 1,
        "model": model.key,
        "unit": model.unit,
        "l_max": model.l_max,
        "convention": CONVENTION,
        "provenance": dict(provenance or {}),
        "values": values,
        "arrays": arrays_document(arrays),
    }
    return json_bytes(document)


def model_from(document: Mapping[str, Any]) -> FittedModel:
    """The model from the content of its file, which ``readers.shape_files`` reads.

    Raises FileError if it is damaged, or holds no model, or one that draws particles of no finite size.
    """
    try:
        key, values, arrays = document["model"], document["values"], arrays_from(document["arrays"])
        if key not in MODELS:
            raise FileError(f"There is no model called {key!r}, only {', '.join(MODELS)}.")
        model = MODELS[key].restored(values, arrays)
        # Values may each be possible and together impossible: only a draw shows what the file would do.
        with np.errstate(all="ignore"):
            draws = model.draw(N_TRIED, 0)
            radii = draws.equivalent_radii()
            virtual_mesh(draws, 0, level=1)
        if not ((radii > RADII[0]) & (radii < RADII[1])).all():
            raise ValueError("the sizes overflow")
        return model
    except (
        KeyError,
        TypeError,
        ValueError,
        AttributeError,
        LookupError,
        OverflowError,
        GeometryError,
    ) as error:
        raise FileError("Its values are impossible for a model of its kind; fit it again.") from error
