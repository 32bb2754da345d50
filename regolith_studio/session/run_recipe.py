"""Run a recipe: from files to all results that it asks for, in one folder.

Every particle is processed independently, and its results go to disk at once (``journal/`` in the folder,
see :mod:`regolith_studio.jobs.batch`); the result files are written from there in the end. So an interrupted
run can be resumed, and the size of a run is limited by the disk and not by the memory.
"""

import contextlib
import dataclasses
import hashlib
import shutil
from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from regolith_studio.dataset.build import software_versions
from regolith_studio.dataset.streaming import check_count, write_stored
from regolith_studio.errors import FileError, RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.io.atomic import staged_folder, write_bytes
from regolith_studio.io.checkpoint import CheckpointRecord, read_note
from regolith_studio.jobs.batch import LOST, Batch, run_batch
from regolith_studio.jobs.compile_kernels import compile_first_for
from regolith_studio.jobs.dataset_jobs import dataset_provenance
from regolith_studio.jobs.events import Job, Progress, Started, Step, Steps
from regolith_studio.jobs.executor import Executor, open_executor
from regolith_studio.jobs.study_checkpoint import StudyCheckpoint
from regolith_studio.jobs.study_jobs import study_coarsening, study_lmax
from regolith_studio.messages import N_
from regolith_studio.readers.particles import unique_name
from regolith_studio.session.batch.dataset_step import (
    build_dataset_step,
    check_dataset_request,
    export_dataset_step,
)
from regolith_studio.session.batch.inputs import BatchInputs
from regolith_studio.session.batch.particle_task import ParticleTask, process_particles
from regolith_studio.session.batch.preprocessing import PreparedInputs, clear_prepared_inputs, prepare_inputs
from regolith_studio.session.batch.writers import (
    ResultWriter,
    RunStatistics,
    descriptor_writer,
    failure_writer,
    fit_writer,
    mesh_writer,
    n_failures,
    shapes_of,
    time_writer,
)
from regolith_studio.session.choices import Choices
from regolith_studio.session.outputs.particles import RECIPE as EXTRACTION
from regolith_studio.session.outputs.studies import STUDIES
from regolith_studio.session.outputs.summary import Summary, write_summary
from regolith_studio.session.recipe import Recipe, Representatives

Part = Generator[Step, None, Any]
JOURNAL_FOLDER, CHECKPOINT, PREPARED_FOLDER = "journal", "checkpoint.sqlite", "prepared"
ENDED = "ended"
"""Note of a run that has ended: the problems that it met."""


@dataclass
class RecipeRun:
    """What a recipe has led to.

    Parameters
    ----------
    folder
        Where everything is.
    tally
        What is known of all particles together.
    summary
        What its page tells.
    problems
        One sentence for each file or particle that failed.
    resume
        Whether studies go on with the answers that are there.
    """

    folder: Path
    recipe: Recipe
    choices: Choices
    items: BatchInputs
    tally: RunStatistics = field(default_factory=RunStatistics)
    summary: Summary = field(default_factory=Summary)
    studies: list[str] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    resume: bool = False

    @property
    def files(self) -> list[str]:
        """Paths of all results below the folder, relative to it; the journal is none."""
        found = (path.relative_to(self.folder) for path in self.folder.rglob("*") if path.is_file())
        return sorted(path.as_posix() for path in found if path.parts[0] != JOURNAL_FOLDER)


