"""Files that this program wrote itself and reads back: JSON, arrays (``.npz``) and states (``.zip``).

They may be damaged, cut short or another's, as any file: one function for each kind, and one sentence.
Arrays within a JSON document are the bytes of each as base64, with its type, its shape and their SHA-256.
"""

import base64
import hashlib
import json
import lzma
import stat
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from math import isfinite
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError, os_error_reason

UNPRINTABLE = "backslashreplace"
"""What becomes of the bytes of a file's name that are not UTF-8: an escape that JSON reads back."""


class _Pairs(list[tuple[str, Any]]):
    """An object as it stood in the text, duplicates included."""


class _Nonfinite(str):
    """NaN, Infinity or -Infinity, as it stood in the text."""

    __slots__ = ()


def parse_strict_json(text: str, where: str) -> Any:
    """Parse JSON without duplicate keys, NaN and infinities (1e999 included).

    ``where``: what to call the text in messages.

    Raises FileError if the text is not JSON, nests too deeply, repeats a key or holds NaN or an infinity.
    """
    try:
        # json itself keeps the last of equal keys and reads NaN, both without a word.
        loose = json.loads(text, object_pairs_hook=_Pairs, parse_constant=_Nonfinite)
        return _strict(loose, where, "")
    except RecursionError as error:
        raise FileError(f"{where} nests too deeply to be read.") from error
    except json.JSONDecodeError as error:
        raise FileError(f"{where} is not JSON: {error.msg} in line {error.lineno}.") from error
    except ValueError as error:
        raise FileError(f"{where} is not JSON that can be read: {error}.") from error


def _strict(value: Any, where: str, place: str) -> Any:
    if isinstance(value, _Nonfinite) or (isinstance(value, float) and not isfinite(value)):
        raise FileError(f"{where} holds {value} at {place or 'its top'}; only finite numbers are allowed.")
    if isinstance(value, _Pairs):
        result: dict[str, Any] = {}
        for key, inner in value:
            if key in result:
                raise FileError(f"{where} has the key {key!r} twice at {place or 'its top'}.")
            result[key] = _strict(inner, where, f"{place}.{key}" if place else key)
        return result
    if isinstance(value, list):
        return [_strict(inner, where, f"{place}[{index}]") for index, inner in enumerate(value)]
    return value


def canonical_json(value: Any) -> str:
    """ASCII with sorted keys, two spaces a level, lists of numbers on one line, floats by ``repr``.

    Raises ValueError if a number is not finite.
    """
    return _canonical(value, "") + "\n"


def _canonical(value: Any, indent: str) -> str:
    inner = indent + "  "
    if isinstance(value, dict) and value:
        rows = [f"{inner}{json.dumps(key)}: {_canonical(value[key], inner)}" for key in sorted(value)]
        return "{\n" + ",\n".join(rows) + f"\n{indent}}}"
    if isinstance(value, list | tuple) and any(isinstance(item, dict | list | tuple) for item in value):
        return "[\n" + ",\n".join(inner + _canonical(item, inner) for item in value) + f"\n{indent}]"
    return json.dumps(value, allow_nan=False)


def json_bytes(document: Any) -> bytes:
    """UTF-8 with one space a level, keys in the given order, ending in a newline.

    Raises ValueError if a number is not finite.
    """
    return _indented(document, 0).encode("utf-8", UNPRINTABLE) + b"\n"


class JsonListWriter:
    """Writes a JSON list item by item; the bytes are those of :func:`json_bytes` for the whole.

    ``head``: entries before the list in the object that contains it; without it the list is the whole
    document. ``key``: of the list in that object.
    """

    def __init__(self, stream: IO[bytes], head: Mapping[str, Any] | None = None, key: str = "") -> None:
        self._stream = stream
        self._depth = 0 if head is None else 1
        self._count = 0
        if head is None:
            self._write("[")
        else:
            self._write(f'{_indented(head, 0)[:-2]},\n "{key}": [')

    def add(self, value: Any) -> None:
        """Write one more item."""
        comma, margin = "," if self._count else "", " " * (self._depth + 1)
        self._write(f"{comma}\n{margin}{_indented(value, self._depth + 1)}")
        self._count += 1

    def close(self, tail: Mapping[str, Any] | None = None) -> None:
        """Write the end of the list, and the entries after it in the object that contains it."""
        self._write(f"\n{' ' * self._depth}]" if self._count else "]")
        for key, value in (tail or {}).items():
            self._write(f',\n "{key}": {_indented(value, 1)}')
        self._write("\n}\n" if self._depth else "\n")

    def _write(self, text: str) -> None:
        self._stream.write(text.encode("utf-8", UNPRINTABLE))


def _indented(value: Any, depth: int) -> str:
    text = json.dumps(value, indent=1, ensure_ascii=False, allow_nan=False)
    return text.replace("\n", "\n" + " " * depth)


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
    with _reported(path, what):
        _check_unpacked(path)
        with np.load(path, allow_pickle=False) as content:
            return {name: np.asarray(content[name]) for name in content.files}


def read_archive(path: Path, what: str) -> dict[str, bytes]:
    """The bytes of all files of a ZIP archive by their names.

    Raises FileError as :func:`read_arrays`.
    """
    check_regular(path)
    with _reported(path, what):
        _check_unpacked(path)
        with zipfile.ZipFile(path) as archive:
            return {name: archive.read(name) for name in archive.namelist()}


def read_json(path: Path) -> Any:
    """A JSON document, as :func:`~regolith_studio.io.own_files.parse_strict_json` reads it.

    Raises FileError if it cannot be read, is too large, or is no strict JSON in UTF-8.
    """
    check_regular(path)
    try:
        if path.stat().st_size > MAX_JSON_BYTES:
            raise FileError(f"{path} is larger than {MAX_JSON_BYTES // 1_000_000} MB.")
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
def _reported(path: Path, what: str) -> Iterator[None]:
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
