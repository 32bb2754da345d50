"""LAMMPS dumps of atoms as text: ``ITEM: ATOMS id type x y z radius``."""

import re

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import printable
from regolith_studio.readers.number_rows import float_or_nan
from regolith_studio.readers.position_formats import ParsedPositions, PositionFormat, named_columns, sized

_ITEM = b"ITEM:"
_SCALED = ({"xs": "x", "ys": "y", "zs": "z"}, {"xsu": "x", "ysu": "y", "zsu": "z"})


_STYLE = re.compile(rb"^ITEM: UNITS[ \t]*\r?\n[ \t]*(\w+)", re.MULTILINE)
_LENGTHS = {
    "real": "angstrom", "metal": "angstrom", "si": "m", "cgs": "cm", "electron": "bohr", "micro": "um",
    "nano": "nm",
}  # fmt: skip
"""Unit of length of each style of units that LAMMPS has; ``lj`` has none."""


def parse(data: bytes, _asked: tuple[str, ...]) -> ParsedPositions:
    """Positions of the last time step in the unit of its style; scaled ones are put into their box."""
    start, steps = data.rfind(b"ITEM: TIMESTEP"), data.count(b"ITEM: TIMESTEP")
    if start < 0:
        raise FileError("is not a LAMMPS dump: it has no ITEM: TIMESTEP.")
    lines = data[start:].splitlines()
    sections = _sections(lines)
    count = _count(sections)
    names, rows = _atoms(sections)
    if len(rows) != count:
        raise FileError(f"is cut short: its last step declares {count:,} particles and has {len(rows):,}.")
    numbers, names = _unscaled(_numbers(rows, names), names, sections)
    columns = named_columns(names)
    if columns.axes is None:
        raise FileError(f"has no columns x, y and z; its atoms have {printable(', '.join(names))[:60]}.")
    notes = (f"The file holds {steps} time steps; the last was read.",) if steps > 1 else ()
    unit = _stated_unit(data)
    return ParsedPositions(numbers[:, list(columns.axes)], sized(numbers, columns), unit, unit, notes)


def _stated_unit(data: bytes) -> str | None:
    """The unit of length by the style of units, which only the first step of a dump may state."""
    style = _STYLE.search(data)
    if style is None or style[1] == b"lj":
        return None
    name = style[1].decode("ascii", "replace")
    if name not in _LENGTHS:
        raise FileError(
            f"is a LAMMPS dump in units of the style “{printable(name)[:20]}”, which is not known."
        )
    return _LENGTHS[name]


def _sections(lines: list[bytes]) -> dict[str, tuple[str, list[bytes]]]:
    """What stands after each ITEM: the rest of its line, and the lines below."""
    sections: dict[str, tuple[str, list[bytes]]] = {}
    rows: list[bytes] = []
    for line in lines:
        if line.startswith(_ITEM):
            text = line[len(_ITEM) :].decode("utf-8", "replace").strip()
            name = next(
                (each for each in ("NUMBER OF ATOMS", "BOX BOUNDS", "ATOMS") if text.startswith(each)), text
            )
            rows = []
            sections[name] = (text[len(name) :].strip(), rows)
        elif line.strip():
            rows.append(line)
    return sections


def _count(sections: dict[str, tuple[str, list[bytes]]]) -> int:
    rows = sections.get("NUMBER OF ATOMS", ("", []))[1]
    if len(rows) != 1 or not re.fullmatch(rb"\s*\d{1,12}\s*", rows[0]):
        raise FileError("is a broken LAMMPS dump: it does not state its number of particles.")
    return int(rows[0])


def _atoms(sections: dict[str, tuple[str, list[bytes]]]) -> tuple[tuple[str, ...], list[bytes]]:
    if "ATOMS" not in sections:
        raise FileError("is cut short: its last time step has no ITEM: ATOMS.")
    text, rows = sections["ATOMS"]
    return tuple(text.lower().split()), rows


def _numbers(rows: list[bytes], names: tuple[str, ...]) -> np.ndarray:
    """All columns as numbers; words, such as elements, are not a number."""
    out = np.full((len(rows), len(names)), np.nan)
    for place, row in enumerate(rows):
        words = row.split()
        if len(words) != len(names):
            raise FileError(
                f"is a broken LAMMPS dump: particle {place + 1:,} has {len(words)} columns, not {len(names)}."
            )
        out[place] = [float_or_nan(word) for word in words]
    return out


def _unscaled(
    numbers: np.ndarray, names: tuple[str, ...], sections: dict[str, tuple[str, list[bytes]]]
) -> tuple[np.ndarray, tuple[str, ...]]:
    """Shares of the box as positions, where the dump holds no others."""
    if named_columns(names).axes is not None:
        return numbers, names
    for scaled in _SCALED:
        if set(scaled) <= set(names):
            lows, highs = _box(sections)
            for axis, name in enumerate(scaled):
                column = names.index(name)
                numbers[:, column] = lows[axis] + numbers[:, column] * (highs[axis] - lows[axis])
            return numbers, tuple(scaled.get(name, name) for name in names)
    return numbers, names


def _box(sections: dict[str, tuple[str, list[bytes]]]) -> tuple[np.ndarray, np.ndarray]:
    kind, rows = sections.get("BOX BOUNDS", ("", []))
    bounds = [[float_or_nan(word) for word in row.split()] for row in rows]
    if "xy" in kind or len(bounds) != 3 or any(len(row) != 2 for row in bounds):
        raise FileError("holds positions as shares of a box that is tilted or not stated; dump x y z.")
    return np.array(bounds)[:, 0], np.array(bounds)[:, 1]


FORMAT = PositionFormat(
    "lammps",
    "a LAMMPS dump",
    (".dump", ".lammpstrj", ".lmp"),
    lambda head: head.startswith((b"ITEM: TIMESTEP", b"ITEM: UNITS")),
    parse,
)
