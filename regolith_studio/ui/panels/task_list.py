"""List of the running tasks: progress, remaining time, stop button."""

import time
from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QFrame,
    QGridLayout,
    QLabel,
    QProgressBar,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.session.tasks import Task
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.widgets.labels import remark


def time_left(done: int, total: int, seconds: float) -> str:
    """Estimated remaining time as text; empty while it is unknown."""
    if not 0 < done < total or seconds < 1.0:
        return ""
    rest = seconds * (total - done) / done
    if rest < 60:
        return tr("about {seconds} s left", seconds=max(1, round(rest)))
    if rest < 5400:
        return tr("about {minutes} min left", minutes=round(rest / 60))
    return tr("about {hours:.1f} h left", hours=rest / 3600)


class _Clock:
    """Seconds that a task has been running, without its pauses."""

    def __init__(self) -> None:
        self._worked, self._since = 0.0, time.monotonic()
        self._running = True

    def seconds(self) -> float:
        return self._worked + (time.monotonic() - self._since if self._running else 0.0)

    def run(self, running: bool) -> None:
        """Start or pause."""
        self._worked, self._since, self._running = self.seconds(), time.monotonic(), running


class _Row:
    """The widgets of one task."""

    def __init__(self, number: int) -> None:
        self.clock = _Clock()
        self.title, self.bar, self.left = QLabel(), QProgressBar(), remark()
        self.bar.setAccessibleName(tr("Progress"))
        self.bar.setFixedHeight(14)
        self.pause, self.stop = QPushButton(tr("Pause")), QPushButton(tr("Stop"))
        self.pause.setObjectName(f"pause_task_{number}")
        self.pause.setToolTip(tr("Hold it back after the step that it is at, or let it go on"))
        self.pause.setCheckable(True)
        self.stop.setObjectName(f"stop_task_{number}")
        self.widgets = (self.title, self.bar, self.left, self.pause, self.stop)

    def show(self, task: Task) -> None:
        self.clock.run(not task.paused)
        parts = filter(None, (task.title, task.message))
        self.title.setText(": ".join(map(translate, parts)))
        self.bar.setRange(0, task.total)
        self.bar.setValue(task.done)
        rest = time_left(task.done, task.total, self.clock.seconds())
        self.left.setText(tr("held back") if task.paused else rest)
        self.pause.setVisible(task.pausable)
        self.pause.setChecked(task.paused)
        self.pause.setText(tr("Resume") if task.paused else tr("Pause"))


class TaskListPanel(QWidget):
    """A row per task in a scroll area."""

    cancelRequested = Signal(int)  # noqa: N815
    pauseRequested = Signal(int, bool)  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("task_list")
        self._rows: dict[int, _Row] = {}
        self.idle = remark(tr("Nothing is running."))
        self._grid = QGridLayout()
        self._grid.setColumnStretch(0, 2)
        self._grid.setColumnStretch(1, 1)
        inside = QWidget()
        column = QVBoxLayout(inside)
        column.addWidget(self.idle)
        column.addLayout(self._grid)
        column.addStretch(1)
        area = QScrollArea()
        area.setFrameShape(QFrame.Shape.NoFrame)
        area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        area.setWidgetResizable(True)
        area.setWidget(inside)
        for part in (area.viewport(), inside):
            part.setAutoFillBackground(False)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(area)

    def show_tasks(self, tasks: Sequence[Task]) -> None:
        """List other tasks."""
        listed = {task.id for task in tasks}
        for number in [number for number in self._rows if number not in listed]:
            self._remove(number)
        for task in tasks:
            row = self._rows.get(task.id) or self._add(task.id)
            row.show(task)
        self.idle.setVisible(not tasks)

    def _add(self, number: int) -> _Row:
        row = self._rows[number] = _Row(number)
        row.stop.clicked.connect(lambda: self.cancelRequested.emit(number))
        row.pause.clicked.connect(lambda held: self.pauseRequested.emit(number, held))
        for column, widget in enumerate(row.widgets):
            self._grid.addWidget(widget, number, column)
        return row

    def _remove(self, number: int) -> None:
        for widget in self._rows.pop(number).widgets:
            self._grid.removeWidget(widget)
            widget.deleteLater()
