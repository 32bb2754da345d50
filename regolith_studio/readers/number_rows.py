"""Rows of numbers in text, however they are separated; runs in the guarded child process only."""

import csv
import io
import math
import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import plural, printable
from regolith_studio.readers.settings import unit_named

COMMENTS = (b"#", b"%", b"!", b"//")
MAX_COLUMNS = 1000
MAX_UNIT = 12
_NUMBER = re.compile(rb"[\"']?[+-]?(\d|\.\d|[.,]\d|(nan|inf)\b)", re.IGNORECASE)
_ANNOUNCED = re.compile(rb'"?sep=([;,|]?)"?', re.IGNORECASE)
"""The first line by which Excel is told the separator; that of a tab has lost it."""
_DECIMAL_COMMA = re.compile(rb"[+-]?\d*(,\d+)?([eE][+-]?\d+)?")
_GROUPED = re.compile(rb"[+-]?\d{1,3}(?:([.,' ]|\xc2\xa0|\xe2\x80\xaf|\xe2\x80\x99)\d{3})+([.,]\d+)?")
"""Digits in groups of three."""
_AMBIGUOUS = re.compile(rb"[+-]?[1-9]\d{0,2},\d{3}")


@dataclass(frozen=True)
class NumberRows:
    """A table of text.

    - ``names``: the column names of its header line; empty where there is none, or it has another number of
      words.
    - ``numbers``: shape (n, columns), float64; whatever is not finite is kept.
    - ``units``: units of the columns from a second header line; empty where there is none.
    - ``header``: the line of words before the numbers, or the last comment, which may name the columns.
    - ``has_header``: whether the former is no comment.
    - ``separator``: between the columns; empty for spaces.
    """

    names: tuple[str, ...]
    numbers: NDArray[np.float64]
    units: tuple[str, ...] = ()
    header: str = ""
    has_header: bool = False
    separator: str = ""


@dataclass(frozen=True)
class _Style:
    """How the rows of a text are written: what separates columns (None for spaces), and decimal commas."""

    separator: bytes | None
    decimal_comma: bool
    quoted: bool

    def words(self, line: bytes) -> list[bytes]:
        """The words of a line without their quotes; empty columns at its end do not count."""
        if self.separator is None:
            words = [word.strip(b"\"'") for word in line.split()]
        elif self.quoted:
            text = line.decode("utf-8", "replace")
            row = next(csv.reader([text], delimiter=self.separator.decode(), skipinitialspace=True), [])
            words = [word.strip().encode() for word in row]
        else:
            words = [word.strip() for word in line.split(self.separator)]
        while len(words) > 1 and not words[-1]:
            words.pop()
        return words


