"""The commands of menus, tool bar, shortcuts and dropped files, and the undo of settings of pages."""

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp
from typing import Any, Protocol, TypeVar
from weakref import finalize

from PySide6.QtCore import QObject, QTimer, Signal
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QDialog, QFileDialog, QWidget

from regolith_studio.errors import RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.io.atomic import write_files
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.particle_jobs import measure_first
from regolith_studio.messages import N_
from regolith_studio.readers.coefficient_tables import TableConvention
from regolith_studio.readers.particles import all_state_unit, has_tables
from regolith_studio.session.choices import Choices, Kind
from regolith_studio.session.code_export import as_command, as_python
from regolith_studio.session.file_kinds import FileKind, kind_of_all, openable_suffixes, volume_suffixes
from regolith_studio.session.preferences import Preferences
from regolith_studio.session.project import SessionRecipe, input_shown, inputs_of
from regolith_studio.session.provenance import (
    MAX_RESTORED,
    FileSource,
    ParticleRef,
    ParticleSource,
    SampleSource,
    UnreadParticle,
    VirtualSource,
    VolumeSource,
)
from regolith_studio.session.recipe import DatasetRequest, Recipe, read_recipe
from regolith_studio.session.results import ParticleEntry
from regolith_studio.session.session import Session
from regolith_studio.ui.dialogs.files import ADD, REPLACE, UnitDialog, ask_add_or_replace, ask_for_files
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.toast import Toast

INTERVAL = 300
"""Milliseconds between two looks at a page: what rests for one is a step."""


class ShownPages(Protocol):
    """The part of :class:`~regolith_studio.ui.page.PageStack` that is followed."""

    changed: Any
    widgets: Any

    @property
    def current(self) -> str:
        """Key of the page that is seen."""

    def go(self, key: str) -> Any:
        """Show a page."""


@dataclass(frozen=True)
class PageStep:
    """One change of the settings of a page.

    - ``page``: its key.
    - ``before``, ``after``: settings of the page.
    - ``depth``: steps of the session that came before; -1 where other particles have been opened since.
    """

    page: str
    before: dict[str, Any]
    after: dict[str, Any]
    depth: int


class PageHistory(QObject):
    """Steps of the pages, taken back page by page.

    - ``depth``: number of steps that the session can take back.
    """

    changed = Signal()

    def __init__(self, depth: Callable[[], int], parent: QObject) -> None:
        super().__init__(parent)
        self._depth = depth
        self._pages: ShownPages | None = None
        self._timer = QTimer(self, interval=INTERVAL)
        self._timer.timeout.connect(self.look)
        self.restart()

    def watch(self, pages: ShownPages) -> None:
        """Follow the page that is seen."""
        self._pages = pages
        pages.changed.connect(lambda _: self.look())
        self._timer.start()

    def restart(self) -> None:
        """Forget every step: the pages show a project that was opened."""
        self._past: list[PageStep] = []
        self._future: list[PageStep] = []
        self._kept: dict[str, dict[str, Any]] = {}
        self._seen: dict[str, dict[str, Any]] = {}
        self._offered: tuple[bool, ...] = (False, False)
        self.changed.emit()

    def stop(self) -> None:
        self._timer.stop()

    def note_opening(self) -> None:
        """Other particles are open: the steps so far are older than that."""
        self._past = [replace(step, depth=-1) for step in self._past]
        self._future.clear()

    def look(self, resting: bool = False) -> None:
        """Keep a change of the page that is seen once it rests, or at once."""
        key = self._pages.current if self._pages else ""
        now = self._pages.widgets[key].settings() if self._pages and key in self._pages.widgets else {}
        kept = self._kept.setdefault(key, now)
        if now != kept and (resting or self._seen.get(key) == now):
            self._past.append(PageStep(key, kept, now, self._depth()))
            self._future.clear()
            self._kept[key] = now
            self.changed.emit()
        self._seen[key] = now
        offered = tuple(self.own_step(name) is not None for name in ("undo", "redo"))
        if offered != self._offered:
            self._offered = offered
            self.changed.emit()

    @property
    def seen(self) -> str:
        """Key of the page that is seen."""
        return self._pages.current if self._pages else ""

    def own_step(self, name: str) -> Callable[[], None] | None:
        """What ``undo`` or ``redo`` does on the page that is seen, which keeps its steps itself."""
        page = self._pages.widgets.get(self._pages.current) if self._pages else None
        return page.step(name) if page is not None else None

    def undo_page(self, older: bool = False) -> str:
        """Page of the step to take back, if it is the newest of all or `older` ones count too."""
        last = self._past[-1] if self._past else None
        return last.page if last and (older or last.depth >= self._depth()) else ""

    def redo_page(self, newer: bool = False) -> str:
        """Page of the step to take again, if it is the next of all or `newer` ones count too."""
        last = self._future[-1] if self._future else None
        return last.page if last and (newer or last.depth <= self._depth()) else ""

    def undo(self) -> None:
        """Take the last step of a page back, on the page."""
        if self._past:
            step = self._past.pop()
            self._future.append(step)
            self._show(step.page, step.before)

    def redo(self) -> None:
        if self._future:
            step = self._future.pop()
            self._past.append(step)
            self._show(step.page, step.after)

    def _show(self, page: str, settings: dict[str, Any]) -> None:
        if self._pages is not None:
            widget = self._pages.go(page)
            widget.restore(settings)
            self._kept[page] = self._seen[page] = widget.settings()
            self.changed.emit()


