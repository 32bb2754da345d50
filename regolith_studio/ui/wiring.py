"""Connects the session with the panels: the one place that knows both."""

import time
from collections.abc import Callable, Mapping
from typing import Any, Protocol

from PySide6.QtCore import QObject, QTimer

from regolith_studio.errors import RegolithError
from regolith_studio.session.session import Session

PAUSE = 0.03
"""Seconds between two refreshments of the same thing, however fast the news come."""


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


class Wiring(QObject):
    """Refreshes what has changed, at most every 30 ms, and hands choices to the session.

    Parameters
    ----------
    session
        Whose topics are heard.
    problem
        Told the sentence of a choice that the session refuses.
    """

    def __init__(self, session: Session, problem: Callable[[str], None], parent: QObject) -> None:
        super().__init__(parent)
        self._session, self._problem = session, problem
        self._refreshers: dict[str, list[Callable[[], None]]] = {}
        self._due: dict[str, None] = {}
        self._cuts: list[Callable[[], None]] = []
        self._last = 0.0
        self._timer = QTimer(self, singleShot=True)
        self._timer.timeout.connect(self._refresh)

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
        self._cuts.append(self._session.topics.choices.connect(show))
        show()

    def refresh(self, topics: str, action: Callable[[], None]) -> None:
        """Call `action` soon after any of the topics (words in one text) has said something, and now."""
        for topic in topics.split():
            if topic not in self._refreshers:
                self._refreshers[topic] = []
                signal = getattr(self._session.topics, topic)
                self._cuts.append(signal.connect(lambda topic=topic: self._mark(topic)))
            self._refreshers[topic].append(action)
        action()

    def hear(self, topic: str, action: Callable[..., None]) -> None:
        """Call `action` with what a topic says, at once."""
        self._cuts.append(getattr(self._session.topics, topic).connect(action))

    def cut(self) -> None:
        """Disconnect everything."""
        self._timer.stop()
        for cut in self._cuts:
            cut()
        self._cuts.clear()
        self._refreshers.clear()

    def _mark(self, topic: str) -> None:
        self._due[topic] = None
        if not self._timer.isActive():
            wait = max(0.0, self._last + PAUSE - time.monotonic())
            self._timer.start(round(1000 * wait))

    def _refresh(self) -> None:
        due, self._due = self._due, {}
        actions = dict.fromkeys(action for topic in due for action in self._refreshers.get(topic, ()))
        for action in actions:
            action()
        self._last = time.monotonic()
