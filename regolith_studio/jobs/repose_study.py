"""Job for the angle of repose against a varied value: runs, their table and the figure, in one folder."""

import contextlib
import os
import shutil
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any

from regolith_studio.coarsening.weights import presets
from regolith_studio.dataset.folder_io import dataset_hash
from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest
from regolith_studio.dem.engine_process import EngineError
from regolith_studio.dem.engines import engine_named
from regolith_studio.dem.run_io import DOCUMENT, case_document, filling_hash, read_run, settled_filling
from regolith_studio.errors import FileError, InputError
from regolith_studio.geometry.particle import Particle
from regolith_studio.io.atomic import JOURNAL, remove_quietly, staged_folder
from regolith_studio.io.output_lock import output_lock
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest
from regolith_studio.jobs.dataset_jobs import DatasetOptions, build_dataset_folder
from regolith_studio.jobs.events import Job, Partial, Progress, Started, Steps
from regolith_studio.jobs.executor import Executor, open_executor, value_of
from regolith_studio.jobs.repose_jobs import PROGRESS_STEPS, ReposeRequest, repose_steps
from regolith_studio.messages import N_, Message
from regolith_studio.studies.repose import ReposeStudy, ReposeSurface, runs_from

CASE_KEYS = ("shapes", "cohesion", "bond_number", "n_particles", "coarse_graining")
"""What of a case can be varied besides the values of Tables 1 and 2."""
OF_PARTICLES = ("shapes", "n_particles", "coarse_graining", "density", "mass", "diameter")
"""What a filling cannot be taken again with another value of."""
SHAPE_KEYS = ("n_facets", "preset")
"""What of the shapes can be varied, each value being a dataset of its own: facets, weights of the loss."""


@dataclass(frozen=True)
class ReposeVariant:
    """One value of what a study varies.

    - ``varied``, ``value``: what, and to what.
    - ``dataset``: folder of the dataset.
    - ``request``: how to run; its seed is the first of the repeats.
    """

    varied: str
    value: float | str
    dataset: Path
    request: ReposeRequest


STUDY = "repose_study"
"""Stem of the files of a study, and name of its folder in the journal."""
DATASETS = "datasets"
"""Folder of a study of shapes with the dataset of each value."""


def study_repose(
    rows: Sequence[ReposeVariant],
    folder: Path,
    repeats: int = 1,
    executor: Executor | int = 1,
    same_filling: bool = False,
) -> Steps:
    """Run every row `repeats` times, each run in a folder of its own; returns :class:`ReposeStudy`.

    Runs are kept in the journal of the folder until :func:`write_study` writes the result. Runs that the
    journal or the folder holds already, finished and of the same case, are not run again: a study that was
    stopped is resumed. A run that fails is a row without an angle.

    - ``executor``: where runs are simulated, or how many at the same time; they change no result. Workers
      that are left over are threads of the engine.
    - ``same_filling``: whether the cylinder is filled once for each dataset and seed, with the first value,
      and lifted again with the others.
    """
    plan = [_PlannedRun.of(row, row.request.case.seed + k) for row in rows for k in range(repeats)]
    if same_filling:
        plan = _sharing_fillings(plan)
    twice = [name for name, times in Counter(run.name for run in plan).items() if times > 1]
    if twice:
        raise InputError(
            f"Two runs would have the folder {twice[0]}: give each value once, and datasets different names."
        )
    total = PROGRESS_STEPS * len(plan)
    yield Started(N_("Angle of repose: study"), total)
    finished = {number: run.finished_in(folder) for number, run in enumerate(plan)}
    documents = {number: document for number, document in finished.items() if document is not None}
    missing = [number for number in range(len(plan)) if number not in documents]
    reached = dict.fromkeys(documents, PROGRESS_STEPS)
    message = ""

    def follow(index: int, step: Progress) -> None:
        nonlocal message
        run, reached[missing[index]] = plan[missing[index]], step.done
        message = run.message(step.message)

    def study() -> ReposeStudy:
        return runs_from([(*plan[number].entry, documents[number]) for number in sorted(documents)])

    yield Partial(study())
    with open_executor(executor) as workers:
        journal = folder / JOURNAL / STUDY
        for dataset in {plan[number].row.dataset for number in missing}:
            workers.check_shared(dataset, journal)
        fills = [number for number in missing if plan[number].filled_by is None]
        lifts = [number for number in missing if number not in fills]
        for missing in filter(None, (fills, lifts)):
            threads = workers.threads_for(len(missing))
            jobs = [plan[number].job(folder, threads) for number in missing]
            with contextlib.closing(workers.as_completed(jobs, follow)) as answers:
                for answer in answers:
                    if answer is not None:
                        number = missing[answer[0]]
                        documents[number], reached[number] = value_of(answer[1]), PROGRESS_STEPS
                        message = plan[number].name
                        yield Partial(study())
                    yield Progress(sum(reached.values()), total, message)
    return study()


