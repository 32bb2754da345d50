"""Projects in the window: opened, saved, recovered, and asked about before it closes."""

import hashlib
import os
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from uuid import uuid4

from psygnal import SignalInstance
from PySide6.QtCore import QDateTime, QObject, QTimer, Signal
from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget

from regolith_studio.errors import RegolithError
from regolith_studio.io.output_lock import lock_file
from regolith_studio.messages import N_
from regolith_studio.session.preferences import preferences_path
from regolith_studio.session.project import SUFFIX, Project, SessionRecipe, read_project
from regolith_studio.session.recipe import Recipe
from regolith_studio.session.results import Failure
from regolith_studio.session.session import Session
from regolith_studio.session.tasks import Task
from regolith_studio.ui.commands import PageHistory, without
from regolith_studio.ui.layout import named
from regolith_studio.ui.page import PageStack
from regolith_studio.ui.translation import inert, tr, translate
from regolith_studio.ui.widgets.toast import Toast


def needs_confirmation(tasks: Sequence[Task], busy: Sequence[str]) -> list[str]:
    """What closing would stop, a sentence each, none of them twice; nothing of work that repeats itself."""
    titles = dict.fromkeys(tr(task.title) for task in tasks if not task.repeats)
    return [*(tr("{task} is running.", task=title) for title in titles), *busy]


def may_close(
    parent: QWidget, reasons: Sequence[str], unsaved: Sequence[str], save: Callable[[], bool]
) -> bool:
    """Ask whether to close although work would be lost, and whether to save first; yes where there is none.

    ``reasons``, ``unsaved``: what would be stopped, and what is not saved, in sentences. ``save``: saves
    what is not; whether that was done.
    """
    if not reasons and not unsaved:
        return True
    title, lost = tr("Close Regolith Studio?"), "\n".join(map(inert, (*reasons, *unsaved)))
    box = named(QMessageBox(QMessageBox.Icon.Question, title, lost, parent=parent), "closing")
    stay = box.addButton(tr("Cancel"), QMessageBox.ButtonRole.RejectRole)
    words = tr("Stop and close") if reasons else tr("Don't save")
    leave = box.addButton(words, QMessageBox.ButtonRole.DestructiveRole)
    kept = box.addButton(tr("Save"), QMessageBox.ButtonRole.AcceptRole) if unsaved else None
    if kept is not None:
        kept.setObjectName("closing_save")
    stay.setObjectName("closing_stay")
    leave.setObjectName("closing_leave")
    box.setDefaultButton(kept or stay)
    box.setEscapeButton(stay)
    box.exec()
    pressed = box.clickedButton()
    box.deleteLater()
    return pressed is leave or (pressed is kept is not None and save())


FILTER = N_("Projects (*.regolith)")
MADE = ("scan", "made")
"""In the state of a page: what was made or opened there, for which closing asks."""
AUTOSAVE_SECONDS = 10
"""Between a change and the copy of it that is kept for the case of a crash."""


class CopyLock:
    """Of an automatic copy: held by the window that it belongs to, and released by any death of it.

    The lock is one of the system, as the number of a process says nothing: in a container the next window
    has the number of the one that crashed.
    """

    def __init__(self, copy: Path) -> None:
        self._file, self._handle = Path(f"{copy}.lock"), -1

    def take(self) -> bool:
        """Take the lock, or hold it further; whether it is held."""
        if self._handle < 0:
            with suppress(OSError):
                self._handle = lock_file(self._file)
        return self._handle >= 0

    def release(self) -> None:
        """Let go of it, and remove its file."""
        if self._handle >= 0:
            self._file.unlink(missing_ok=True)
            os.close(self._handle)
            self._handle = -1


@dataclass(frozen=True)
class _Opening:
    """A project whose particles are being read: its name, the task, and the last failure since it began."""

    name: str
    task: int
    reason: str = ""


