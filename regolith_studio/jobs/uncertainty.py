"""Job for the budget of uncertainty: descriptors over a design, heaps with one step changed at a time."""

from collections.abc import Generator, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any, cast

import numpy as np

from regolith_studio.dataset.build import software_versions
from regolith_studio.dataset.folder_io import dataset_hash
from regolith_studio.dem.angle_of_repose import measure_repose
from regolith_studio.dem.engines import ENGINES, engine_named, engine_notes
from regolith_studio.dem.evaluation.section import NotAPileError
from regolith_studio.dem.run_io import read_final_state
from regolith_studio.errors import InputError, RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.imaging.volume import Volume
from regolith_studio.io.atomic import JOURNAL, staged_folder, write_bytes
from regolith_studio.io.output_lock import output_lock
from regolith_studio.io.own_files import json_bytes
from regolith_studio.jobs.compile_kernels import compile_first, compile_first_for
from regolith_studio.jobs.dataset_jobs import (
    DatasetOptions,
    MeasuredPopulation,
    RepresentativesRequest,
    build_dataset_folder,
)
from regolith_studio.jobs.events import Job, Partial, Progress, Started, Step, Steps
from regolith_studio.jobs.executor import Executor, open_executor, value_of
from regolith_studio.jobs.extraction_settings import VolumeInput
from regolith_studio.jobs.repose_jobs import ReposeRequest
from regolith_studio.jobs.repose_study import (
    DATASETS,
    STUDY,
    ReposeVariant,
    study_place,
    study_repose,
    write_study,
)
from regolith_studio.jobs.study_jobs import StudyCheckpoint, hash_of_particles, hash_of_rows
from regolith_studio.jobs.uncertainty_chain import (
    RESCANNED,
    Chain,
    GrainSample,
    Levels,
    draw_levels,
    evaluate_rows,
)
from regolith_studio.messages import N_, Message
from regolith_studio.steps import as_events, result_of
from regolith_studio.studies.repose import ReposeStudy
from regolith_studio.studies.uncertainty import (
    EVALUATION,
    FILLING,
    OUTPUTS,
    RESAMPLED,
    AngleBudget,
    ChainStep,
    DescriptorBudget,
    UncertaintyBudget,
    budget_document,
    check_count,
    saltelli_rows,
)

KIND = "uncertainty"
"""Of the list of files, and stem of them."""
ROWS_A_TASK = 8
"""Rows of the design that one task evaluates: their grains are made once, and a stop loses no more."""
TOE_FACTOR = 4 / 3
"""On the minimum height of the lower cut, by which the evaluation itself judges what the cut does."""
OF_HEAPS = ("heaps", "case", "engine")
"""Keys of the recipe that change no descriptor and no dataset."""
OTHER_ENGINES = ("rapier", "mujoco", "box3d")


@dataclass(frozen=True, eq=False)
class UncertaintyRequest:
    """How the budget is made; picklable.

    - ``base``: points of the design, a power of two; it has (steps + 2) times as many rows.
    - ``heaps``: seeds of each step; 0 for descriptors alone.
    - ``repose``: of the heaps.
    """

    base: int = 16
    heaps: int = 6
    repose: ReposeRequest = field(default_factory=ReposeRequest)

    def __post_init__(self) -> None:
        if self.base < 4 or self.base & (self.base - 1):
            raise InputError(
                f"The points of the design are a power of two from 4 on, such as 16 or 64, got {self.base}."
            )
        if self.heaps == 1 or self.heaps < 0:
            raise InputError(f"Differences need two heaps of each step or more, or none, got {self.heaps}.")


