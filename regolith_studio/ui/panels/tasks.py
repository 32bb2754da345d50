"""The running task in the status bar: title, progress, stop button."""

import time
from collections.abc import Sequence

from PySide6.QtCore import QEvent, QTimer, Signal
from PySide6.QtWidgets import QHBoxLayout, QProgressBar, QToolButton, QWidget

from regolith_studio.messages import N_
from regolith_studio.session.tasks import Task
from regolith_studio.ui.icons import icon
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.translation.numbers import number_text
from regolith_studio.ui.widgets.labels import ElidedLabel

SHOW_DELAY = 250
"""Milliseconds after which a running task is shown."""
MANY = 500
"""Steps of a task from which on its progress is shown in per cent."""
IDLE = N_("Ready")


class TasksPanel(QWidget):
    """Shows the oldest task that has not been told to stop, and the number of others."""

    cancelRequested = Signal(int)  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("tasks")
        self._tasks: tuple[Task, ...] = ()
        self._since: dict[int, float] = {}
        self.text = ElidedLabel(tr(IDLE))
        self.text.setObjectName("tasks_text")
        self.bar = QProgressBar()
        self.bar.setAccessibleName(tr("Progress"))
        self.bar.setFixedWidth(150)
        self.bar.setFixedHeight(12)
        self.bar.setTextVisible(False)
        self.stop = QToolButton()
        self.stop.setObjectName("tasks_stop")
        self.stop.setAccessibleName(tr("Stop"))
        self.stop.setToolTip(tr("Stop the running task"))
        self.stop.setAutoRaise(True)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(6, 1, 6, 1)
        layout.addWidget(self.bar)
        layout.addWidget(self.stop)
        layout.addWidget(self.text, 1)
        self._make_room()
        self._timer = QTimer(self, interval=SHOW_DELAY, singleShot=True)
        self._timer.timeout.connect(self._show)
        self.stop.clicked.connect(self._request)
        self.set_theme(current_theme())
        self._show()

    def value(self) -> tuple[Task, ...]:
        """The running tasks."""
        return self._tasks

    def setValue(self, tasks: Sequence[Task]) -> None:
        """Show other tasks, those that run longer than :data:`SHOW_DELAY`."""
        now = time.monotonic()
        self._tasks = tuple(tasks)
        self._since = {task.id: self._since.get(task.id, now) for task in self._tasks}
        self._show()

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self.stop.setIcon(icon("stop", theme.bad, theme.muted))

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._make_room()

    def _make_room(self) -> None:
        """The same height with and without tasks, so that the views keep their size."""
        self.setFixedHeight(max(self.stop.sizeHint().height() + 4, self.fontMetrics().height() + 4))

    def _show(self) -> None:
        patience = time.monotonic() - SHOW_DELAY / 1000
        seen = [task for task in self._tasks if self._since[task.id] <= patience]
        if len(seen) < len(self._tasks) and not self._timer.isActive():
            self._timer.start()
        self.bar.setVisible(bool(seen))
        self.stop.setVisible(bool(seen))
        if not seen:
            self.text.setText(tr(IDLE))
            return
        first, others = _oldest(seen), len(seen) - 1
        self.bar.setRange(0, first.total)
        self.bar.setValue(first.done)
        count = f" ({_progress(first)})" if first.total else ""
        message = f": {translate(first.message)}" if first.message else ""
        more = "   " + tr("and {count} more", count=others) if others else ""
        held = " – " + tr("paused") if first.paused else ""
        held = " – " + tr("Stopping …") if first.stopping else held
        self.text.setText(f"{translate(first.title)}{count}{message}{held}{more}")

    def _request(self) -> None:
        if self._tasks:
            self.cancelRequested.emit(_oldest(self._tasks).id)


def _oldest(tasks: Sequence[Task]) -> Task:
    return next((task for task in tasks if not task.stopping), tasks[0])


def _progress(task: Task) -> str:
    """How much is done: in steps, or in per cent where these are many."""
    if task.total >= MANY:
        return number_text(task.done / task.total, ".0%")
    return tr("{at} of {total}", at=task.done, total=task.total)
