"""Spherical-harmonics coefficients of one particle, its surface at a degree, and descriptors."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from regolith_studio.descriptors.describe import Descriptors, describe
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.coefficients import checked_degree
from regolith_studio.harmonics.fit import DEFAULT_FIT_OPTIONS, FitOptions, HarmonicFit
from regolith_studio.harmonics.surface import reconstruct
from regolith_studio.jobs.events import Failed, Job, Partial, Progress, Started, Steps
from regolith_studio.jobs.executor import Executor, open_executor, value_of

FIT_DEGREE = 30
"""Everything is fitted to this degree once; lower ones are truncations of that fit."""


@dataclass(frozen=True)
class FitOrder:
    """How particles are to be expanded.

    Parameters
    ----------
    l_max
        Highest degree.
    fit_options
        Star point, radius rule and reference.

    Raises
    ------
    InputError
        If the degree is out of range.
    """

    l_max: int = FIT_DEGREE
    fit_options: FitOptions = DEFAULT_FIT_OPTIONS

    def __post_init__(self) -> None:
        checked_degree(self.l_max, FIT_DEGREE)


def fit_one(mesh: Mesh, order: FitOrder = FitOrder()) -> Steps:
    """Fit `mesh`; returns a ``HarmonicFit``."""
    yield Started("Fitting spherical harmonics")
    return order.fit_options.fit(mesh, order.l_max)


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


def fit_sample(
    particles: Sequence[Particle], order: FitOrder = FitOrder(), workers: int | Executor = 1
) -> Steps:
    """Fit every particle; returns a tuple of ``HarmonicFit``, or the sentence where that is impossible."""
    yield Started("Fitting spherical harmonics", len(particles))
    jobs = [Job(fit_one, (particle.mesh, order)) for particle in particles]
    with open_executor(workers) as executor:
        results = yield from executor.run_all(jobs, [particle.name for particle in particles])
    return tuple(e.sentence if isinstance(e, Failed) else value_of(e) for e in results)
