"""JSON: strict reading, writing in a canonical form, and lists that are written item by item."""

import json
from collections.abc import Mapping
from math import isfinite
from typing import IO, Any

from regolith_studio.errors import FileError

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
