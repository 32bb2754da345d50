"""Jobs for the studies of sections 3.1 and 3.2 over a whole sample, and for the gallery of Fig. 7.

A study asks its mapper for one answer a particle (or a few particles), always in the same order. Each answer
is written to a checkpoint; after a resume the study gets those from there and computes the rest. Numbers are
kept to the bit, so that the results do not depend on interruptions.
"""

import contextlib
import dataclasses
import hashlib
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Self

import numpy as np

from regolith_studio.dataset.build import software_versions
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.fit_options import FIT_DEGREE
from regolith_studio.io.checkpoint import Checkpoint, CheckpointRecord
from regolith_studio.jobs.coarsening_jobs import CoarsenedParticle, CoarseningRequest, coarsen_particle
from regolith_studio.jobs.compile_kernels import compile_first, compile_first_for
from regolith_studio.jobs.events import Job, Partial, Progress, Started, Step, Steps
from regolith_studio.jobs.executor import Executor, call, open_executor, value_of
from regolith_studio.messages import N_
from regolith_studio.shape_models.sample import Sample
from regolith_studio.steps import as_events, result_of
from regolith_studio.studies import Mapper, StudyProgress
from regolith_studio.studies.coarsening import TargetChoice, coarsening_study
from regolith_studio.studies.lmax import lmax_study
from regolith_studio.studies.loss_variants import LossVariant, paper_variants
from regolith_studio.studies.polyhedron_gallery import GalleryPolyhedron, GalleryStudy
from regolith_studio.studies.population import population_study

MAX_NUMBERS = 4096
"""Largest array that is kept; larger ones, and answers of other kinds, are computed again."""


class StudyCheckpoint:
    """The answers of one study, in the order in which it asks.

    As a context it removes its file when all went well or nothing is in it, and keeps it otherwise.

    ``path``: of the file, in a folder of its own below that of the results. ``resume``: whether to continue
    with what is there, if anything is.
    """

    def __init__(self, path: Path, resume: bool = False) -> None:
        self._path, self._resume = path, resume
        self._checkpoint: Checkpoint | None = None
        self._known: dict[int, Any] = {}
        self._n_asked = 0

    def open(self, study: str, options: object, inputs: str) -> None:
        """Open the file, before the study asks for anything.

        ``options``: their ``repr`` must name all that the answers depend on. ``inputs``: changes when an
        input does, as :func:`hash_of_particles`.
        """
        subject = {
            "study": study,
            "set of options": _sha256(repr(options).encode("utf-8")),
            "set of particles": inputs,
            "set of program versions": software_versions(),
        }
        if not self._resume or not self._path.exists():
            self._checkpoint = Checkpoint.create(self._path, subject)
            return
        self._checkpoint = Checkpoint.resume(self._path, subject, "study")
        self._known = {record.index: _decode(record) for record in self._checkpoint.records()}

    def wrap(self, mapper: Mapper) -> Mapper:
        """The mapper, called only for answers that are not known, and with its answers kept."""

        def mapped(function: Callable[[Any], Any], items: Iterable[Any]) -> Iterator[Any]:
            listed = list(items)
            numbers = range(self._n_asked, self._n_asked + len(listed))
            self._n_asked += len(listed)
            missing = [item for at, item in zip(numbers, listed, strict=True) if at not in self._known]
            answers = iter(mapper(function, missing)) if missing else iter(())
            for at in numbers:
                if at in self._known:
                    yield self._known.pop(at)
                    continue
                while (answer := next(answers)) is None:
                    yield None
                self._keep(at, answer)
                yield answer

        return mapped

    def _keep(self, at: int, answer: Any) -> None:
        if self._checkpoint is not None and (record := _encode(at, answer)) is not None:
            self._checkpoint.add([record])

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: object, *_error: object) -> None:
        if self._checkpoint is None:
            return
        empty = not self._checkpoint.indices
        self._checkpoint.close()
        if kind is None or empty:
            self._path.unlink(missing_ok=True)
            for folder in (self._path.parent, self._path.parent.parent):
                with contextlib.suppress(OSError):  # not empty: other files stay
                    folder.rmdir()


