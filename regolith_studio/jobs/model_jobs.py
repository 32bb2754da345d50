"""Jobs for virtual particles (sections 2.3 and 3.1): fit a shape model, draw particles, make meshes,
evaluate models against a sample."""

from collections.abc import Generator, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.errors import GeometryError, InputError, RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.fit_options import FIT_DEGREE
from regolith_studio.harmonics.synthesis import level_for, reconstruct
from regolith_studio.io.atomic import write_in_stage
from regolith_studio.io.file_names import MAX_NAME_BYTES, cut_name, file_stem
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.jobs.compile_kernels import compile_first
from regolith_studio.jobs.events import Job, Partial, Progress, Started, Step, Steps
from regolith_studio.jobs.executor import Executor, open_executor, value_of
from regolith_studio.jobs.particle_jobs import FitRequest, MeasuredParticle, fit_sample, measure_particle
from regolith_studio.jobs.study_jobs import study_population
from regolith_studio.messages import N_
from regolith_studio.readers.shape_files import ShapeSource, radius_of
from regolith_studio.shape_models.chunked_sampling import check_draws, joined
from regolith_studio.shape_models.materials import MaterialCard
from regolith_studio.shape_models.models import DEFAULT_MODEL, MODELS, model_settings
from regolith_studio.shape_models.protocol import FittedModel, SizeRange
from regolith_studio.shape_models.realizations import Realizations, virtual_mesh
from regolith_studio.shape_models.sample import Sample
from regolith_studio.shape_models.size_law import checked_bounds
from regolith_studio.steps import as_events
from regolith_studio.studies.population import (
    KEYS,
    MEASURE_BATCH,
    MESH_LEVEL,
    PopulationStudy,
    default_draws,
    descriptors_of,
)
from regolith_studio.studies.population_distances import WEIGHTINGS, DistributionComparison
from regolith_studio.studies.population_tables import (
    PopulationPanel,
    components_panels,
    density_panels,
    pair_panels,
    quantile_panels,
)

STL_HEADER = "Regolith Studio, virtual particle, micrometres"
PAPER_DEGREE = 10
BATCH_SIZE = 20
"""Particles that one process makes at a time."""
N_EXAMPLES = 6
MAX_SIZED = 10_000
"""Drawn particles whose sizes are computed at once."""
ModelOrigin = ShapeSource | tuple[Particle, ...]


@dataclass(frozen=True)
class GenerationRequest:
    """Which model is to draw which particles.

    - ``model``: key of ``MODELS``; empty for what the source brings, or the default one.
    - ``settings``: of the model that differ from its own, as pairs.
    - ``l_max``: degree of the particles; ``None`` for that of the model's settings, where the source has it:
      all degrees for ``recombined``, ``sample_matched`` and ``hull_field``, 10 for the others (section 3.1).
    - ``n``: how many.
    - ``seed``: of all draws.
    - ``size_range``: smallest and largest equivalent radius, micrometres.
    """

    model: str = ""
    settings: tuple[tuple[str, Any], ...] = ()
    l_max: int | None = None
    n: int = 100
    seed: int = 0
    size_range: SizeRange | None = None

    def __post_init__(self) -> None:
        if self.n < 1:
            raise InputError(f"At least one particle must be drawn, got {self.n}.")
        if self.seed < 0:
            raise InputError(f"A seed must not be negative, got {self.seed}.")
        if self.l_max is not None and not 1 <= self.l_max <= FIT_DEGREE:
            raise InputError(f"l_max must lie between 1 and {FIT_DEGREE}, got {self.l_max}.")
        checked_bounds(self.size_range)
        if self.model or self.settings:
            model_settings(self.model or DEFAULT_MODEL, dict(self.settings))


def fit_request_for(request: GenerationRequest | None = None) -> FitRequest:
    """How meshes are expanded for a request: to twice its degree, which maps of measured surfaces need."""
    wanted = None if request is None else request.l_max
    return FitRequest(FIT_DEGREE if wanted is None else min(FIT_DEGREE, 2 * wanted))


