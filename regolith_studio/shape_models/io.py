"""The file of a fitted model: JSON with its values, arrays and provenance."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.errors import FileError, GeometryError
from regolith_studio.harmonics.coefficients import CONVENTION
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.json_text import json_bytes
from regolith_studio.io.own_files import arrays_document, arrays_from
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.protocol import FittedModel
from regolith_studio.shape_models.realizations import virtual_mesh

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