def _sharing_fillings(plan: "Sequence[_PlannedRun]") -> "list[_PlannedRun]":
    """The runs, each with the filling of the first one of its dataset and seed.

    Raises InputError if what varies are the particles, or nothing does.
    """
    varied = plan[0].row.varied.partition(" ")[0]
    if varied in (*OF_PARTICLES, "dataset"):
        raise InputError(f"Runs that differ in {varied} have no filling in common; let each fill its own.")
    first: dict[tuple[Path, int], _PlannedRun] = {}
    runs = []
    for run in plan:
        filler = first.setdefault((run.row.dataset, run.request.case.seed), run)
        runs.append(run if filler is run else replace(run, filled_by=filler.name))
    return runs


@dataclass(frozen=True, eq=False)
class _PlannedRun:
    """A run of a study: a value with a seed; `filled_by` is the name of the run whose filling it takes."""

    row: ReposeVariant
    request: ReposeRequest
    filled_by: str | None = None

    @classmethod
    def of(cls, row: ReposeVariant, seed: int) -> "_PlannedRun":
        request = replace(row.request, case=replace(row.request.case, seed=seed), overwrite=True)
        return cls(row, request)

    @property
    def name(self) -> str:
        """Of its folder."""
        name = f"{self.row.varied}_{self.row.value}_seed{self.request.case.seed}"
        return name.replace("/", "-").replace(" ", "-")

    @property
    def entry(self) -> tuple[str, float | str, str]:
        """What varies, its value, and the name."""
        return self.row.varied, self.row.value, self.name

    def message(self, step: str) -> Message:
        """What is done for the run."""
        return Message(
            "{varied} {value}: {step}", varied=Message(self.row.varied), value=self.row.value, step=step
        )

    def _request_in(self, folder: Path) -> ReposeRequest:
        if self.filled_by is None:
            return self.request
        return replace(self.request, filling=study_place(folder, self.filled_by))

    def finished_in(self, folder: Path) -> dict[str, Any] | None:
        """Its document, if a study in the folder has run it already."""
        return finished_run(study_place(folder, self.name), self.row.dataset, self._request_in(folder))

    def job(self, folder: Path, threads: int | None) -> Job:
        """Simulate it, with as many threads of the engine as it asks for itself, or as are given."""
        request = self._request_in(folder)
        if threads is not None:
            request = replace(request, threads=threads)
        return Job(simulate_study_run, (self.row.dataset, folder / JOURNAL / STUDY / self.name, request))


def study_place(folder: Path, name: str, kind: str = STUDY) -> Path:
    """Where a study in `folder` has a run of this name: in the journal until the study is written."""
    unfinished = folder / JOURNAL / kind / name
    return unfinished if unfinished.is_dir() else folder / name


def write_study(study: ReposeStudy, folder: Path, surface: ReposeSurface | None = None) -> list[str]:
    """Write table and figure of a study, and its runs beside them, in one step; returns the files' names.

    Runs of earlier studies in the folder stay.

    ``surface``: through the angles of the study, which is written too.
    """
    from regolith_studio.studies.figures.repose import (
        write_repose_study,  # matplotlib
        write_surface,
    )

    def write(stage: Path) -> tuple[Path, ...]:
        files = write_repose_study(study, stage)
        return files if surface is None else (*files, *write_surface(surface, stage))

    return write_with_runs(folder, STUDY, write)