def sample_of_meshes(
    particles: Sequence[Particle], request: FitRequest, workers: int | Executor = 1
) -> Steps:
    """Expand particles for a model; returns a :class:`ShapeSource`, its notes name those left out."""
    fits = yield from fit_sample(particles, request, workers)
    return source_of_fits(particles, fits)


def source_of_fits(particles: Sequence[Particle], fits: Sequence[HarmonicFit | str]) -> ShapeSource:
    """The sample of what ``fit_sample`` returned for `particles`; failed ones become notes."""
    good = [
        (p.name, radius_of(fit)) for p, fit in zip(particles, fits, strict=True) if not isinstance(fit, str)
    ]
    notes = tuple(f"{p.name}: {fit}" for p, fit in zip(particles, fits, strict=True) if isinstance(fit, str))
    groups = sorted({particle.group for particle in particles if particle.group})
    sample = Sample.of([coefficients for _, coefficients in good], [name for name, _ in good])
    return ShapeSource(sample, ", ".join(groups) or "meshes", notes=notes)


def fit_model(source: ShapeSource, request: GenerationRequest) -> Steps:
    """Fit the model that a request names to a source; returns a ``FittedModel``.

    Raises InputError if they do not go together, or the model cannot be fitted.
    """
    content = source.content
    yield from compile_first("model")
    yield Started(N_("Fitting the model"))
    if isinstance(content, MaterialCard):
        return _model_of_card(content, request)
    if not isinstance(content, Sample):
        return _given_model(content, request)
    key = request.model or DEFAULT_MODEL
    settings = model_settings(key, dict(request.settings))
    degree = min(settings.l_max, content.l_max) if request.l_max is None else request.l_max
    settings = replace(settings, l_max=degree)
    return MODELS[key].fit(content, settings)


def make_card(sample: Sample, name: str, label: str, origin: str) -> Steps:
    """The card of a sample with its hull field, evaluated against the sample; returns a ``MaterialCard``."""
    yield from compile_first("model")
    yield Started(N_("Making a material card"))
    return MaterialCard.of(sample, name, label, origin)


def draw(model: FittedModel, request: GenerationRequest) -> Steps:
    """Draw the particles of a request, chunk by chunk; returns :class:`Realizations`."""
    check_draws(request.n, model.l_max)
    yield from compile_first("model")
    yield Started(N_("Drawing"), request.n)
    parts: list[Realizations] = []
    for part in model.draw_chunks(request.n, request.seed, request.size_range):
        parts.append(part)
        yield Progress(sum(map(len, parts)), request.n)
    return joined(parts)


def _model_of_card(card: MaterialCard, request: GenerationRequest) -> FittedModel:
    if request.model not in ("", card.key) or request.settings:
        raise InputError(
            f"The card {card.name} holds no particles, so that no other model can be fitted to it: it brings "
            f"{card.key} with settings of its own."
        )
    return card.model(request.l_max)


def _given_model(model: FittedModel, request: GenerationRequest) -> FittedModel:
    if request.model not in ("", model.key) or request.settings or request.l_max not in (None, model.l_max):
        raise InputError(
            f"The file holds a fitted model ({model.key}, l_max = {model.l_max}); for another one begin with "
            "the fit of the sample."
        )
    return model


def particle_names(n: int, first: int = 0) -> tuple[str, ...]:
    """virtual-000001, virtual-000002 and so on, whatever their number."""
    return tuple(f"virtual-{first + i + 1:06d}" for i in range(n))


def drawn_names(title: str, n: int) -> tuple[str, ...]:
    """title-0000, title-0001 and so on: what is drawn in one go, with digits for all of it."""
    digits = max(4, len(str(n - 1)))
    title = cut_name(title, MAX_NAME_BYTES - 1 - digits)
    return tuple(f"{title}-{index:0{digits}d}" for index in range(n))


def groups_of(draws: Realizations, model: FittedModel) -> tuple[str, ...]:
    """Name of the mixture's part that each particle was drawn from; empty where a model has no parts."""
    names = getattr(model, "names", ())
    return tuple(names[c] for c in np.asarray(draws.components)) if names else ("",) * len(draws)


