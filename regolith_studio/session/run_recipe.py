"""Run a recipe: from files to all results that it asks for, in one folder.

Every particle is processed independently, and its results go to disk at once (``journal/`` in the folder,
see :mod:`regolith_studio.jobs.batch`); the result files are written from there in the end, under a hidden
name, and take the places of those of an earlier run together. So an interrupted run can be resumed and leaves
the earlier results as they were, and the size of a run is limited by the disk and not by the memory.
"""

import contextlib
import dataclasses
import hashlib
import shutil
from collections.abc import Callable, Generator, Iterable, Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from regolith_studio.dataset.build import software_versions
from regolith_studio.dataset.folder_io import check_count, write_stored
from regolith_studio.descriptors.catalogue import CATALOGUE, CHORD_KEYS, DEFAULT_KEYS
from regolith_studio.errors import FileError, RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.io.atomic import JOURNAL, staged_folder, write_bytes, write_in_stage
from regolith_studio.io.checkpoint import CheckpointRecord, read_note
from regolith_studio.io.file_names import file_stem, unique_name
from regolith_studio.io.own_files import read_json
from regolith_studio.jobs.batch import LOST, Batch, run_batch
from regolith_studio.jobs.compile_kernels import compile_first_for
from regolith_studio.jobs.dataset_jobs import (
    DatasetOptions,
    build_dataset_folder,
    dataset_provenance,
    export_dataset_folder,
)
from regolith_studio.jobs.events import Job, Progress, Started, Step, Steps
from regolith_studio.jobs.executor import Executor, open_executor
from regolith_studio.jobs.study_jobs import StudyCheckpoint, study_coarsening, study_lmax
from regolith_studio.messages import N_
from regolith_studio.readers.archives import archive_of
from regolith_studio.readers.particles import FileProblem, left_out
from regolith_studio.session.batch.inputs import BatchInputs, FileInput, read_members
from regolith_studio.session.batch.particle_task import ParticleTask, process_particles
from regolith_studio.session.batch.preprocessing import PreparedInputs, clear_prepared_inputs, prepare_inputs
from regolith_studio.session.batch.writers import (
    RunStatistics,
    Write,
    check_dataset_request,
    descriptor_writer,
    export_options,
    failure_writer,
    fit_writer,
    mesh_writer,
    n_failures,
    representatives_request,
    shapes_of,
    time_writer,
    write_library,
)
from regolith_studio.session.choices import Choices
from regolith_studio.session.outputs.particles import RECIPE as EXTRACTION
from regolith_studio.session.outputs.studies import STUDIES
from regolith_studio.session.outputs.summary import Summary, write_summary
from regolith_studio.session.recipe import Recipe, Representatives

Part = Generator[Step, None, Any]
CHECKPOINT, PREPARED_FOLDER, DATASET = "checkpoint.sqlite", "prepared", "dataset"
ENDED = "ended"
"""Note of a run that has ended: its problems and notes."""


@dataclass
class RecipeRun:
    """A recipe while it runs, and its results.

    - ``folder``: folder of the results.
    - ``stage``: hidden folder that they are written to before they take their places.
    - ``tally``: sums over all particles.
    - ``summary``: content of the summary page.
    - ``problems``: one sentence for each file or particle that failed.
    - ``notes``: what the readers of files note: how they were read, and what was left out.
    - ``resume``: whether studies continue from their checkpoints.
    """

    folder: Path
    recipe: Recipe
    choices: Choices
    items: BatchInputs
    tally: RunStatistics = field(default_factory=RunStatistics)
    summary: Summary = field(default_factory=Summary)
    studies: list[str] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    resume: bool = False
    stage: Path = field(init=False)

    @property
    def files(self) -> list[str]:
        """Paths of all results below the folder, relative to it; the journal is none."""
        result = (path.relative_to(self.folder) for path in self.folder.rglob("*") if path.is_file())
        return sorted(path.as_posix() for path in result if path.parts[0] != JOURNAL)


