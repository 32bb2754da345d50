"""Spherical-harmonics coefficients of one particle, its surface at a degree, and descriptors."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from regolith_studio.descriptors.describe import Descriptors, describe
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.health import MeshHealth, inspect
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.fit import HarmonicFit, fit_harmonics
from regolith_studio.harmonics.surface import reconstruct
from regolith_studio.jobs.events import Partial, Progress, Started, Steps

FIT_DEGREE = 30
"""Everything is fitted to this degree once; lower ones are truncations of that fit."""


@dataclass(frozen=True)
class Examined:
    """What is known of a particle before anything is fitted.

    Parameters
    ----------
    descriptors
        ``None`` where the mesh has none, for example because it is flat.
    problem
        Why, in one sentence.
    """

    health: MeshHealth
    descriptors: Descriptors | None
    problem: str = ""


def examine(particle: Particle, box_metric: str = "exact") -> Examined:
    """Health and descriptors of one particle; never raises for what is wrong with the mesh."""
    health = inspect(particle.mesh)
    try:
        return Examined(health, describe(particle.mesh, box_metric=box_metric))
    except RegolithError as error:
        return Examined(health, None, str(error))


def examine_one(particle: Particle, box_metric: str = "exact") -> Steps:
    """As :func:`examine`, for a runner."""
    yield Started("Measuring")
    return examine(particle, box_metric)


def examine_particles(particles: Sequence[Particle], box_metric: str = "exact") -> Steps:
    """Each particle in order; partial results and the result are tuples of :class:`Examined`, so far."""
    yield Started("Measuring particles", len(particles))
    seen: list[Examined] = []
    for particle in particles:
        seen.append(examine(particle, box_metric))
        yield Partial(tuple(seen))
        yield Progress(len(seen), len(particles), particle.name)
    return tuple(seen)


def fit_one(mesh: Mesh, l_max: int = FIT_DEGREE) -> Steps:
    """Fit `mesh` up to degree `l_max`; returns a ``HarmonicFit``."""
    yield Started("Fitting spherical harmonics")
    return fit_harmonics(mesh, l_max=l_max)


def draw_surface(fit: HarmonicFit, l_max: int, level: int) -> Steps:
    """The fit's surface cut at `l_max`; returns a :class:`Mesh` in the particle's frame."""
    yield Started("Drawing the fit")
    return reconstruct(fit, l_max, level=level)


def describe_meshes(meshes: Mapping[str, Mesh], box_metric: str = "exact") -> Steps:
    """Descriptors of named meshes; partial results and the result are ``dict[name, Descriptors]``."""
    yield Started("Measuring", len(meshes))
    described: dict[str, Descriptors] = {}
    for name, mesh in meshes.items():
        described[name] = describe(mesh, box_metric=box_metric)
        yield Partial(dict(described))
        yield Progress(len(described), len(meshes), name)
    return described
