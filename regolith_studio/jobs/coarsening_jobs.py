"""Jobs that coarsen one particle, with every improved polyhedron as a partial result, or a sample."""

import time
from collections import deque
from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

from regolith_studio.coarsening.coarsen import coarsening_steps, in_unit
from regolith_studio.coarsening.core.line_overlap import compound_distance
from regolith_studio.coarsening.loss import loss
from regolith_studio.coarsening.methods import METHODS
from regolith_studio.coarsening.progress import CoarseningProgress
from regolith_studio.coarsening.result import CoarseningResult
from regolith_studio.coarsening.settings import DEFAULT_METHOD, FACETS_LIMITS
from regolith_studio.coarsening.stopping_criteria import Trial, fewest_facets
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import JACCARD, LossWeights
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.descriptors.describe import Descriptors, describe, relative_errors
from regolith_studio.errors import JobCancelled
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.ray_casting import jaccard_distance
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.fit_options import DEFAULT_FIT_OPTIONS, FIT_DEGREE, FitOptions
from regolith_studio.harmonics.synthesis import reconstruct
from regolith_studio.jobs.compile_kernels import compile_first, compile_first_for, is_compiled
from regolith_studio.jobs.events import (
    Failed,
    Finished,
    Job,
    JobResult,
    Partial,
    Progress,
    Started,
    Step,
    Steps,
)
from regolith_studio.jobs.executor import Executor, open_executor
from regolith_studio.messages import N_

N_RECENT = 200
"""Steps that come with each progress."""


@dataclass(frozen=True)
class CoarseningRequest:
    """Parameters of a coarsening; picklable.

    - ``weights``: of the loss, Eq. 9.
    - ``settings``: the method's settings that differ from its defaults, as (name, value) pairs.
    - ``target``: ``particle``: the mesh itself is imitated; ``fit``: the surface at degree `l_max`, drawn at
      `level` (section 3.2).
    - ``fit_options``: how the fit is made, to degree 30 or `l_max`.
    - ``largest_error``: where given, the fewest facets whose weighted errors are all below it, instead of
      `n_facets`.
    """

    weights: LossWeights
    n_facets: int = 20
    method: str = DEFAULT_METHOD
    settings: tuple[tuple[str, bool | int | float | str], ...] = ()
    seed: int = 0
    target: str = "particle"
    l_max: int = 10
    level: int = 4
    fit_options: FitOptions = DEFAULT_FIT_OPTIONS
    largest_error: float | None = None

    @property
    def max_facets(self) -> int:
        """Facets that no polyhedron exceeds."""
        return self.n_facets if self.largest_error is None else FACETS_LIMITS[1]

    @property
    def kept(self) -> frozenset[str]:
        """Terms of the loss that the method keeps exactly."""
        return self.weights.kept if METHODS[self.method].keeps_terms else frozenset()

    @property
    def stopping_criterion(self) -> str:
        """How fine the polyhedra are, to be put into a sentence."""
        if self.largest_error is None:
            return f"{self.n_facets} facets"
        return f"the fewest facets whose errors are all below {100 * self.largest_error:g} %"


@dataclass(frozen=True)
class CoarsenedParticle:
    """Result of coarsening one particle of a sample.

    - ``coarsened``: ``None`` if it failed.
    - ``problem``: why it failed, in one sentence.
    - ``coefficients``: of the fit cut at the request's l_max; ``None`` where none was made.
    - ``notes``: what to know about the particle: repairs of its mesh, warnings of its fit.
    - ``seconds``: time of fit and coarsening together.
    """

    name: str
    index: int
    coarsened: CoarseningResult | None
    problem: str = ""
    coefficients: ShCoefficients | None = None
    notes: tuple[str, ...] = ()
    seconds: float = 0.0


def coarsen_one(mesh: Mesh, request: CoarseningRequest) -> Steps:
    """Coarsen `mesh` as requested; yields ``CoarseningProgress``, returns a ``CoarseningResult``.

    While the method's kernels are compiled, the polyhedron by quadrics is what there is to see.
    """
    if not is_compiled(request.method):
        yield from compile_first_for("quadric")
        quadric = replace(request, method="quadric", settings=(), largest_error=None)
        yield from _run_coarsening(mesh, quadric)
        yield from compile_first_for(request.method)
    yield Started(N_("Coarsening"))
    return (yield from _run_coarsening(mesh, request))


@dataclass(frozen=True)
class ParticleComparison:
    """A polyhedron against the particle itself, where it imitates the particle's fit.

    ``errors``: relative error of each descriptor of the loss (Eq. 8). ``jaccard_distance``: eq. 7.
    """

    errors: Mapping[str, float]
    jaccard_distance: float


def compare_with_particle(
    mesh: Mesh, descriptors: Descriptors, coarsened: CoarseningResult, box_metric: str = "exact"
) -> Steps:
    """Compare a polyhedron with a particle in whose frame it lies; returns :class:`ParticleComparison`.

    ``descriptors``: of `mesh`, with the same box metric.
    """
    yield from compile_first("describe")
    yield Started(N_("Comparing with the particle"))
    achieved = describe(coarsened.polyhedron, LOSS_KEYS, box_metric)
    solid, moved = coarsened.polyhedron, mesh.moved(shift=-coarsened.centre)
    if isinstance(solid, ConvexCompound):
        overlap = compound_distance(moved, solid)
    else:
        overlap = jaccard_distance(moved, solid)
    return ParticleComparison(relative_errors(descriptors, achieved), overlap)


