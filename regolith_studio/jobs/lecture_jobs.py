"""For a lecture: the paper's annealing iteration by iteration, the fit degree by degree, a field."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from regolith_studio.coarsening.coarsen import coarsen, settings_of
from regolith_studio.coarsening.core.polyhedron_measures import polyhedron_of
from regolith_studio.coarsening.loss import Evaluation
from regolith_studio.coarsening.methods import METHODS
from regolith_studio.coarsening.methods.annealing import AnnealingSettings
from regolith_studio.coarsening.progress import MethodStep, Move
from regolith_studio.coarsening.result import CoarseningResult
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.descriptors.describe import describe, relative_errors
from regolith_studio.errors import GeometryError, InputError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.synthesis import gallery, radii_on_icosphere
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest
from regolith_studio.jobs.compile_kernels import compile_first, compile_first_for
from regolith_studio.jobs.events import Partial, Progress, Started, Steps
from regolith_studio.messages import N_
from regolith_studio.shape_models.materials import materials
from regolith_studio.shape_models.realizations import virtual_mesh

MAX_ITERATIONS = 2_000
"""Iterations of a lesson at most: every one of them keeps its polyhedra."""
PLANE_TOLERANCE = 1e-9
BALLS = 1
"""Degrees up to which a fit is nearly a ball: the box of trimesh has its sides but for 0.02 %, and takes
0.6 s where the search for the least, which can rule out no edge, takes 5 s."""


@dataclass(frozen=True, eq=False)
class AnnealingStep:
    """One iteration of the annealing; polyhedra about the particle's centroid, in its unit.

    - ``number``: k; 0 is the start.
    - ``polyhedron``: after the decision.
    - ``evaluation``: its errors and loss.
    - ``move``: what was proposed and decided; ``None`` for the start.
    - ``before``: the polyhedron as it was.
    - ``proposal``: ``None`` where the half-spaces bound no polyhedron.
    - ``facet``, ``proposed_facet``: facet of the moved plane in `before` and in `proposal`; ``None`` where
      it bounds none.
    - ``distance``: how far the point p_i was moved.
    """

    number: int
    polyhedron: ConvexPolyhedron
    evaluation: Evaluation
    move: Move | None = None
    before: ConvexPolyhedron | None = None
    proposal: ConvexPolyhedron | None = None
    facet: int | None = None
    proposed_facet: int | None = None
    distance: float = 0.0


@dataclass(frozen=True, eq=False)
class AnnealingLesson:
    """An annealing to be looked through, and what the exact method finds for the same request.

    - ``approximated``: the surface that is imitated, in the particle's frame.
    - ``centre``: its centroid, shape (3,).
    - ``scale``: length that one unit of the unit-volume particle stands for.
    - ``exact``: ``None`` until it is known.
    """

    approximated: Mesh
    centre: FloatArray
    scale: float
    n_facets: int
    weights: LossWeights
    settings: AnnealingSettings
    steps: tuple[AnnealingStep, ...]
    exact: CoarseningResult | None = None


def trace_annealing(mesh: Mesh, request: CoarseningRequest) -> Steps:
    """Anneal and keep every iteration, then coarsen exactly; returns an :class:`AnnealingLesson`.

    The seed, weights and number of facets are those of the request, and its settings if they are those of the
    annealing: the last polyhedron is that of the method itself.
    """
    settings = settings_of("annealing", dict(request.settings) if request.method == "annealing" else None)
    if settings.iterations > MAX_ITERATIONS:
        raise InputError(f"A lesson has at most {MAX_ITERATIONS:,} iterations; choose fewer in the settings.")
    if request.weights.all_zero:
        raise InputError("All weights of the loss are 0, so there is nothing to optimise; raise one of them.")
    yield from compile_first_for("exact")
    yield Started(N_("Annealing step by step"), settings.iterations)
    target = Target.of(mesh)
    seed = np.random.SeedSequence(request.seed)
    run = METHODS["annealing"].run(target, request.n_facets, request.weights, seed, settings)
    raw = []
    for step in run:
        raw.append(step)
        yield Progress(step.step, step.steps)
    lesson = AnnealingLesson(
        mesh,
        target.centre,
        target.scale,
        request.n_facets,
        request.weights,
        settings,
        _trace_steps(target, raw),
    )
    yield Partial(lesson)
    exact = coarsen(target, request.n_facets, "exact", request.weights, request.seed)
    return replace(lesson, exact=exact)


def _trace_steps(target: Target, raw: list[MethodStep]) -> tuple[AnnealingStep, ...]:
    """The steps of the method with the polyhedra of all proposals, in the frame of the particle."""
    first = raw[0].half_spaces
    move = raw[1].move
    if first is None or move is None:
        raise ValueError("an annealing begins with a polyhedron and a move")
    points, now = first.points, _polyhedron(target, first)
    steps = [AnnealingStep(0, now, move.before)]
    for step in raw[1:]:
        move = step.move
        if move is None:
            raise ValueError("every iteration has a move")
        proposed = HalfSpaces.from_points(move.points) if move.proposed is not None else None
        proposal = _polyhedron(target, proposed) if proposed is not None else None
        i = move.plane
        after = proposal if move.accepted and proposal is not None else now
        evaluated = move.proposed if move.accepted and move.proposed is not None else move.before
        steps.append(
            AnnealingStep(
                number=step.step,
                polyhedron=after,
                evaluation=evaluated,
                move=move,
                before=now,
                proposal=proposal,
                facet=_facet_in_plane(now, target, points[i]),
                proposed_facet=_facet_in_plane(proposal, target, move.points[i])
                if proposal is not None
                else None,
                distance=target.scale * float(np.linalg.norm(move.points[i] - points[i])),
            )
        )
        if move.accepted:
            points, now = move.points, after
    return tuple(steps)


def _polyhedron(target: Target, half_spaces: HalfSpaces) -> ConvexPolyhedron:
    return polyhedron_of(target.in_particle_frame(half_spaces))


def _facet_in_plane(solid: ConvexPolyhedron, target: Target, point: FloatArray) -> int | None:
    """The facet in the plane of a foot point of the unit-volume particle; ``None`` where it bounds none."""
    foot = target.scale * (point @ target.axes)
    gap = np.linalg.norm(solid.half_spaces.points - foot, axis=1)
    nearest = int(gap.argmin())
    limit = PLANE_TOLERANCE * (target.scale + float(np.linalg.norm(foot)))
    return nearest if gap[nearest] <= limit else None


@dataclass(frozen=True, eq=False)
class DegreeStep:
    """The fit cut at one degree.

    - ``mesh``: its surface in the particle's frame; ``None`` where a radius is negative.
    - ``errors``: relative errors (Eq. 8) against the particle, of the descriptors of the loss; empty with no
      mesh.
    - ``radial_error``: root mean square of the radius left over, as a share of that of the radius.
    - ``mean_radius``: c_00 / sqrt(4 pi).
    """

    l_max: int
    mesh: Mesh | None
    errors: Mapping[str, float]
    radial_error: float
    mean_radius: float


def trace_degrees(mesh: Mesh, fit: HarmonicFit, level: int = 4) -> Steps:
    """The fit at every degree from 0 on; partial results and the result are tuples of :class:`DegreeStep`."""
    yield from compile_first("describe", "degrees")
    degrees = range(fit.l_max + 1)
    yield Started(N_("Fitting degree by degree"), len(degrees))
    truth = describe(mesh, LOSS_KEYS)
    steps: tuple[DegreeStep, ...] = ()
    for degree, surface in gallery(fit, degrees, level):
        cut = fit.truncated(degree)
        errors = _errors(truth, surface, "trimesh" if degree <= BALLS else "exact")
        steps += (DegreeStep(degree, surface, errors, cut.radial_error, fit.coefficients.mean_radius),)
        yield Partial(steps)
        yield Progress(degree + 1, len(degrees), f"l = {degree}")
    return steps


def _errors(truth: Mapping[str, float], surface: Mesh | None, box_metric: str) -> Mapping[str, float]:
    if surface is None:
        return {}
    try:
        return relative_errors(truth, describe(surface, LOSS_KEYS, box_metric), LOSS_KEYS)
    except GeometryError:
        return {}


@dataclass(frozen=True, eq=False)
class DrawnField:
    """One realisation of a Gaussian field of ln r, and its particle.

    - ``values``: ln(r / mean) at the vertices of `sphere` and of `mesh`, shape (n,).
    - ``sphere``: of radius 1.
    - ``mesh``: the particle, centred on its star point.
    """

    values: FloatArray
    sphere: Mesh
    mesh: Mesh


def draw_field(material: str, amplitudes: FloatArray, seed: int, level: int = 4) -> DrawnField:
    """Draw a particle of a material with other amplitudes sqrt(A_l) / mu, l = 1, 2, ...

    The same seed has the same random numbers, so that the particle changes with its spectrum.
    """
    card = materials().get(material)
    if card is None:
        raise InputError(f"There is no material {material!r}; there are {', '.join(materials())}.")
    model = card.field(len(amplitudes)).with_amplitudes(amplitudes)
    draws = model.draw(1, seed)
    mesh = virtual_mesh(draws, 0, level)
    relative = draws.coefficients[0].copy()
    relative[0] = 0.0
    return DrawnField(radii_on_icosphere(ShCoefficients(relative), level), icosphere(level), mesh)


def draw_field_later(material: str, amplitudes: FloatArray, seed: int) -> Steps:
    """:func:`draw_field` as a job; returns :class:`DrawnField`."""
    yield from compile_first("fit")
    yield Started("Drawing a field", 1)
    return draw_field(material, amplitudes, seed)
