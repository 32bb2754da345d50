"""Tables of results, written as CSV for spreadsheets and as JSON for programs."""

import csv
import json
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from regolith_studio.io.own_files import UNPRINTABLE

Cell = str | int | float | None
"""What a table may hold; ``None`` and NaN stand for a missing value."""
PLAIN_NUMBERS = 1e7
"""Numbers below this are shown without an exponent of ten."""
_FORMULA = re.compile(r"(^|[;,\t\r\n])('*)(?=[=+\-@\t\r\n])")
"""Before what a spreadsheet would compute: at the start of a cell, or behind what may separate cells."""
_SHIELDED = re.compile(r"(^|[;,\t\r\n])'('*)(?=[=+\-@\t\r\n])")
_NUMBER = re.compile(r"[+-]?((\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|inf)")


@dataclass(frozen=True)
class Column:
    """One column of a table.

    ``name``: key in JSON and first word of the CSV header. ``unit``: unit as printed: ``um``, ``%``, ``s``;
    empty for text, counts and ratios.
    """

    name: str
    unit: str = ""

    @property
    def header(self) -> str:
        """Name with the unit in brackets, as the CSV file prints it."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True)
class Table:
    """Named columns and rows of equal length.

    - ``title``: one line that describes the rows.
    - ``columns``: one :class:`Column` a column.
    - ``rows``: one sequence of cells a row.
    - ``notes``: sentences for the reader: definitions, settings, seeds.

    Raises ValueError if a name appears twice or a row has another length than `columns`.
    """

    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        rows = tuple(tuple(_plain(cell) for cell in row) for row in self.rows)
        names = [column.name for column in self.columns]
        if len(set(names)) != len(names):
            raise ValueError(f"column names must differ, got {names}")
        for row in rows:
            if len(row) != len(self.columns):
                raise ValueError(f"rows must have {len(self.columns)} cells, got {len(row)}: {row}")
        object.__setattr__(self, "columns", tuple(self.columns))
        object.__setattr__(self, "rows", rows)
        object.__setattr__(self, "notes", tuple(self.notes))

    def column(self, name: str) -> tuple[Cell, ...]:
        """The cells of the column called `name`, top to bottom.

        Raises KeyError if there is no such column.
        """
        for index, column in enumerate(self.columns):
            if column.name == name:
                return tuple(row[index] for row in self.rows)
        raise KeyError(name)

    @property
    def records(self) -> list[dict[str, Cell]]:
        """Each row with its cells by the names of the columns."""
        names = [column.name for column in self.columns]
        return [dict(zip(names, row, strict=True)) for row in self.rows]


def csv_text(table: Table, separator: str = ",") -> str:
    """The table as CSV: one header line (``name [unit]``), then the rows; missing values are empty."""
    return _csv([[column.header for column in table.columns], *table.rows], separator)


def csv_bytes(rows: Iterable[Sequence[object]]) -> bytes:
    """Rows as CSV in UTF-8: floats by ``repr``, ``None`` as an empty cell, text quoted where necessary.

    A text that a spreadsheet would take for a formula, because it begins with ``=``, ``+``, ``-``, ``@`` or a
    tab or line end and is no number, gets an apostrophe in front; so does what follows a semicolon, comma,
    tab or line end in a text, as spreadsheets differ in what separates cells. :func:`read_csv` removes it.
    """
    return _csv(rows).encode("utf-8", UNPRINTABLE)


def read_csv(lines: Iterable[str]) -> Iterator[dict[str, str]]:
    """Rows of CSV that this program has written, by the cells of the first; the texts are as they were."""
    for row in csv.DictReader(lines):
        yield {name: _original(cell) if isinstance(cell, str) else cell for name, cell in row.items()}


def json_text(table: Table) -> str:
    """The table as JSON: title, notes, columns with units, and one object a row."""
    document = {
        "title": table.title,
        "notes": list(table.notes),
        "columns": [{"name": column.name, "unit": column.unit} for column in table.columns],
        "rows": table.records,
    }
    return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def write_table(table: Table, folder: Path, stem: str) -> tuple[Path, Path]:
    """Write ``stem.csv`` and ``stem.json`` into `folder`, which is made if it is missing."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = (folder / f"{stem}.csv", folder / f"{stem}.json")
    for path, text in zip(paths, (csv_text(table), json_text(table)), strict=True):
        path.write_text(text, encoding="utf-8", newline="\n")
    return paths


def rows_as_text(table: Table, digits: int = 3) -> tuple[Sequence[str], ...]:
    """Header and rows as strings of `digits` significant digits, for a terminal or a summary page."""
    header = [column.header for column in table.columns]
    return (header, *[[_printed(cell, digits) for cell in row] for row in table.rows])


def _csv(rows: Iterable[Sequence[object]], separator: str = ",") -> str:
    lines = _Lines()
    writer = csv.writer(lines, delimiter=separator, lineterminator="\r\n")
    writer.writerows([_as_text(cell) if isinstance(cell, str) else cell for cell in row] for row in rows)
    return "".join(lines)


class _Lines(list[str]):
    """Takes rows that end in ``\\r\\n``, and ends them in ``\\n``.

    The writer quotes the signs of its own end of a line only, and readers take a bare ``\\r`` for an end too.
    """

    def write(self, row: str) -> None:
        """Add a row."""
        self.append(f"{row[:-2]}\n")


def _as_text(cell: str) -> str:
    return cell if _NUMBER.fullmatch(cell) else _FORMULA.sub(r"\1'\2", cell)


def _original(cell: str) -> str:
    return _SHIELDED.sub(r"\1\2", cell)


def _plain(cell: object) -> Cell:
    """A cell as plain Python: numpy scalars become numbers, NaN becomes missing, infinity text."""
    value = cell.item() if hasattr(cell, "item") else cell
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else str(value)
    if value is None or isinstance(value, str | int | float):
        return value
    raise ValueError(f"a table holds text and numbers, got {type(value).__name__}")


def _printed(cell: Cell, digits: int) -> str:
    if cell is None:
        return ""
    if not isinstance(cell, float):
        return str(cell)
    text = f"{cell:.{digits}g}"
    return f"{float(text):.0f}" if "e+" in text and abs(cell) < PLAIN_NUMBERS else text