def run_recipe(
    recipe: Recipe,
    base: Path,
    folder: Path,
    workers: int | Executor = 1,
    resume: bool = False,
    chunk: int | None = None,
) -> Steps:
    """Do all that `recipe` asks for; returns :class:`RecipeRun`.

    Particles that fail are told and do not stop the others. Each part of the output appears whole or
    not at all.

    Parameters
    ----------
    base
        Folder that relative inputs are relative to.
    folder
        Where to write.
    workers
        Processes at a time; 0 for one a core. The results do not depend on it.
    resume
        Whether to go on with a run of the same recipe into the same folder that has not ended.
    chunk
        Particles that are done, written and lost together; by default 1 in small batches and 25 to 200
        in those of 200 or more. The results do not depend on it.

    Raises
    ------
    InputError
        If the recipe holds a choice that cannot be used.
    FileError
        If no input can be read, the folder cannot be written, or holds an unfinished run that is not to
        be resumed or is of another recipe.
    """
    choices, place = recipe.choices(), folder / JOURNAL_FOLDER
    if folder.exists() and not folder.is_dir():
        raise FileError(f"{folder} is a file; name a folder for the results.")
    checkpoint = place / CHECKPOINT
    over = checkpoint.exists() and read_note(checkpoint, ENDED) is not None
    if checkpoint.exists() and not (over or resume):
        raise FileError(
            f"{folder} holds a run that has not ended; go on with --resume, or remove {place} to begin anew."
        )
    if recipe.population is not None:
        _check_size(recipe, recipe.population.n)
    with open_executor(workers) as executor:
        prepared: PreparedInputs = yield from prepare_inputs(
            recipe, base, place / PREPARED_FOLDER, executor, over=over and resume
        )
        done = RecipeRun(folder, recipe, choices, BatchInputs.of(recipe, base, prepared), resume=resume)
        _check(done)
        batch = _opened(done, resume, chunk)
        with batch.checkpoint:
            if (ended := batch.checkpoint.note(ENDED)) is not None:
                done.problems = ended
                return done
            yield from _worked(done, batch, executor)
            yield from _assembled(done, batch)
            _tell_of_volumes(done, prepared)
            yield from _whole(done, executor)
            if recipe.outputs.summary:
                write_summary(folder, done.recipe, done.summary, done.studies, done.problems)
            write_bytes(folder / "recipe.json", recipe.to_json().encode("utf-8"))
            batch.checkpoint.remove_records(**{ENDED: done.problems})
            clear_prepared_inputs(prepared)
    return done


def _check(done: RecipeRun) -> None:
    """Refuse before the work what could not be done after it."""
    if not done.items.members:
        sentences = [problem.sentence for problem in done.items.problems]
        raise FileError(sentences[0] if sentences else "There is no file to read.")
    _check_size(done.recipe, len(done.items.members))
    check_dataset_request(done.recipe, len(done.items.members))


def _check_size(recipe: Recipe, n_particles: int) -> None:
    """Refuse a dataset that could not be read again."""
    if recipe.outputs.dataset:
        wish = recipe.representatives
        check_count(wish.count if wish and wish.count else n_particles, recipe.choices().order.max_facets)


def _opened(done: RecipeRun, resume: bool, chunk: int | None) -> Batch:
    """The batch of the recipe, begun or taken up again."""
    items, place = done.items, done.folder / JOURNAL_FOLDER / CHECKPOINT
    inputs = "\n".join(items.fingerprints()).encode("utf-8", "surrogateescape")
    subject = {
        "recipe": done.recipe.model_dump(mode="json"),
        "set of input files": hashlib.sha256(inputs).hexdigest(),
        "set of program versions": software_versions(),
    }
    if resume and place.exists():
        return Batch.resume(place, len(items.members), subject)
    return Batch.create(place, len(items.members), subject, chunk)


def _worked(done: RecipeRun, batch: Batch, executor: Executor) -> Part:
    wish = done.recipe.outputs
    shapes = wish.dataset and done.recipe.representatives is None
    coarse = wish.meshes or shapes or wish.summary
    asked = ParticleTask(
        measure=wish.descriptors or wish.summary,
        fit=wish.fits,
        order=done.choices.order if coarse else None,
        shapes=shapes,
        box_metric=done.choices.box_metric,
        fit_options=done.choices.fit_options,
    )
    members = done.items.members
    yield from compile_first_for(done.choices.method if coarse else "")
    yield Started(N_("Working on particles"), len(members))
    yield from run_batch(
        batch,
        lambda chunk: Job(process_particles, (tuple((i, members[i]) for i in chunk), asked)),
        executor,
        n_failures,
    )


def _assembled(done: RecipeRun, batch: Batch) -> Part:
    """Turn what is on disk into the files that were asked for."""
    wish = done.recipe.outputs
    yield Started(N_("Writing the results"), batch.n_items)
    _tally(done, batch)
    with contextlib.ExitStack() as stack:
        sinks: list[ResultWriter] = [
            done.summary,
            stack.enter_context(failure_writer(done.folder)),
            stack.enter_context(time_writer(done.folder / JOURNAL_FOLDER / "times.csv")),
        ]
        if wish.descriptors:
            sinks.append(stack.enter_context(descriptor_writer(done.folder)))
        if wish.meshes:
            sinks.append(stack.enter_context(mesh_writer(done.folder / "meshes", done.choices.order)))
        if wish.fits:
            sinks.append(stack.enter_context(fit_writer(done.folder / "fit.json")))
        for record in _records(done, batch):
            for sink in sinks:
                sink.add(record)
            yield Progress(record.index + 1, batch.n_items, record.values["name"])
    if wish.dataset and done.recipe.representatives is None:
        _write_dataset(done, batch)


