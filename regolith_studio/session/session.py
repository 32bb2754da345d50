"""The session: particles, choices and results; a change of choices updates the results."""

import dataclasses
from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from regolith_studio.errors import InputError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.events import Failed, Job
from regolith_studio.jobs.particle_jobs import (
    MeasuredParticle,
    load_particles,
    load_sample,
    measure_particles,
)
from regolith_studio.jobs.runners import Runner
from regolith_studio.messages import N_
from regolith_studio.readers.coefficient_tables import TableConvention, TableReading
from regolith_studio.readers.particles import LoadedParticles, unique_names
from regolith_studio.readers.settings import ReadingSettings
from regolith_studio.resources import SAMPLE
from regolith_studio.session.choices import STUDIES, Choices, Kind, depends
from regolith_studio.session.history import History
from regolith_studio.session.provenance import (
    FileSource,
    ParticleRef,
    ParticleSource,
    RestoredParticles,
    SampleSource,
    UnreadParticle,
    ref_by_source,
    refs_of,
    restore_particles,
    unread_members,
)
from regolith_studio.session.recipe import DatasetRequest, Recipe
from regolith_studio.session.recompute import LiveResults
from regolith_studio.session.results import Failure, ParticleEntry, Results, SessionEvents
from regolith_studio.session.study_requests import study_job
from regolith_studio.session.tasks import Reactions, Task, TaskBoard

MOST_SHOWN = 1000
"""Members of an archive that are opened, at random: each is a mesh in memory."""


