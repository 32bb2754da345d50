"""The file of a fitted model: JSON with its values, arrays and provenance."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from regolith_studio.errors import FileError
from regolith_studio.harmonics.coefficients import CONVENTION
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.json_arrays import arrays_document, arrays_from
from regolith_studio.io.json_text import json_bytes
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.protocol import FittedModel

FORMAT = "regolith-studio model"


def write_model(path: Path, model: FittedModel, provenance: Mapping[str, Any] | None = None) -> None:
    """Write a model; the same model gives the same bytes.

    Parameters
    ----------
    provenance
        Plain values that describe the sample and the settings of the fit.

    Raises
    ------
    FileError
        If it cannot be written.
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
    write_bytes(path, json_bytes(document))


def model_from(document: Mapping[str, Any]) -> FittedModel:
    """The model from the content of its file, which ``readers.shape_files`` reads.

    Raises
    ------
    FileError
        If it is damaged, or holds no model.
    """
    try:
        key, values, arrays = document["model"], document["values"], arrays_from(document["arrays"])
        if key not in MODELS:
            raise FileError(f"There is no model called {key!r}, only {', '.join(MODELS)}.")
        return MODELS[key].restored(values, arrays)
    except (KeyError, TypeError, ValueError, AttributeError, LookupError, OverflowError) as error:
        raise FileError("The numbers in it make no model of its kind; fit it again.") from error
