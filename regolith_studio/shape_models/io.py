"""The two files of a fitted model: JSON with its values and provenance, and NPZ with its arrays."""

import hashlib
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.harmonics.coefficients import CONVENTION
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.protocol import FittedModel

FORMAT = "regolith-studio model"


def write_model(
    stem: Path, model: FittedModel, provenance: Mapping[str, Any] | None = None
) -> tuple[Path, Path]:
    """Write ``stem.json`` and ``stem.npz``; the same model gives the same bytes.

    Parameters
    ----------
    provenance
        Plain values that describe the sample and the settings of the fit.
    """
    stem.parent.mkdir(parents=True, exist_ok=True)
    text, numbers = Path(f"{stem}.json"), Path(f"{stem}.npz")
    values, arrays = model.stored()
    packed = io.BytesIO()
    np.savez_compressed(packed, **arrays)  # type: ignore[arg-type]
    document = {
        "format": FORMAT,
        "version": 1,
        "model": model.key,
        "unit": model.unit,
        "l_max": model.l_max,
        "convention": CONVENTION,
        "provenance": dict(provenance or {}),
        "values": values,
        "arrays": {"file": numbers.name, "sha256": hashlib.sha256(packed.getvalue()).hexdigest()},
    }
    text.write_text(json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n", "utf-8")
    numbers.write_bytes(packed.getvalue())
    return text, numbers


def model_from(document: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]], sha256: str) -> FittedModel:
    """The model from the contents of its two files, which ``readers.shape_files`` reads.

    Parameters
    ----------
    sha256
        Of the NPZ file's bytes.

    Raises
    ------
    FileError
        If the files do not belong together, or hold no model.
    """
    try:
        expected, key, values = document["arrays"]["sha256"], document["model"], document["values"]
        if sha256 != expected:
            raise FileError("The two files of the model do not belong together.")
        if key not in MODELS:
            raise FileError(f"There is no model called {key!r}, only {', '.join(MODELS)}.")
        return MODELS[key].restored(values, arrays)
    except (KeyError, TypeError, ValueError, AttributeError, LookupError) as error:
        raise FileError("The numbers in it make no model of its kind; fit it again.") from error
