"""Jobs for particles: read files, measure descriptors and mesh health, fit spherical harmonics."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path

import numpy as np

from regolith_studio.descriptors.catalogue import CATALOGUE, DEFAULT_KEYS, LOSS_KEYS
from regolith_studio.descriptors.describe import Descriptors, describe, description_steps, relative_errors
from regolith_studio.errors import GeometryError, RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.mesh_health import MeshHealth, inspect
from regolith_studio.geometry.particle import Particle, defect_triangles
from regolith_studio.harmonics.coefficients import checked_degree
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.fit_options import DEFAULT_FIT_OPTIONS, FIT_DEGREE, FitOptions
from regolith_studio.harmonics.star_point import StarPointVisibility, hidden_faces, star_point_visibility
from regolith_studio.harmonics.synthesis import reconstruct
from regolith_studio.jobs.compile_kernels import compile_first
from regolith_studio.jobs.events import Failed, Job, Partial, Progress, Started, Steps
from regolith_studio.jobs.executor import Executor, open_executor, value_of
from regolith_studio.messages import N_, Message, Number, join_messages
from regolith_studio.readers.coefficient_tables import DEFAULT_TABLE_READING, TableConvention, TableReading
from regolith_studio.readers.particles import (
    FileProblem,
    LoadedParticles,
    MeshFile,
    collect_particles,
    find_files,
    left_out,
    read_each,
    sample_particles,
)
from regolith_studio.readers.settings import AS_USUAL, ReadingSettings
from regolith_studio.steps import result_of

LARGE = 200_000
"""Faces of a mesh from which on the parts of its measurement are reported: they take more than a second."""


def load_particles(
    paths: Sequence[Path],
    reading: ReadingSettings = AS_USUAL,
    tables: TableReading = DEFAULT_TABLE_READING,
    most: int | None = None,
    seed: int = 0,
) -> Steps:
    """Read the meshes in `paths` (files, folders, archives); returns :class:`LoadedParticles`.

    Tables of coefficients are read as `tables` says. Of more members of archives than `most` a random part is
    read.
    """
    problems: list[FileProblem] = []
    results: list[Particle | FileProblem] = []
    files = find_files(paths, problems, tables)
    files, notes = _random_part(files, len(files) if most is None else most, seed)
    yield from compile_first("read")
    yield Started(N_("Reading particles"), len(files))
    for done, (file, result) in enumerate(read_each(files, reading), start=1):
        results.append(result)
        yield Progress(done, len(files), file.path.name)
    return replace(collect_particles(results, problems), left_out=(*notes, *left_out(paths)))


def _random_part(files: list[MeshFile], most: int, seed: int) -> tuple[list[MeshFile], tuple[str, ...]]:
    """The files with at most so many members of archives, in order, and a sentence if that is a part."""
    members = [index for index, file in enumerate(files) if file.member is not None]
    if len(members) <= most:
        return files, ()
    left = set(members) - set(np.random.default_rng(seed).choice(members, most, replace=False).tolist())
    sentence = N_("Shown is a random part of the archive: {shown} of {total}, seed {seed}.")
    note = Message(sentence, shown=Number(most, ",d"), total=Number(len(members), ",d"), seed=seed)
    return [file for index, file in enumerate(files) if index not in left], (note,)


def measure_first(paths: Sequence[Path], convention: TableConvention = "auto") -> Steps:
    """Name and longest side of the first mesh, as its file gives it.

    Where it cannot be read: why, as a sentence, if there is no other file, else ``None``.
    """
    yield Started(N_("Reading particles"))
    problems: list[FileProblem] = []
    files = find_files(paths, problems, TableReading(None, convention))
    for file, result in read_each(files[:1], ReadingSettings(repair=False)):
        if not isinstance(result, FileProblem):
            return file.path.stem, float(np.ptp(result.mesh.bounds, axis=0).max())
        problems.append(result)
    return problems[0].sentence if len(files) < 2 and problems else None


def load_sample() -> Steps:
    """Read the particles that ship with the program; returns :class:`LoadedParticles`."""
    yield from compile_first("read")
    yield Started(N_("Reading the sample"))
    return LoadedParticles(tuple(sample_particles()))


@dataclass(frozen=True)
class MeasuredParticle:
    """Health, descriptors and visibility of a particle, before anything is fitted.

    - ``descriptors``: ``None`` where the mesh has none, for example because it is flat.
    - ``problem``: why, in one sentence.
    - ``visibility``: what its star point cannot see; ``None`` where the mesh has no inside, for example
      because it is open.
    """

    health: MeshHealth
    descriptors: Descriptors | None
    problem: str = ""
    visibility: StarPointVisibility | None = None


def measure_particle(
    particle: Particle, box_metric: str = "exact", keys: Sequence[str] = DEFAULT_KEYS
) -> MeasuredParticle:
    """Health, descriptors and visibility of one particle; never raises for what is wrong with the mesh."""
    measured: MeasuredParticle = result_of(_measuring(particle, box_metric, keys))
    return measured


def _measuring(particle: Particle, box_metric: str, keys: Sequence[str]) -> Steps:
    """As :func:`measure_particle`; a large mesh names what is worked out before each part."""
    known = particle.repair
    parts = 2 + len(keys)
    is_large = len(particle.mesh.faces) >= LARGE
    if is_large:
        yield Progress(0, parts, N_("Checking the mesh"))
    health = known.health_after if known and known.mesh is particle.mesh else inspect(particle.mesh)
    if is_large:
        yield Progress(1, parts, N_("Visibility"))
    visibility = _visibility(particle)
    steps = description_steps(particle.mesh, keys, box_metric)
    try:
        for done in count(2):
            label = next(steps)
            if is_large:
                yield Progress(done, parts, label)
    except StopIteration as end:
        return MeasuredParticle(health, end.value, "", visibility)
    except RegolithError as error:
        return MeasuredParticle(health, None, str(error), visibility)


def _visibility(particle: Particle) -> StarPointVisibility | None:
    try:
        return star_point_visibility(particle.mesh)
    except RegolithError:
        return None


def find_faults(particle: Particle, visibility: StarPointVisibility | None = None) -> Steps:
    """Where a mesh is faulty or was before its repair, and what its star point cannot see.

    Returns the corners (k, 3, 3) of the triangles of each kind, as ``defect_triangles`` names them, and
    ``hidden``.
    """
    yield Started(N_("Checking the mesh"))
    corners: dict[str, FloatArray] = defect_triangles(particle)
    if visibility is not None and visibility.hidden_surface_share > 0.0:
        hidden = hidden_faces(particle.mesh, np.array(visibility.star_point))
        corners["hidden"] = particle.mesh.triangles[hidden]
    return corners


def measure_one(particle: Particle, keys: Sequence[str] = DEFAULT_KEYS) -> Steps:
    """As :func:`measure_particle`, for a runner."""
    yield from compile_first("describe")
    yield Started(N_("Measuring"))
    return (yield from _measuring(particle, "exact", keys))


def measure_particles(particles: Sequence[Particle]) -> Steps:
    """Each particle in order; partial results and the result are tuples of :class:`MeasuredParticle`, so far.

    A partial result comes when an eighth more is known, so that the copied tuples grow as the number of
    particles and not as its square.
    """
    yield from compile_first("describe")
    yield Started(N_("Measuring particles"), len(particles))
    measured: list[MeasuredParticle] = []
    due = 1
    for particle in particles:
        measured.append(measure_particle(particle))
        if len(measured) >= due:
            yield Partial(tuple(measured))
            due = len(measured) + max(1, len(measured) // 8)
        yield Progress(len(measured), len(particles), particle.name)
    return tuple(measured)


def measure_sample(
    particles: Sequence[Particle], workers: int | Executor = 1, keys: Sequence[str] = DEFAULT_KEYS
) -> Steps:
    """As :func:`measure_particles`, in one or several processes; returns a tuple of what was measured."""
    yield from compile_first("describe")
    yield Started(N_("Measuring"), len(particles))
    jobs = [Job(measure_one, (particle, keys)) for particle in particles]
    with open_executor(workers) as executor:
        results = yield from executor.run_all(jobs, [particle.name for particle in particles])
    return tuple(value_of(result) for result in results)


@dataclass(frozen=True)
class FitRequest:
    """How particles are to be expanded.

    ``l_max``: highest degree. ``fit_options``: star point, radius rule and reference.
    """

    l_max: int = FIT_DEGREE
    fit_options: FitOptions = DEFAULT_FIT_OPTIONS

    def __post_init__(self) -> None:
        checked_degree(self.l_max, FIT_DEGREE)


def fit_one(mesh: Mesh, request: FitRequest = FitRequest()) -> Steps:
    """Fit `mesh`; returns a ``HarmonicFit``."""
    yield from compile_first("fit")
    yield Started(N_("Fitting spherical harmonics"))
    return request.fit_options.fit(mesh, request.l_max)


def draw_surface(fit: HarmonicFit, l_max: int, level: int) -> Steps:
    """The fit's surface cut at `l_max`; returns a :class:`Mesh` in the particle's frame."""
    yield Started(N_("Drawing the fit"))
    try:
        return reconstruct(fit, l_max, level=level)
    except GeometryError as error:
        sentence = N_(
            "The expansion up to l = {degree} has negative radii and bounds no solid: choose another l_max, "
            "star point or reference."
        )
        raise GeometryError(Message(sentence, degree=l_max)) from error


def describe_meshes(meshes: Mapping[str, Mesh], box_metric: str = "exact") -> Steps:
    """Descriptors of named meshes; partial results and the result are ``dict[name, Descriptors]``."""
    yield from compile_first("describe")
    yield Started(N_("Measuring"), len(meshes))
    described: dict[str, Descriptors] = {}
    for name, mesh in meshes.items():
        described[name] = describe(mesh, box_metric=box_metric)
        yield Partial(dict(described))
        yield Progress(len(described), len(meshes), name)
    return described


def fit_sample(
    particles: Sequence[Particle], request: FitRequest = FitRequest(), workers: int | Executor = 1
) -> Steps:
    """Fit every particle; returns a tuple of ``HarmonicFit``, or the sentence where that is impossible."""
    yield from compile_first("fit")
    yield Started(N_("Fitting spherical harmonics"), len(particles))
    jobs = [Job(fit_one, (particle.mesh, request)) for particle in particles]
    with open_executor(workers) as executor:
        results = yield from executor.run_all(jobs, [particle.name for particle in particles])
    return tuple(e.sentence if isinstance(e, Failed) else value_of(e) for e in results)


TOLERANCE = 0.05
"""Relative error of a descriptor beyond which a fit is far off."""
_NEARLY = 0.8
CHECKED = (*LOSS_KEYS, "convexity", "elongation", "flatness")
_DEGREES = (10, 15, 20, 30, 40)
"""Degrees that are tried."""
_NAMED = 3
"""Descriptors that are named, the worst ones."""
_SMOOTH_DEGREE, _LEVELS = 10, (3, 4)
"""Levels of the surfaces that are measured, up to this degree and above: fine enough for the tolerance.
The box of a smooth surface takes twenty times as long at the next level."""


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
    parts = [
        Message(
            "{label} {error} %", label=Message(CATALOGUE[key].label), error=Number(100 * errors[key], ".0f")
        )
        for key in far[:_NAMED]
    ]
    if len(far) > _NAMED:
        parts.append(Message(N_("{count} more"), count=len(far) - _NAMED))
    return Message(
        N_("At l = {degree} off by more than {limit} %: {descriptors}; {remedy}"),
        degree=fit.l_max,
        limit=Number(100 * TOLERANCE, ".0f"),
        descriptors=join_messages(parts, ", "),
        remedy=_remedy(mesh, fit, request),
    )


def may_be_far(reference: Descriptors, descriptors: Descriptors) -> bool:
    """Whether descriptors of particle and fit, on whatever meshes, are near :data:`TOLERANCE` or beyond."""
    return max(relative_errors(reference, descriptors, CHECKED).values()) > _NEARLY * TOLERANCE


def _remedy(mesh: Mesh, fit: HarmonicFit, request: FitRequest) -> Message:
    for degree in _DEGREES:
        if degree <= fit.l_max:
            continue
        try:
            finer = request.fit_options.fit(mesh, degree)
        except RegolithError:
            break
        if max(_errors(mesh, finer).values()) <= TOLERANCE:
            return Message(N_("l_max {degree} would do."), degree=degree)
    return Message(N_("no degree up to {degree} would do."), degree=_DEGREES[-1])


def _errors(mesh: Mesh, fit: HarmonicFit) -> dict[str, float]:
    surface = reconstruct(fit, level=_LEVELS[fit.l_max > _SMOOTH_DEGREE])
    reference, descriptors = (describe(each, keys=CHECKED) for each in (mesh, surface))
    return relative_errors(reference, descriptors, CHECKED)