def uncertainty_steps(
    chain: Chain,
    request: UncertaintyRequest,
    folder: Path,
    workers: int | Executor = 1,
    resume: bool = False,
) -> Steps:
    """Make the budget in `folder`; partial results and the result are :class:`UncertaintyBudget`.

    The folder holds what is known so far after the descriptors and after every heap; no other process writes
    to it meanwhile. Rows and heaps that are known already are not computed again.

    ``workers``: tasks and heaps at the same time; they change no result. ``resume``: whether rows of an
    interrupted run are taken up; heaps always are.
    """
    with (
        output_lock(folder),
        StudyCheckpoint(folder / JOURNAL / f"{KIND}.sqlite", resume) as answers,
        open_executor(workers) as executor,
    ):
        budget = yield from _descriptors(chain, request, answers, executor)
        _write(budget, folder)
        if request.heaps:
            budget = yield from _angles(chain, request, folder, executor, budget)
            _write(budget, folder)
    return budget


def measure_uncertainty(
    source: Sequence[Particle] | Volume,
    folder: Path | str,
    request: UncertaintyRequest | None = None,
    workers: int = 1,
    **settings: Any,
) -> UncertaintyBudget:
    """What each step from the voxel to the angle costs, written into `folder`.

    - ``source``: particles, or a scan of grey values or labels.
    - ``request``: size of the design and number of heaps.
    - ``workers``: processes at a time; 0 for one a core.
    - ``settings``: fields of :class:`~regolith_studio.jobs.uncertainty_chain.Chain`: ``grains``,
      ``coarsening``, ``model``, ``n_representatives``, ``seed``.
    """
    given = source if isinstance(source, Volume) else tuple(source)
    chain = Chain.of(given, **settings)
    steps = uncertainty_steps(chain, request or UncertaintyRequest(), Path(folder), workers)
    return cast("UncertaintyBudget", result_of(steps))


def _descriptors(
    chain: Chain, request: UncertaintyRequest, answers: StudyCheckpoint, executor: Executor
) -> Generator[Step, None, UncertaintyBudget]:
    """Evaluate all rows of the design, those of the same grains in one task."""
    if isinstance(chain.source, tuple):
        check_count(len(chain.source))
    yield from compile_first_for(*{method for _, method in chain.choices["method"]})
    yield from compile_first("representatives", *["model"] * bool(chain.model))
    steps = chain.steps
    design = saltelli_rows(steps, request.base, chain.seed)
    flat = design.reshape(-1, len(steps)).tolist()
    named = [{step.key: level for step, level in zip(steps, row, strict=True)} for row in flat]
    tasks, total = _tasks(named, request.base), len(named) + 1
    yield Started(N_("Uncertainty of descriptors"), total)
    results = np.full((len(named), len(OUTPUTS)), np.nan)
    nominal, n_grains, at, problem, message = np.full(len(OUTPUTS), np.nan), 0, 0, "", ""
    recipe = _recipe(chain, request)
    reached: dict[int, int] = {}
    """Rows of each task that is computed and not yet handed on."""

    def budget() -> UncertaintyBudget:
        shaped = results.reshape(*design.shape[:2], len(OUTPUTS))
        found = DescriptorBudget(steps, nominal, shaped, n_grains, problem)
        return UncertaintyBudget(found, None, chain.not_counted, recipe)

    def follow(number: int, step: Progress) -> None:
        nonlocal message
        reached[number], message = step.done, step.message

    def evaluated(function: Any, missing: Iterable[Any]) -> Iterator[Any]:
        number = 0
        for result in executor.results((Job(function, (task,)) for task in missing), follow):
            if result is not None:
                reached.pop(number, None)
                number += 1
            yield None if result is None else value_of(result)

    of_rows = {key: value for key, value in recipe.items() if key not in OF_HEAPS}
    answers.open(KIND, of_rows, recipe["input_sha256"])
    done = 0
    for found in answers.wrap(evaluated)(partial(evaluate_rows, chain, repr(recipe)), tasks):
        if found is None:
            yield Progress(done + sum(reached.values()), total, message)
            continue
        for name, means in found["rows"].items():
            target = nominal if name == "-1" else results[int(name)]
            target[:] = means
        problem = problem or found["problem"]
        if at == 0:
            n_grains = found.get("n_grains", 0)
            check_count(n_grains)
            if not found["rows"]:
                raise RegolithError(found["problem"])
        done, at = done + len(tasks[at]), at + 1
        yield Partial(budget())
        yield Progress(done, total, problem or message)
    return budget()