def coarsen_particle(
    particle: Particle, request: CoarseningRequest, index: int, fit: HarmonicFit | None = None
) -> Steps:
    """Fit (where requested) and coarsen one particle of a sample; returns `CoarsenedParticle`.

    ``fit``: of the particle by the request's options, to at least its degree, if there is one already.
    """
    yield from compile_first_for(request.method)
    yield Started(f"Coarsening {particle.name}")
    begun = time.perf_counter()
    mesh, notes, coefficients = particle.mesh, particle.notes, None
    if request.target == "fit":
        fit = (fit or request.fit_options.fit(mesh, max(request.l_max, FIT_DEGREE))).truncated(request.l_max)
        mesh, notes = reconstruct(fit, request.l_max, level=request.level), notes + fit.warnings
        coefficients = fit.coefficients
    coarsened = yield from _run_coarsening(mesh, request, shown=False)
    seconds = time.perf_counter() - begun
    return CoarsenedParticle(particle.name, index, coarsened, "", coefficients, notes, seconds)


def coarsen_sample(
    particles: Sequence[Particle],
    request: CoarseningRequest,
    workers: int | Executor = 1,
    indices: Sequence[int] | None = None,
) -> Steps:
    """Fit and coarsen every particle; returns a tuple of :class:`CoarsenedParticle`.

    A particle that fails is reported with its message and does not stop the others. The results do not
    depend on `workers` (0: one process a core), nor on where a particle stands in the sample; they carry its
    place in a larger one where `indices` are given.
    """
    yield from compile_first_for(request.method)
    yield Started(N_("Coarsening"), len(particles))
    places = range(len(particles)) if indices is None else indices
    pairs = list(zip(particles, places, strict=True))
    jobs = [Job(coarsen_particle, (particle, request, at)) for particle, at in pairs]
    with open_executor(workers) as executor:
        results = yield from executor.run_all(jobs, [particle.name for particle in particles])
    return tuple(_particle_result(at, p, result) for (p, at), result in zip(pairs, results, strict=True))


def _particle_result(at: int, particle: Particle, result: JobResult) -> CoarsenedParticle:
    match result:
        case Finished(value) if isinstance(value, CoarsenedParticle):
            return value
        case Failed(sentence):
            return CoarsenedParticle(particle.name, at, None, sentence, notes=particle.notes)
        case _:
            raise JobCancelled("The coarsening was stopped.")


@lru_cache(maxsize=4)
def _target(mesh: Mesh) -> Target:
    """The measured target of a mesh; a moved weight or face count need not measure it anew."""
    return Target.of(mesh)


MEASURED_EVERY = 0.05
"""Seconds between two steps whose descriptors are measured: a polyhedron takes some milliseconds."""


def _measured_step(step: CoarseningProgress, target: Target, weights: LossWeights) -> CoarseningProgress:
    """A step with the descriptors of its polyhedron, and the Jaccard distance that is left of its loss."""
    assert step.polyhedron is not None, "there is something to be measured"
    achieved = describe(step.polyhedron, LOSS_KEYS)
    errors = relative_errors(in_unit(target.descriptors, target.scale), achieved)
    rest, weight = step.loss - loss(weights, errors, 0.0), weights[JACCARD]
    distance = min(max(rest / weight, 0.0), 1.0) if weight else float("nan")
    return replace(step, achieved=achieved, errors=errors, jaccard_distance=distance)


def _run_coarsening(mesh: Mesh, request: CoarseningRequest, shown: bool = True) -> Generator[Step, None, Any]:
    """Coarsen `mesh`; the polyhedra of the steps are measured and passed on only where they are `shown`."""
    common: dict[str, Any] = {
        "method": request.method,
        "weights": request.weights,
        "seed": request.seed,
        "settings": dict(request.settings),
    }
    steps: Generator[CoarseningProgress | Trial, None, CoarseningResult]
    if request.largest_error is None:
        steps = coarsening_steps(_target(mesh), request.n_facets, **common)
    else:
        steps = fewest_facets(_target(mesh), request.largest_error, **common)
    trials, recent, due = "", deque[CoarseningProgress](maxlen=N_RECENT), 0.0
    while True:
        try:
            step = next(steps)
        except StopIteration as end:
            return end.value
        if isinstance(step, Trial):
            trials = f"{step.n_facets} facets: {100 * step.largest_error:.2g} %"
            continue
        if shown:
            if step.polyhedron is not None and time.monotonic() >= due:
                step = _measured_step(step, _target(mesh), request.weights)
                due = time.monotonic() + MEASURED_EVERY
            recent.append(step)
            yield Partial(replace(step, recent=tuple(recent)))
        yield Progress(step.step, step.steps, trials)
