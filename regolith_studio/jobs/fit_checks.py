"""Whether a fit is near enough to its particle, and which degree would be."""

from collections.abc import Sequence

from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.descriptors.comparison import relative_errors
from regolith_studio.descriptors.describe import describe
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.surface import reconstruct
from regolith_studio.jobs.compile_kernels import compile_first
from regolith_studio.jobs.events import Failed, Job, Started, Steps
from regolith_studio.jobs.executor import Executor, open_executor, value_of
from regolith_studio.jobs.particle_jobs import FitRequest
from regolith_studio.messages import N_

TOLERANCE = 0.05
"""Relative error of a descriptor beyond which a fit is far off."""
_CHECKED = (*LOSS_KEYS, "convexity", "elongation", "flatness")
_DEGREES, _LEVEL = (10, 15, 20, 30, 40), 5
"""Degrees that are tried, and the level of the surfaces that are measured."""


def check_fits(
    particles: Sequence[Particle],
    fits: Sequence[HarmonicFit],
    request: FitRequest,
    workers: int | Executor = 1,
) -> Steps:
    """A sentence on each fit that is far off, empty on others; returns a tuple of them."""
    yield from compile_first("fit")
    yield Started(N_("Measuring the fits"), len(particles))
    pairs = zip(particles, fits, strict=True)
    jobs = [Job(check_fit, (particle.mesh, fit, request)) for particle, fit in pairs]
    with open_executor(workers) as executor:
        results = yield from executor.run_all(jobs, [particle.name for particle in particles])
    return tuple(each.sentence if isinstance(each, Failed) else value_of(each) for each in results)


def check_fit(mesh: Mesh, fit: HarmonicFit, request: FitRequest) -> Steps:
    """Which descriptors of a fit are off by more than :data:`TOLERANCE`, and the degree at which none is."""
    yield Started(N_("Measuring the fits"))
    errors = _errors(mesh, fit)
    far = sorted((key for key in errors if errors[key] > TOLERANCE), key=errors.__getitem__, reverse=True)
    if not far:
        return ""
    words = ", ".join(f"{key} {100 * errors[key]:.0f} %" for key in far)
    remedy = _remedy(mesh, fit, request)
    return f"The fit up to l = {fit.l_max} is off by more than {100 * TOLERANCE:.0f} % in {words}; {remedy}"


def _remedy(mesh: Mesh, fit: HarmonicFit, request: FitRequest) -> str:
    for degree in _DEGREES:
        if degree <= fit.l_max:
            continue
        try:
            finer = request.fit_options.fit(mesh, degree)
        except RegolithError:
            break
        if max(_errors(mesh, finer).values()) <= TOLERANCE:
            return f"l_max {degree} would do."
    return f"no degree up to {_DEGREES[-1]} would do."


def _errors(mesh: Mesh, fit: HarmonicFit) -> dict[str, float]:
    reference, found = (describe(each, keys=_CHECKED) for each in (mesh, reconstruct(fit, level=_LEVEL)))
    return relative_errors(reference, found, _CHECKED)
