"""The models of particle shape, one module each, and their settings from plain values."""

from collections.abc import Mapping
from dataclasses import fields
from typing import TYPE_CHECKING, Any

from pydantic import TypeAdapter, ValidationError

from regolith_studio.errors import InputError
from regolith_studio.registry import Registry

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