class ProjectFiles(QObject):
    """The current project file, and whether the session has changed since it was saved.

    - ``session``, ``pages``: what is saved.
    - ``steps``: begin again with a project.
    - ``toast``: says what came of it.
    - ``window``: parent of the dialogs.
    """

    changed = Signal()

    def __init__(
        self, session: Session, pages: PageStack, steps: PageHistory, toast: Toast, window: QWidget
    ) -> None:
        super().__init__(window)
        self._steps = steps
        self._session, self._pages, self._toast, self._window = session, pages, toast, window
        self.path: Path | None = None
        self._digest = ""
        self._saved: Project | None = None
        self._lock = CopyLock(autosave_path())
        self._recovered: dict[Path, CopyLock] = {}
        self._copied: Project | None = None
        self._begun: Recipe | None = None
        self._opening: _Opening | None = None
        self._to_resume: Project | None = None
        self._restored = False
        self._remaking = False
        self._changed = False
        self._timer = QTimer(self, interval=1000 * AUTOSAVE_SECONDS)
        self._timer.timeout.connect(self._follow_pages)
        self._timer.start()
        pages.built.connect(self._note_page)
        for event in (session.events.choices, session.events.particles):
            event.connect(self._note_change)
        for connected, slot in self._reactions():
            connected.connect(slot)

    def _reactions(self) -> tuple[tuple[SignalInstance, Callable[..., None]], ...]:
        """Events of the session, and what follows them."""
        events = self._session.events
        return (
            (events.particles, self._begin),
            (events.particles, self._go_on_later),
            (events.failed, self._note_failure),
            (events.tasks, self._follow_opening),
            (events.tasks, self._end_remaking_later),
        )

    @property
    def modified(self) -> bool:
        """Whether a project is open and no longer what its file holds; not while it is being opened."""
        saved = self._saved
        return (
            self.path is not None
            and saved is not None
            and self._lasting(self._state()) != self._lasting(saved)
        )

    def _lasting(self, state: Project) -> Project:
        """What of a state can be unsaved: neither what is looked at, nor results that are made again."""
        passing = MADE if self._remaking else ()
        pages = {
            page: {name: value for name, value in fields.items() if name not in passing}
            for page, fields in state.pages.items()
        }
        return state.model_copy(update={"page": "", "selected": "", "pages": pages})

    def title(self) -> str:
        if self.path is None:
            return "Regolith Studio"
        return f"{self.path.stem}{' *' if self.modified else ''} – Regolith Studio"

    def unsaved(self) -> list[str]:
        """What closing would lose, in sentences."""
        if self._restored:
            return [tr("What was restored after the crash is not saved as a project.")]
        if self.path is None:
            return [tr("This session is not saved as a project.")] if self._is_begun() else []
        return [tr("{name} has changes that are not saved.", name=self.path.name)] if self.modified else []

    def _is_begun(self) -> bool:
        """Whether a session without a name holds more than what the window was opened with."""
        state = self._state()
        made = any(page.get(key) for page in state.pages.values() for key in MADE)
        return self._begun is not None and (made or state.recipe != self._begun)

    def _begin(self) -> None:
        """Keep what the first particles make of the session: nothing of it is lost by closing."""
        if self._begun is None and self._session.particles:
            self._begun = self._state().recipe

    def save(self) -> bool:
        """Write the project into its file, asking for one the first time; says whether it was written."""
        if self.path is None:
            return self.save_as()
        question = tr(
            "{name} has changed on the disk since this window opened or saved it. Replace it?",
            name=self.path.name,
        )
        return (_digest(self.path) in ("", self._digest) or self._agreed(question)) and self._write(self.path)

    def save_as(self) -> bool:
        start = str(self.path or Path.home() / f"project{SUFFIX}")
        name, _ = QFileDialog.getSaveFileName(self._window, tr("Save project"), start, tr(FILTER))
        if not name:
            return False
        path = Path(name)
        if path.suffix == SUFFIX:  # the dialog has asked whether it may be replaced
            return self._write(path)
        path = path.with_name(path.name + SUFFIX)
        question = tr("{name} exists already. Replace it?", name=path.name)
        return (not path.exists() or self._agreed(question)) and self._write(path)

    def open(self, path: Path) -> None:
        digest = _digest(path)
        if self._bring_back(path):
            self.path, self._digest = path, digest
            self._saved = None
            self.changed.emit()

    def offer_recovery(self) -> None:
        """Ask whether to bring back what a window that crashed has left, the newest first.

        Nothing is removed unasked: what is brought back stays until this window has a copy of its own, and
        what has not been asked about is offered by the next window.
        """
        for path in stale_autosaves():
            lock = CopyLock(path)
            if lock.take() and path.exists():  # no other window asks about it, or has just been answered
                self._ask_about(path, lock)
                return

    def _ask_about(self, path: Path, lock: CopyLock) -> None:
        text = tr("Regolith Studio was not closed properly the last time. Restore its state?")
        box = QMessageBox(QMessageBox.Icon.Question, tr("Recover"), text, parent=self._window)
        box.setObjectName("recovery")
        box.setInformativeText(_saved_at(path))
        yes, no = QMessageBox.StandardButton.Yes, QMessageBox.StandardButton.No
        box.setStandardButtons(yes | no)
        box.setDefaultButton(yes)

        def decided(answer: int) -> None:
            box.deleteLater()
            self._recovered[path] = lock
            if answer == yes.value and self._bring_back(path):
                self._take_name(path)
                self._note_change()
                return
            self._forget_recovered()
            self.offer_recovery()

        box.finished.connect(decided)
        box.open()

    def _take_name(self, copy: Path) -> None:
        """Go on under the name of the project that an automatic copy belongs to, not saved yet."""
        name = read_project(copy).file
        self._restored = True
        if name:
            self.path, self._digest, self._saved = Path(name), _digest(Path(name)), Project()

    def _forget_recovered(self) -> None:
        for path, lock in self._recovered.items():
            _remove(path)
            lock.release()
        self._recovered = {}

    def close(self) -> None:
        """The window closes as it should: nothing needs to be brought back."""
        self._timer.stop()
        for event in (self._session.events.choices, self._session.events.particles):
            event.disconnect(self._note_change)
        for connected, slot in self._reactions():
            connected.disconnect(slot)
        _remove(autosave_path())
        self._lock.release()
        self._forget_recovered()

    def _state(self) -> Project:
        pages = {key: state for key, widget in self._pages.widgets.items() if (state := widget.state())}
        return Project.of(self._session, self._pages.current, pages)

    def _session_recipe(self) -> SessionRecipe:
        return SessionRecipe.of(self._session.particles, self._session.choices, unread=self._session.unread)

    def _write(self, path: Path) -> bool:
        state, session_recipe = self._state(), self._session_recipe()
        try:
            state.save(path, session_recipe.model)
        except RegolithError as error:
            self._toast.problem(str(error))
            return False
        self.path, self._saved, self._digest, self._restored = path, state, _digest(path), False
        self._toast.note(
            " ".join((tr("Saved {path}.", path=path), *without(session_recipe, self._session.unread)))
        )
        self.changed.emit()
        return True

    def _agreed(self, question: str) -> bool:
        """Whether the user answers with yes."""
        box = QMessageBox(QMessageBox.Icon.Question, tr("Save project"), question, parent=self._window)
        box.setObjectName("replace_project")
        yes, no = QMessageBox.StandardButton.Yes, QMessageBox.StandardButton.No
        box.setStandardButtons(yes | no)
        box.setDefaultButton(no)
        agreed = box.exec() == yes.value
        box.deleteLater()
        return agreed

    def _bring_back(self, path: Path) -> bool:
        try:
            project = read_project(path)
            task = project.open_in(self._session, path.parent)
        except RegolithError as error:
            self._toast.problem(str(error))
            return False
        for key, state in project.pages.items():
            if key in self._pages.pages:
                self._pages.go(key).restore(state)
        if project.page in self._pages.pages:
            self._pages.go(project.page)
        self._to_resume = project
        if any(each.id == task for each in self._session.tasks):  # none is, if jobs run at once
            self._opening = _Opening(path.name, task)
        return True

    def _follow_opening(self) -> None:
        """Leave a project whose particles have not come when their reading has ended."""
        opening = self._opening
        if opening is None or any(each.id == opening.task for each in self._session.tasks):
            return
        self._opening = None
        self._leave(opening)

    def _note_failure(self, failure: Failure) -> None:
        if self._opening is not None:
            self._opening = replace(self._opening, reason=failure.sentence)

    def _go_on_later(self) -> None:
        if self._to_resume is not None:
            QTimer.singleShot(0, self, self._go_on)
        self._opening = None

    def _go_on(self) -> None:
        """Put the particle of a project back on screen, and what was made of its particles."""
        project, self._to_resume = self._to_resume, None
        if project is None:
            return
        if any(entry.id == project.selected for entry in self._session.particles):
            self._session.select(project.selected)
        for key, state in project.pages.items():
            if key in self._pages.widgets:
                self._pages.widgets[key].resume(state)
        self._steps.restart()
        if self.path is not None and not self._restored:
            self._saved, self._remaking = self._state(), True
            self._end_remaking()
            self.changed.emit()

    def _end_remaking_later(self) -> None:
        if self._remaking:
            QTimer.singleShot(0, self, self._end_remaking)  # what has just ended may start the next

    def _end_remaking(self) -> None:
        """Take the results of an opened project for saved ones, once all have been made again."""
        if not self._remaking or self._session.tasks or self._saved is None:
            return
        now = self._state().pages
        pages = {
            page: fields | {name: now[page][name] for name in MADE if name in now.get(page, {})}
            for page, fields in self._saved.pages.items()
        }
        self._saved, self._remaking = self._saved.model_copy(update={"pages": pages}), False
        self.changed.emit()

    def _note_page(self, key: str) -> None:
        """Take the state of a page at its first visit for a saved one."""
        if self._saved is None or key in self._saved.pages:
            return
        if state := self._pages.widgets[key].state():
            self._saved = self._saved.model_copy(update={"pages": self._saved.pages | {key: state}})

    def _leave(self, opening: _Opening) -> None:
        """Give up the name of a project whose particles were not read: saving would lose what it names.

        A copy that a crash has left is offered again by the next window.
        """
        self.path, self._digest, self._saved, self._restored = None, "", None, False
        self._to_resume = None
        for lock in self._recovered.values():
            lock.release()
        self._recovered = {}
        if opening.reason:
            name = opening.name
            note = tr("{name} is not open and stays as it is; move its files back to open it.", name=name)
            self._toast.problem(f"{translate(opening.reason)} {note}")
        self.changed.emit()

    def _note_change(self) -> None:
        self._changed = True
        self.changed.emit()

    def _follow_pages(self) -> None:
        """Renew the copy if anything has changed, also on a page that says nothing of it."""
        state = self._state()
        first, self._copied = self._copied is None, self._copied or state
        if (first and not self._changed) or (state == self._copied and not self._changed):
            return
        self._changed, self._copied = False, state
        self._autosave()
        self.changed.emit()

    def _autosave(self) -> None:
        path = autosave_path()
        with suppress(OSError):  # which the saving tells
            path.parent.mkdir(parents=True, exist_ok=True)
        self._lock.take()  # first: a file without a lock is one that a crash has left
        with self._toast.reporting():
            copy = self._state().model_copy(update={"file": str(self.path or "")})
            copy.save(path, self._session_recipe().model)
            if not self._recovered:
                return
            if self._session.tasks:
                self._changed = True
            else:  # what was brought back has been read, and is in this copy
                self._forget_recovered()