def particles_of(
    draws: Realizations, groups: Sequence[str] = (), level: int | None = None, first: int = 0
) -> tuple[Particle, ...]:
    """The drawn particles as closed meshes on ``icosphere(level)``.

    - ``groups``: one for each particle; none by default.
    - ``level``: by default that of their degree.
    - ``first``: number of the first one, for its name.
    """
    names = particle_names(len(draws), first)
    level = level_for(draws.l_max) if level is None else level
    return tuple(
        Particle(name, virtual_mesh(draws, i, level), groups[i] if groups else "", notes=(_origin(draws),))
        for i, name in enumerate(names)
    )


_VIRTUAL = "Virtual particle"


def _origin(draws: Realizations) -> str:
    return f"{_VIRTUAL} (model {draws.model}, seed {draws.seed})."


def is_origin(note: str) -> bool:
    """Whether a particle's note says that it was drawn from a model, not what was changed."""
    return note.startswith(_VIRTUAL)


def drawn_group(part: str, title: str) -> str:
    """Group of drawn particles: another one than that of the particles that the model was fitted to.

    - ``part``: the mixture's part that they were drawn from, if it has parts.
    - ``title``: of their population.
    """
    return part or f"{title} (virtual)"


def make_particles(draws: Realizations, model: FittedModel, title: str, level: int | None = None) -> Steps:
    """The drawn particles as a recipe with a population of the name `title` has them, with progress.

    Returns a tuple of :class:`Particle`.
    """
    yield Started(N_("Making meshes"), len(draws))
    level = level_for(draws.l_max) if level is None else level
    names, parts = drawn_names(title, len(draws)), groups_of(draws, model)
    notes, made = (_origin(draws),), []
    for index, (name, part) in enumerate(zip(names, parts, strict=True)):
        group = drawn_group(part, title)
        made.append(Particle(name, virtual_mesh(draws, index, level), group, notes=notes))
        yield Progress(index + 1, len(draws), name)
    return tuple(made)


def write_meshes(
    draws: Realizations, groups: Sequence[str], level: int, folder: Path, workers: int | Executor = 1
) -> Steps:
    """Write ``<name>.stl`` of each particle into `folder`; returns what is known of each, in order.

    Each process makes, measures and writes particles of its own, so that memory does not grow with their
    number. Returns a tuple of :class:`MeasuredParticle`.
    """
    yield Started(N_("Writing particles"), len(draws))
    jobs = (
        Job(
            _write_batch,
            (
                draws.chosen(range(first, min(first + BATCH_SIZE, len(draws)))),
                tuple(groups[first : first + BATCH_SIZE]),
                level,
                folder,
                first,
            ),
        )
        for first in range(0, len(draws), BATCH_SIZE)
    )
    facts: list[MeasuredParticle] = []
    with open_executor(workers) as executor:
        for result in executor.results(jobs):
            facts += value_of(result) if result is not None else ()
            yield Progress(len(facts), len(draws))
    return tuple(facts)


def _write_batch(draws: Realizations, groups: tuple[str, ...], level: int, folder: Path, first: int) -> Steps:
    yield Started(N_("Writing particles"), len(draws))
    facts = []
    for particle in particles_of(draws, groups, level, first):
        write_in_stage(
            folder, f"{file_stem(particle.name)}.stl", stl_bytes(particle.mesh.triangles, STL_HEADER)
        )
        facts.append(measure_particle(particle))
    return tuple(facts)


@dataclass(frozen=True, eq=False)
class ModelFitResult:
    """A fitted model, what it was fitted to, and some of the measured particles at its degree.

    - ``source``: all that was known; a model fitted to a half has seen only that.
    - ``model``: fitted.
    - ``n_fitted``: particles that the model was fitted to; 0 where it came as a card or file.
    - ``examples``: meshes of measured particles, centred; none where there are none.
    - ``first``: a drawn particle, that of seed 0; none where the model can draw none.
    """

    source: ShapeSource
    model: FittedModel
    n_fitted: int
    examples: tuple[Mesh, ...]
    first: Mesh | None = None


