"""Everything that is running, one row each: progress, time left, a button that stops it."""

import time
from collections.abc import Sequence

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QGridLayout, QLabel, QProgressBar, QPushButton, QVBoxLayout, QWidget

from regolith_studio.session.tasks import Task
from regolith_studio.ui.widgets.labels import remark


def time_left(done: int, total: int, seconds: float) -> str:
    """A few words on how long the rest will take; empty while nothing can be said."""
    if not 0 < done < total or seconds < 1.0:
        return ""
    rest = seconds * (total - done) / done
    if rest < 60:
        return f"about {max(1, round(rest))} s left"
    return f"about {round(rest / 60)} min left" if rest < 5400 else f"about {rest / 3600:.1f} h left"


class TaskListPanel(QWidget):
    """Rows come and go with the tasks."""

    cancelRequested = Signal(int)  # noqa: N815

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("task_list")
        self._since: dict[int, float] = {}
        self._rows: dict[int, tuple[QLabel, QProgressBar, QLabel, QPushButton]] = {}
        self.idle = remark("Nothing is running.")
        self._grid = QGridLayout()
        self._grid.setColumnStretch(0, 2)
        self._grid.setColumnStretch(1, 1)
        layout = QVBoxLayout(self)
        layout.addWidget(self.idle)
        layout.addLayout(self._grid)
        layout.addStretch(1)

    def show_tasks(self, tasks: Sequence[Task]) -> None:
        """List these instead."""
        now = time.monotonic()
        self._since = {task.id: self._since.get(task.id, now) for task in tasks}
        for number in [number for number in self._rows if number not in self._since]:
            self._remove(number)
        for task in tasks:
            title, bar, left, _stop = self._rows.get(task.id) or self._add(task.id)
            title.setText(f"{task.title}: {task.message}" if task.message else task.title)
            bar.setRange(0, task.total)
            bar.setValue(task.done)
            left.setText(time_left(task.done, task.total, now - self._since[task.id]))
        self.idle.setVisible(not tasks)

    def _add(self, number: int) -> tuple[QLabel, QProgressBar, QLabel, QPushButton]:
        bar, stop = QProgressBar(), QPushButton("Stop")
        bar.setAccessibleName("Progress")
        bar.setFixedHeight(14)
        stop.setObjectName(f"stop_task_{number}")
        stop.clicked.connect(lambda: self.cancelRequested.emit(number))
        row = self._rows[number] = (QLabel(), bar, remark(), stop)
        for column, widget in enumerate(row):
            self._grid.addWidget(widget, number, column)
        return row

    def _remove(self, number: int) -> None:
        for widget in self._rows.pop(number):
            self._grid.removeWidget(widget)
            widget.deleteLater()
