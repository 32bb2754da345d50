"""Files that this program wrote itself and reads back: arrays (``.npz``), states (``.zip``) and JSON.

They may be damaged, cut short or another's, as any file: one function for each kind, and one sentence.
Arrays within a JSON document are the bytes of each as base64, with its type, its shape and their SHA-256.
"""

import base64
import hashlib
import lzma
import stat
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError, os_error_reason
from regolith_studio.io.json_text import parse_strict_json

MAX_UNPACKED_BYTES = 2_000_000_000
"""Maximum unpacked size of an archive."""
MAX_JSON_BYTES = 320_000_000

_DAMAGE = (
    *(zipfile.BadZipFile, zlib.error, lzma.LZMAError, KeyError, ValueError, TypeError, IndexError, EOFError),
    *(RuntimeError, MemoryError, OverflowError, SyntaxError),
)
"""What zipfile, zlib and NumPy raise for bytes that nobody wrote: also encryption, methods and recursion."""


def read_arrays(path: Path, what: str) -> dict[str, NDArray[Any]]:
    """All arrays of a ``.npz`` file by their names; no objects.

    ``what``: it is to hold, for the message: ``shapes of a run``.

    Raises FileError if it cannot be read, is damaged, or would unpack to more than MAX_UNPACKED_BYTES.
    """
    check_regular(path)
    with _said(path, what):
        _check_unpacked(path)
        with np.load(path, allow_pickle=False) as content:
            return {name: np.asarray(content[name]) for name in content.files}


def read_archive(path: Path, what: str) -> dict[str, bytes]:
    """The bytes of all files of a ZIP archive by their names.

    Raises FileError as :func:`read_arrays`.
    """
    check_regular(path)
    with _said(path, what):
        _check_unpacked(path)
        with zipfile.ZipFile(path) as archive:
            return {name: archive.read(name) for name in archive.namelist()}


def read_json(path: Path, largest: int = MAX_JSON_BYTES) -> Any:
    """A JSON document, as :func:`~regolith_studio.io.json_text.parse_strict_json` reads it.

    Raises FileError if it cannot be read, is larger than that many bytes, or is no strict JSON in UTF-8.
    """
    check_regular(path)
    try:
        if path.stat().st_size > largest:
            raise FileError(f"{path} is larger than {largest // 1_000_000} MB.")
        return parse_strict_json(path.read_text("utf-8"), str(path))
    except OSError as error:
        raise FileError(f"{path} cannot be read: {os_error_reason(error)}.") from error
    except UnicodeDecodeError as error:
        raise FileError(f"{path} is not UTF-8 text.") from error


def check_regular(path: Path) -> None:
    """Check that a path is that of a file: a pipe would be waited for, and a device has no end.

    Raises FileError if it is none, or not there.
    """
    try:
        mode = path.stat().st_mode
    except OSError as error:
        raise FileError(f"{path} cannot be read: {os_error_reason(error)}.") from error
    except ValueError as error:
        raise FileError(f"{str(path)!r} cannot be the name of a file.") from error
    if not stat.S_ISREG(mode):
        raise FileError(f"{path} is a folder, a device or a pipe, not a file.")


@contextmanager
def _said(path: Path, what: str) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise FileError(f"{path} cannot be read: {os_error_reason(error)}.") from error
    except _DAMAGE as error:
        raise FileError(f"{path} holds no {what} of this program, or is damaged.") from error


def _check_unpacked(path: Path) -> None:
    with zipfile.ZipFile(path) as archive:
        if sum(entry.file_size for entry in archive.infolist()) > MAX_UNPACKED_BYTES:
            raise FileError(f"{path} would unpack to more than {MAX_UNPACKED_BYTES // 10**9} GB.")


KINDS = "biufU"
"""Kinds of arrays: booleans, integers, floats and text; no objects, structures or dates."""


def arrays_document(arrays: Mapping[str, NDArray[Any]]) -> dict[str, dict[str, Any]]:
    """The entries of a document for arrays of numbers or text, in C order and little-endian."""
    return {name: _document(np.asarray(array)) for name, array in arrays.items()}


def arrays_from(document: Mapping[str, Any]) -> dict[str, NDArray[Any]]:
    """The arrays by name: inverse of :func:`arrays_document`.

    Raises FileError if the bytes of one are not those that were written, or its type or shape is none.
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