def _digest(path: Path) -> str:
    """SHA-256 of a file; empty if there is none that can be read."""
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return ""


THIS_START = f"{os.getpid()}-{uuid4().hex[:8]}"
"""Of this process alone: numbers of processes come again."""


def autosave_path() -> Path:
    """Where this process keeps its state for the case of a crash."""
    return preferences_path().with_name(f"autosave-{THIS_START}{SUFFIX}")


def stale_autosaves() -> list[Path]:
    """What windows that no longer live have left, the newest first."""
    autosaves = preferences_path().parent.glob(f"autosave-*{SUFFIX}")
    abandoned = [path for path in autosaves if path != autosave_path() and _is_abandoned(path)]
    return sorted(abandoned, key=lambda path: path.stat().st_mtime, reverse=True)


def _saved_at(path: Path) -> str:
    """Text with the time of an autosave."""
    moment = QDateTime.fromSecsSinceEpoch(int(path.stat().st_mtime))
    return tr("It was saved at {moment}.", moment=moment.toString("yyyy-MM-dd HH:mm"))


def _remove(autosave: Path) -> None:
    """With the model that may lie beside it."""
    for path in (autosave, *autosave.parent.glob(f"{autosave.stem}-model*")):
        path.unlink(missing_ok=True)


def _is_abandoned(path: Path) -> bool:
    lock = CopyLock(path)
    taken = lock.take()
    lock.release()
    return taken