def _tasks(rows: Sequence[Levels], base: int) -> list[list[tuple[int, Levels]]]:
    """The present settings as row -1, then all rows by the levels of the scan's steps.

    Rows of one point follow each other, those of the same drawn particles first among them: a point is
    complete early, and particles are drawn once for all of its rows that have them.
    """
    groups: dict[tuple[int, ...], list[tuple[int, Levels]]] = {}
    order = sorted(enumerate(rows), key=lambda row: (row[0] % base, draw_levels(row[1])))
    for number, levels in order:
        groups.setdefault(tuple(levels.get(key, 0) for key in RESCANNED), []).append((number, levels))
    parts = [
        group[k : k + ROWS_A_TASK] for group in groups.values() for k in range(0, len(group), ROWS_A_TASK)
    ]
    return [[(-1, {})], *parts]


def _hash_of(chain: Chain) -> str:
    match chain.source:
        case tuple():
            return hash_of_particles(chain.source)
        case Volume():
            return hash_of_rows(np.asarray(chain.source.array), (str(chain.source.voxel_size),))
    volume = chain.volume
    return hash_of_rows(np.asarray(volume.array), (str(volume.voxel_size),))


def _recipe(chain: Chain, request: UncertaintyRequest) -> dict[str, Any]:
    """All settings, as JSON; with the same input and versions they give the same budget."""
    coarsening = asdict(replace(chain.coarsening, weights=None))  # type: ignore[arg-type]
    weights = {key: value for key, value in chain.coarsening.weights.items() if value}
    coarsening |= {"weights": weights, "kept": sorted(chain.coarsening.kept)}
    source = chain.source
    return {
        "source": str(source.path) if isinstance(source, VolumeInput) else chain.kind,
        "input_sha256": _hash_of(chain),
        "grains": chain.grains.as_document() if chain.kind != "particles" else None,
        "coarsening": coarsening,
        "model": chain.model,
        "n_representatives": chain.n_representatives,
        "seed": chain.seed,
        "levels": {
            step.key: list(step.levels) if step.key != RESAMPLED else len(step.levels) for step in chain.steps
        },
        "design_points": request.base,
        "heaps": request.heaps,
        "case": asdict(request.repose.case) if request.heaps else None,
        "engine": request.repose.engine if request.heaps else None,
    }


def _write(budget: UncertaintyBudget, folder: Path) -> None:
    """Write tables, document and figure of what is known so far in one step."""
    from regolith_studio.studies.figures.repose import write_uncertainty  # matplotlib

    with staged_folder(folder, KIND) as stage:
        write_uncertainty(budget, stage)