def run_recipe(
    recipe: Recipe,
    base: Path,
    folder: Path,
    workers: int | Executor = 1,
    resume: bool = False,
    chunk: int | None = None,
) -> Steps:
    """Compute and write all outputs of `recipe`; returns :class:`RecipeRun`.

    Particles that fail are listed in ``problems`` and do not stop the others. The output is written
    completely or not at all.

    - ``base``: folder that relative inputs are relative to.
    - ``folder``: where to write.
    - ``workers``: processes at a time; 0 for one a core. The results do not depend on it.
    - ``resume``: whether to continue an unfinished run of the same recipe into the same folder.
    - ``chunk``: particles that are done, written and lost together; by default 1 in small batches and 25 to
      200 in those of 200 or more. The results do not depend on it.
    """
    choices, journal = recipe.choices(), folder / JOURNAL
    if folder.exists() and not folder.is_dir():
        raise FileError(f"{folder} is a file; name a folder for the results.")
    checkpoint = journal / CHECKPOINT
    finished = checkpoint.exists() and read_note(checkpoint, ENDED) is not None
    if checkpoint.exists() and not (finished or resume):
        raise FileError(
            f"{folder} holds a run that has not ended; go on with --resume, or remove {journal} "
            "to begin anew."
        )
    if recipe.population is not None:
        _check_size(recipe, recipe.population.n)
    with open_executor(workers) as executor:
        prepared: PreparedInputs = yield from prepare_inputs(
            recipe, base, journal / PREPARED_FOLDER, executor, finished=finished and resume
        )
        run = RecipeRun(folder, recipe, choices, BatchInputs.of(recipe, base, prepared), resume=resume)
        run.notes = _notes_on_files(recipe, base, prepared)
        _check_inputs(run)
        for path in _first_files(recipe, base):
            executor.check_shared(path)
        batch = _open_batch(run, resume, chunk)
        with batch.checkpoint:
            if (ended := batch.checkpoint.note(ENDED)) is not None:
                run.problems, run.notes = ended
                return run
            yield from _process_particles(run, batch, executor)
            _count_results(run, batch)
            with staged_folder(folder, "run") as run.stage:
                yield from _write_results(run, batch)
                _write_volume_documents(run, prepared)
                yield from _process_sample(run, executor)
                run.problems = [each.replace(str(run.stage), str(folder)) for each in run.problems]
                if recipe.outputs.summary:
                    write_summary(run.stage, run.recipe, run.summary, run.studies, run.problems)
                write_bytes(run.stage / "recipe.json", recipe.to_json().encode("utf-8"))
            batch.checkpoint.remove_records(**{ENDED: (run.problems, run.notes)})
            clear_prepared_inputs(prepared)
    return run


def _notes_on_files(recipe: Recipe, base: Path, prepared: PreparedInputs) -> list[str]:
    """What is noted on volumes, and on files in the folders of meshes that are none."""
    notes = [note for each in recipe.openings for note in left_out([base / name for name in each.files])]
    for entry, folder in zip(recipe.volumes, prepared.volumes, strict=True):
        document = read_json(folder / EXTRACTION)
        notes += [f"{Path(entry.file).name}: {note}" for note in document["notes"]]
    return notes


def _check_inputs(run: RecipeRun) -> None:
    """Check before the work what would fail after it."""
    if not run.items.members:
        sentences = [problem.sentence for problem in run.items.problems]
        raise FileError(sentences[0] if sentences else "There is no file to read.")
    count = len(run.items.members)
    _check_size(run.recipe, run.items.largest_group if run.recipe.outputs.dataset_by_group else count)
    check_dataset_request(run.recipe, count)


def _first_files(recipe: Recipe, base: Path) -> Iterable[Path]:
    """The first file of each folder that workers read from, or the archive that it is in."""
    paths = [base / name for entry in recipe.openings for name in entry.files]
    files = [archive_of(path) or path for path in paths]
    return {path.parent: path for path in reversed(files)}.values()


def _check_size(recipe: Recipe, n_particles: int) -> None:
    """Raise an error for a dataset that would be too large to be read."""
    if recipe.outputs.dataset:
        count = recipe.representatives.count if recipe.representatives else 0
        check_count(count or n_particles, recipe.choices().coarsening_request.max_facets)


