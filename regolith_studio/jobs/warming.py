"""Compiles every kernel before somebody waits for it; the machine code stays on disk."""

from collections.abc import Callable

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


def warm_up(workers: int | Executor = 0) -> Steps:
    """Run the whole chain on a small body, each method in a process of its own; returns the steps' names.

    Parameters
    ----------
    workers
        Processes at a time; 0 for one a core.
    """
    chores: dict[str, Callable[[str], None]] = dict.fromkeys(reversed(list(METHODS)), _coarsen)
    chores["fit"] = _measure_and_fit
    yield Started(N_("Compiling"), len(chores))
    jobs = [Job(call, (chore, name)) for name, chore in chores.items()]
    with open_executor(workers) as executor:
        results = yield from executor.run_all(jobs, list(chores))
    for result in results:
        value_of(result)
    return tuple(chores)


def _body() -> Mesh:
    sphere = icosphere(2)
    return Mesh(sphere.vertices * [3.0, 2.0, 1.5], sphere.faces)


def _measure_and_fit(_name: str) -> None:
    measure_particle(Particle("body", _body()))
    reconstruct(fit_harmonics(_body(), 4, sampling_degree=8), 2, level=1)


def _coarsen(method: str) -> None:
    coarsen(_body(), 12, method)