def _angles(
    chain: Chain,
    request: UncertaintyRequest,
    folder: Path,
    executor: Executor,
    budget: UncertaintyBudget,
) -> Generator[Step, None, UncertaintyBudget]:
    """Run the heaps of all steps, those of the first seed first, and measure them."""
    place = folder / JOURNAL / STUDY / DATASETS
    plan, missing = _plan(chain, request)
    datasets = yield from _datasets(chain, plan, request, place, executor, budget.recipe)
    nominal = dataset_hash(datasets[FILLING])
    same = [each for each in plan if each.levels and dataset_hash(datasets[each.dataset]) == nominal]
    rows = []
    for k in range(request.heaps):
        for each in plan:
            if each in same:
                continue
            dataset = datasets[f"{RESAMPLED}-{k}" if each.step.key == RESAMPLED else each.dataset]
            run = replace(each.request, case=replace(each.request.case, seed=request.repose.case.seed + k))
            rows.append(ReposeVariant(each.step.key, each.level, dataset, run))
    not_counted = (*budget.not_counted, *missing)
    notes = tuple(dict.fromkeys(note for each in plan for note in engine_notes(_engine_of(each))))

    def angle(study: ReposeStudy) -> UncertaintyBudget:
        return replace(
            budget, angle=_angle_budget(plan, same, study, request, folder, notes), not_counted=not_counted
        )

    def events_of(step: Step) -> Iterator[Step]:
        if not isinstance(step, Partial):
            yield step
            return
        current = angle(step.value)
        if step.value.runs:  # one file: the journal is in use, and may not be moved for a moment
            write_bytes(folder / "uncertainty.json", json_bytes(budget_document(current)))
        yield Partial(current)

    study = yield from as_events(study_repose(rows, folder, 1, executor), events_of)
    final = angle(study)
    write_study(study, folder)
    return final


@dataclass(frozen=True, eq=False)
class _AngleStep:
    """A level of a step for heaps: levels of the dataset, and how the heap is run."""

    step: ChainStep
    level: str
    levels: Levels
    request: ReposeRequest

    @property
    def dataset(self) -> str:
        """Name of its folder."""
        return "-".join([FILLING] if not self.levels else map(str, *self.levels.items()))


def _engine_of(each: _AngleStep) -> Any:
    return engine_named(each.request.engine)


def _plan(chain: Chain, request: UncertaintyRequest) -> tuple[list[_AngleStep], list[ChainStep]]:
    """The present settings first; then each step at its other levels; and what cannot be changed."""
    how, missing = request.repose, []
    plan = [_AngleStep(ChainStep(FILLING, N_("Filling"), ("as set",)), "as set", {}, how)]
    for step in chain.steps_of_shapes:
        if step.key == RESAMPLED:
            changed = replace(step, levels=("all grains", "resampled"))
            plan.append(_AngleStep(changed, "resampled", {}, how))
            continue
        numbers = {name: k for k, name in reversed(list(enumerate(step.levels)))}  # the first of equal ones
        names = tuple(dict.fromkeys(step.levels))
        changed = replace(step, levels=names)
        plan += [_AngleStep(changed, name, {step.key: numbers[name]}, how) for name in names[1:]]
    engine = engine_named(how.engine)
    others = [ENGINES[key] for key in OTHER_ENGINES if key in ENGINES and key != engine.key]
    other = next((each for each in others if not each.find().problem), None)
    names = (engine.key, other.key if other else "")
    step = ChainStep("engine", N_("Engine"), names, "" if other else N_("no other engine is installed"))
    if other is None:
        missing.append(step)
    else:
        plan.append(_AngleStep(step, other.key, {}, replace(how, engine=other.key, settings=None)))
    settings = engine.Settings() if how.settings is None else how.settings
    if (pace := getattr(settings, "time_step", None)) is None:
        missing.append(ChainStep("time_step", N_("Time step"), (), N_("the engine sets it itself")))
    else:
        step = ChainStep("time_step", N_("Time step"), (f"{pace:g}", f"{pace / 2:g}"))
        changed_settings = replace(settings, time_step=pace / 2)
        plan.append(_AngleStep(step, step.levels[1], {}, replace(how, settings=changed_settings)))
    return plan, missing