def _open_batch(run: RecipeRun, resume: bool, chunk: int | None) -> Batch:
    """The batch of the recipe, new or resumed."""
    items, journal = run.items, run.folder / JOURNAL / CHECKPOINT
    inputs = "\n".join(each.fingerprint for each in items.members).encode("utf-8", "surrogateescape")
    subject = {
        "recipe": run.recipe.model_dump(mode="json"),
        "set of input files": hashlib.sha256(inputs).hexdigest(),
        "set of program versions": software_versions(),
    }
    if resume and journal.exists():
        return Batch.resume(journal, len(items.members), subject)
    return Batch.create(journal, len(items.members), subject, chunk)


def _process_particles(run: RecipeRun, batch: Batch, executor: Executor) -> Part:
    outputs = run.recipe.outputs
    shapes = outputs.dataset and run.recipe.representatives is None
    needs_polyhedra = outputs.meshes or shapes or outputs.summary
    task = ParticleTask(
        measure=outputs.descriptors or outputs.summary,
        fit=outputs.fits,
        coarsening=run.choices.coarsening_request if needs_polyhedra else None,
        shapes=shapes,
        box_metric=run.choices.box_metric,
        fit_options=run.choices.fit_options,
        keys=_keys(run),
    )
    members = run.items.members
    yield from compile_first_for(run.choices.method if needs_polyhedra else "")
    yield Started(N_("Working on particles"), len(members))
    yield from run_batch(
        batch,
        lambda chunk: Job(process_particles, (tuple((i, members[i]) for i in chunk), task)),
        executor,
        n_failures,
    )


def _keys(run: RecipeRun) -> tuple[str, ...]:
    """Of the descriptors that are measured, in the order of the catalogue."""
    wanted = {*DEFAULT_KEYS, *(CHORD_KEYS if run.recipe.outputs.chords else ())}
    return tuple(key for key in CATALOGUE if key in wanted)


def _write_results(run: RecipeRun, batch: Batch) -> Part:
    """Write the output files from the checkpoint."""
    outputs = run.recipe.outputs
    yield Started(N_("Writing the results"), batch.n_items)
    with contextlib.ExitStack() as stack:
        writers: list[Write] = [
            run.summary.add,
            stack.enter_context(failure_writer(run.stage, run.items.problems)),
            stack.enter_context(time_writer(run.folder / JOURNAL / "times.csv")),
        ]
        if outputs.descriptors:
            writers.append(stack.enter_context(descriptor_writer(run.stage, _keys(run))))
        if outputs.meshes:
            writers.append(
                stack.enter_context(mesh_writer(run.stage / "meshes", run.choices.coarsening_request))
            )
        if outputs.fits:
            writers.append(stack.enter_context(fit_writer(run.stage / "fit.json")))
        for record in _records(run, batch):
            for write in writers:
                write(record)
            yield Progress(record.index + 1, batch.n_items, record.values["name"])
    if outputs.dataset and run.recipe.representatives is None:
        _write_dataset(run, batch)


def _count_results(run: RecipeRun, batch: Batch) -> None:
    for record in _records(run, batch):
        run.tally.add(record)
        if isinstance(run.items.members[record.index], FileInput):
            values = record.values
            run.notes += [f"{values['name']}: {note}" for note in values.get("notes", ())]
    run.problems += [problem.with_path for problem in run.items.problems]
    run.problems += run.tally.unread + run.tally.problems
    if not run.tally.n_read:
        batch.checkpoint.close()
        shutil.rmtree(run.folder / JOURNAL, ignore_errors=True)
        with contextlib.suppress(OSError):
            run.folder.rmdir()
        raise FileError(run.tally.unread[0])


def _records(run: RecipeRun, batch: Batch) -> Iterator[CheckpointRecord]:
    """The record of each particle; those whose process died get a name and a failure.

    Of a file that could not be read the reason names the path, as files of several fractions have one name.
    """
    for record in batch.checkpoint.records():
        member = run.items.members[record.index]
        if LOST in record.values:
            failures = [{"stage": LOST, "reason": record.values[LOST]}]
            values = {"name": member.name, "group": "", "failures": failures}
            record = dataclasses.replace(record, values=values)
        if isinstance(member, FileInput):
            for failure in record.values["failures"]:
                if failure["stage"] == "reading":
                    failure["reason"] = FileProblem(str(member.file.path), failure["reason"]).with_path
        yield record


