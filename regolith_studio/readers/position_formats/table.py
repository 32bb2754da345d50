"""Tables of text: CSV with or without column names, or numbers between spaces."""

import re

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import plural
from regolith_studio.readers.number_rows import NumberRows, number_rows
from regolith_studio.readers.position_formats import (
    NAME_THEM,
    NamedColumns,
    ParsedPositions,
    PositionFormat,
    asked_columns,
    counts_first,
    named_columns,
    named_rows,
)

_FOURTH = "The fourth column has no name; it was interpreted as the diameter."
_YADE = re.compile(r"format\s+(\w+)", re.IGNORECASE)
"""The head of YADE's text: ``# format x_y_z_r``."""


def parse(data: bytes, asked: tuple[str, ...]) -> ParsedPositions:
    """Positions of the columns named x, y and z, or of the only three; the size of one named so.

    Without names a fourth column is the diameter, which a note says.
    """
    table = number_rows(data, with_units=True)
    if asked:
        return named_rows(table.numbers, asked_columns(asked, table.numbers.shape[1]))
    columns = _stated(table)
    return _unnamed(table) if columns is None else named_rows(table.numbers, columns)


def _stated(table: NumberRows) -> NamedColumns | None:
    """The columns that the head names; None where there is none."""
    width = table.numbers.shape[1]
    yade = _YADE.match(table.header)
    names = tuple(yade[1].split("_")) if yade else _with_units(table.names, table.units)
    if table.has_header and len(names) != width:
        raise FileError(f"has {plural(width, 'column')}, and a head that does not name as many; {NAME_THEM}.")
    if len(names) != width or all(_is_number(name) for name in names):
        return None
    columns = named_columns(names)
    if columns.axes is None:
        raise FileError(f"has no columns x, y and z; they are called {', '.join(names[:6])}; {NAME_THEM}.")
    return columns


def _unnamed(table: NumberRows) -> ParsedPositions:
    numbers = table.numbers
    width = numbers.shape[1]
    if width < 3:
        raise FileError(f"has {plural(width, 'column')}; positions need three: x, y and z.")
    if width > 4:
        raise FileError(f"has {width} columns without names; {NAME_THEM}.")
    if width == 4:
        if counts_first(numbers):
            raise FileError(
                f"has four columns without names, of which the first is whole numbers; {NAME_THEM}."
            )
        return ParsedPositions(numbers[:, :3], numbers[:, 3], notes=(_FOURTH,))
    return ParsedPositions(numbers)


def _with_units(names: tuple[str, ...], units: tuple[str, ...]) -> tuple[str, ...]:
    """Names with the units of a line of their own behind them."""
    if not units:
        return names
    return tuple(
        f"{name} [{unit.strip('[]()')}]" if unit else name for name, unit in zip(names, units, strict=True)
    )


def _is_number(name: str) -> bool:
    try:
        float(name)
    except ValueError:
        return False
    return True


FORMAT = PositionFormat(
    "table",
    "a table",
    (".csv", ".txt", ".dat", ".tsv", ".asc", ".xyz"),
    lambda _head: False,
    parse,
    takes_names=True,
)
