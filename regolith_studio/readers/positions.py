"""Particle positions from tables, XYZ, LAMMPS dumps and VTK files, for the angle of repose."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, locked_floats
from regolith_studio.readers.sandbox.parent import Sandbox, shared_sandbox
from regolith_studio.readers.units import UNITS, unit_factor

__all__ = ["ParticlePositions", "read_positions"]

_METRES = 1e-6
"""Metres in a micrometre."""


@dataclass(frozen=True, eq=False)
class ParticlePositions:
    """Centres of particles, and how large they are.

    Parameters
    ----------
    points
        Shape (n, 3), metres.
    diameters
        Shape (n,), metres; None where the file does not state it.
    name
        As the user knows the file.
    notes
        Sentences that a user should read.

    Raises
    ------
    ValueError
        If the shapes are others.
    """

    points: FloatArray
    diameters: FloatArray | None
    name: str = ""
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        points = locked_floats(self.points, (None, 3), "points")
        object.__setattr__(self, "points", points)
        if self.diameters is not None:
            object.__setattr__(self, "diameters", locked_floats(self.diameters, (len(points),), "diameters"))

    def __reduce__(
        self,
    ) -> tuple[Callable[..., "ParticlePositions"], tuple[ArrayLike | str | Any | None, ...]]:
        return ParticlePositions, (self.points, self.diameters, self.name, self.notes)

    def __len__(self) -> int:
        return len(self.points)


def read_positions(
    path: str | Path, unit: str = "m", *, fourth_column: str = "diameter", sandbox: Sandbox | None = None
) -> ParticlePositions:
    """The particles of a position file; of several time steps the last.

    Parameters
    ----------
    path
        A table (.csv, .txt, .dat), XYZ, a LAMMPS dump, or VTK points (.vtk, .vtp, .vtu).
    unit
        Unit of the file's numbers, where the file names none itself (``x [mm]``).
    fourth_column
        What a fourth column without a name is: ``diameter`` or ``radius`` (as YADE writes it).
    sandbox
        The child process that parses the file; by default the one of this process.

    Raises
    ------
    FileError
        With one sentence if the file cannot be read.
    InputError
        If there is no such unit.
    """
    if unit not in UNITS or unit == "voxel":
        raise InputError(
            f"Positions are in one of {', '.join(key for key in UNITS if key != 'voxel')}, not {unit}."
        )
    if fourth_column not in ("diameter", "radius"):
        raise InputError(f"A fourth column is a diameter or a radius, not {fourth_column}.")
    path = Path(path)
    answer = (sandbox or shared_sandbox()).request("positions", path)
    header = answer.header
    points = answer.arrays[0] * (unit_factor(header["unit"] or unit) * _METRES)
    diameters = None
    notes = tuple(header["notes"])
    if len(answer.arrays) > 1:
        diameters = answer.arrays[1] * (
            unit_factor(header["diameter_unit"] or header["unit"] or unit) * _METRES
        )
        if fourth_column == "radius" and any("interpreted as the diameter" in note for note in notes):
            diameters = 2.0 * diameters
            notes = tuple(note.replace("as the diameter", "as the radius") for note in notes)
    return ParticlePositions(points, diameters, path.stem, notes)