@dataclass(frozen=True, eq=False)
class GenerationResult:
    """Drawn particles, meshes of the first of them, what they were drawn from, and the ends of their r_eq.

    `radii` is left out where there are more than :data:`MAX_SIZED`.
    """

    draws: Realizations
    examples: tuple[Mesh, ...]
    model: FittedModel
    request: GenerationRequest
    radii: tuple[float, float] | None = None


def fit_shapes(origin: ModelOrigin, request: GenerationRequest, half: bool = False) -> Steps:
    """Expand particles where that is needed, and fit; returns :class:`ModelFitResult`.

    ``origin``: particles, or what a file or a material has to offer. ``half``: fit to the random half that a
    study with the same seed fits to in its first split.
    """
    if isinstance(origin, tuple):
        source: ShapeSource = yield from sample_of_meshes(origin, fit_request_for(request))
    else:
        source = origin
    sample = source.content if isinstance(source.content, Sample) else None
    fitted_to = source
    if sample is not None and half:
        fitted_to = ShapeSource(
            sample.chosen(sample.halves(request.seed)[0]), source.name, source.sha256, source.notes
        )
    model: FittedModel = yield from fit_model(fitted_to, request)
    n_fitted = len(fitted_to.content) if isinstance(fitted_to.content, Sample) else 0
    first: Mesh | None = None
    with suppress(RegolithError):
        first = live_mesh(model, 0)
    examples = _example_meshes(sample, model.l_max) if sample else ()
    if sample is not None:
        _ = sample.equivalent_radii  # kept by the sample; the window asks for them
    return ModelFitResult(source, model, n_fitted, examples, first)


def draw_shapes(model: FittedModel, request: GenerationRequest) -> Steps:
    """Draw the particles of a request; returns :class:`GenerationResult`."""
    draws: Realizations = yield from draw(model, request)
    level = level_for(draws.l_max)
    meshes = [virtual_mesh(draws, i, level) for i in range(min(N_EXAMPLES, len(draws)))]
    radii = draws.equivalent_radii() if 0 < len(draws) <= MAX_SIZED else None
    ends = None if radii is None else (float(radii.min()), float(radii.max()))
    return GenerationResult(draws, tuple(meshes), model, request, ends)


def draw_live(model: FittedModel, seed: int) -> Steps:
    """:func:`live_mesh` as a job; returns the mesh."""
    yield from compile_first("model")
    yield Started("Drawing a particle", 1)
    return live_mesh(model, seed)


def live_mesh(model: FittedModel, seed: int) -> Mesh:
    """One particle; the same seed gives the same random numbers, so that it changes with the spectrum."""
    return virtual_mesh(model.draw(1, seed), 0, level_for(model.l_max))


def _example_meshes(sample: Sample, l_max: int) -> tuple[Mesh, ...]:
    """Particles from all over the sample, in their own places of its order."""
    picks = np.unique(np.linspace(0, len(sample) - 1, N_EXAMPLES).astype(int))
    cut = sample.truncated(min(l_max, sample.l_max))
    meshes = []
    for index in picks:
        try:
            meshes.append(reconstruct(cut.particle(int(index)), level=level_for(cut.l_max)))
        except GeometryError:
            continue
    return tuple(meshes)


MIN_FOR_PROCESSES = 400
"""Particles to be measured beyond which processes are started: some seconds of work, and fits that this
process could not be stopped at."""


@dataclass(frozen=True, eq=False)
class ModelEvaluationResult:
    """A study, and the panels of its figures by name: number, volume, pairs, quantiles, components."""

    study: PopulationStudy
    panels: Mapping[str, tuple[PopulationPanel, ...]]


def evaluate_models(sample: Sample, models: Sequence[str] | None, **options: Any) -> Steps:
    """Evaluate models; partial results and the result are :class:`ModelEvaluationResult`.

    Long studies use one process a core. The options are those of
    :func:`~regolith_studio.studies.population.population_study`.
    """
    rounds = options.get("n_splits", 5) * options.get("n_repeats", 5) * len(models or MODELS)
    n_measured = len(sample) + rounds * default_draws(len(sample))
    steps = study_population(sample, models, 0 if n_measured > MIN_FOR_PROCESSES else 1, **options)
    shown = Progress(0, n_measured, "")
    while True:
        try:
            step: Step = next(steps)
        except StopIteration as end:
            return (yield from evaluation_panels(end.value, shown))
        if isinstance(step, Progress):
            shown = step
        if isinstance(step, Partial):
            step = Partial((yield from evaluation_panels(step.value, shown)))
        yield step


