"""What is known of particles before anything is fitted: health and descriptors."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from regolith_studio.descriptors.describe import Descriptors, describe
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh_health import MeshHealth, inspect
from regolith_studio.geometry.particle import Particle, defect_triangles
from regolith_studio.harmonics.sight import Sight, sight
from regolith_studio.harmonics.visibility import hidden_faces
from regolith_studio.jobs.events import Job, Partial, Progress, Started, Steps
from regolith_studio.jobs.executor import Executor, open_executor, value_of


@dataclass(frozen=True)
class Examined:
    """What is known of a particle before anything is fitted.

    Parameters
    ----------
    descriptors
        ``None`` where the mesh has none, for example because it is flat.
    problem
        Why, in one sentence.
    sight
        What its star point cannot see; ``None`` where the mesh has no inside, for example because it is open.
    """

    health: MeshHealth
    descriptors: Descriptors | None
    problem: str = ""
    sight: Sight | None = None


def examine(particle: Particle, box_metric: str = "exact") -> Examined:
    """Health, descriptors and sight of one particle; never raises for what is wrong with the mesh."""
    known = particle.repair
    health = known.health_after if known and known.mesh is particle.mesh else inspect(particle.mesh)
    seen = _seen(particle)
    try:
        return Examined(health, describe(particle.mesh, box_metric=box_metric), "", seen)
    except RegolithError as error:
        return Examined(health, None, str(error), seen)


def _seen(particle: Particle) -> Sight | None:
    try:
        return sight(particle.mesh)
    except RegolithError:
        return None


def find_faults(particle: Particle, seen: Sight | None = None) -> Steps:
    """Where a mesh is wrong or was before it was mended, and what its star point cannot see.

    Returns the corners (k, 3, 3) of the triangles of each kind, as ``defect_triangles`` names them, and
    ``hidden``.
    """
    yield Started("Looking for faults")
    found: dict[str, FloatArray] = defect_triangles(particle)
    if seen is not None and seen.hidden_surface_share > 0.0:
        hidden = hidden_faces(particle.mesh, np.array(seen.star_point))
        found["hidden"] = particle.mesh.triangles[hidden]
    return found


def examine_one(particle: Particle, box_metric: str = "exact") -> Steps:
    """As :func:`examine`, for a runner."""
    yield Started("Measuring")
    return examine(particle, box_metric)


def examine_particles(particles: Sequence[Particle], box_metric: str = "exact") -> Steps:
    """Each particle in order; partial results and the result are tuples of :class:`Examined`, so far.

    A partial result comes when an eighth more is known: what is copied grows as the number of particles
    and not as its square.
    """
    yield Started("Measuring particles", len(particles))
    seen: list[Examined] = []
    due = 1
    for particle in particles:
        seen.append(examine(particle, box_metric))
        if len(seen) >= due:
            yield Partial(tuple(seen))
            due = len(seen) + max(1, len(seen) // 8)
        yield Progress(len(seen), len(particles), particle.name)
    return tuple(seen)


def examine_sample(
    particles: Sequence[Particle], box_metric: str = "exact", workers: int | Executor = 1
) -> Steps:
    """As :func:`examine_particles`, by several processes; returns a tuple of :class:`Examined`."""
    yield Started("Measuring", len(particles))
    jobs = [Job(examine_one, (particle, box_metric)) for particle in particles]
    with open_executor(workers) as executor:
        results = yield from executor.run_all(jobs, [particle.name for particle in particles])
    return tuple(value_of(result) for result in results)