def _tally(done: RecipeRun, batch: Batch) -> None:
    for record in _records(done, batch):
        done.tally.add(record)
    done.problems += [problem.with_path for problem in done.items.problems]
    done.problems += done.tally.unread + done.tally.problems
    if not done.tally.n_read:
        batch.checkpoint.close()
        shutil.rmtree(done.folder / JOURNAL_FOLDER, ignore_errors=True)
        with contextlib.suppress(OSError):
            done.folder.rmdir()
        raise FileError(done.tally.unread[0])


def _records(done: RecipeRun, batch: Batch) -> Iterator[CheckpointRecord]:
    """What is known of each particle; those that ended their process get a name."""
    for record in batch.checkpoint.records():
        if LOST in record.values:
            failures = [{"stage": LOST, "reason": record.values[LOST]}]
            name = done.items.members[record.index].name
            record = dataclasses.replace(record, values={"name": name, "group": "", "failures": failures})
        yield record


def _tell_of_volumes(done: RecipeRun, prepared: PreparedInputs) -> None:
    """Write beside the results how the grains of each volume were found, and which were left out."""
    taken: set[str] = set()
    if done.recipe.volumes:
        (done.folder / "volumes").mkdir(exist_ok=True)
    for entry, source in zip(done.recipe.volumes, prepared.volumes, strict=True):
        name = unique_name(Path(entry.file).stem, "", taken)
        write_bytes(done.folder / "volumes" / f"{name}.json", (source / EXTRACTION).read_bytes())


def _write_dataset(done: RecipeRun, batch: Batch) -> None:
    try:
        write_stored(
            done.folder / "dataset",
            lambda: shapes_of(batch),
            done.tally.n_coarse,
            name=done.folder.resolve().name,
            provenance=dataset_provenance(done.tally.fitted, done.choices.order, _preset(done)),
        )
    except RegolithError as error:
        if done.tally.n_coarse:
            raise
        done.problems.append(f"There is no dataset, because no particle could be coarsened. ({error})")


def _preset(done: RecipeRun) -> str | None:
    return None if done.choices.preset_modified else done.choices.preset


def _whole(done: RecipeRun, executor: Executor) -> Part:
    """What needs all particles at the same time: representatives and studies; then the exports."""
    recipe, wish, there = done.recipe, done.recipe.outputs, done.tally.n_coarse > 0
    if recipe.representatives or wish.lmax_study or wish.coarsening_study:
        particles = yield from _read(done)
        if recipe.representatives is not None:
            there = yield from _represented(done, recipe.representatives, particles, executor)
        yield from _studied(done, particles, executor)
    if recipe.exports is not None and there:
        try:
            yield from export_dataset_step(recipe.exports, recipe.seed, done.folder)
        except RegolithError as error:
            done.problems.append(str(error))


def _represented(
    done: RecipeRun, wish: Representatives, particles: list[Particle], executor: Executor
) -> Generator[Step, None, bool]:
    """Write the dataset of those that stand for all; whether that was possible."""
    try:
        built = yield from build_dataset_step(
            done.recipe, wish, particles, done.choices.order, _preset(done), done.folder, executor
        )
    except RegolithError as error:
        done.problems.append(f"There is no dataset. ({error})")
        return False
    failed = [f"{each.name}: {each.problem}" for each in built.outcomes if each.coarsened is None]
    done.problems += [sentence for sentence in failed if sentence not in done.problems]
    return True


def _studied(done: RecipeRun, particles: list[Particle], executor: Executor) -> Part:
    wish, choices = done.recipe.outputs, done.choices
    if wish.lmax_study:
        lmax = partial(study_lmax, particles, executor, choices.seed, fit_options=choices.fit_options)
        yield from _study(done, "lmax_study", lmax)
    if wish.coarsening_study:
        yield from _study(
            done, "coarsening_study", partial(study_coarsening, particles, choices.order, executor)
        )


def _read(done: RecipeRun) -> Generator[Step, None, list[Particle]]:
    """All particles that can be read, which a study needs at the same time."""
    yield Started(N_("Reading particles"), len(done.items.members))
    found: list[Particle] = []
    for number, item in enumerate(done.items.members, start=1):
        with contextlib.suppress(RegolithError):
            found.append(item.particle())
        yield Progress(number, len(done.items.members), item.name)
    return found


def _study(done: RecipeRun, name: str, study: Callable[..., Steps]) -> Part:
    with StudyCheckpoint(done.folder / JOURNAL_FOLDER / f"{name}.sqlite", done.resume) as answers:
        try:
            found = yield from study(answers=answers)
        except RegolithError as error:
            done.problems.append(str(error))
            return
        done.studies.append(name)
        with staged_folder(done.folder / "studies", name) as stage:
            STUDIES[name].write(found, stage)
