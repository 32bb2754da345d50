"""Rows of numbers in text, however they are separated; runs in the guarded child process only."""

import math
import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import printable
from regolith_studio.readers.units import unit_named

COMMENTS = (b"#", b"%", b"!", b"//")
MAX_COLUMNS = 1000
MAX_UNIT = 12
_NUMBER = re.compile(rb"[+-]?(\d|\.\d|nan|inf)", re.IGNORECASE)


@dataclass(frozen=True)
class NumberRows:
    """A table of text.

    Parameters
    ----------
    names
        The column names of its header line; empty where there is none.
    numbers
        Shape (n, columns), float64; whatever is not finite is kept.
    units
        Units of the columns from a second header line; empty where there is none.
    """

    names: tuple[str, ...]
    numbers: NDArray[np.float64]
    units: tuple[str, ...] = ()


def number_rows(
    data: bytes, skip_headers: int = 1, numeric_headers: int = 0, with_units: bool = False
) -> NumberRows:
    """The rows of a text of numbers with at most `skip_headers` lines of words before them.

    With `with_units`, a line of units may follow the header.
    Up to `numeric_headers` first rows of numbers may have another number of columns; they are ignored.

    Spaces, tabs, commas and semicolons separate; where semicolons do, a comma is a decimal comma.
    Lines that begin with ``#``, ``%``, ``!`` or ``//`` are comments, the last of which may name the columns.

    Raises
    ------
    FileError
        With the second half of a sentence that names the first line that is no row of numbers.
    """
    if not data:
        raise FileError("is empty: it has no bytes at all.")
    if b"\0" in data[:4096]:
        raise FileError("is not a text of numbers: it holds zero bytes.")
    lines = [(number, line) for number, raw in enumerate(data.splitlines(), 1) if (line := raw.strip())]
    header, units, first = _header(lines, skip_headers, with_units)
    words = _rows(lines[first:], numeric_headers)
    width = len(words[0])
    if width > MAX_COLUMNS:
        raise FileError(f"has {width:,} columns; at most {MAX_COLUMNS:,} are read.")
    return NumberRows(_names(header, width), _numbers(words, data), _names(units, width))


def _header(lines: list[tuple[int, bytes]], skip_headers: int, with_units: bool) -> tuple[bytes, bytes, int]:
    """The line with the names of the columns, that with their units, and the index of the first row."""
    header = units = comment = b""
    headers = 0
    for place, (number, line) in enumerate(lines):
        if line.startswith(COMMENTS):
            comment = line
        elif _NUMBER.match(line):
            return header or comment.lstrip(b"#%!/"), units, place
        elif with_units and header and _are_units(line):
            units = line
        else:
            header, headers = line, headers + 1
            if headers > skip_headers:
                raise FileError(f"is not a table of numbers: line {number:,} begins with “{_shown(line)}”.")
    raise FileError("holds no row of numbers.")


def _rows(lines: list[tuple[int, bytes]], numeric_headers: int) -> list[list[bytes]]:
    """The words of the rows, each as many as in the first one."""
    words: list[list[bytes]] = []
    decimal_comma = b";" in lines[0][1] and b"," in lines[0][1]
    for number, line in lines:
        if line.startswith(COMMENTS):
            continue
        row = _row(line, decimal_comma)
        if words and len(row) != len(words[0]):
            if len(words) > numeric_headers:
                raise FileError(
                    f"has {len(row)} columns in line {number:,} and {len(words[0])} in the first row."
                )
            words = []
        words.append(row)
    return words


def _are_units(line: bytes) -> bool:
    """Whether a line names a length between its separators, and words that may be units otherwise."""
    words = [word.strip(" \t\"'[]()") for word in re.split(r"[,;\t ]", line.decode("utf-8", "replace"))]
    return any(map(unit_named, words)) and all(len(word) <= MAX_UNIT for word in words)


def _row(line: bytes, decimal_comma: bool) -> list[bytes]:
    if decimal_comma:
        return [word.strip() for word in line.replace(b",", b".").rstrip(b";").split(b";")]
    if b"," in line or b";" in line:
        separator = b";" if b";" in line else b","
        return [word.strip() for word in line.removesuffix(separator).split(separator)]
    return line.split()


def _numbers(words: list[list[bytes]], data: bytes) -> NDArray[np.float64]:
    try:
        return np.array([list(map(float, row)) for row in words])
    except ValueError:
        pass
    for row, each in enumerate(words):
        for column, word in enumerate(each, start=1):
            try:
                float(word)
            except ValueError:
                raise FileError(
                    f"has “{_shown(word)}” where a number belongs, in row {row + 1:,}, column {column}"
                    f"{' (write decimal points, not commas)' if b',' in data else ''}."
                ) from None
    raise FileError("is not a table of numbers.")


def _names(line: bytes, width: int) -> tuple[str, ...]:
    """The header's words as names, if there are as many as columns."""
    text = printable(line.decode("utf-8", "replace")).strip()
    for separator in (",", ";", "\t", None):
        if separator is None or separator in text:
            names = tuple(word.strip().strip("\"'") for word in text.split(separator))
            return names if len(names) == width else ()
    return ()


def _shown(word: bytes) -> str:
    return printable(word[:24].decode("utf-8", "replace"))


def float_or_nan(word: str | bytes) -> float:
    """The number that a word is, or not a number."""
    try:
        return float(word)
    except ValueError:
        return math.nan