def hash_of_particles(particles: Sequence[Particle]) -> str:
    """Changes when a name, a group or a coordinate does."""
    whole = hashlib.sha256()
    for each in particles:
        parts = (each.name.encode("utf-8", "surrogateescape"), each.group.encode("utf-8", "surrogateescape"))
        for part in (*parts, each.mesh.vertices.tobytes(), each.mesh.faces.tobytes()):
            whole.update(len(part).to_bytes(8, "little") + part)
    return whole.hexdigest()


def hash_of_rows(rows: np.ndarray[Any, Any], names: Sequence[str] = ()) -> str:
    """Of a table of numbers and the names of its rows."""
    return _sha256(repr((rows.shape, rows.dtype.str, tuple(names))).encode("utf-8") + rows.tobytes())


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _encode(at: int, answer: Any) -> CheckpointRecord | None:
    """A message, an array of numbers, one with a flag for each row, or a document; ``None`` for other kinds.

    A document is a dictionary that JSON can hold: its numbers come back to the bit.
    """
    match answer:
        case str():
            return CheckpointRecord(at, {"text": answer})
        case dict():
            return CheckpointRecord(at, {"document": answer})
        case np.ndarray() if answer.dtype == np.float64 and answer.size <= MAX_NUMBERS:
            numbers = np.ascontiguousarray(answer).astype("<f8").tobytes()
            return CheckpointRecord(at, {"shape": list(answer.shape)}, {"numbers": numbers})
        case (np.ndarray() as table, tuple(flags)) if all(isinstance(flag, bool) for flag in flags):
            encoded = _encode(at, table)
            if encoded is not None:
                return CheckpointRecord(at, {**encoded.values, "flags": list(flags)}, encoded.blobs)
    return None


def _decode(record: CheckpointRecord) -> Any:
    values = record.values
    if "text" in values:
        return values["text"]
    if "document" in values:
        return values["document"]
    numbers = np.frombuffer(record.blobs["numbers"], dtype="<f8")
    table = numbers.astype(np.float64).reshape(values["shape"])
    return (table, tuple(values["flags"])) if "flags" in values else table


def study_lmax(
    particles: Sequence[Particle],
    workers: int | Executor = 1,
    seed: int = 0,
    answers: StudyCheckpoint | None = None,
    **options: Any,
) -> Steps:
    """Fig. 3 for `particles`; partial results and the result are ``LmaxStudy``.

    - ``workers``: processes at a time; 0 for one a core.
    - ``answers``: keeps the results of each particle, so that the study can be resumed.
    - ``options``: further ones of :func:`~regolith_studio.studies.lmax.lmax_study`: degrees, level, keys ...
    """
    yield from compile_first("fit", "describe", "degrees")
    yield Started(N_("RMSRE against l_max"), len(particles))
    if answers is not None:
        answers.open("lmax", (seed, sorted(options.items())), hash_of_particles(particles))
    with open_executor(workers) as executor:
        mapper = _with_answers(executor.map, answers)
        return (yield from as_job_steps(lmax_study(particles, mapper=mapper, seed=seed, **options)))


def study_population(
    sample: Sample,
    models: Sequence[str] | None = None,
    workers: int | Executor = 1,
    answers: StudyCheckpoint | None = None,
    **options: Any,
) -> Steps:
    """Figs. 4 to 6 for `sample`; partial results and the result are ``PopulationStudy``.

    - ``models``: keys of ``MODELS``; all by default.
    - ``workers``: processes at a time; 0 for one a core.
    - ``answers``: keeps the results of particles and draws, so that the study can be resumed.
    - ``options``: further ones of :func:`~regolith_studio.studies.population.population_study`.
    """
    yield from compile_first("describe", "model")
    yield Started(N_("Evaluating models"), 0)
    if answers is not None:
        inputs = hash_of_rows(sample.coefficients, (*sample.names, sample.unit))
        answers.open("population", (models, sorted(options.items())), inputs)
    with open_executor(workers) as executor:
        mapper = _with_answers(partial(_map_with_pauses, executor), answers)
        return (yield from as_job_steps(population_study(sample, models, mapper=mapper, **options)))


