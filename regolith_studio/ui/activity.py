"""The running tasks in the status bar, and the dock with all tasks and messages."""

import time
from collections.abc import Sequence

from PySide6.QtCore import QEvent, Qt, QTimer, Signal
from PySide6.QtWidgets import (
    QApplication,
    QDockWidget,
    QFrame,
    QGridLayout,
    QLabel,
    QMainWindow,
    QPlainTextEdit,
    QProgressBar,
    QPushButton,
    QScrollArea,
    QToolButton,
    QWidget,
)

from regolith_studio.messages import N_
from regolith_studio.session.session import Session
from regolith_studio.session.tasks import Task
from regolith_studio.ui.bindings import Bindings
from regolith_studio.ui.layout import STRETCH, hbox, named, tabs, vbox
from regolith_studio.ui.result_card import TaskClock, progress_text
from regolith_studio.ui.theme import Theme, current_theme, icon
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.widgets.labels import ElidedLabel, hint_label
from regolith_studio.ui.widgets.toast import Toast

SHOW_DELAY = 250
"""Milliseconds after which a running task is shown."""
IDLE = N_("Ready")


class TasksPanel(QWidget):
    """Shows the oldest task that has not been told to stop, and the number of others."""

    cancelRequested = Signal(int)  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("tasks")
        self._tasks: tuple[Task, ...] = ()
        self._since: dict[int, float] = {}
        self.text = named(ElidedLabel(tr(IDLE)), "tasks_text")
        self.bar = named(QProgressBar(), spoken=tr("Progress"))
        self.bar.setFixedWidth(150)
        self.bar.setFixedHeight(12)
        self.bar.setTextVisible(False)
        self.stop = named(QToolButton(), "tasks_stop", tr("Stop"), tip=tr("Stop the running task"))
        self.stop.setAutoRaise(True)
        hbox(self.bar, self.stop, (self.text, 1), parent=self, margins=(6, 1, 6, 1))
        self._make_room()
        self._timer = QTimer(self, interval=SHOW_DELAY, singleShot=True)
        self._timer.timeout.connect(self._show)
        self.stop.clicked.connect(self._request)
        self.set_theme(current_theme())
        self._show()

    def value(self) -> tuple[Task, ...]:
        return self._tasks

    def setValue(self, tasks: Sequence[Task]) -> None:
        """Show other tasks, those that run longer than :data:`SHOW_DELAY`."""
        now = time.monotonic()
        self._tasks = tuple(tasks)
        self._since = {task.id: self._since.get(task.id, now) for task in self._tasks}
        self._show()

    def set_theme(self, theme: Theme) -> None:
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
        count = f" ({progress_text(first)})" if first.total else ""
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


class _Row:
    """The widgets of one task."""

    def __init__(self, number: int) -> None:
        self.clock = TaskClock()
        self.title, self.bar, self.left = QLabel(), QProgressBar(), hint_label()
        self.bar.setAccessibleName(tr("Progress"))
        self.bar.setFixedHeight(14)
        self.pause, self.stop = QPushButton(tr("Pause")), QPushButton(tr("Stop"))
        self.pause.setObjectName(f"pause_task_{number}")
        self.pause.setToolTip(tr("Pause after the current step, or resume"))
        self.pause.setCheckable(True)
        self.stop.setObjectName(f"stop_task_{number}")
        self.widgets = (self.title, self.bar, self.left, self.pause, self.stop)

    def show(self, task: Task) -> None:
        parts = filter(None, (task.title, task.message))
        self.title.setText(": ".join(map(translate, parts)))
        self.bar.setRange(0, task.total)
        self.bar.setValue(task.done)
        self.left.setText(self.clock.show(task))
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
        self.idle = hint_label(tr("Nothing is running."))
        self._grid = QGridLayout()
        self._grid.setColumnStretch(0, 2)
        self._grid.setColumnStretch(1, 1)
        inside = QWidget()
        vbox(self.idle, self._grid, STRETCH, parent=inside, margins=None)
        area = QScrollArea()
        area.setFrameShape(QFrame.Shape.NoFrame)
        area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        area.setWidgetResizable(True)
        area.setWidget(inside)
        for part in (area.viewport(), inside):
            part.setAutoFillBackground(False)
        vbox(area, parent=self)

    def show_tasks(self, tasks: Sequence[Task]) -> None:
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
        self.text = named(QPlainTextEdit(), spoken=tr("Log"))
        self.text.setReadOnly(True)
        self.text.setMaximumBlockCount(LIMIT)
        self.copy = named(QPushButton(tr("Copy report")), "copy_log")
        self.copy.clicked.connect(lambda: QApplication.clipboard().setText(self.text.toPlainText()))
        vbox((self.text, 1), hbox(STRETCH, self.copy), parent=self, margins=None)

    def add(self, kind: str, sentence: str, details: str = "") -> None:
        """Add a message of the kind ``note`` or ``problem``."""
        clock = time.strftime("%H:%M:%S")
        lines = [f"{clock}  {tr(MESSAGE_KINDS[kind]):8s} {sentence}"]
        lines += [f"          {line}" for line in details.splitlines()]
        self.text.appendPlainText("\n".join(lines))


LINES = 16
"""Height of the dock in lines of text when it is first seen, in a window that has thrice as many."""


class ActivityDock(QDockWidget):
    """Two tabs: tasks and log."""

    def __init__(self, window: QMainWindow) -> None:
        super().__init__(tr("Activity"), window)
        self.setObjectName("activity")
        self._window, self._sized = window, False
        self.tasks, self.log = TaskListPanel(), LogPanel()
        self.tabs = tabs("activity_tabs", [(self.tasks, tr("Tasks")), (self.log, tr("Log"))])
        self.setWidget(self.tabs)
        self.setAllowedAreas(Qt.DockWidgetArea.BottomDockWidgetArea)
        window.addDockWidget(Qt.DockWidgetArea.BottomDockWidgetArea, self)
        self.hide()

    def wire(self, session: Session, bindings: Bindings, toast: Toast) -> None:
        """Follow the session and what the toast says, from now on."""
        bindings.refresh("tasks", lambda: self.tasks.show_tasks(session.tasks), slow=True)
        self.tasks.cancelRequested.connect(session.cancel)
        self.tasks.pauseRequested.connect(session.pause)
        toast.shown.connect(self.log.add)

    def show_tab(self, name: str) -> None:
        """Show ``tasks`` or ``log``; hide the dock if that is seen already."""
        panel = self.tasks if name == "tasks" else self.log
        seen = self.isVisible() and self.tabs.currentWidget() is panel
        self.setVisible(not seen)
        self.tabs.setCurrentWidget(panel)
        if not self._sized:
            self._sized = True
            height = min(LINES * self.fontMetrics().lineSpacing(), self._window.height() // 3)
            self._window.resizeDocks([self], [height], Qt.Orientation.Vertical)
