"""The sample of a report from a scan or a recipe: its grains, meshes and virtual particles."""

import tempfile
from pathlib import Path

from regolith_studio.errors import InputError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.jobs.executor import open_executor
from regolith_studio.jobs.scan_jobs import scratch_folder
from regolith_studio.messages import N_
from regolith_studio.readers.particles import FileProblem, collect_particles
from regolith_studio.session.batch.inputs import BatchInputs
from regolith_studio.session.batch.preprocessing import prepare_inputs
from regolith_studio.session.recipe import Recipe


def load_recipe_particles(recipe: Recipe, base: Path, workers: int = 1) -> Steps:
    """Read or make all particles of a recipe; returns :class:`LoadedParticles`.

    Parameters
    ----------
    base
        Folder that relative inputs are relative to.

    Raises
    ------
    FileError
        If nothing can be read.
    InputError
        If the recipe holds something that cannot be used.
    """
    with tempfile.TemporaryDirectory(dir=scratch_folder()) as folder, open_executor(workers) as executor:
        prepared = yield from prepare_inputs(recipe, base, Path(folder) / "prepared", executor)
        inputs = BatchInputs.of(recipe, base, prepared)
        yield Started(N_("Reading particles"), len(inputs.members))
        results: list[Particle | FileProblem] = []
        for number, item in enumerate(inputs.members, start=1):
            try:
                results.append(item.particle())
            except InputError as error:
                results.append(FileProblem(item.name, str(error)))
            yield Progress(number, len(inputs.members), item.name)
        return collect_particles(results, inputs.problems)
