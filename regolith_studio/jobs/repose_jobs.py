"""Jobs for the angle of repose (2.6, 3.3): simulate the lifting cylinder, measure the pile, vary a value."""

import time
from collections.abc import Generator, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from regolith_studio.coarsening.weights import presets
from regolith_studio.dataset.folder_io import dataset_hash, read_dataset
from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest
from regolith_studio.dem.angle_of_repose import ReposeMeasurement, check_number, measure_repose
from regolith_studio.dem.case import PreparedCase, ReposeCase, prepare
from regolith_studio.dem.engine import Engine, SimulationResult
from regolith_studio.dem.engine_process import EngineError, run_engine
from regolith_studio.dem.engines import DEFAULT_ENGINE, engine_named
from regolith_studio.dem.evaluation.settings import EvaluationSettings, NotAPileError
from regolith_studio.dem.initial_packing import loose_column
from regolith_studio.dem.run_io import (
    case_document,
    read_run,
    run_document,
    save_result,
    save_shapes,
    snapshot_files,
    staged_run,
)
from regolith_studio.dem.snapshot import ParticleState, Snapshot
from regolith_studio.errors import FileError, InputError, MissingRequirement
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest
from regolith_studio.jobs.dataset_jobs import DatasetOptions, build_dataset_folder
from regolith_studio.jobs.events import Partial, Progress, Started, Step, Steps
from regolith_studio.messages import N_
from regolith_studio.studies.repose import runs_from

