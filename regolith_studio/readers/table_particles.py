"""Particles that are given by their spherical-harmonics coefficients: the surface is synthesised."""

from pathlib import Path

from regolith_studio.errors import GeometryError
from regolith_studio.geometry.particle import Particle
from regolith_studio.readers.coefficient_tables import read_coefficients
from regolith_studio.readers.guard import Guard
from regolith_studio.readers.sentences import sentence_about

TABLE_SUFFIXES = (".anm", ".sh", ".shc")
"""What is a table of coefficients wherever it lies."""

TEXT_SUFFIXES = (".txt", ".dat", ".tab", ".csv")
"""What may be one where it is named itself; in a folder it is passed over."""

_FINE_DEGREE = 16
"""Above it 2,562 vertices would not show what the coefficients hold."""


def particle_of_table(path: Path, unit: str, group: str = "", guard: Guard | None = None) -> Particle:
    """The particle that a table of coefficients describes, about its star point.

    Its mesh has 5,120 faces, or 20,480 where the degree is above 16, and the volume of the smooth surface.

    Raises
    ------
    FileError
        With one sentence if the file is no such table.
    GeometryError
        With one sentence if its surface passes through its centre.
    """
    from regolith_studio.harmonics.surface import reconstruct

    table = read_coefficients(path, unit, guard=guard)
    try:
        mesh = reconstruct(table.coefficients, level=5 if table.coefficients.l_max > _FINE_DEGREE else 4)
    except GeometryError as error:
        sentence = f"holds no particle: {str(error)[0].lower()}{str(error)[1:]}"
        raise GeometryError(sentence_about(path, sentence)) from None
    return Particle(table.name, mesh, group, table.source, table.notes)
