"""Reading the particles that a command line names."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from regolith_studio.cli.options import Repair, Unit, usage_errors
from regolith_studio.cli.terminal import print_errors, run_with_progress

if TYPE_CHECKING:
    from regolith_studio.readers.particles import LoadedParticles


@dataclass(frozen=True)
class ReadingOptions:
    """How meshes are read."""

    unit: Unit = "um"
    repair: Repair = True

    def read(self, paths: Sequence[Path], l_max: int | None = None) -> "LoadedParticles":
        """The particles in files and folders; unreadable files are reported on stderr.

        Parameters
        ----------
        l_max
            Degree above which coefficients of tables are left out.

        Raises
        ------
        FileError
            If nothing can be read.
        """
        from regolith_studio.jobs.particle_jobs import load_particles
        from regolith_studio.readers.units import unit_factor

        with usage_errors():
            unit_factor(self.unit)
        reading = load_particles(tuple(paths), self.unit, self.repair, l_max)
        loaded: LoadedParticles = run_with_progress(reading)
        print_errors(problem.with_path for problem in loaded.problems)
        return loaded


def exit_code(paths: Sequence[Path], loaded: "LoadedParticles", failures: int = 0) -> int:
    """1 if a file that was named itself, or any particle, failed; a folder may hold other things."""
    named = {str(path) for path in paths if not path.is_dir()}
    return 1 if failures or any(problem.path in named for problem in loaded.problems) else 0