PROGRESS_STEPS = 1000
"""Of a run, in its progress."""


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

    Raises
    ------
    InputError
        If the particles are too few for an angle.
    """

    case: ReposeCase = field(default_factory=ReposeCase)
    engine: str = DEFAULT_ENGINE
    settings: Any = None
    evaluation: EvaluationSettings = field(default_factory=EvaluationSettings)
    overwrite: bool = False

    def __post_init__(self) -> None:
        check_number(self.case.n_particles, self.evaluation)


@dataclass(frozen=True, eq=False)
class ReposeRun:
    """A run on disk.

    Parameters
    ----------
    folder
        Where it is.
    document
        Content of its ``repose.json``.
    ending
        Particles and checks.
    measurement
        The angle, or the reason why there is none.
    """

    folder: Path
    document: dict[str, Any]
    ending: SimulationResult
    measurement: ReposeMeasurement | NotAPileError


def simulate_repose(dataset_folder: Path, folder: Path, request: ReposeRequest) -> Steps:
    """Draw particles from a dataset on disk, simulate, measure, write; returns :class:`ReposeRun`.

    Partial results are :class:`~regolith_studio.dem.engine.Snapshot`. What was saved stays when the run
    is stopped or fails, and ``repose.json`` says so; but it replaces no finished run.
    """
    prepared = prepare(read_dataset(dataset_folder), request.case, dataset_hash(dataset_folder))
    return (yield from simulate_prepared(prepared, folder, request))


def simulate_prepared(prepared: PreparedCase, folder: Path, request: ReposeRequest) -> Steps:
    """The same for particles that are drawn already."""
    yield Started(N_("Angle of repose"), PROGRESS_STEPS)
    engine = engine_named(request.engine)
    settings = engine.Settings() if request.settings is None else request.settings
    if problem := engine.find().problem:
        raise MissingRequirement(problem)
    with staged_run(folder, request.overwrite) as stage:
        save_shapes(stage, prepared)
        return (yield from _simulate(_RunWriter(prepared, engine, settings, stage), folder, request))


def _simulate(record: "_RunWriter", folder: Path, request: ReposeRequest) -> Steps:
    """Run the engine and save how it ends."""
    steps = run_engine(record.engine.key, record.prepared, record.settings, record.folder)
    share, message = 0.0, "starting"
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
        measured: ReposeMeasurement | NotAPileError | None = None,
        problem: str | None = None,
    ) -> dict[str, Any]:
        document = run_document(
            self.prepared,
            self.engine,
            self.settings,
            state=state,
            ending=ending,
            measured=measured,
            problem=problem,
            n_snapshots=len(snapshot_files(self.folder)),
        )
        particles = ending.particles if ending else None
        save_result(self.folder, document, particles, time.monotonic() - self.begun)
        return document


def _finish_run(
    record: _RunWriter, ending: SimulationResult, folder: Path, evaluation: EvaluationSettings
) -> ReposeRun:
    measured = measure_result(ending, evaluation)
    if isinstance(measured, ReposeMeasurement):
        from regolith_studio.studies.figures.repose import write_section_figure  # matplotlib

        write_section_figure(ending.particles.points, ending.particles.diameters, measured, record.folder)
    document = record.save("finished", ending, measured)
    return ReposeRun(folder, document, ending, measured)


def measure_result(
    ending: SimulationResult, evaluation: EvaluationSettings
) -> ReposeMeasurement | NotAPileError:
    """The angle of a finished run; a refusal is a result too."""
    try:
        return measure_repose(ending.particles.points, ending.particles.diameters, evaluation)
    except NotAPileError as refusal:
        return refusal


def preview_repose(dataset_folder: Path, case: ReposeCase) -> Steps:
    """The particles of a case before they fall; returns (:class:`PreparedCase`, :class:`ParticleState`)."""
    yield Started(N_("Drawing particles"))
    prepared = prepare(read_dataset(dataset_folder), case, dataset_hash(dataset_folder))
    yield Progress(1, 2)
    return prepared, loose_column(prepared)


def remeasure(pile: ParticleState, evaluation: EvaluationSettings) -> Steps:
    """The angle of a pile once more, with other choices; returns the measurement or the refusal."""
    yield Started(N_("Measuring"))
    try:
        return measure_repose(pile.points, pile.diameters, evaluation)
    except NotAPileError as refusal:
        return refusal


CASE_KEYS = ("shapes", "cohesion", "n_particles", "coarse_graining")
"""What of a case can be varied besides the values of Tables 1 and 2."""
SHAPE_KEYS = ("n_facets", "preset")
"""What of the shapes can be varied, each value being a dataset of its own: facets, weights of the loss."""


@dataclass(frozen=True)
class ReposeVariant:
    """One value of what a study varies.

    Parameters
    ----------
    varied, value
        What, and to what.
    dataset
        Folder of the dataset.
    request
        How to run; its seed is the first of the repeats.
    """

    varied: str
    value: float | str
    dataset: Path
    request: ReposeRequest


def study_repose(rows: Sequence[ReposeVariant], folder: Path, repeats: int = 1) -> Steps:
    """Run every row `repeats` times, each run in a folder of its own; returns :class:`ReposeStudy`.

    Runs that a folder holds already, finished and of the same case, are not run again: a study that was
    stopped is resumed. A run that fails is a row without an angle.
    """
    plan = [(row, row.request.case.seed + k) for row in rows for k in range(repeats)]
    yield Started(N_("Angle of repose: study"), PROGRESS_STEPS * len(plan))
    done: list[tuple[str, float | str, str, dict[str, Any]]] = []
    for number, (row, seed) in enumerate(plan):
        request = replace(row.request, case=replace(row.request.case, seed=seed), overwrite=True)
        place = folder / f"{row.varied}_{row.value}_seed{seed}".replace("/", "-").replace(" ", "-")
        document = _finished_run(place, row.dataset, request)
        if document is None:
            document = yield from _study_run(row, request, place, number, len(plan))
        done.append((row.varied, row.value, place.name, document))
        yield Progress(PROGRESS_STEPS * (number + 1), PROGRESS_STEPS * len(plan), place.name)
        yield Partial(runs_from(done))
    return runs_from(done)


def _study_run(
    row: ReposeVariant, request: ReposeRequest, place: Path, number: int, total: int
) -> Generator[Step, None, dict[str, Any]]:
    steps = simulate_repose(row.dataset, place, request)
    try:
        while True:
            try:
                step = next(steps)
            except StopIteration as end:
                return dict(end.value.document)
            if isinstance(step, Progress):
                message = f"{row.varied} {row.value}: {step.message}"
                yield Progress(PROGRESS_STEPS * number + step.done, PROGRESS_STEPS * total, message)
    except EngineError as error:
        return error.document
    finally:
        steps.close()


def _finished_run(place: Path, dataset: Path, request: ReposeRequest) -> dict[str, Any] | None:
    """The document of a finished run of the same case on the same dataset, if there is one."""
    try:
        document = read_run(place).document
    except FileError:
        return None
    engine = engine_named(request.engine)
    settings = asdict(engine.Settings() if request.settings is None else request.settings)
    same = (
        document["state"] == "finished"
        and document["dataset"]["sha256"] == dataset_hash(dataset)
        and document["case"] == case_document(request.case)
        and document["engine"]["key"] == engine.key
        and document["engine"]["settings"] == settings
        and document["measurement"].get("settings", asdict(request.evaluation)) == asdict(request.evaluation)
    )
    return document if same else None


def with_value(request: ReposeRequest, key: str, value: Any) -> ReposeRequest:
    """The same request with one value of Table 1, Table 2 or the case changed.

    Raises
    ------
    InputError
        If there is no such value, or it cannot be this.
    """
    case = request.case
    if key in CASE_KEYS:
        return replace(request, case=replace(case, **{key: value}))
    for part, kind in (("contact", ContactParameters), ("test", LiftingCylinderTest)):
        if key in {each.name for each in fields(kind)}:
            changed = replace(getattr(case, part), **{key: _to_float(key, value)})
            return replace(request, case=replace(case, **{part: changed}))
    known = [each.name for kind in (ContactParameters, LiftingCylinderTest) for each in fields(kind)]
    raise InputError(f"{key!r} cannot be varied; these can: {', '.join([*known, *CASE_KEYS])}.")


def _to_float(key: str, value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError) as error:
        raise InputError(f"The value of {key} must be a number, got {value!r}.") from error


@dataclass(frozen=True, eq=False)
class ReposeStudyRequest:
    """What is varied, and how; picklable.

    Parameters
    ----------
    key, values
        Of Table 1, Table 2, the case, or :data:`SHAPE_KEYS`.
    request
        Of every run, but for the value.
    dataset
        Folder of the dataset; not needed where the shapes are varied.
    repeats
        Runs of each value, with seeds one after the other.
    particles, coarsening
        What datasets are made from where the shapes are varied.

    Raises
    ------
    InputError
        If a value cannot be used, or what the study needs is missing.
    """

    key: str
    values: tuple[float | str, ...]
    request: ReposeRequest
    dataset: Path | None = None
    repeats: int = 1
    particles: tuple[Particle, ...] = ()
    coarsening: CoarseningRequest | None = None

    def __post_init__(self) -> None:
        if not self.values:
            raise InputError("A study needs values: write them with commas between them.")
        if self.key in SHAPE_KEYS:
            if not self.particles or self.coarsening is None:
                raise InputError("Shapes are varied from open particles; open some, or the shipped sample.")
            for value in self.values:
                _with_shape_value(self.coarsening, self.key, value)
            return
        if self.dataset is None:
            raise InputError(N_("There is no dataset yet: open one, or make one first."))
        for value in self.values:
            with_value(self.request, self.key, value)


def values_in(key: str, text: str) -> tuple[float | str, ...]:
    """Values written with commas between them: names, whole numbers or numbers, as the key has them.

    Raises
    ------
    InputError
        If one is none.
    """
    words = [word.strip() for word in text.split(",") if word.strip()]
    if key in ("shapes", "cohesion", "preset"):
        return tuple(dict.fromkeys(words))
    whole = key in ("n_facets", "n_particles")
    try:
        return tuple(dict.fromkeys(int(word) if whole else float(word) for word in words))
    except ValueError as error:
        kind = "whole numbers" if whole else "numbers"
        raise InputError(f"Values of this kind are {kind} with commas between them, got {text!r}.") from error


def run_repose_study(study_request: ReposeStudyRequest, folder: Path) -> Steps:
    """Run a study in a folder of its own and write its tables and figure; returns ``ReposeStudy``."""
    rows: list[ReposeVariant] = []
    if study_request.key not in SHAPE_KEYS:
        assert study_request.dataset is not None
        rows = [
            ReposeVariant(
                study_request.key,
                value,
                study_request.dataset,
                with_value(study_request.request, study_request.key, value),
            )
            for value in study_request.values
        ]
    else:
        yield Started("Angle of repose: datasets", len(study_request.values))
        for number, value in enumerate(study_request.values):
            place = folder / "datasets" / f"{study_request.key}-{value}"
            yield from _build_variant_dataset(study_request, number, place)
            rows.append(ReposeVariant(study_request.key, value, place, study_request.request))
    study = yield from study_repose(rows, folder, study_request.repeats)
    from regolith_studio.studies.figures.repose import write_repose_study  # matplotlib

    write_repose_study(study, folder)
    return study


def _build_variant_dataset(study_request: ReposeStudyRequest, number: int, place: Path) -> Steps:
    """A dataset of the open particles with one of the values; the same particles give the same bytes."""
    assert study_request.coarsening is not None
    value = study_request.values[number]
    request = _with_shape_value(study_request.coarsening, study_request.key, value)
    preset = str(value) if study_request.key == "preset" else None
    options = DatasetOptions(name=f"{study_request.key} {value}", preset=preset, overwrite=True)
    for step in build_dataset_folder(study_request.particles, request, place, options):
        if isinstance(step, Progress):
            yield Progress(number, len(study_request.values), f"dataset of {value}: {step.message}")


def _with_shape_value(request: CoarseningRequest, key: str, value: float | str) -> CoarseningRequest:
    """The request with another number of facets or other weights."""
    if key == "preset":
        known = presets()
        if value not in known:
            raise InputError(f"There is no preset {value!r}; there are {', '.join(known)}.")
        return replace(request, weights=known[str(value)].weights)
    if not isinstance(value, int) or not 4 <= value <= 1000:
        raise InputError(f"A particle has between 4 and 1,000 facets, got {value}.")
    return replace(request, n_facets=value, largest_error=None)
