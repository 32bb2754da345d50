"""Reading the particles that a command line names."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from regolith_studio.cli.options import Convention, usage_errors
from regolith_studio.cli.terminal import print_errors, run_with_progress
from regolith_studio.readers.settings import ReadingSettings

if TYPE_CHECKING:
    from regolith_studio.readers.particles import LoadedParticles


@dataclass(frozen=True)
class ReadingOptions(ReadingSettings):
    """How meshes and tables are read."""

    convention: Convention = "auto"

    def read(self, paths: Sequence[Path], l_max: int | None = None) -> "LoadedParticles":
        """The particles in files and folders; unreadable files are reported on stderr.

        ``l_max``: degree above which coefficients of tables are left out.
        """
        from regolith_studio.jobs.particle_jobs import load_particles
        from regolith_studio.readers.coefficient_tables import TableReading, table_convention
        from regolith_studio.readers.units import unit_factor

        with usage_errors():
            unit_factor(self.unit)
            tables = TableReading(l_max, table_convention(self.convention))
        steps = load_particles(tuple(paths), ReadingSettings.of(self), tables)
        loaded: LoadedParticles = run_with_progress(steps)
        print_errors(loaded.left_out)
        print_errors(problem.with_path for problem in loaded.problems)
        return loaded


def exit_code(loaded: "LoadedParticles", failures: int = 0) -> int:
    """1 if a file, named itself or in a folder, or any particle failed."""
    return 1 if failures or loaded.problems else 0