FILTERS = (
    N_("Particles (*.stl *.ply *.obj *.off *.glb *.gltf *.3mf *.zip *.anm *.sh *.shc)"),
    N_("Tables of coefficients (*.anm *.sh *.shc *.txt *.dat *.csv)"),
    N_("Datasets (dataset.json)"),
    N_("Projects (*.regolith)"),
    N_("Recipes (*.json)"),
    N_("All files (*)"),
)
T = TypeVar("T")
OPENING = "opening"
"""Where a step is that of opening particles."""
LOOK = "look"
"""Lane of the job that reads one particle while its unit is asked."""


def without(session_recipe: SessionRecipe, unread: Sequence[UnreadParticle] = ()) -> list[str]:
    """What a recipe or project lacks, and what it keeps although it could not be read, in sentences."""
    parts = (
        (
            N_("{count} particles came from no file and are not in it ({names}); export them."),
            session_recipe.without_source,
        ),
        (
            N_("{count} particles whose files could not be read stay in it ({names})."),
            [each.id for each in unread],
        ),
    )
    return [
        tr(sentence, count=len(ids), names=", ".join(ids[:3]) + (" …" if len(ids) > 3 else ""))
        for sentence, ids in parts
        if ids
    ]


class Commands(QObject):
    """Opens, saves and exports, with the dialogs that are needed.

    - ``session``: what is commanded.
    - ``preferences``: recent files, and the unit of each folder.
    - ``toast``: says what came of it.
    - ``window``: parent of the dialogs.
    """

    stepped = Signal()
    """Undo or redo has changed choices that are made on Explore."""

    def __init__(self, session: Session, preferences: Preferences, toast: Toast, window: QWidget) -> None:
        super().__init__(window)
        self.page_steps = PageHistory(lambda: session.n_steps, self)
        self._session, self._preferences, self._toast, self._window = session, preferences, toast, window
        self.openers: dict[FileKind, Callable[[Path], object]] = {FileKind.RECIPE: self._open_recipe}
        self._models: Path | None = None
        self._before: list[Recipe] = []
        self._after: list[Recipe] = []
        session.events.left_out.connect(toast.notes)

    def open(self) -> None:
        """Ask for files of any kind and open them, each kind on its page."""
        volumes = " ".join(f"*{suffix}" for suffix in volume_suffixes())
        every = " ".join(f"*{suffix}" for suffix in openable_suffixes())
        first = (tr("All that can be opened ({suffixes})", suffixes=every),)
        kinds = (*first, tr("Volumes ({suffixes})", suffixes=volumes), *map(tr, FILTERS))
        self.open_paths(ask_for_files(self._window, tr("Open"), self._folder(), ";;".join(kinds)))

    def open_folder(self) -> None:
        name = QFileDialog.getExistingDirectory(self._window, tr("Open a folder of meshes"), self._folder())
        self.open_paths([Path(name)] if name else [])

    def open_sample(self) -> None:
        """Open the shipped particles; asks before others that are open are replaced."""
        if answer := self._add_or_replace(SampleSource):
            self._remember_open()
            self._session.open_sample(add=answer == ADD)

    def open_paths(self, paths: Sequence[Path], unit: str | None = None) -> None:
        """Open meshes and folders, or one file of another kind; asks for the unit of meshes if need be."""
        kind = self._try(lambda: kind_of_all(paths)) if paths else None
        if kind is None:
            return
        opener = self.openers.get(kind)
        if opener is not None:
            self._try(lambda: opener(paths[0]))
            self._preferences.add_recent(paths[0])
            return
        reading: tuple[str, TableConvention] | None = (unit, "auto") if unit else None
        reading = reading or self._ask_reading(list(paths))
        if reading is None:
            return
        unit, convention = reading
        answer = self._add_or_replace(SampleSource)
        if not answer:
            return
        for path in paths:
            self._preferences.add_recent(path, unit)
        self._preferences.save()
        self._remember_open()
        self._try(lambda: self._session.open(paths, unit, add=answer == ADD, convention=convention))

    def ask_before_making(self) -> str:
        """Whether particles that a page is about to make are added or replace the open ones; or nothing.

        Asked where some of the open ones were read from files, and before the work: keys that are typed while
        it runs must not answer the question.
        """
        return self._add_or_replace(SampleSource, VolumeSource, VirtualSource)

    def adopt(self, particles: Sequence[Particle], origin: ParticleSource, answer: str = "") -> bool:
        """Open particles that a page has made; whether the user has agreed.

        ``answer``: of :meth:`ask_before_making`; asked now if left out.
        """
        answer = answer or self.ask_before_making()
        if answer:
            self._remember_open()
            self._session.adopt(particles, add=answer == ADD, origin=origin)
        return bool(answer)

    def _add_or_replace(self, *replaceable: type[ParticleSource]) -> str:
        """``add`` or ``replace``, asked unless all open particles are of replaceable sources; or nothing."""
        particles = self._session.particles
        if all(each.ref is not None and isinstance(each.ref.origin, replaceable) for each in particles):
            return REPLACE
        return ask_add_or_replace(self._preferences, len(particles), self._window) or ""

    def change_unit(self, id: str) -> None:
        """Ask for the unit of the files that this particle was opened with, and read them again in it."""
        entries = self._session.particles
        origin = next((each.ref.origin for each in entries if each.id == id and each.ref), None)
        if not isinstance(origin, FileSource):
            self._toast.problem(tr("{name} was not read from a file whose unit could be changed.", name=id))
            return
        paths = [Path(path) for path in origin.paths]
        reading = self._reading_of_user(paths, origin.reading.unit, origin.convention)
        if reading is None or reading == (origin.reading.unit, origin.convention):
            return
        unit, convention = reading
        read = dataclasses.replace(origin.reading, unit=unit)
        changed = dataclasses.replace(origin, reading=read, convention=convention)
        refs = [
            ParticleRef(changed, each.ref.key) if each.ref and each.ref.origin == origin else each.ref
            for each in entries
        ]
        moved = [dataclasses.replace(each, ref=ref) for each, ref in zip(entries, refs, strict=True)]
        unread = [
            dataclasses.replace(each, ref=ParticleRef(changed, each.ref.key))
            if each.ref.origin == origin
            else each
            for each in self._session.unread
        ]
        recipe = self._to_reopen(moved, unread)
        if recipe is None:
            self._toast.problem(
                tr("Close the particles that came from no file first: they cannot be reopened.")
            )
            return
        for path in paths:
            self._preferences.add_recent(path, unit)
        self._preferences.save()
        self._remember_open()
        self._try(lambda: self._session.open_recipe(recipe, Path.cwd(), keep_selected=True))

    def save_recipe(self) -> None:
        """Ask for a file and write the present choices into it."""
        start = str(Path(self._folder()) / "recipe.json")
        kinds = tr("Recipes (*.json)")
        name, _ = QFileDialog.getSaveFileName(self._window, tr("Save recipe"), start, kinds)
        if not name:
            return
        dataset_request = self._session.dataset_request
        session_recipe = SessionRecipe.of(
            self._session.particles,
            self._session.choices,
            dataset_request=dataset_request,
            unread=self._session.unread,
        )
        with self._toast.reporting():
            recipe, models = session_recipe.files_for(Path(name))
            write_files({**models, Path(name): recipe.to_json().encode("utf-8")})
            command = f"regolith-studio run {Path(name).name}"
            note = tr("Saved {name}; run it with: {command}", name=name, command=command)
            self._toast.note(" ".join((note, *without(session_recipe, self._session.unread))))

    def copy_command(self) -> None:
        """Put the command line that does the same onto the clipboard."""
        QGuiApplication.clipboard().setText(as_command(self._session.choices, inputs_of(self._session)))
        self._toast.note(tr("The command is on the clipboard."))

    def copy_python(self) -> None:
        """Put a script that does the same onto the clipboard."""
        QGuiApplication.clipboard().setText(as_python(self._session.choices, input_shown(self._session)))
        self._toast.note(tr("The script is on the clipboard."))

    def undo(self) -> None:
        """Undo the last change; where there is none, reopen what was open before the last opening."""
        self.page_steps.look(resting=True)
        if own := self.page_steps.own_step("undo"):
            own()
            self.page_steps.look()
            return
        match self.next_step("undo"):
            case "explore":
                self._step(self._session.undo)
            case "opening":
                self._exchange(self._before, self._after)
            case _:
                self.page_steps.undo()

    def redo(self) -> None:
        """Redo what was undone last, a change or an opening."""
        if own := self.page_steps.own_step("redo"):
            own()
            self.page_steps.look()
            return
        match self.next_step("redo"):
            case "explore":
                self._step(self._session.redo)
            case "opening":
                self._exchange(self._after, self._before)
            case _:
                self.page_steps.redo()

    def _step(self, step: Callable[[], None]) -> None:
        before = self._session.choices
        step()
        if self._session.choices.changed_from(before) - {"selected"}:  # each page shows the particle
            self.stepped.emit()

    def next_step(self, name: str) -> str:
        """Page that ``undo`` or ``redo`` would act on, or :data:`OPENING`; empty where there is nothing."""
        session, steps = self._session, self.page_steps
        if name == "undo":
            newest, possible, opening = steps.undo_page(), session.can_undo, bool(self._before)
            oldest = steps.undo_page(older=True)
        else:
            newest, possible = steps.redo_page(), session.can_redo
            opening = bool(self._after) and not session.can_undo
            oldest = steps.redo_page(newer=True)
        return newest or ("explore" if possible else OPENING if opening else oldest)

    def step_title(self, name: str, pages: Mapping[str, str]) -> str:
        """What ``undo`` or ``redo`` would act on, and on which page; empty where it would change nothing."""
        where = self.page_steps.seen if self.page_steps.own_step(name) else self.next_step(name)
        if where == OPENING:
            return tr("Undo the opening") if name == "undo" else tr("Redo the opening")
        page = tr(pages[where]) if where else ""
        title = tr("Undo on {page}", page=page) if name == "undo" else tr("Redo on {page}", page=page)
        return title if where else ""

    def _remember_open(self) -> None:
        """Keep how to reopen the particles that are about to be closed."""
        if self._session.particles:
            self._push_open(self._before)
            self._after.clear()

    def _push_open(self, openings: list[Recipe]) -> None:
        """Add how to reopen what is open; where that is not possible, nothing beyond it can be reached."""
        recipe = self._to_reopen(self._session.particles, self._session.unread)
        openings[:] = [*openings, recipe] if recipe is not None else []

    def _exchange(self, openings: list[Recipe], others: list[Recipe]) -> None:
        """Reopen the last of `openings`; what is open now goes to the others."""
        recipe = openings.pop()
        self._push_open(others)
        self._reopen(recipe)

    def _to_reopen(self, entries: Sequence[ParticleEntry], unread: Sequence[UnreadParticle]) -> Recipe | None:
        """How to reopen these particles; ``None`` where some came neither from a file nor from a model."""
        kept = SessionRecipe.of(entries, self._session.choices, unread=unread)
        return None if kept.without_source else self._try(lambda: self._with_model(kept))

    def _with_model(self, kept: SessionRecipe) -> Recipe:
        """A recipe whose model, if it has one, has been written into a temporary folder."""
        if kept.model is None:
            return kept.recipe
        if self._models is None:
            self._models = Path(mkdtemp(prefix="regolith-studio-"))
            finalize(self, rmtree, self._models, ignore_errors=True)
        recipe, models = kept.files_for(self._models / "open.json", absolute_path=True)
        write_files(models)
        return recipe

    def _reopen(self, recipe: Recipe | None) -> None:
        if recipe is not None:
            self._try(lambda: self._session.open_recipe(recipe, Path.cwd(), keep_selected=True))

    def start_study(self, kind: Kind) -> None:
        self._try(lambda: self._session.start_study(kind))

    def stop(self, task_id: int) -> None:
        self._session.cancel(task_id)

    def _open_recipe(self, path: Path) -> int | None:
        recipe = read_recipe(path)
        names = {each.name for each in dataclasses.fields(Choices)} - {"selected"}
        self._session.choose(**{name: getattr(recipe.choices(), name) for name in names})
        if recipe.representatives or recipe.exports:
            self._session.opened_request = DatasetRequest(recipe.representatives, recipe.exports)
        if recipe.population is not None and recipe.population.n > MAX_RESTORED:
            self._toast.note(
                tr(
                    "Its settings have been applied; its population is too large to "
                    "be opened: use Run as a batch."
                )
            )
            return None
        return self._session.open_recipe(recipe, path.parent)

    def _ask_reading(self, paths: list[Path]) -> tuple[str, TableConvention] | None:
        """Unit of files without one, and convention of tables; asked where they are not known."""
        if all_state_unit(paths):
            return "um", "auto"
        known = {self._preferences.unit_for(path) for path in paths}
        unit = known.pop() if len(known) == 1 else None
        if unit and not has_tables(paths):
            return unit, "auto"
        return self._reading_of_user(paths, unit or self._session.choices.unit)

    def _reading_of_user(
        self, paths: list[Path], suggestion: str, convention: TableConvention = "auto"
    ) -> tuple[str, TableConvention] | None:
        dialog = UnitDialog(paths, suggestion, self._window)
        dialog.convention.choose(convention)

        def measure(convention: TableConvention) -> None:
            self._session.run(
                LOOK,
                N_("Reading particles"),
                Job(measure_first, (paths, convention)),
                dialog.set_first,
                failed=lambda _: dialog.set_first(None),  # it is reported when the file is opened
                repeats=True,
            )

        dialog.conventionChanged.connect(measure)
        measure(convention)
        accepted = dialog.exec() == QDialog.DialogCode.Accepted
        self._session.stop(LOOK)
        reading = dialog.value(), dialog.table_convention()
        dialog.deleteLater()
        return reading if accepted else None

    def _folder(self) -> str:
        recent = [Path(path) for path in self._preferences.recent]
        folders = [path if path.is_dir() else path.parent for path in recent]
        return str(next((folder for folder in folders if folder.is_dir()), Path.home()))

    def _try(self, action: Callable[[], T]) -> T | None:
        try:
            return action()
        except RegolithError as error:
            self._toast.problem(str(error))
            return None
