"""A frame around the plot of a study, with start and stop buttons and progress."""

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QProgressBar, QPushButton, QVBoxLayout, QWidget

from regolith_studio.messages import N_
from regolith_studio.session.tasks import Task
from regolith_studio.ui.translation import tr, tr_count
from regolith_studio.ui.widgets.labels import ElidedLabel


class StudyFrame(QWidget):
    """Places a plot below its controls.

    ``name``: prefix of the buttons' object names. ``plot``: the plot.
    """

    startRequested = Signal()  # noqa: N815
    cancelRequested = Signal(int)  # noqa: N815

    def __init__(self, name: str, plot: QWidget) -> None:
        super().__init__()
        self._task = 0
        self.start = QPushButton(tr("Compute"))
        self.start.setObjectName(f"{name}_start")
        self.stop = QPushButton(tr("Stop"))
        self.stop.setObjectName(f"{name}_stop")
        self.bar = QProgressBar()
        self.bar.setAccessibleName(tr("Progress of the study"))
        self.bar.setFixedHeight(12)
        self.bar.setTextVisible(False)
        self.hint_label = ElidedLabel(role="hint")
        row = QHBoxLayout()
        row.setContentsMargins(8, 6, 8, 0)
        row.setSpacing(10)
        row.addWidget(self.start)
        row.addWidget(self.stop)
        row.addWidget(self.bar, 1)
        row.addWidget(self.hint_label, 1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        layout.addLayout(row)
        layout.addWidget(plot, 1)
        self.start.clicked.connect(self.startRequested)
        self.stop.clicked.connect(lambda: self.cancelRequested.emit(self._task))
        self.show_task(None)

    def set_count(self, count: int) -> None:
        """Set the number of particles of the study."""
        self.start.setText(
            tr_count(N_("Compute for this particle"), N_("Compute for all {count} particles"), count)
        )
        self.start.setEnabled(count > 0)

    def show_task(self, task: Task | None) -> None:
        """Show the progress of the study, or that it is not running."""
        running = task is not None
        seen, hidden = (self.stop, self.start) if running else (self.start, self.stop)
        focused = hidden.hasFocus()
        seen.show()
        if focused:  # otherwise the focus goes to the next widget
            seen.setFocus()
        hidden.hide()
        self.hint_label.setVisible(not running)
        self.bar.setVisible(running)
        self.stop.setText(tr("Stopping …") if task is not None and task.stopping else tr("Stop"))
        if task is not None:
            self._task = task.id
            self.bar.setRange(0, task.total)
            self.bar.setValue(task.done)

    def set_hint(self, text: str) -> None:
        """Set the text beside the button."""
        self.hint_label.setText(text)