def utf8_text(data: bytes) -> bytes:
    """A text as UTF-8: from UTF-8, from UTF-16 without a byte order mark, or from Windows-1252.

    Raises FileError with the second half of a sentence if it is none of them.
    """
    start = data[:4096]
    if b"\0" in start:
        zeros = start[1::2].count(0), start[::2].count(0)
        if max(zeros) < 0.9 * (len(start) // 2) or min(zeros) > 0:
            raise FileError("is not a text of numbers: it holds zero bytes.")
        return data.decode("utf-16-le" if zeros[0] else "utf-16-be", "replace").encode()
    try:
        data.decode("utf-8")
    except UnicodeDecodeError:
        try:
            return data.decode("cp1252").encode()
        except UnicodeDecodeError:
            raise FileError(
                "is not a text of numbers in an encoding that is known (UTF-8, UTF-16, Windows-1252)."
            ) from None
    return data


def number_rows(
    data: bytes, skip_headers: int = 1, numeric_headers: int = 0, with_units: bool = False
) -> NumberRows:
    """The rows of a text of numbers with at most `skip_headers` lines of words before them.

    With `with_units`, a line of units may follow the header.
    Up to `numeric_headers` first rows of numbers may have another number of columns; they are ignored.

    Spaces, tabs, commas and semicolons separate, or what a first line ``sep=;`` names.
    Whether commas are decimal commas is decided by all rows. Numbers may be in quotes.
    Lines that begin with ``#``, ``%``, ``!`` or ``//`` are comments, the last of which may name the columns.

    Raises FileError with the second half of a sentence that names the first line that is no row of numbers.
    """
    if not data:
        raise FileError("is empty: it has no bytes at all.")
    data = utf8_text(data)
    lines = [(number, line) for number, raw in enumerate(data.splitlines(), 1) if (line := raw.strip())]
    announced = _ANNOUNCED.fullmatch(lines[0][1]) if lines else None
    lines = lines[1:] if announced else lines
    header, is_comment, units, first = _header(lines, skip_headers, with_units)
    rows = [(number, line) for number, line in lines[first:] if not line.startswith(COMMENTS)]
    style = _style([line for _, line in rows], (announced[1] or b"\t") if announced else None)
    words = _rows(rows, numeric_headers, style)
    width = len(words[0])
    if width > MAX_COLUMNS:
        raise FileError(f"has {width:,} columns; at most {MAX_COLUMNS:,} are read.")
    return NumberRows(
        _names(header, width, style),
        _numbers(words, style.decimal_comma),
        _names(units, width, style),
        printable(header.decode("utf-8", "replace")).strip(),
        bool(header) and not is_comment,
        (style.separator or b"").decode(),
    )


def _header(
    lines: list[tuple[int, bytes]], skip_headers: int, with_units: bool
) -> tuple[bytes, bool, bytes, int]:
    """The line that names the columns, whether it is a comment, that with their units, and the first row."""
    header = units = comment = b""
    headers = 0
    for place, (number, line) in enumerate(lines):
        if line.startswith(COMMENTS):
            comment = line
        elif _NUMBER.match(line):
            return header or comment.lstrip(b"#%!/"), not header, units, place
        elif with_units and header and _are_units(line):
            units = line
        else:
            header, headers = line, headers + 1
            if headers > skip_headers:
                raise FileError(f"is not a table of numbers: line {number:,} begins with “{_shown(line)}”.")
    raise FileError("holds no row of numbers.")


def _style(rows: list[bytes], announced: bytes | None) -> _Style:
    """How the rows are written, decided by all of them."""
    quoted = any(b'"' in row for row in rows)
    commas = any(b"," in row for row in rows)
    if announced is not None:
        return _Style(announced, commas and (announced != b"," or quoted), quoted)
    if 2 * sum(b";" in row for row in rows) > len(rows):
        return _Style(b";", commas, quoted)
    if not commas:
        return _Style(None, False, quoted)
    if not quoted and all(len(row.split()) > 1 and all(map(_is_decimal, row.split())) for row in rows):
        return _Style(None, True, False)
    style = _Style(b",", False, quoted)
    inside = {word for row in rows for word in style.words(row) if b"," in word} if quoted else set()
    if inside and all(_AMBIGUOUS.fullmatch(word) for word in inside):
        raise FileError(
            f"has “{_shown(min(inside))}”, whose comma may be a decimal comma or separate thousands; write "
            "decimal points, or semicolons between the columns."
        )
    return _Style(b",", bool(inside), quoted)


def _is_decimal(word: bytes) -> bool:
    return _DECIMAL_COMMA.fullmatch(word) is not None


def _rows(lines: list[tuple[int, bytes]], numeric_headers: int, style: _Style) -> list[list[bytes]]:
    """The words of the rows, each as many as in the first one."""
    words: list[list[bytes]] = []
    for number, line in lines:
        row = style.words(line)
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


def _numbers(words: list[list[bytes]], decimal_comma: bool) -> NDArray[np.float64]:
    if decimal_comma:
        _check_decimal_commas(words)
        words = [[word.replace(b",", b".") for word in row] for row in words]
    try:
        return np.array([list(map(float, row)) for row in words])
    except ValueError:
        pass
    for row, each in enumerate(words):
        for column, word in enumerate(each, start=1):
            try:
                float(word)
            except ValueError:
                raise FileError(_fault(word, row, column, decimal_comma)) from None
    raise FileError("is not a table of numbers.")


def _check_decimal_commas(words: list[list[bytes]]) -> None:
    """Refuse points among decimal commas, which separate thousands or are decimal points of some rows."""
    for row, each in enumerate(words):
        for column, word in enumerate(each, start=1):
            if b"." in word or word.count(b",") > 1:
                raise FileError(_fault(word, row, column, decimal_comma=True))


def _fault(word: bytes, row: int, column: int, decimal_comma: bool) -> str:
    place = f"in row {row + 1:,}, column {column}"
    if _GROUPED.fullmatch(word) and not word.startswith((b"0", b"-0")):
        return f"has “{_shown(word)}” {place}: write numbers without separators of thousands."
    if b"." in word and b"," in word:
        return f"has “{_shown(word)}” {place}, with a point and a comma; write one decimal sign."
    if decimal_comma and b"." in word and re.fullmatch(rb"[-+.\deE]+", word):
        return f"has “{_shown(word)}” {place}, and decimal commas elsewhere; write one decimal sign."
    return (
        f"has “{_shown(word)}” where a number belongs, {place}"
        f"{' (write decimal points, not commas)' if b',' in word else ''}."
    )


def _names(line: bytes, width: int, style: _Style) -> tuple[str, ...]:
    """The header's words as names, if there are as many as columns."""
    text = line.strip()
    for separator in dict.fromkeys((style.separator, b",", b";", b"\t", None)) if text else ():
        words = _Style(separator, False, b'"' in text).words(text)
        if len(words) == width:
            return tuple(printable(word.decode("utf-8", "replace")).strip().strip("\"'") for word in words)
    return ()


def _shown(word: bytes) -> str:
    return printable(word[:24].decode("utf-8", "replace"))


def float_or_nan(word: str | bytes) -> float:
    """The number that a word is, or not a number."""
    try:
        return float(word)
    except ValueError:
        return math.nan


_NAMES = {
    "max_feret_diameter": ("length", "l", "max feret", "length l"),
    "width": ("width", "w", "breadth", "width w"),
    "thickness": ("thickness", "t", "height", "thickness t"),
    "volume": ("volume", "v"),
}
_OWN = ("equivalent_radius", "sphericity", "aspect_ratio", "convexity")
"""Columns that are taken only under the names that this program gives them: others mean other things."""
_KEYS = {name: key for key, names in _NAMES.items() for name in names}
_COLUMN = re.compile(r"\s*([^\[\](),/]*?)[\s,/]*(?:[\[(]\s*([^\])]*?)\s*[\])])?\s*")


@dataclass(frozen=True)
class DescriptorColumns:
    """Columns of descriptors in a table: keys, the unit that each states or "", and values of shape (n,)."""

    keys: tuple[str, ...]
    units: tuple[str, ...]
    values: tuple[NDArray[np.float64], ...]
    notes: tuple[str, ...]


def named_columns(data: bytes) -> DescriptorColumns:
    """The columns whose names are those of length, width, thickness or a descriptor, among any others.

    Raises FileError with the second half of a sentence if there is none, or no row with numbers in all.
    """
    text = utf8_text(data.removeprefix(b"\xef\xbb\xbf")).decode("utf-8")
    lines = text.splitlines()
    head = next((line for line in lines if line.strip()), "")
    separator = max("\t;,", key=head.count)
    try:
        rows = [row for row in csv.reader(io.StringIO(text), delimiter=separator) if any(map(str.strip, row))]
    except csv.Error:
        raise FileError("is not a table of words and numbers.") from None
    if not rows:
        raise FileError("is empty: it has no row of names.")
    found: dict[str, tuple[int, str]] = {}
    notes = []
    for place, cell in enumerate(rows[0]):
        key, unit, unknown = _column(cell)
        shown = printable(cell.strip())[:40]
        if key in found:
            notes.append(f"Left out the column “{shown}”: an earlier one has {key}.")
        elif key:
            found[key] = (place, unit)
            if unknown:
                notes.append(f"The column “{shown}” names no known unit of length; the given one is taken.")
    if not found:
        names = ", ".join(printable(cell.strip())[:20] for cell in rows[0][:6])
        raise FileError(f"has no column of length, width and thickness; its columns are {names}.")
    comma = separator != ","
    words = [[_cell(row, place, comma) for place, _ in found.values()] for row in rows[1:]]
    values = np.array(words, dtype=np.float64).reshape(-1, len(found))
    with np.errstate(invalid="ignore"):
        good = ((values > 0) & (values < 1e30)).all(axis=1)
    if not good.any():
        raise FileError(f"has no row with positive numbers in {', '.join(found)}.")
    lost = int((~good).sum())
    if lost:
        notes.append(f"Left out {plural(lost, 'row')} without positive numbers in {', '.join(found)}.")
    units = tuple(unit for _, unit in found.values())
    return DescriptorColumns(tuple(found), units, tuple(values[good].T), tuple(notes))


def _column(cell: str) -> tuple[str, str, bool]:
    """Key and unit of a column, empty for others, and whether it states another unit than those of length."""
    match = _COLUMN.fullmatch(cell)
    if match is None:
        return "", "", False
    name = " ".join(match[1].lower().replace("_", " ").split())
    key = match[1] if match[1] in (*_OWN, *_NAMES) else _KEYS.get(name, "")
    if not key:
        return "", "", False
    unit = unit_named(re.sub(r"[\^]?[23³²]$", "", match[2] or "")) or ""
    return key, unit, bool(match[2]) and not unit and (key in _NAMES or key == "equivalent_radius")


def _cell(row: list[str], place: int, decimal_comma: bool) -> float:
    word = row[place].strip() if place < len(row) else ""
    return float_or_nan(word.replace(",", ".") if decimal_comma else word)
