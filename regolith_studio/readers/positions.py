"""Particle positions from tables, XYZ and LAMMPS dumps, for the angle of repose."""

import re
from dataclasses import dataclass
from pathlib import Path

from regolith_studio.errors import FileError, InputError
from regolith_studio.geometry.arrays import FloatArray, LockedRecord, locked_floats
from regolith_studio.readers.position_formats import NAME_THEM
from regolith_studio.readers.sandbox.parent import shared_sandbox
from regolith_studio.readers.settings import UNITS, unit_factor

__all__ = ["ParticlePositions", "asks_for_columns", "read_positions"]

_METRES = 1e-6
"""Metres in a micrometre."""


@dataclass(frozen=True, eq=False)
class ParticlePositions(LockedRecord):
    """Centres of particles, and how large they are.

    - ``points``: shape (n, 3), metres.
    - ``diameters``: shape (n,), metres; None where the file does not state it.
    - ``name``: as the user knows the file.
    - ``notes``: sentences that a user should read.
    - ``states_unit``: whether the file names the unit of its numbers.

    Raises ValueError if the shapes are others.
    """

    points: FloatArray
    diameters: FloatArray | None
    name: str = ""
    notes: tuple[str, ...] = ()
    states_unit: bool = False

    def __post_init__(self) -> None:
        points = locked_floats(self.points, (None, 3), "points")
        object.__setattr__(self, "points", points)
        if self.diameters is not None:
            object.__setattr__(self, "diameters", locked_floats(self.diameters, (len(points),), "diameters"))

    def __len__(self) -> int:
        return len(self.points)


def read_positions(path: str | Path, unit: str = "m", *, columns: str = "") -> ParticlePositions:
    """The particles of a position file; of several time steps the last.

    - ``path``: a table (.csv, .txt, .dat), XYZ, or a LAMMPS dump.
    - ``unit``: unit of the file's numbers, where the file names none itself (``x [mm]``, ``x_mm``, the units
      of a LAMMPS dump).
    - ``columns``: names of all columns of a table or XYZ file, in their order: x, y, z, perhaps diameter or
      radius, and any other name for the rest (``type x y z vx vy vz``). By default those of the file.

    Raises FileError with one sentence if the file cannot be read. Raises InputError if there is no such
    unit.
    """
    if unit not in UNITS or unit == "voxel":
        raise InputError(
            f"Positions are in one of {', '.join(key for key in UNITS if key != 'voxel')}, not {unit}."
        )
    path = Path(path)
    names = re.split(r"[\s,;]+", columns.strip()) if columns.strip() else []
    answer = shared_sandbox().request("positions", path, columns=names)
    header = answer.header
    points = answer.arrays[0] * (unit_factor(header["unit"] or unit) * _METRES)
    diameters = None
    if len(answer.arrays) > 1:
        diameters = answer.arrays[1] * (
            unit_factor(header["diameter_unit"] or header["unit"] or unit) * _METRES
        )
    states_unit = bool(header["unit"])
    return ParticlePositions(points, diameters, path.stem, tuple(header["notes"]), states_unit)


def asks_for_columns(error: FileError) -> bool:
    """Whether a file was refused because the names of its columns must be given."""
    return NAME_THEM in str(error)
