"""JSON without loopholes: duplicate keys, NaN and infinities (1e999 too) are refused by their place."""

import json
from math import isfinite
from typing import Any

from regolith_studio.errors import DatasetError


class _Pairs(list[tuple[str, Any]]):
    """An object as it stood in the text, duplicates included."""


class _Nonfinite(str):
    """NaN, Infinity or -Infinity, as it stood in the text."""

    __slots__ = ()


def strict_json(text: str, where: str) -> Any:
    """Parse JSON text.

    Parameters
    ----------
    where
        What to call the text in messages.

    Raises
    ------
    DatasetError
        If the text is no JSON, nests too deeply, repeats a key or holds NaN or an infinity.
    """
    try:
        loose = json.loads(text, object_pairs_hook=_Pairs, parse_constant=_Nonfinite)
        return _strict(loose, where, "")
    except RecursionError as error:
        raise DatasetError(f"{where} nests too deeply to be read.") from error
    except json.JSONDecodeError as error:
        raise DatasetError(f"{where} is not JSON: {error.msg} in line {error.lineno}.") from error
    except ValueError as error:
        raise DatasetError(f"{where} is not JSON that can be read: {error}.") from error


def _strict(value: Any, where: str, place: str) -> Any:
    if isinstance(value, _Nonfinite) or (isinstance(value, float) and not isfinite(value)):
        raise DatasetError(f"{where} holds {value} at {place or 'its top'}; only finite numbers are allowed.")
    if isinstance(value, _Pairs):
        result: dict[str, Any] = {}
        for key, inner in value:
            if key in result:
                raise DatasetError(f"{where} has the key {key!r} twice at {place or 'its top'}.")
            result[key] = _strict(inner, where, f"{place}.{key}" if place else key)
        return result
    if isinstance(value, list):
        return [_strict(inner, where, f"{place}[{index}]") for index, inner in enumerate(value)]
    return value


def tidy_json(value: Any) -> str:
    """Sorted keys, two spaces a level, lists of numbers on one line, floats by ``repr``.

    Raises
    ------
    ValueError
        If a number is not finite.
    """
    return _tidy(value, "") + "\n"


def _tidy(value: Any, indent: str) -> str:
    inner = indent + "  "
    if isinstance(value, dict) and value:
        rows = [f"{inner}{json.dumps(key)}: {_tidy(value[key], inner)}" for key in sorted(value)]
        return "{\n" + ",\n".join(rows) + f"\n{indent}}}"
    if isinstance(value, list | tuple) and any(isinstance(item, dict | list | tuple) for item in value):
        return "[\n" + ",\n".join(inner + _tidy(item, inner) for item in value) + f"\n{indent}]"
    return json.dumps(value, allow_nan=False)
