"""Formats of particle positions; each module of this folder defines one as ``FORMAT``."""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import plural, printable
from regolith_studio.readers.settings import UNITS, unit_named
from regolith_studio.registry import Registry

Numbers = NDArray[np.float64]


@dataclass(frozen=True)
class ParsedPositions:
    """Particles as a file states them, unchecked.

    - ``points``: shape (n, 3), float64, in `unit`; may hold values that are not finite.
    - ``diameters``: shape (n,) in `diameter_unit`, or None.
    - ``unit``, ``diameter_unit``: keys of ``readers.settings.FILE_UNITS`` where the file names them.
    - ``notes``: sentences.
    """

    points: Numbers
    diameters: Numbers | None = None
    unit: str | None = None
    diameter_unit: str | None = None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class PositionFormat:
    """A format of particle positions.

    - ``key``, ``label``, ``suffixes``: as for a mesh format.
    - ``recognises``: whether the first 1,024 bytes can only be this format.
    - ``parse``: bytes, and the names of all columns if a user gave them, to particles. Raises ``FileError``
      with the second half of a sentence.
    - ``takes_names``: whether a user may name the columns; they count more than those of the file.
    """

    key: str
    label: str
    suffixes: tuple[str, ...]
    recognises: Callable[[bytes], bool]
    parse: Callable[[bytes, tuple[str, ...]], ParsedPositions]
    takes_names: bool = False


@dataclass(frozen=True)
class NamedColumns:
    """Which columns of a table hold what, found by their names."""

    axes: tuple[int, int, int] | None
    size: int | None = None
    is_radius: bool = False
    unit: str | None = None
    size_unit: str | None = None


_UNIT = re.compile(r"[\[(]\s*([^\])]{1,12})\s*[\])]\s*$|_(nm|[uµμ]m|mm|cm|m)$", re.IGNORECASE)  # x [mm], x_mm
_X = (
    "x", "xu", "pos_x", "posx", "position_x", "points:0", "points_0", "coordinates:0", "coordinates_0",
    "center_x", "centre_x", "x_coordinate", "particle x_coordinate", "x_coord", "rx", "cx",
)  # fmt: skip
_SIZES: Mapping[str, bool] = {
    "diameter": False, "d": False, "size": False, "diam": False, "particle_size": False,
    "particle size": False, "c_diameter": False, "equivalent_diameter": False,
    "radius": True, "r": True, "rad": True, "c_radius": True, "equivalent_radius": True,
}  # fmt: skip


NAME_THEM = "name its columns, for example “x y z radius” (--columns)"
"""The advice of each refusal that asks for the names of columns."""


def named_columns(names: tuple[str, ...]) -> NamedColumns:
    """Columns of x, y, z and of the size, by the names that programs give them.

    A unit behind a name (``x [mm]``, ``x_mm``) counts for the positions or the size.

    Raises FileError with the second half of a sentence if such a unit is unknown, or x, y and z have
    different ones.
    """
    cleaned: dict[str, int] = {}
    units: dict[str, str | None] = {}
    for place, name in enumerate(names):
        unit = _UNIT.search(name)
        key = _UNIT.sub("", name).strip().lower().replace("-", "_")
        if key not in cleaned:
            cleaned[key], units[key] = place, (unit[1] or unit[2]).strip() if unit else None
    axes, unit_of_axes = None, None
    for pattern in _X:
        triple = [pattern, *(_turned(pattern, step) for step in (1, 2))]
        if all(key in cleaned for key in triple):
            axes = (cleaned[triple[0]], cleaned[triple[1]], cleaned[triple[2]])
            unit_of_axes = _unit_of([units[key] for key in triple])
            break
    for key, is_radius in _SIZES.items():
        if key in cleaned:
            size_unit = _unit_of([units[key]]) or unit_of_axes
            return NamedColumns(axes, cleaned[key], is_radius, unit_of_axes, size_unit)
    return NamedColumns(axes, None, False, unit_of_axes)


def _unit_of(stated: list[str | None]) -> str | None:
    """The one unit that the heads of some columns state, or None if none does."""
    keys = {text: unit_named(text) for text in stated if text is not None}
    for text, key in keys.items():
        if key is None:
            shown = ", ".join(each for each in UNITS if each != "voxel")
            raise FileError(
                f"states the unit “{printable(text)}” for a column, which is not known ({shown})."
            )
    if len(set(keys.values())) > 1:
        raise FileError("states different units for x, y and z; write them in one.")
    return next(iter(keys.values()), None)


def asked_columns(names: tuple[str, ...], width: int) -> NamedColumns:
    """The columns that a user has named.

    Raises FileError with the second half of a sentence if they are not as many as those of the file, or x, y
    and z are not among them.
    """
    shown = printable(" ".join(names))[:60]
    if len(names) != width:
        raise FileError(f"has {plural(width, 'column')}, and “{shown}” names {len(names)}.")
    columns = named_columns(names)
    if columns.axes is None:
        raise FileError(f"needs columns called x, y and z; “{shown}” does not name all of them.")
    return columns


def named_rows(numbers: Numbers, columns: NamedColumns, notes: tuple[str, ...] = ()) -> ParsedPositions:
    """The particles in rows whose columns are known."""
    points = numbers[:, list(columns.axes or (0, 1, 2))]
    return ParsedPositions(points, sized(numbers, columns), columns.unit, columns.size_unit, notes)


def counts_first(numbers: Numbers) -> bool:
    """Whether the first column holds whole numbers (a type, an identifier) and the three after it do not."""
    return bool((numbers[:, 0] % 1 == 0).all() and (numbers[:, 1:4] % 1 != 0).any())


def sized(numbers: Numbers, columns: NamedColumns) -> Numbers | None:
    """Diameters of the rows, if there is such a column."""
    if columns.size is None:
        return None
    return numbers[:, columns.size] * (2.0 if columns.is_radius else 1.0)


def _turned(pattern: str, step: int) -> str:
    """The name of the y or z column beside that of x."""
    if pattern.endswith("0"):
        return f"{pattern[:-1]}{step}"
    place = pattern.index("x")
    return pattern[:place] + "xyz"[step] + pattern[place + 1 :]


POSITION_FORMATS: Registry[PositionFormat] = Registry(__name__, "FORMAT", "position_readers")


def position_suffixes() -> frozenset[str]:
    """The suffixes of all position formats, lower case, with the dot."""
    return frozenset(suffix for row in POSITION_FORMATS.values() for suffix in row.suffixes)
