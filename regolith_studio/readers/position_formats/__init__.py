"""Formats of particle positions; each module of this folder defines one as ``FORMAT``."""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from regolith_studio.readers.units import unit_named
from regolith_studio.registry import Registry

Numbers = NDArray[np.float64]


@dataclass(frozen=True)
class ParsedPositions:
    """Particles as a file states them, unchecked.

    Parameters
    ----------
    points
        Shape (n, 3), float64, in `unit`; may hold values that are not finite.
    diameters
        Shape (n,) in `diameter_unit`, or None.
    unit, diameter_unit
        Keys of ``readers.units.UNITS`` where the file names them.
    notes
        Sentences.
    """

    points: Numbers
    diameters: Numbers | None = None
    unit: str | None = None
    diameter_unit: str | None = None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class PositionFormat:
    """A format of particle positions.

    Parameters
    ----------
    key, label, suffixes
        As for a mesh format.
    recognises
        Whether the first 1,024 bytes can only be this format.
    parse
        Bytes to particles. Raises ``FileError`` with the second half of a sentence.
    """

    key: str
    label: str
    suffixes: tuple[str, ...]
    recognises: Callable[[bytes], bool]
    parse: Callable[[bytes], ParsedPositions]


@dataclass(frozen=True)
class NamedColumns:
    """Which columns of a table hold what, found by their names."""

    axes: tuple[int, int, int] | None
    size: int | None = None
    is_radius: bool = False
    unit: str | None = None
    size_unit: str | None = None


_UNIT = re.compile(r"[\[(]\s*([^\])]{1,12})\s*[\])]\s*$")
_X = (
    "x", "xu", "pos_x", "posx", "position_x", "points:0", "points_0", "coordinates:0", "coordinates_0",
    "center_x", "centre_x", "x_coordinate", "particle x_coordinate", "x_coord", "rx", "cx",
)  # fmt: skip
_SIZES: Mapping[str, bool] = {
    "diameter": False, "d": False, "size": False, "diam": False, "particle_size": False,
    "particle size": False, "c_diameter": False, "equivalent_diameter": False,
    "radius": True, "r": True, "rad": True, "c_radius": True, "equivalent_radius": True,
}  # fmt: skip


def named_columns(names: tuple[str, ...]) -> NamedColumns:
    """Columns of x, y, z and of the size, by the names that programs give them.

    A unit in brackets behind a name (``x [mm]``) counts for the positions or the size.
    """
    cleaned: dict[str, int] = {}
    units: dict[str, str | None] = {}
    for place, name in enumerate(names):
        unit = _UNIT.search(name)
        key = _UNIT.sub("", name).strip().lower().replace("-", "_")
        if key not in cleaned:
            cleaned[key], units[key] = place, unit_named(unit[1]) if unit else None
    axes, unit_of_axes = None, None
    for pattern in _X:
        triple = [pattern, *(_turned(pattern, step) for step in (1, 2))]
        if all(key in cleaned for key in triple):
            axes = (cleaned[triple[0]], cleaned[triple[1]], cleaned[triple[2]])
            unit_of_axes = units[triple[0]]
            break
    for key, is_radius in _SIZES.items():
        if key in cleaned:
            return NamedColumns(axes, cleaned[key], is_radius, unit_of_axes, units[key] or unit_of_axes)
    return NamedColumns(axes, None, False, unit_of_axes)


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
