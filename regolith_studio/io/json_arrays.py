"""Arrays in JSON documents: the bytes of each as base64, with its type, its shape and their SHA-256."""

import base64
import hashlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError

KINDS = "biufU"
"""Kinds of arrays: booleans, integers, floats and text; no objects, structures or dates."""


def arrays_document(arrays: Mapping[str, NDArray[Any]]) -> dict[str, dict[str, Any]]:
    """The entries of a document for arrays of numbers or text, in C order and little-endian."""
    return {name: _document(np.asarray(array)) for name, array in arrays.items()}


def arrays_from(document: Mapping[str, Any]) -> dict[str, NDArray[Any]]:
    """The arrays by name: inverse of :func:`arrays_document`.

    Raises
    ------
    FileError
        If the bytes of one are not those that were written, or its type or shape is none.
    """
    return {name: _array(name, entry) for name, entry in document.items()}


def _document(array: NDArray[Any]) -> dict[str, Any]:
    data = np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("<"))
    return {
        "dtype": data.dtype.str,
        "shape": list(array.shape),
        "sha256": hashlib.sha256(data.tobytes()).hexdigest(),
        "base64": base64.b64encode(data.tobytes()).decode("ascii"),
    }


def _array(name: str, entry: Mapping[str, Any]) -> NDArray[Any]:
    try:
        data = base64.b64decode(entry["base64"], validate=True)
        if hashlib.sha256(data).hexdigest() != entry["sha256"]:
            raise FileError(f"The array {name!r} is damaged: its SHA-256 is another than the file states.")
        dtype = np.dtype(entry["dtype"])
        if dtype.kind not in KINDS:
            raise FileError(f"The array {name!r} is one of {dtype}, not of plain numbers or text.")
        return np.frombuffer(data, dtype).reshape(entry["shape"]).astype(dtype.newbyteorder("="))
    except (KeyError, TypeError, ValueError, MemoryError) as error:
        raise FileError(f"The array {name!r} has no bytes, type or shape of an array.") from error