def evaluation_panels(
    study: PopulationStudy, shown: Progress
) -> Generator[Step, None, ModelEvaluationResult]:
    """The study with the panels of its figures; how far the work is stays as `shown`."""
    at_figures = replace(shown, message="figures")
    panels = {name: density_panels(study, name) for name in WEIGHTINGS}
    panels |= {"quantiles": quantile_panels(study), "components": components_panels(study)}
    yield at_figures
    pairs = yield from as_events(pair_panels(study), lambda _step: (at_figures,))
    return ModelEvaluationResult(study, panels | {"pairs": pairs})


MAX_COMPARED = 300
"""Particles of either kind that are measured at most: ten seconds of work for rough ones."""
_SMOOTH_DEGREE = 10
"""Up to this degree meshes one level coarser are measured: boxes of fine smooth ones take a second each."""


def compare_distributions(
    sample: Sample | None,
    draws: Realizations,
    size_range: SizeRange | None = None,
    workers: int | Executor = 1,
) -> Steps:
    """Measure drawn and measured particles, these with all their degrees and at that of the draws. A job.

    Measured particles are taken from all over the sample, those of the range of sizes. Returns
    :class:`~regolith_studio.studies.population_distances.DistributionComparison`.
    """
    kinds = [draws.chosen(range(min(len(draws), MAX_COMPARED)))]
    if sample is not None:
        kinds += _measured_kinds(sample, draws, size_range)
    total = sum(len(each) for each in kinds)
    level = MESH_LEVEL - (max(each.l_max for each in kinds) <= _SMOOTH_DEGREE)
    yield from compile_first("describe")
    yield Started(N_("Comparing distributions"), total)
    tables, done = [], 0
    with open_executor(workers) as executor:
        for each in kinds:
            tables.append((yield from _descriptor_table(each, level, (done, total), executor)))
            done += len(each)
    drawn, measured, cut = (*tables, *(np.empty((0, len(KEYS))),) * 2)[:3]
    degree = draws.l_max if sample is None else sample.l_max
    return DistributionComparison(KEYS, measured, drawn, cut, draws.model, draws.l_max, degree)


def _measured_kinds(
    sample: Sample, draws: Realizations, size_range: SizeRange | None
) -> Iterator[Realizations]:
    """The sample's particles, and cut at the degree of the draws where that is lower."""
    low, high = size_range or (0.0, np.inf)
    inside = np.flatnonzero((sample.equivalent_radii >= low) & (sample.equivalent_radii <= high))
    places = np.linspace(0, len(inside) - 1, min(len(inside), MAX_COMPARED)).astype(np.int64)
    rows = sample.coefficients[inside[np.unique(places)]]
    yield Realizations(rows, "radius", "measured", draws.seed, sample.unit)
    if draws.l_max < sample.l_max:
        cut = rows[:, : (draws.l_max + 1) ** 2]
        yield Realizations(cut, "radius", "measured", draws.seed, sample.unit)


def _descriptor_table(
    draws: Realizations, level: int, place: tuple[int, int], executor: Executor
) -> Generator[Step, None, FloatArray]:
    batches = (range(i, min(i + MEASURE_BATCH, len(draws))) for i in range(0, len(draws), MEASURE_BATCH))
    jobs = (Job(_measure_batch, (draws.chosen(batch), level)) for batch in batches)
    tables = [np.empty((0, len(KEYS)))]
    for result in executor.results(jobs):
        if result is not None:
            tables.append(value_of(result))
        yield Progress(place[0] + sum(map(len, tables)), place[1])
    table = np.concatenate(tables)
    return table[np.isfinite(table).all(axis=1)]


def _measure_batch(draws: Realizations, level: int) -> Steps:
    yield Started(N_("Comparing distributions"), len(draws))
    return descriptors_of(draws, KEYS, level)
