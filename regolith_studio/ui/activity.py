"""The dock below the pages: the running tasks and the log of messages."""

import time
from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QApplication,
    QDockWidget,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QMainWindow,
    QPlainTextEdit,
    QProgressBar,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.messages import N_
from regolith_studio.session.session import Session
from regolith_studio.session.tasks import Task
from regolith_studio.ui.bindings import Bindings
from regolith_studio.ui.layout import tabs
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.widgets.labels import remark
from regolith_studio.ui.widgets.toast import Toast


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
        self.pause.setToolTip(tr("Pause after the current step, or resume"))
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
        self.left.setText(tr("Stopping …") if task.stopping else tr("paused") if task.paused else rest)
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


LIMIT = 2000
"""Maximum number of lines."""
MESSAGE_KINDS = {"note": N_("note"), "problem": N_("problem")}


class LogPanel(QWidget):
    """A line per message, with its details indented below."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("log")
        self.text = QPlainTextEdit()
        self.text.setReadOnly(True)
        self.text.setMaximumBlockCount(LIMIT)
        self.text.setAccessibleName(tr("Log"))
        self.copy = QPushButton(tr("Copy report"))
        self.copy.setObjectName("copy_log")
        self.copy.clicked.connect(lambda: QApplication.clipboard().setText(self.text.toPlainText()))
        row = QHBoxLayout()
        row.addStretch(1)
        row.addWidget(self.copy)
        layout = QVBoxLayout(self)
        layout.addWidget(self.text, 1)
        layout.addLayout(row)

    def add(self, kind: str, sentence: str, details: str = "") -> None:
        """Add a message of the kind ``note`` or ``problem``."""
        clock = time.strftime("%H:%M:%S")
        lines = [f"{clock}  {tr(MESSAGE_KINDS[kind]):8s} {sentence}"]
        lines += [f"          {line}" for line in details.splitlines()]
        self.text.appendPlainText("\n".join(lines))


class ActivityDock(QDockWidget):
    """Two tabs: tasks and log."""

    def __init__(self, window: QMainWindow) -> None:
        super().__init__(tr("Activity"), window)
        self.setObjectName("activity")
        self.tasks, self.log = TaskListPanel(), LogPanel()
        self.tabs = tabs("activity_tabs", [(self.tasks, tr("Tasks")), (self.log, tr("Log"))])
        self.setWidget(self.tabs)
        self.setAllowedAreas(Qt.DockWidgetArea.BottomDockWidgetArea)
        window.addDockWidget(Qt.DockWidgetArea.BottomDockWidgetArea, self)
        self.hide()

    def wire(self, session: Session, bindings: Bindings, toast: Toast) -> None:
        """Follow the session and what the toast says, from now on."""
        bindings.refresh("tasks", lambda: self.tasks.show_tasks(session.tasks), slow=True)
        bindings.listen("exported", self._note_export)
        self.tasks.cancelRequested.connect(session.cancel)
        self.tasks.pauseRequested.connect(session.pause)
        toast.shown.connect(self.log.add)

    def _note_export(self, folder: object) -> None:
        self.log.add("note", tr("A dataset was written to {folder}.", folder=folder))

    def show_tab(self, name: str) -> None:
        """Show ``tasks`` or ``log``; hide the dock if that is seen already."""
        panel = self.tasks if name == "tasks" else self.log
        seen = self.isVisible() and self.tabs.currentWidget() is panel
        self.setVisible(not seen)
        self.tabs.setCurrentWidget(panel)
