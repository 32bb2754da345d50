"""Jobs for the angle of repose (2.6, 3.3): simulate the lifting cylinder, measure the pile."""

import time
from collections.abc import Generator, Iterable, Iterator
from contextlib import closing
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from regolith_studio.dataset.folder_io import dataset_hash, read_dataset
from regolith_studio.dem.angle_of_repose import ReposeMeasurement, check_number, measure_repose
from regolith_studio.dem.case import PreparedCase, ReposeCase, prepare
from regolith_studio.dem.drum_angle import DrumMeasurement, measure_drum
from regolith_studio.dem.engine import CheckedEngine, Engine, ResumableEngine, SimulationResult
from regolith_studio.dem.engine_process import EngineError, run_engine
from regolith_studio.dem.engines import (
    DEFAULT_ENGINE,
    ENGINES,
    check_capability,
    check_case,
    engine_named,
)
from regolith_studio.dem.evaluation import EvaluationSettings
from regolith_studio.dem.evaluation.section import NotAPileError
from regolith_studio.dem.heap_packing import HeapPacking, measure_packing
from regolith_studio.dem.initial_packing import loose_column, no_particles
from regolith_studio.dem.run_io import (
    Measured,
    run_document,
    save_result,
    save_shapes,
    snapshot_files,
    staged_run,
    with_filling,
    with_kept_filling,
)
from regolith_studio.dem.snapshot import ParticleState, Snapshot, read_particle_state
from regolith_studio.dem.verification.certificate import (
    MEASUREMENTS,
    QUICK,
    Turn,
    measure_lines,
    verifiable_engine,
)
from regolith_studio.dem.verification.heaps import SEEDS, HeapRuns, step_pair
from regolith_studio.errors import InputError, MissingRequirement
from regolith_studio.jobs.events import Job, JobResult, Partial, Progress, Started, Step, Steps
from regolith_studio.jobs.executor import Executor, value_of
from regolith_studio.jobs.runners.process_pool import ProcessPoolRunner, cores
from regolith_studio.messages import N_
from regolith_studio.steps import as_events

PROGRESS_STEPS = 1000
"""Of a run, in its progress."""
MAX_PREVIEWED = 20_000
"""Placing so many particles takes some seconds."""


@dataclass(frozen=True)
class ReposeRequest:
    """How to simulate a case.

    Parameters
    ----------
    case
        What is simulated.
    engine
        Key of the engine.
    settings
        Of the engine, or ``None`` for its defaults.
    evaluation
        How the pile is measured.
    overwrite
        Whether an earlier run in the folder may be replaced.
    threads
        Of an engine that uses several; they change no result.
    filling
        Folder of a run of the same particles, whose filled cylinder is lifted again; ``None`` to fill it.
    kept
        Folders of runs; where `filling` names none, the first filling among them is taken that the same
        engine made of the same particles with the same friction.

    Raises
    ------
    InputError
        If the particles are too few for an angle, or the engine has not what the case needs.
    """

    case: ReposeCase = field(default_factory=ReposeCase)
    engine: str = DEFAULT_ENGINE
    settings: Any = None
    evaluation: EvaluationSettings = field(default_factory=EvaluationSettings)
    overwrite: bool = False
    threads: int = 1
    filling: Path | None = None
    kept: tuple[Path, ...] = ()

    def __post_init__(self) -> None:
        if self.case.drum is None:
            check_number(self.case.n_particles, self.evaluation)
        check_case(engine_named(self.engine), self.case)


@dataclass(frozen=True, eq=False)
class ReposeRun:
    """A run on disk.

    - ``folder``: where it is.
    - ``document``: content of its ``repose.json``.
    - ``ending``: particles and checks.
    - ``measurement``: the angle, that of a drum as a
      :class:`~regolith_studio.dem.drum_angle.DrumMeasurement`, or the reason why there is none.
    """

    folder: Path
    document: dict[str, Any]
    ending: SimulationResult
    measurement: Measured


