"""The angle of repose of a dataset: simulate the lifting cylinder, measure the pile (2.6, 3.3)."""

import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from regolith_studio.dataset.folder import read_dataset
from regolith_studio.dataset.reading import dataset_hash
from regolith_studio.dem.case import Prepared, ReposeCase, prepare
from regolith_studio.dem.engine import Ending, Engine, Moment
from regolith_studio.dem.engines import DEFAULT_ENGINE, engine_named
from regolith_studio.dem.evaluation.refusal import NoPile
from regolith_studio.dem.evaluation.settings import EvaluationSettings
from regolith_studio.dem.filling import loose_column
from regolith_studio.dem.host import run_engine
from regolith_studio.dem.pile import Pile
from regolith_studio.dem.repose import ReposeMeasurement, measure_repose
from regolith_studio.dem.run_document import run_document
from regolith_studio.dem.run_folder import claim_folder, save_ending, save_shapes, snapshot_files
from regolith_studio.errors import EnvironmentProblem, RegolithError
from regolith_studio.jobs.events import Partial, Progress, Started, Steps

PARTS = 1000
"""Of a run, in its progress."""


@dataclass(frozen=True)
class ReposeOrder:
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
    """

    case: ReposeCase = field(default_factory=ReposeCase)
    engine: str = DEFAULT_ENGINE
    settings: Any = None
    evaluation: EvaluationSettings = field(default_factory=EvaluationSettings)
    overwrite: bool = False


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
    ending: Ending
    measurement: ReposeMeasurement | NoPile


def simulate_repose(dataset_folder: Path, folder: Path, order: ReposeOrder) -> Steps:
    """Draw particles from a dataset on disk, simulate, measure, write; returns :class:`ReposeRun`.

    Partial results are :class:`~regolith_studio.dem.engine.Moment`. What was saved stays when the run
    is stopped or fails, and ``repose.json`` says so.
    """
    yield Started("Angle of repose", PARTS)
    prepared = prepare(read_dataset(dataset_folder), order.case, dataset_hash(dataset_folder))
    return (yield from simulate_prepared(prepared, folder, order))


def simulate_prepared(prepared: Prepared, folder: Path, order: ReposeOrder) -> Steps:
    """The same for particles that are drawn already."""
    engine = engine_named(order.engine)
    settings = engine.Settings() if order.settings is None else order.settings
    if problem := engine.find().problem:
        raise EnvironmentProblem(problem)
    claim_folder(folder, order.overwrite)
    save_shapes(folder, prepared)
    record = _Record(prepared, engine, settings, folder)
    steps = run_engine(engine.key, prepared, settings, folder)
    share, message = 0.0, "starting"
    try:
        while True:
            try:
                moment = next(steps)
            except StopIteration as end:
                return _concluded(record, end.value, order.evaluation)
            if isinstance(moment, Moment):
                share, message = moment.share, moment.message
                yield Partial(moment)
            yield Progress(round(PARTS * share), PARTS, message)
    except RegolithError as error:
        record.save("failed", problem=str(error))
        raise
    except GeneratorExit:
        record.save("stopped")
        raise
    finally:
        steps.close()


@dataclass(frozen=True, eq=False)
class _Record:
    """What is written whenever and however a run ends."""

    prepared: Prepared
    engine: Engine
    settings: Any
    folder: Path
    begun: float = field(default_factory=time.monotonic)

    def save(
        self,
        state: str,
        ending: Ending | None = None,
        measured: ReposeMeasurement | NoPile | None = None,
        problem: str | None = None,
    ) -> dict[str, Any]:
        document = run_document(
            self.prepared,
            self.engine,
            self.settings,
            state=state,
            seconds=time.monotonic() - self.begun,
            ending=ending,
            measured=measured,
            problem=problem,
            n_snapshots=len(snapshot_files(self.folder)),
        )
        save_ending(self.folder, document, ending.pile if ending else None)
        return document


def _concluded(record: _Record, ending: Ending, evaluation: EvaluationSettings) -> ReposeRun:
    measured = measured_or_refused(ending, evaluation)
    if isinstance(measured, ReposeMeasurement):
        from regolith_studio.studies.repose_figures import write_section_figure  # matplotlib

        write_section_figure(ending.pile.points, ending.pile.diameters, measured, record.folder)
    document = record.save("finished", ending, measured)
    return ReposeRun(record.folder, document, ending, measured)


def measured_or_refused(ending: Ending, evaluation: EvaluationSettings) -> ReposeMeasurement | NoPile:
    """The angle of a finished run; a refusal is a result too. The plate is at z = 0."""
    try:
        return measure_repose(ending.pile.points, ending.pile.diameters, evaluation, base=0.0)
    except NoPile as refusal:
        return refusal


def preview_repose(dataset_folder: Path, case: ReposeCase) -> Steps:
    """The particles of a case before they fall; returns (:class:`Prepared`, :class:`Pile`)."""
    yield Started("Drawing particles")
    prepared = prepare(read_dataset(dataset_folder), case, dataset_hash(dataset_folder))
    yield Progress(1, 2)
    return prepared, loose_column(prepared)


def remeasure(pile: Pile, evaluation: EvaluationSettings) -> Steps:
    """The angle of a pile once more, with other choices; returns the measurement or the refusal."""
    yield Started("Measuring")
    try:
        return measure_repose(pile.points, pile.diameters, evaluation, base=0.0)
    except NoPile as refusal:
        return refusal