class Session:
    """Particles, choices and results of one user; belongs to the thread that made it.

    ``runner``: drives the jobs and brings their events into this thread. ``choices``: where to begin; the
    defaults if left out.

    - ``events``: signals of the session.
    - ``particles``, ``results``: all that is open, and what has been computed of the selected particle.
    - ``left_out``: sentences on what was not opened with the particles, such as the rest of a large archive.
    - ``unread``: particles of the project or recipe whose files could not be read: saving keeps them.
    - ``dataset_request``: dataset settings of a recipe of this session; ``None`` before representatives are
      chosen.
    """

    def __init__(self, runner: Runner, choices: Choices | None = None) -> None:
        self.events = SessionEvents()
        self.particles: tuple[ParticleEntry, ...] = ()
        self.left_out: tuple[str, ...] = ()
        self.unread: tuple[UnreadParticle, ...] = ()
        self.results = Results()
        self._runner = runner
        chosen = choices or Choices(target="fit")  # the window begins with the paper's chain
        self._history: History[Choices] = History(chosen)
        self._board = TaskBoard(runner, self.events.tasks.emit)
        self._live = LiveResults(self, self._board)
        self._studied: dict[Kind, Choices] = {}
        self._dataset_folder: Path | None = None
        self._opened_request: DatasetRequest | None = None
        self.dataset_request: DatasetRequest | None = None

    # --- reading -------------------------------------------------------------------------------

    @property
    def choices(self) -> Choices:
        """The present choices."""
        return self._history.value

    @property
    def selected(self) -> ParticleEntry | None:
        """The particle on screen."""
        return next((entry for entry in self.particles if entry.id == self.choices.selected), None)

    @property
    def open_particles(self) -> tuple[Particle, ...]:
        """The particles themselves, in the order of the list."""
        return tuple(entry.particle for entry in self.particles)

    @property
    def tasks(self) -> tuple[Task, ...]:
        """What is running, oldest first."""
        return self._board.running

    @property
    def ending_queue(self) -> str:
        """Queue of the task whose end is reacted to at present, if there is one."""
        return self._board.ending

    @property
    def n_steps(self) -> int:
        """Number of steps that :meth:`undo` can take back."""
        return self._history.depth

    @property
    def can_undo(self) -> bool:
        """Whether :meth:`undo` would change something."""
        return self._history.can_undo

    @property
    def can_redo(self) -> bool:
        """Whether :meth:`redo` would change something."""
        return self._history.can_redo

    @property
    def dataset_folder(self) -> Path | None:
        """The dataset that was written or read last."""
        return self._dataset_folder

    @dataset_folder.setter
    def dataset_folder(self, folder: Path) -> None:
        self._dataset_folder = folder
        self.events.dataset_folder.emit()

    @property
    def opened_request(self) -> DatasetRequest | None:
        """What the recipe that was opened last says of its dataset."""
        return self._opened_request

    @opened_request.setter
    def opened_request(self, request: DatasetRequest) -> None:
        self._opened_request = request
        self.events.opened_request.emit()

    # --- particles -----------------------------------------------------------------------------

    def open(
        self,
        paths: Sequence[Path | str],
        unit: str | None = None,
        add: bool = False,
        reading: ReadingSettings | None = None,
        convention: TableConvention = "auto",
        restored: bool = False,
    ) -> int:
        """Read files and folders of meshes in the background; returns the task's id.

        - ``unit``: length unit of files that have none; the chosen one if left out.
        - ``add``: keep the particles that are open already.
        - ``reading``: how meshes are read; as chosen if left out.
        - ``convention``: of tables of coefficients: normalisation and phase.
        - ``restored``: whether a project or recipe names them: those that cannot be read stay in it.
        """
        reading = reading or ReadingSettings.of(self.choices)
        reading = replace(reading, unit=unit or reading.unit)
        named = tuple(Path(path).absolute() for path in paths)
        origin = FileSource(tuple(map(str, named)), reading, convention=convention)
        tables = TableReading(None, convention)
        job = Job(load_particles, (named, reading, tables, MOST_SHOWN, self.choices.seed))
        return self._load(N_("Reading particles"), job, origin, add, restored=restored)

    def open_sample(self, add: bool = False) -> int:
        """Load the shipped particles, in place of the open ones unless `add`; returns the task's id."""
        return self._load(N_("Reading the sample"), Job(load_sample), SampleSource(), add)

    def open_recipe(self, recipe: Recipe, base: Path, *, keep_selected: bool = False) -> int:
        """Restore the particles of a recipe: read, extract or draw them; returns the task's id.

        ``base``: folder that relative files are looked up in. ``keep_selected``: whether the particle on
        screen stays there if it is among the restored ones.
        """
        if keep_selected:
            return self._restore(recipe, base, self.choices.selected)
        if recipe.only_files and recipe.inputs == [SAMPLE]:
            return self.open_sample()
        if recipe.only_files and len(recipe.openings) == 1 and SAMPLE not in recipe.inputs:
            (entry,) = recipe.openings
            if entry.l_max is None:
                files = [base / file for file in entry.files]
                reading = ReadingSettings.of(entry)
                return self.open(files, reading=reading, convention=entry.convention, restored=True)
        return self._restore(recipe, base)

    def _restore(self, recipe: Recipe, base: Path, selected: str = "") -> int:
        def take(restored: RestoredParticles) -> None:
            self._replace_particles(restored.loaded, restored.refs, selected=selected, unread=restored.unread)

        title = N_("Restoring particles")
        job = Job(restore_particles, (recipe, base))
        reactions = Reactions(take, failed=self.failure_reporter(title))
        return self._board.start("load", title, job, reactions, repeats=True)

    def keep(self, ids: Collection[str]) -> None:
        """Close all particles but these."""
        kept = [entry for entry in self.particles if entry.id in ids]
        if not kept:
            raise InputError("There are no particles to keep.")
        loaded = LoadedParticles(tuple(entry.particle for entry in kept))
        self._replace_particles(loaded, tuple(entry.ref for entry in kept))

    def adopt(
        self, particles: Sequence[Particle], add: bool = False, origin: ParticleSource | None = None
    ) -> None:
        """Open particles that were made elsewhere, as if they had been read.

        ``origin``: how a recipe restores them. ``add``: keep the particles that are open already.
        """
        if not particles:
            raise InputError("There are no particles to open.")
        refs = refs_of(particles, origin) if origin else ()
        self._replace_particles(LoadedParticles(tuple(particles)), refs, add)

    def select(self, id: str) -> None:
        """Put another particle on screen."""
        self.choose(selected=id)

    # --- choices -------------------------------------------------------------------------------

    def choose(self, step: str | None = None, /, **changes: Any) -> None:
        """Change choices; what follows from them is recomputed in the background.

        ``step``: changes in a row with the same word are one step of undo, until :meth:`end_step`.
        """
        after = self.choices.replaced(**changes)
        if "selected" in changes and after.selected not in {"", *(entry.id for entry in self.particles)}:
            raise InputError(f"There is no particle called {after.selected!r} among those that are open.")
        before = self.choices
        self._history.push(after, step)
        self._follow(before)

    def end_step(self) -> None:
        """End the undo step of a drag: a slider was released."""
        self._history.end_step()

    def undo(self) -> None:
        """Undo the last step."""
        before = self.choices
        self._history.undo()
        self._follow(before)

    def redo(self) -> None:
        """Redo the last step that was undone."""
        before = self.choices
        self._history.redo()
        self._follow(before)

    # --- studies, exports and other jobs ----------------------------------------------------------------

    def start_study(self, kind: Kind | str, **options: Any) -> int:
        """Run ``lmax_study`` or ``coarsening_study`` over all open particles; returns the task's id."""
        kind = Kind(kind)
        choices = self.choices
        title, job = study_job(kind, self._open_particles(), choices, options)

        def show(value: Any) -> None:
            self._studied[kind] = choices
            self.update(kind.value, **{kind.value: value})
            self._mark_outdated()

        def fail(failure: Failed) -> None:
            self.update(kind.value, failures={**self.results.failures, kind.value: failure.sentence})
            self.failure_reporter(title)(failure)

        left = {each: why for each, why in self.results.failures.items() if each != kind.value}
        self.update(kind.value, failures=left)
        return self._board.start(kind, title, job, Reactions(show, partial=show, failed=fail))

    def choices_of(self, kind: Kind) -> Choices | None:
        """Those that a study was computed with; ``None`` if there is none."""
        return self._studied.get(kind)

    def run(
        self,
        queue: str,
        title: str,
        job: Job,
        finished: Callable[[Any], None],
        partial: Callable[[Any], None] | None = None,
        failed: Callable[[Failed], None] | None = None,
        stopped: Callable[[], None] | None = None,
        *,
        repeats: bool = False,
        after_running: bool = False,
    ) -> int:
        """Run any job in the background, the newest of its queue; returns the task's id.

        - ``finished``, ``partial``, ``failed``, ``stopped``: called in this thread while no newer job has
          taken the queue; without `failed`, a failure is emitted as ``events.failed``.
        - ``repeats``, ``after_running``: see :meth:`TaskBoard.start
          <regolith_studio.session.tasks.TaskBoard.start>`.
        """
        reactions = Reactions(
            finished,
            partial or (lambda _value: None),
            failed or self.failure_reporter(title),
            stopped or (lambda: None),
        )
        return self._board.start(queue, title, job, reactions, repeats=repeats, after_running=after_running)

    def stop(self, queue: str) -> None:
        """Stop what runs in a queue, silently."""
        self._board.stop_queue(queue)

    def cancel(self, task_id: int) -> None:
        """Stop one task; harmless if it has ended."""
        self._board.cancel(task_id)

    def pause(self, task_id: int, paused: bool = True) -> None:
        """Pause one task between two of its steps, or resume it; no effect if that is impossible."""
        (self._board.pause if paused else self._board.resume)(task_id)

    def close(self) -> None:
        """Stop everything and wait for it."""
        for task in self.tasks:
            self._board.stop_queue(task.queue)
        self._runner.close()

    # --- for the parts of the session ----------------------------------------------------------

    def update(self, *events: str, **changes: Any) -> None:
        """Replace fields of the results and emit events by their names."""
        self.results = dataclasses.replace(self.results, **changes)
        for name in events:
            getattr(self.events, name).emit()

    def failure_reporter(self, title: str) -> Any:
        """A reaction that emits a failure of the work called `title`."""

        def report(failure: Failed) -> None:
            self.events.failed.emit(Failure(title, failure.sentence, failure.details))

        return report

    def _open_particles(self) -> tuple[Particle, ...]:
        if not self.particles:
            raise InputError(N_("No particle is open; open a mesh first."))
        return self.open_particles

    def _follow(self, before: Choices) -> None:
        changed = self.choices.changed_from(before)
        if not changed:
            return
        self.events.choices.emit(changed)
        self._mark_outdated()
        self._live.follow(before, self.choices)

    def _mark_outdated(self) -> None:
        done = {kind: made for kind, made in self._studied.items() if kind in STUDIES}
        names = frozenset(kind.value for kind, made in done.items() if depends(kind, made, self.choices))
        if names != self.results.outdated:
            changed = names ^ self.results.outdated
            self.update(*sorted(changed), outdated=names)

    def _load(
        self, title: str, job: Job, origin: ParticleSource, add: bool = False, restored: bool = False
    ) -> int:
        def take(loaded: LoadedParticles) -> None:
            unread = unread_members(origin, loaded) if restored else ()
            self._replace_particles(loaded, refs_of(loaded.particles, origin), add, unread=unread)

        reactions = Reactions(take, failed=self.failure_reporter(title))
        return self._board.start("load", title, job, reactions, repeats=True)

    def _replace_particles(
        self,
        loaded: LoadedParticles,
        refs: Sequence[ParticleRef | None] = (),
        add: bool = False,
        selected: str = "",
        unread: Sequence[UnreadParticle] = (),
    ) -> None:
        if loaded.problems:
            self.events.problems.emit(loaded.problems)
        if loaded.left_out:
            self.events.left_out.emit(loaded.left_out)
        self.left_out = (*self.left_out, *loaded.left_out) if add else loaded.left_out
        self.unread = (*(self.unread if add else ()), *unread)
        kept = self.particles if add else ()
        fresh = unique_names(loaded.particles, [entry.id for entry in kept])
        found_refs = refs or [ref_by_source(particle) for particle in loaded.particles]
        self.particles = kept + tuple(
            ParticleEntry(particle.name, particle, ref=ref)
            for particle, ref in zip(fresh, found_refs, strict=True)
        )
        is_open = any(entry.id == selected for entry in self.particles)
        shown = selected if is_open else self.particles[len(kept)].id
        self._live.clear_cache()
        self._studied.clear()
        self._history.restart(self.choices.replaced(selected=shown))
        self.update(
            "lmax_study", "coarsening_study", lmax_study=None, coarsening_study=None, outdated=frozenset()
        )
        self.events.particles.emit()
        self.events.choices.emit(frozenset({"selected"}))
        self._inspect()
        self._live.follow(None, self.choices)

    def _inspect(self) -> None:
        def note(seen: tuple[MeasuredParticle, ...]) -> None:
            rows = list(self.particles)
            for at, facts in enumerate(seen):
                if rows[at].health is None:
                    rows[at] = dataclasses.replace(
                        rows[at],
                        health=facts.health,
                        descriptors=facts.descriptors,
                        visibility=facts.visibility,
                    )
            self.particles = tuple(rows)
            self.events.particles.emit()

        job = Job(measure_particles, (self._open_particles(),))
        title = N_("Measuring particles")
        reactions = Reactions(note, partial=note, failed=self.failure_reporter(title))
        self._board.start("inspect", title, job, reactions, repeats=True)