def repose_steps(dataset_folder: Path, folder: Path, request: ReposeRequest) -> Steps:
    """Draw particles from a dataset on disk, simulate, measure, write; returns :class:`ReposeRun`.

    Partial results are :class:`~regolith_studio.dem.engine.Snapshot`. What was saved stays when the run
    is stopped or fails, and ``repose.json`` says so; but it replaces no finished run. A run that was killed
    or stopped goes on from the last state of its engine when the same is asked for again.
    """
    prepared = prepared_case(dataset_folder, request)
    return (yield from simulate_prepared(prepared, folder, request))


def prepared_case(dataset_folder: Path, request: ReposeRequest) -> PreparedCase:
    """The drawn particles, in the filling of an earlier run if one is named or kept."""
    prepared = prepare(read_dataset(dataset_folder), request.case, dataset_hash(dataset_folder))
    if request.filling is not None:
        return with_filling(prepared, request.filling)
    engine = engine_named(request.engine)
    if not isinstance(engine, ResumableEngine):
        return prepared
    return with_kept_filling(prepared, engine, request.settings or engine.Settings(), request.kept)


def simulate_prepared(prepared: PreparedCase, folder: Path, request: ReposeRequest) -> Steps:
    """The same for particles that are drawn already."""
    yield Started(N_("Angle of repose"), PROGRESS_STEPS)
    engine = engine_named(request.engine)
    settings = engine.Settings() if request.settings is None else request.settings
    check_prepared(engine, prepared)
    if problem := engine.find().problem:
        raise MissingRequirement(problem)
    with staged_run(folder, request.overwrite) as stage:
        save_shapes(stage, prepared)
        return (yield from _simulate(_RunWriter(prepared, engine, settings, stage), folder, request))


def check_prepared(engine: Engine, prepared: PreparedCase) -> None:
    """Check that an engine simulates the shapes of a case, and begins with its filling."""
    check_case(engine, prepared.case)
    if prepared.are_compounds:
        check_capability(engine, "compounds", f"compounds of convex parts ({prepared.dataset_name})")
    if isinstance(engine, CheckedEngine):
        engine.check(prepared)
    if prepared.filling is not None and not isinstance(engine, ResumableEngine):
        others = [each.label for each in ENGINES.values() if isinstance(each, ResumableEngine)]
        raise InputError(
            f"{engine.label} fills its cylinder itself; an earlier filling goes with {', '.join(others)}."
        )


def _simulate(record: "_RunWriter", folder: Path, request: ReposeRequest) -> Steps:
    """Run the engine and save how it ends."""
    steps = run_engine(record.engine.key, record.prepared, record.settings, record.folder, request.threads)
    share, message = 0.0, N_("starting")
    try:
        while True:
            try:
                moment = next(steps)
            except StopIteration as end:
                return _finish_run(record, end.value, folder, request.evaluation)
            if isinstance(moment, Snapshot):
                share, message = moment.share, moment.message
                yield Partial(moment)
            yield Progress(round(PROGRESS_STEPS * share), PROGRESS_STEPS, message)
    except EngineError as error:
        error.document = record.save("failed", problem=str(error))
        raise
    except (GeneratorExit, KeyboardInterrupt):
        record.save("stopped")
        raise
    finally:
        steps.close()


@dataclass(frozen=True, eq=False)
class _RunWriter:
    """What is written whenever and however a run ends."""

    prepared: PreparedCase
    engine: Engine
    settings: Any
    folder: Path
    begun: float = field(default_factory=time.monotonic)

    def save(
        self,
        state: str,
        ending: SimulationResult | None = None,
        measured: Measured | None = None,
        packing: HeapPacking | None = None,
        problem: str | None = None,
    ) -> dict[str, Any]:
        document = run_document(
            self.prepared,
            self.engine,
            self.settings,
            state=state,
            ending=ending,
            measured=measured,
            packing=packing,
            problem=problem,
            n_snapshots=len(snapshot_files(self.folder)),
        )
        particles = ending.particles if ending else None
        save_result(self.folder, document, particles, time.monotonic() - self.begun)
        return document


