"""A page of the window: its protocol, its actions and its context; see :mod:`regolith_studio.ui.pages`."""

import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from PySide6.QtWidgets import QWidget

from regolith_studio.jobs.events import Failed, Job
from regolith_studio.messages import N_
from regolith_studio.session.file_kinds import FileKind
from regolith_studio.session.preferences import Preferences
from regolith_studio.session.session import Session
from regolith_studio.ui.bindings import Bindings
from regolith_studio.ui.commands import Commands
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.widgets.toast import Toast

BREAK = "-"
PAGE_MENU, VIEW = N_("&Page"), N_("&View")
"""Menus of the commands of the page that is seen, and of what it shows."""


@dataclass(frozen=True)
class ActionSpec:
    """One row.

    - ``name``: of the command that it runs, and its object name; :data:`BREAK` for a line between actions.
    - ``text``: in the menu; "&" marks the letter.
    - ``icon``: file in ``resources/icons``; empty for none.
    - ``shortcut``: empty for none.
    - ``tip``: in the tool bar; the text if empty.
    - ``checked``: ``True`` or ``False`` for a switch, ``None`` for a command.
    - ``bar``: its place in the tool bar: ``words`` with its text, ``under`` with `label` below its icon,
      ``icon`` without, empty for none.
    - ``label``: one or two words for the tool bar; the text if empty.
    - ``menu``: title of its menu; those of :data:`regolith_studio.ui.actions.WITHIN_VIEW` are menus within
      View.
    """

    name: str
    text: str = ""
    icon: str = ""
    shortcut: str = ""
    tip: str = ""
    checked: bool | None = None
    bar: str = ""
    label: str = ""
    menu: str = PAGE_MENU


class PageWidget(QWidget):
    """Base class of pages; every method may be overridden."""

    def build(self) -> None:
        """Make the parts of the page; called once, right after construction."""

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme, once after building and at every change; its parts have done so."""

    def commands(self) -> Mapping[str, Callable[..., object]]:
        """A function for each name in :attr:`Page.actions`; switches are called with their state."""
        return {}

    def on_show(self) -> None:
        """Called when the page becomes the current one."""

    def on_hide(self) -> None:
        """Called when another page becomes the current one."""

    def open_path(self, path: Path) -> None:
        """Open a file whose kind is one of :attr:`Page.opens`: dropped, chosen, or named at start."""

    def busy(self) -> str:
        """One sentence on what closing would lose or stop, or nothing; tasks need not be named."""
        return ""

    def settings(self) -> dict[str, Any]:
        """The part of :meth:`state` that undo takes back: what is set on this page alone."""
        return {}

    def state(self) -> dict[str, Any]:
        """What a project file keeps of this page, as plain JSON; under ``made``, what was computed here."""
        return self.settings()

    def restore(self, state: Mapping[str, Any]) -> None:
        """Show what :meth:`state` returned once, maybe by another version: ignore what is not known."""

    def resume(self, state: Mapping[str, Any]) -> None:
        """Show again what was made of the particles, which are open now; after :meth:`restore`."""

    def on_close(self) -> None:
        """Called when the window closes: release graphics memory, stop timers."""


@dataclass(frozen=True)
class PageContext:
    """The context of a page: session, preferences and services of the window.

    - ``key``: of the page.
    - ``session``: particles, choices, results, events; see :mod:`regolith_studio.session`.
    - ``bindings``: the page's own: what it refreshes is refreshed while the page is seen, and at its next
      visit if something has changed meanwhile.
    - ``preferences``: what is remembered from one start to the next; see :meth:`recall`.
    - ``toast``: ``note(sentence)`` and ``problem(sentence, details)``.
    - ``commands``: opening, saving and exporting, with their dialogs.
    - ``views``: backend of three-dimensional views, for :func:`regolith_studio.ui.views.factory.make_view`.
    - ``go``: shows another page by its key, and returns its widget.
    """

    key: str
    session: Session
    bindings: Bindings
    preferences: Preferences
    toast: Toast
    commands: Commands
    views: str
    go: Callable[[str], PageWidget]

    def start(
        self,
        title: str,
        job: Job,
        finished: Callable[[Any], None],
        partial: Callable[[Any], None] | None = None,
        failed: Callable[[Failed], None] | None = None,
        stopped: Callable[[], None] | None = None,
        queue: str = "",
        *,
        repeats: bool = False,
        after_running: bool = False,
    ) -> int:
        """Run a job in the background, seen in the task list; returns the number for :meth:`Session.cancel`.

        - ``title``: on screen.
        - ``job``: a generator function with its arguments; see :mod:`regolith_studio.jobs.events`.
        - ``finished``, ``partial``, ``failed``, ``stopped``: called in the thread of the window, and only
          while no newer job has taken the queue. A failure that is not taken care of becomes a toast.
        - ``queue``: jobs of one queue of one page replace each other.
        - ``repeats``: the job starts by itself when the page is opened again: closing the window does not
          ask about it.
        - ``after_running``: let the running job of the queue end and be shown first: for controls that are
          dragged.
        """
        return self.session.run(
            f"{self.key}:{queue}",
            title,
            job,
            finished,
            partial,
            failed,
            stopped,
            repeats=repeats,
            after_running=after_running,
        )

    def stop(self, queue: str = "") -> None:
        """Stop what runs in a queue of this page, silently: its reactions are not called any more."""
        self.session.stop(f"{self.key}:{queue}")

    def recall(self, name: str, default: Any = None) -> Any:
        """What was remembered under this name by this page."""
        return self.preferences.window.get(f"page.{self.key}", {}).get(name, default)

    def remember(self, name: str, value: Any) -> None:
        """Remember plain JSON for the next start; written when the window closes."""
        kept = self.preferences.window.get(f"page.{self.key}", {}) | {name: value}
        self.preferences.window = self.preferences.window | {f"page.{self.key}": kept}


@dataclass(frozen=True)
class Page:
    """A page as a row of the sidebar.

    - ``key``: name of its package.
    - ``title``: in the sidebar: one word or two.
    - ``icon``: file in ``resources/icons``.
    - ``order``: place in the sidebar, from small to large.
    - ``tip``: one sentence on what can be done there.
    - ``make``: ``module:Class`` of the widget, called with its context; imported at the first visit, so that
      the window starts fast.
    - ``opens``: kinds of files that :meth:`PageWidget.open_path` of this page opens.
    - ``actions``: commands of the page, in menus and tool bar while it is seen, in the command palette
      always.
    """

    key: str
    title: str
    icon: str
    order: int
    tip: str
    make: str
    actions: tuple[ActionSpec, ...] = ()
    opens: tuple[FileKind, ...] = ()

    def build(self, context: PageContext) -> PageWidget:
        """Make the widget of the page with all its parts."""
        widget: PageWidget = pkgutil.resolve_name(self.make)(context)
        widget.build()
        return widget