def _map_with_pauses(
    executor: Executor, function: Callable[[Any], Any], items: Iterable[Any]
) -> Iterator[Any]:
    """As :meth:`Executor.map`, with ``None`` while waiting, so that the study can be stopped."""
    for result in executor.results(Job(call, (function, item)) for item in items):
        yield None if result is None else value_of(result)


def study_coarsening(
    particles: Sequence[Particle],
    request: CoarseningRequest,
    workers: int | Executor = 1,
    answers: StudyCheckpoint | None = None,
    title: str = "RMSRE against loss weights",
    **options: Any,
) -> Steps:
    """Fig. 8 for `particles`; partial results and the result are ``CoarseningStudy``.

    - ``request``: method, number of facets, settings, seed and target; weights are those of the rows.
    - ``workers``: processes at a time; 0 for one a core.
    - ``answers``: keeps the results of each particle, so that the study can be resumed.
    - ``title``: title of the task.
    - ``options``: further ones of :func:`~regolith_studio.studies.coarsening.coarsening_study`: rows,
      box_metric.
    """
    yield from compile_first_for(request.method, *(row.method for row in options.get("rows") or ()))
    yield Started(title, len(particles))
    if answers is not None:
        answers.open("coarsening", (request, sorted(options.items())), hash_of_particles(particles))
    with open_executor(workers) as executor:
        study = coarsening_study(
            particles,
            n_facets=request.n_facets,
            method=request.method,
            seed=request.seed,
            settings=dict(request.settings),
            target=TargetChoice(request.target, request.l_max, request.level, request.fit_options),
            mapper=_with_answers(executor.map, answers),
            **options,
        )
        return (yield from as_job_steps(study))


def _with_answers(mapper: Mapper, answers: StudyCheckpoint | None) -> Mapper:
    return mapper if answers is None else answers.wrap(mapper)


def as_job_steps(steps: Generator[StudyProgress, None, Any]) -> Generator[Step, None, Any]:
    """The steps of a study as events of a job."""
    return as_events(steps, _study_events)


def _study_events(step: StudyProgress) -> Iterator[Step]:
    yield Progress(step.done, step.total, step.message)
    if step.partial is not None:
        yield Partial(step.partial)


@dataclass(frozen=True)
class GalleryCell:
    """One picture of the gallery.

    ``row``, ``column``: index of the loss and of the particle, from 0. ``outcome``: the polyhedron, or why
    there is none.
    """

    row: int
    column: int
    outcome: CoarsenedParticle


def coarsen_gallery(
    particles: Sequence[Particle], request: CoarseningRequest, rows: Sequence[LossVariant] | None = None
) -> Steps:
    """Coarsen each particle by the loss of each row; results, partial and final, are ``list[GalleryCell]``.

    ``request``: number of facets, seed and target of all. ``rows``: whose weights, method and settings are
    taken; by default those of Fig. 8 by the request's method.
    """
    variants = _variants(rows, request)
    total = len(particles) * len(variants)
    yield Started(N_("Coarsening for the gallery"), total)
    cells: list[GalleryCell] = []
    for column, particle in enumerate(particles):
        fit = _fit_of(particle, request)
        for row, variant in enumerate(variants):
            now = Progress(len(cells), total)
            outcome = yield from _outcome(particle, _with_loss(request, variant), column, fit, now)
            cells.append(GalleryCell(row, column, outcome))
            yield Partial(list(cells))
            yield Progress(len(cells), total, particle.name)
    return cells


