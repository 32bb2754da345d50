"""Connections between the session and the panels."""

import time
from collections.abc import Callable, Collection, Mapping
from functools import partial
from typing import Any, Protocol

from PySide6.QtCore import QObject, QTimer

from regolith_studio.errors import RegolithError
from regolith_studio.session.session import Session

FAST, SLOW = 0.03, 0.15
"""Seconds between two refreshments of the same thing: of the views, and of plots and tables.

Fast ones come at once when nothing has come for a while; slow ones always wait, so that the picture of a
view is not kept back by the painting of a plot.
"""


class ChoicePanel(Protocol):
    """A panel that edits choices."""

    @property
    def FIELDS(self) -> tuple[str, ...]: ...
    @property
    def valueChanged(self) -> Any: ...
    @property
    def editingFinished(self) -> Any: ...
    def objectName(self) -> str: ...
    def setValue(self, value: Mapping[str, Any]) -> None: ...


class Bindings(QObject):
    """Refreshes panels after changes, at a limited rate, and passes choices to the session.

    ``session``: whose events are listened to. ``problem``: told the sentence of a choice that the session
    refuses.
    """

    def __init__(self, session: Session, problem: Callable[[str], None], parent: QObject) -> None:
        super().__init__(parent)
        self._session, self._problem = session, problem
        self._disconnectors: list[Callable[[], None]] = []
        self._holders: list[Callable[[], None]] = []
        self._fast, self._slow = Throttle(FAST, self, at_once=True), Throttle(SLOW, self, at_once=False)

    def edit(self, panel: ChoicePanel) -> None:
        """Let a panel edit the choices it names, and show them whenever they change."""
        step = panel.objectName()

        def choose(changes: Mapping[str, Any]) -> None:
            try:
                self._session.choose(f"{step} {' '.join(changes)}", **changes)
            except RegolithError as error:
                self._problem(str(error))
                show()

        def show() -> None:
            panel.setValue({name: getattr(self._session.choices, name) for name in panel.FIELDS})

        panel.valueChanged.connect(choose)
        panel.editingFinished.connect(self._session.end_step)
        self._listen("choices", show, panel.FIELDS)
        show()

    def refresh(
        self,
        events: str,
        action: Callable[[], None],
        fields: Collection[str] = (),
        *,
        slow: bool = False,
        keeps_particles: bool = False,
    ) -> None:
        """Call `action` soon after any of the events (words in one text), and now.

        - ``fields``: of the choices, whose change matters to `action`; each of them if empty.
        - ``slow``: for tables and plots.
        - ``keeps_particles``: whether `action` keeps references to particles; :meth:`refresh_hidden` calls
          it while the page is hidden.
        """
        throttle = self._slow if slow else self._fast
        throttle.register(action)
        if keeps_particles:
            self._holders.append(partial(throttle.run_now, action))
        for event in events.split():
            self._listen(event, lambda: throttle.add(action), fields)
        action()

    @property
    def idle(self) -> bool:
        """Nothing waits to be refreshed, or all of it waits for :meth:`resume`."""
        return self._fast.idle and self._slow.idle

    def listen(self, event: str, action: Callable[..., None]) -> None:
        """Call `action` with the arguments of an event, at once."""
        signal = getattr(self._session.events, event)
        signal.connect(action)
        self._disconnectors.append(lambda: signal.disconnect(action))

    def _listen(self, event: str, action: Callable[[], None], fields: Collection[str]) -> None:
        if event != "choices" or not fields:
            self.listen(event, action)
            return

        def act_on(changed: frozenset[str]) -> None:
            if not changed.isdisjoint(fields):
                action()

        self.listen(event, act_on)

    def pause(self) -> None:
        """Refresh nothing until :meth:`resume`; what is due meanwhile is kept."""
        self._fast.pause()
        self._slow.pause()

    def resume(self) -> None:
        """Refresh what has become due, and go on."""
        self._fast.resume()
        self._slow.resume()

    def refresh_hidden(self) -> None:
        """Refresh, although it is not seen, what would else keep particles that have been closed."""
        for holder in self._holders:
            holder()

    def disconnect_all(self) -> None:
        self._fast.stop()
        self._slow.stop()
        for disconnect_all in self._disconnectors:
            disconnect_all()
        self._disconnectors.clear()
        self._holders.clear()


class Throttle(QObject):
    """Calls added functions, each at most once in `seconds`; those due together in the order of registration.

    A page that has been hidden would else show results first and then, in their place, the particle that they
    are of.
    """

    def __init__(self, seconds: float, parent: QObject, *, at_once: bool) -> None:
        super().__init__(parent)
        self._seconds, self._at_once = seconds, at_once
        self._order: dict[Callable[[], None], int] = {}
        self._due: dict[Callable[[], None], float] = {}
        self._last: dict[Callable[[], None], float] = {}
        self._paused = False
        self._timer = QTimer(self, singleShot=True)
        self._timer.timeout.connect(self._run)

    @property
    def idle(self) -> bool:
        """Nothing is due, or nothing is called for the time being."""
        return self._paused or not self._due

    def register(self, action: Callable[[], None]) -> None:
        """Call `action` after all that are registered already, where they are due together."""
        self._order.setdefault(action, len(self._order))

    def add(self, action: Callable[[], None]) -> None:
        """Call `action` at its next refresh."""
        if action not in self._due:
            begin = self._last.get(action, 0.0) if self._at_once else time.monotonic()
            self._due[action] = begin + self._seconds
            self._wait()

    def run_now(self, action: Callable[[], None]) -> None:
        """Call an action if it is due, even while nothing is called."""
        if self._due.pop(action, None) is not None:
            action()
            self._last[action] = time.monotonic()

    def pause(self) -> None:
        """Call nothing for a while."""
        self._paused = True
        self._timer.stop()

    def resume(self) -> None:
        self._paused = False
        self._wait()

    def stop(self) -> None:
        self._timer.stop()
        self._due.clear()
        self._last.clear()

    def _wait(self) -> None:
        if self._due and not self._paused:
            self._timer.start(max(0, round(1000 * (min(self._due.values()) - time.monotonic()))))

    def _run(self) -> None:
        now = time.monotonic() + 0.001
        due = [each for each, moment in self._due.items() if moment <= now]
        for action in sorted(due, key=lambda each: self._order.get(each, 0)):
            if self._due.pop(action, None) is None:
                continue
            action()
            self._last[action] = time.monotonic()
        self._wait()