def _finish_run(
    record: _RunWriter, ending: SimulationResult, folder: Path, evaluation: EvaluationSettings
) -> ReposeRun:
    measured: Measured
    packing = None
    if record.prepared.case.drum is None:
        measured = measure_result(ending, evaluation)
    else:
        measured = _measure_moments(record)
    if isinstance(measured, ReposeMeasurement):
        from regolith_studio.studies.figures.repose import write_section_figure  # matplotlib

        write_section_figure(ending.particles.points, ending.particles.diameters, measured, record.folder)
        packing = measure_packing(record.prepared, ending.particles, measured)
    document = record.save("finished", ending, measured, packing)
    return ReposeRun(folder, document, ending, measured)


def _measure_moments(record: _RunWriter) -> DrumMeasurement | NotAPileError:
    """The angles of a drum from the snapshots of the run; a refusal is a result too."""
    try:
        return measure_drum(record.prepared, map(read_particle_state, snapshot_files(record.folder)))
    except NotAPileError as refusal:
        return refusal


def measure_result(
    ending: SimulationResult, evaluation: EvaluationSettings
) -> ReposeMeasurement | NotAPileError:
    """The angle of a finished run; a refusal is a result too."""
    try:
        return measure_repose(ending.particles.points, ending.particles.diameters, evaluation)
    except NotAPileError as refusal:
        return refusal


def preview_repose(dataset_folder: Path, request: ReposeRequest) -> Steps:
    """The particles of a case before they fall, or in the filling of an earlier run.

    Returns (:class:`PreparedCase`, :class:`ParticleState`). The state is empty where there are more than
    `MAX_PREVIEWED`.
    """
    yield Started(N_("Drawing particles"))
    prepared = prepared_case(dataset_folder, request)
    yield Progress(1, 2)
    if len(prepared) > MAX_PREVIEWED:
        return prepared, no_particles()
    return prepared, prepared.filling if prepared.filling is not None else loose_column(prepared)


def remeasure(pile: ParticleState, evaluation: EvaluationSettings) -> Steps:
    """The angle of a heap once more, with other choices; returns the measurement or the refusal."""
    yield Started(N_("Measuring"))
    try:
        return measure_repose(pile.points, pile.diameters, evaluation)
    except NotAPileError as refusal:
        return refusal


def verify_engine(key: str, quick: bool = False) -> Steps:
    """Measure the lines of an engine, each a :class:`Partial` when it is done; returns a
    :class:`~regolith_studio.dem.verification.certificate.Certificate`.

    The seeds of the half step run beside the other lines, on all cores.

    ``key``: of the engine. ``quick``: leave out what takes more than minutes: gravity and dice.
    """
    runs, keys = HeapRuns(verifiable_engine(key)), QUICK if quick else MEASUREMENTS

    def events(turn: Turn) -> Iterator[Step]:
        name, line = turn
        if line is not None:
            yield Partial(line)
        yield Progress(keys.index(name) + (line is not None), len(keys), name)

    yield Started(N_("Verifying the engine"), len(keys))
    n, others = cores() - 1, SEEDS[1:]
    with closing(Executor(len(others), ProcessPoolRunner(n) if n else None)) as executor:
        if n:
            pairs = executor.results(Job(_step_pair, (key, seed)) for seed in others)
            next(pairs)  # submits them all
            runs.further_pairs = partial(_values, pairs)
        return (yield from as_events(measure_lines(runs, keys), events))


def _step_pair(key: str, seed: int) -> Steps:
    yield Started(N_("Verifying the engine"))
    return (yield from as_events(step_pair(verifiable_engine(key), seed), lambda _step: (Progress(0, 1),)))


def _values(results: Iterable[JobResult | None]) -> Generator[None, None, list[Any]]:
    """What the jobs returned; the caller gets a turn while they run."""
    values = []
    for result in results:
        if result is None:
            yield
        else:
            values.append(value_of(result))
    return values
