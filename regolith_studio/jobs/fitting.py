"""Spherical-harmonics coefficients of one particle, its surface at a degree, and descriptors."""

from collections.abc import Mapping, Sequence

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.events import Partial, Progress, Started, Steps


def fit_one(mesh: Mesh, l_max: int = 30) -> Steps:
    """Fit `mesh` up to degree `l_max`; returns a ``HarmonicFit``."""
    from regolith_studio.harmonics.fit import fit_harmonics

    yield Started("Fitting spherical harmonics")
    return fit_harmonics(mesh, l_max=l_max)


def draw_surface(fit: "object", l_max: int, level: int) -> Steps:
    """The fit's surface cut at `l_max`; returns a :class:`Mesh` in the particle's frame."""
    from regolith_studio.harmonics.surface import reconstruct

    yield Started("Drawing the fit")
    return reconstruct(fit, l_max, level=level)


def describe_meshes(meshes: Mapping[str, Mesh]) -> Steps:
    """Descriptors of named meshes; partial results and the result are ``dict[name, Descriptors]``."""
    from regolith_studio.descriptors.describe import describe

    yield Started("Measuring", len(meshes))
    described = {}
    for name, mesh in meshes.items():
        described[name] = describe(mesh)
        yield Partial(dict(described))
        yield Progress(len(described), len(meshes), name)
    return described


def inspect_particles(particles: Sequence[Particle]) -> Steps:
    """Health and descriptors of each particle, in order.

    Partial results and the result are tuples of (``MeshHealth``, ``Descriptors``), so far.
    """
    from regolith_studio.descriptors.describe import describe
    from regolith_studio.geometry.health import inspect

    yield Started("Measuring particles", len(particles))
    seen = []
    for particle in particles:
        seen.append((inspect(particle.mesh), describe(particle.mesh)))
        yield Partial(tuple(seen))
        yield Progress(len(seen), len(particles), particle.name)
    return tuple(seen)