def _datasets(
    chain: Chain,
    plan: Sequence[_AngleStep],
    request: UncertaintyRequest,
    place: Path,
    workers: int | Executor,
    recipe: Mapping[str, Any],
) -> Generator[Step, None, dict[str, Path]]:
    """A dataset for each step that changes the shapes, one for each seed of the bootstrap; others share.

    Those that an interrupted run has made from the same are not made again.
    """
    places: dict[str, Path] = {}
    jobs: list[tuple[str, Levels]] = []
    for each in plan:
        if each.step.key == RESAMPLED:
            jobs += [(f"{RESAMPLED}-{k}", {RESAMPLED: k}) for k in range(request.heaps)]
        elif each.levels or each.step.key == FILLING:
            jobs.append((each.dataset, each.levels))
    yield Started(N_("Datasets of the steps"), len(jobs))
    said = N_("dataset of {value}: {step}")
    of_shapes = {key: value for key, value in recipe.items() if key not in OF_HEAPS}
    samples: list[GrainSample] = []
    for number, (name, levels) in enumerate(jobs):
        places[name], mark = place / name, place / f".{name}"
        made_of = repr((of_shapes, levels, software_versions()))
        if places[name].is_dir() and mark.exists() and mark.read_text("utf-8") == made_of:
            continue
        if set(RESCANNED) & set(levels):
            yield Progress(number, len(jobs), Message(said, value=name, step=N_("grains of the scan")))
            sample = chain.sample(levels)
        else:
            samples = samples or [chain.sample({})]
            sample = samples[0]
        for step in _dataset(sample, levels, places[name], workers):
            if isinstance(step, Progress):
                yield Progress(number, len(jobs), Message(said, value=name, step=step.message))
        write_bytes(mark, made_of.encode("utf-8"))
    return places


def _dataset(sample: GrainSample, levels: Levels, place: Path, workers: int | Executor) -> Steps:
    """Representatives of the grains at these levels as a dataset; the same grains give the same bytes."""
    chain = sample.chain
    if chain.model:
        yield Progress(0, 1, N_("drawing particles"))
        particles, described = sample.drawn_and_described(levels)
    else:
        picks = sample.picks(levels).tolist()
        particles, described = (
            tuple(each[k] for k in picks) for each in (sample.particles, sample.descriptors)
        )
    population = MeasuredPopulation(tuple(range(len(described))), described)
    chosen = tuple(replace(each, name=f"{k:05d}-{each.name}") for k, each in enumerate(particles))
    options = DatasetOptions(
        name=KIND,
        overwrite=True,
        workers=workers,
        representatives=RepresentativesRequest(chain.n_representatives),
    )
    yield from build_dataset_folder(chosen, chain.request(levels), place, options, population)


def _angle_budget(
    plan: Sequence[_AngleStep],
    same: Sequence[_AngleStep],
    study: ReposeStudy,
    request: UncertaintyRequest,
    folder: Path,
    notes: tuple[str, ...],
) -> AngleBudget:
    """The angles of the runs by level and seed, and those of the present settings evaluated otherwise.

    ``same``: levels that give the dataset of the present settings, whose heaps are theirs too.
    """
    first = request.repose.case.seed
    angles = {(each.step.key, each.level): np.full(request.heaps, np.nan) for each in plan}
    evaluated = np.full(request.heaps, np.nan)
    settings = request.repose.evaluation
    other = replace(settings, toe=TOE_FACTOR * settings.toe)
    for run in study.runs:
        angles[run.varied, str(run.value)][run.seed - first] = np.nan if run.angle is None else run.angle
        if run.varied == FILLING and run.angle is not None:
            evaluated[run.seed - first] = _angle_of(study_place(folder, run.folder), other)
    toes = tuple(f"lower cut at {each.toe:g} d or more" for each in (settings, other))
    step = ChainStep(EVALUATION, N_("Evaluation"), toes)
    nominal = angles.pop((FILLING, plan[0].level))
    angles |= {(each.step.key, each.level): nominal for each in same}
    steps = dict.fromkeys(each.step for each in plan[1:])
    return AngleBudget((*steps, step), nominal, {**angles, (step.key, toes[1]): evaluated}, notes)


def _angle_of(place: Path, evaluation: Any) -> float:
    final = read_final_state(place / "final.npz")
    try:
        return measure_repose(final.points, final.diameters, evaluation).angle
    except NotAPileError:
        return np.nan
