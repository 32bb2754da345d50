"""Particles as files: one STL each, and ``particles.csv`` with what they are."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from regolith_studio.geometry.particle import Particle
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.stl import stl_bytes
from regolith_studio.io.tables import Cell, Column, Table, csv_text
from regolith_studio.jobs.particle_jobs import MeasuredParticle
from regolith_studio.session.outputs.descriptors import descriptor_table

STL_HEADER = "Regolith Studio, particle, micrometres"


def write_particles(
    folder: Path,
    particles: Sequence[Particle],
    facts: Sequence[MeasuredParticle],
    extra: Mapping[str, Sequence[Cell]] | None = None,
) -> None:
    """Write ``<name>.stl`` for each particle and ``particles.csv``.

    Parameters
    ----------
    extra
        More columns, by name.
    """
    for particle in particles:
        write_bytes(folder / f"{particle.name}.stl", stl_bytes(particle.mesh.triangles, STL_HEADER))
    table = descriptor_table(particles, facts)
    for name, cells in (extra or {}).items():
        rows = tuple((*row, cell) for row, cell in zip(table.rows, cells, strict=True))
        table = Table(table.title, (*table.columns, Column(name)), rows)
    write_bytes(folder / "particles.csv", csv_text(table).encode("utf-8"))
