"""Compiles every kernel ahead of its first use; the machine code is cached on the disk."""

from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.methods import METHODS
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.harmonics.surface import reconstruct
from regolith_studio.jobs.events import Job, Started, Steps
from regolith_studio.jobs.executor import Executor, call, open_executor, value_of
from regolith_studio.jobs.particle_jobs import measure_particle
from regolith_studio.messages import N_


def compile_kernels(workers: int | Executor = 0) -> Steps:
    """Run all methods on a small mesh, each in a process of its own; returns their names.

    Parameters
    ----------
    workers
        Processes at a time; 0 for one a core.
    """
    tasks = (*reversed(list(METHODS)), "fit")
    yield Started(N_("Compiling"), len(tasks))
    jobs = [Job(call, (run_task, name)) for name in tasks]
    with open_executor(workers) as executor:
        results = yield from executor.run_all(jobs, list(tasks))
    for result in results:
        value_of(result)
    return tasks


def run_task(name: str) -> None:
    """Run what compiles the kernels of one entry point: ``fit``, or the key of a coarsening method."""
    (_measure_and_fit if name == "fit" else _coarsen)(name)


def _small_mesh() -> Mesh:
    sphere = icosphere(2)
    return Mesh(sphere.vertices * [3.0, 2.0, 1.5], sphere.faces)


def _measure_and_fit(_name: str) -> None:
    measure_particle(Particle("body", _small_mesh()))
    reconstruct(fit_harmonics(_small_mesh(), 4, sampling_degree=8), 2, level=1)


def _coarsen(method: str) -> None:
    coarsen(_small_mesh(), 12, method)