def write_with_runs(folder: Path, kind: str, write: Callable[[Path], Sequence[Path]]) -> list[str]:
    """Let `write` write files into `folder` in one step with the runs of the journal; names of the files."""
    journal = folder / JOURNAL / kind
    with staged_folder(folder, kind) as stage:
        files = write(stage)
        for place in _runs_and_datasets(folder) | _runs_and_datasets(journal):
            shutil.copytree(study_place(folder, place, kind), stage / place, copy_function=_link)
    remove_quietly(journal)
    with contextlib.suppress(OSError):  # it holds the journal of another study
        journal.parent.rmdir()
    return [path.name for path in files]


def _runs_and_datasets(folder: Path) -> set[str]:
    """Paths of the runs and of the datasets in a folder of studies, relative to it."""
    runs = {path.parent for path in folder.glob(f"[!.]*/{DOCUMENT}")}
    return {path.relative_to(folder).as_posix() for path in (*runs, *folder.glob(f"{DATASETS}/[!.]*"))}


def _link(source: str, target: str) -> None:
    """Give a file a second name, or copy it where the file system has one name a file."""
    try:
        os.link(source, target)
    except OSError:
        shutil.copy2(source, target)


def simulate_study_run(dataset: Path, place: Path, request: ReposeRequest) -> Steps:
    """Simulate one run in `place`; returns its document, even if it failed."""
    try:
        run = yield from repose_steps(dataset, place, request)
    except EngineError as error:
        return error.document
    return dict(run.document)


def finished_run(place: Path, dataset: Path, request: ReposeRequest) -> dict[str, Any] | None:
    """The document of a finished run of the same case on the same dataset, if there is one."""
    try:
        document = read_run(place).document
        filling = None if request.filling is None else settled_filling(request.filling)
    except FileError:
        return None
    engine = engine_named(request.engine)
    settings = asdict(engine.Settings() if request.settings is None else request.settings)
    same = (
        document["state"] == "finished"
        and document["dataset"]["sha256"] == dataset_hash(dataset)
        and document["case"] == case_document(request.case)
        and document["filling"]["sha256"] == filling_hash(filling)
        and document["engine"]["key"] == engine.key
        and document["engine"]["settings"] == settings
        and document["measurement"].get("settings", asdict(request.evaluation)) == asdict(request.evaluation)
    )
    return document if same else None


def with_value(request: ReposeRequest, key: str, value: Any) -> ReposeRequest:
    """The same request with one value of Table 1, Table 2 or the case changed."""
    case = request.case
    if key in CASE_KEYS:
        if not isinstance(getattr(case, key), str):
            value = _to_float(key, value)
        if key == "n_particles":
            value = int(value)
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
    workers
        Runs at the same time.

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
    workers: int = 1

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
            raise InputError(N_("There is no dataset yet: open or build one first."))
        for value in self.values:
            with_value(self.request, self.key, value)


def values_in(key: str, text: str) -> tuple[float | str, ...]:
    """Values written with commas between them: names, whole numbers or numbers, as the key has them."""
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
            place = folder / JOURNAL / STUDY / DATASETS / f"{study_request.key}-{value}"
            yield from _build_variant_dataset(study_request, number, place)
            rows.append(ReposeVariant(study_request.key, value, place, study_request.request))
    with output_lock(folder):
        study = yield from study_repose(rows, folder, study_request.repeats, study_request.workers)
        write_study(study, folder)
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
            yield Progress(number, len(study_request.values), _dataset_message(value, step.message))


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


def _dataset_message(value: object, step: str) -> Message:
    """What is done for the dataset of a value."""
    known = step if isinstance(step, Message) else Message(step)
    return Message(N_("dataset of {value}: {step}"), value=value, step=known)