def _write_volume_documents(run: RecipeRun, prepared: PreparedInputs) -> None:
    """Write how the grains of each volume were extracted, and which were left out."""
    taken: dict[str, int] = {}
    if run.recipe.volumes:
        (run.stage / "volumes").mkdir()
    for entry, source in zip(run.recipe.volumes, prepared.volumes, strict=True):
        name = file_stem(unique_name(Path(entry.file).stem.replace(":", "-"), "", taken))
        write_in_stage(run.stage / "volumes", f"{name}.json", (source / EXTRACTION).read_bytes())


def _write_dataset(run: RecipeRun, batch: Batch) -> None:
    provenance = dataset_provenance(run.tally.fitted, run.choices.coarsening_request, _preset(run))
    name = run.folder.resolve().name
    try:
        if run.recipe.outputs.dataset_by_group:
            write_library(run.stage / DATASET, batch, name, provenance)
            return
        write_stored(
            run.stage / DATASET,
            lambda: shapes_of(batch),
            run.tally.n_coarse,
            name=name,
            provenance=provenance,
        )
    except RegolithError as error:
        if run.tally.n_coarse:
            raise
        run.problems.append(f"There is no dataset, because no particle could be coarsened. ({error})")


def _preset(run: RecipeRun) -> str | None:
    return None if run.choices.preset_modified else run.choices.preset


def _process_sample(run: RecipeRun, executor: Executor) -> Part:
    """The steps that need all particles at the same time: representatives and studies; then the exports."""
    recipe, outputs, has_dataset = run.recipe, run.recipe.outputs, run.tally.n_coarse > 0
    if recipe.representatives or outputs.lmax_study or outputs.coarsening_study:
        particles = [particle for _, particle in (yield from read_members(run.items.members, []))]
        if recipe.representatives is not None:
            has_dataset = yield from _build_dataset(run, recipe.representatives, particles, executor)
        yield from _run_studies(run, particles, executor)
    if recipe.exports is not None and has_dataset:
        try:
            options = export_options(recipe.exports, recipe.seed)
            yield from export_dataset_folder(
                run.stage / DATASET,
                recipe.exports.targets,
                run.stage / "exports",
                options,
                recipe.exports.lossy,
            )
        except RegolithError as error:
            run.problems.append(str(error))


def _build_dataset(
    run: RecipeRun, outputs: Representatives, particles: list[Particle], executor: Executor
) -> Generator[Step, None, bool]:
    """Write the dataset of the representatives; returns whether that was possible."""
    name, chosen = (
        outputs.name or run.folder.resolve().name,
        representatives_request(outputs, run.recipe.seed),
    )
    options = DatasetOptions(name, _preset(run), True, executor, chosen, outputs.sizes)
    try:
        built = yield from build_dataset_folder(
            particles, run.choices.coarsening_request, run.stage / DATASET, options
        )
    except RegolithError as error:
        run.problems.append(f"There is no dataset. ({error})")
        return False
    failed = [f"{each.name}: {each.problem}" for each in built.outcomes if each.coarsened is None]
    run.problems += [sentence for sentence in failed if sentence not in run.problems]
    return True


def _run_studies(run: RecipeRun, particles: list[Particle], executor: Executor) -> Part:
    outputs, choices = run.recipe.outputs, run.choices
    if outputs.lmax_study:
        lmax = partial(study_lmax, particles, executor, choices.seed, fit_options=choices.fit_options)
        yield from _run_study(run, "lmax_study", lmax)
    if outputs.coarsening_study:
        yield from _run_study(
            run,
            "coarsening_study",
            partial(study_coarsening, particles, choices.coarsening_request, executor),
        )


def _run_study(run: RecipeRun, name: str, study: Callable[..., Steps]) -> Part:
    with StudyCheckpoint(run.folder / JOURNAL / f"{name}.sqlite", run.resume) as answers:
        try:
            result = yield from study(answers=answers)
        except RegolithError as error:
            run.problems.append(str(error))
            return
        run.studies.append(name)
        with staged_folder(run.stage / "studies", name) as stage:
            STUDIES[name].write(result, stage)
