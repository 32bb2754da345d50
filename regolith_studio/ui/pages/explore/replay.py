"""Shows the steps of a run one by one, where they are computed faster than they can be seen."""

from collections import deque
from dataclasses import replace

from PySide6.QtCore import QObject, QTimer, Signal

from regolith_studio.coarsening.progress import CoarseningProgress
from regolith_studio.session.results import Results

INTERVAL = 40
"""Milliseconds between two steps."""
FRAMES = 40
"""About as many steps are shown of those that wait, so that a long run is shown in two seconds too."""
REPLAYED = ("annealing",)
"""Methods whose steps are worth watching; the others come to their result in few."""


class RunReplay(QObject):
    """Collects the steps of a run and emits them at a steady pace."""

    shown = Signal(object)
    """A :class:`CoarseningProgress` with its polyhedron."""
    ended = Signal()
    """All steps that there are have been shown."""

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._waiting: deque[CoarseningProgress] = deque()
        self._last: CoarseningProgress | None = None
        self._timer = QTimer(self, interval=INTERVAL)
        self._timer.timeout.connect(self._show_next)

    @property
    def playing(self) -> bool:
        """Whether steps are still to be shown."""
        return self._timer.isActive()

    def follow(self, results: Results, method: str) -> None:
        """Take the newest steps of the results; forget the others where another run has begun."""
        newest = results.coarsening_progress
        if newest is None or method not in REPLAYED:
            self.stop()
            return
        for step in newest.recent:
            if self._last is None or step.step > self._last.step:
                self._add(step)
        if self._waiting and not self.playing:
            self._timer.start()
            self._show_next()

    def stop(self) -> None:
        """Forget the steps that have not been shown."""
        self._waiting.clear()
        self._last = None
        self._timer.stop()

    def _add(self, step: CoarseningProgress) -> None:
        if step.polyhedron is None and self._last is not None:
            step = replace(step, polyhedron=self._last.polyhedron)
        self._last = step
        self._waiting.append(step)

    def _show_next(self) -> None:
        if self._waiting:
            for _ in range(len(self._waiting) // FRAMES):
                self._waiting.popleft()
            self.shown.emit(self._waiting.popleft())
        else:
            self._timer.stop()
            self.ended.emit()