def study_gallery(
    particles: Sequence[Particle],
    request: CoarseningRequest,
    rows: Sequence[LossVariant] | None = None,
    workers: int | Executor = 1,
    answers: StudyCheckpoint | None = None,
) -> Steps:
    """As :func:`coarsen_gallery`, particle by particle; the result is the study that can be written.

    ``workers``: processes at a time; 0 for one a core. ``answers``: keeps the polyhedra of each particle, so
    that the study can be resumed.
    """
    variants = _variants(rows, request)
    yield Started(N_("Coarsening for the gallery"), len(particles))
    if answers is not None:
        answers.open("solids", (request, variants), hash_of_particles(particles))
    cells: dict[tuple[int, int], GalleryPolyhedron | str] = {}
    with open_executor(workers) as executor:
        mapper = _with_answers(executor.map, answers)
        columns = mapper(partial(coarsen_column, request=request, rows=variants), list(enumerate(particles)))
        for column, (particle, answer) in enumerate(zip(particles, columns, strict=True)):
            for row, cell in enumerate(answer["rows"]):
                cells[row, column] = cell if isinstance(cell, str) else GalleryPolyhedron.from_document(cell)
            yield Progress(column + 1, len(particles), particle.name)
    return GalleryStudy(tuple(row.label for row in variants), tuple(each.name for each in particles), cells)


def coarsen_column(
    numbered: tuple[int, Particle], request: CoarseningRequest, rows: Sequence[LossVariant]
) -> dict[str, Any]:
    """The polyhedra of one particle, by row, as a document; a sentence where there is none.

    Pure and picklable: for process pools.
    """
    column, particle = numbered
    fit = _fit_of(particle, request)
    cells: list[dict[str, Any] | str] = []
    for row in rows:
        outcome = result_of(_outcome(particle, _with_loss(request, row), column, fit, Progress(0, 0)))
        cell = _polyhedron_of(outcome)
        cells.append(cell if isinstance(cell, str) else cell.document())
    return {"rows": cells}


def _variants(rows: Sequence[LossVariant] | None, request: CoarseningRequest) -> tuple[LossVariant, ...]:
    settings: dict[str, Any] = dict(request.settings)
    return paper_variants(request.method, **settings) if rows is None else tuple(rows)


def study_of_cells(cells: Sequence[GalleryCell], labels: Sequence[str], names: Sequence[str]) -> GalleryStudy:
    """The result of :func:`coarsen_gallery` as a study that can be written."""
    polyhedra = {(each.row, each.column): _polyhedron_of(each.outcome) for each in cells}
    return GalleryStudy(tuple(labels), tuple(names), polyhedra)


def _polyhedron_of(outcome: CoarsenedParticle) -> GalleryPolyhedron | str:
    """What a gallery keeps of a particle, or why there is no polyhedron."""
    return outcome.problem if outcome.coarsened is None else GalleryPolyhedron.of(outcome.coarsened)


def _fit_of(particle: Particle, request: CoarseningRequest) -> HarmonicFit | str | None:
    """The fit that is the target, where one is; the sentence of the error if there is none."""
    if request.target != "fit":
        return None
    try:
        return request.fit_options.fit(particle.mesh, FIT_DEGREE)
    except RegolithError as error:
        return str(error)


def _with_loss(request: CoarseningRequest, row: LossVariant) -> CoarseningRequest:
    method, settings = row.method_run, row.settings_run
    return dataclasses.replace(
        request, weights=row.weights, method=method, settings=settings, largest_error=None
    )


def _outcome(
    particle: Particle,
    request: CoarseningRequest,
    index: int,
    fit: HarmonicFit | str | None,
    now: Progress,
) -> Generator[Step, None, CoarsenedParticle]:
    """Coarsen one particle; yields `now` in place of each of its steps, so that it can be stopped."""
    if isinstance(fit, str):
        return CoarsenedParticle(particle.name, index, None, fit)
    steps = coarsen_particle(particle, request, index, fit)
    try:
        outcome: CoarsenedParticle = yield from as_events(steps, lambda _step: (now,))
        return outcome
    except RegolithError as error:
        return CoarsenedParticle(particle.name, index, None, str(error))
