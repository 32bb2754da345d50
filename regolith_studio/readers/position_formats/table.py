"""Tables of text: CSV with or without column names, or numbers between spaces."""

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import plural
from regolith_studio.readers.number_rows import number_rows
from regolith_studio.readers.position_formats import ParsedPositions, PositionFormat, named_columns, sized

_FOURTH = "The fourth column has no name; it was interpreted as the diameter."


def parse(data: bytes) -> ParsedPositions:
    """Positions of the columns named x, y and z, or of the first three; the size of one named so.

    Without names a fourth column is the diameter.

    Raises
    ------
    FileError
        If the text is no table, or has fewer than three columns.
    """
    table = number_rows(data, with_units=True)
    numbers = table.numbers
    if table.names:
        columns = named_columns(_with_units(table.names, table.units))
        if columns.axes is not None:
            points = numbers[:, list(columns.axes)]
            return ParsedPositions(points, sized(numbers, columns), columns.unit, columns.size_unit)
        if not all(_is_number(name) for name in table.names):
            shown = ", ".join(table.names[:6])
            raise FileError(f"has no columns x, y and z; they are called {shown}.")
    if numbers.shape[1] < 3:
        raise FileError(f"has {plural(numbers.shape[1], 'column')}; positions need three: x, y and z.")
    if numbers.shape[1] > 4:
        raise FileError(f"has {numbers.shape[1]} columns without names; name them x, y, z and diameter.")
    if numbers.shape[1] == 4:
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
    "table", "a table", (".csv", ".txt", ".dat", ".tsv", ".asc"), lambda _head: False, parse
)
