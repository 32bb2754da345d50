"""Base of the dialogs that ask for settings of long work, and then show its progress."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from PySide6.QtCore import QUrl, Signal
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QFormLayout, QProgressBar, QVBoxLayout, QWidget

from regolith_studio.errors import InputError
from regolith_studio.session.tasks import Task
from regolith_studio.ui.dialogs.batch_fields import PathField
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import remark


class RunDialog(QDialog):
    """Asks, then shows the progress; closing it stops nothing.

    Emits ``started`` with the request, and ``stopped``. A dialog calls :meth:`judge` whenever its value may
    have changed.

    Parameters
    ----------
    name
        Begins the names of its widgets.
    folder
        Suggested for the results.
    page
        Of the results, which the last button opens.
    """

    started = Signal(object)
    stopped = Signal()

    def __init__(self, name: str, title: str, folder: Path, page: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(title)
        self.setObjectName(f"{name}_dialog")
        self.setMinimumWidth(600)
        self._page, self._running = page, False
        self._fields: tuple[QWidget, ...] = ()
        self.folder = PathField(f"{name}_folder", tr("Folder of the results"), folder=True)
        self.folder.setValue(folder)
        self.folder.changed.connect(self.judge)
        self.state = remark()
        self.state.setObjectName(f"{name}_state")
        self.bar = QProgressBar()
        self.bar.setAccessibleName(tr("Progress"))
        self.box = QDialogButtonBox(QDialogButtonBox.StandardButton.Close, parent=self)
        role = QDialogButtonBox.ButtonRole.ActionRole
        self.go = self.box.addButton(tr("Run"), role)
        self.halt = self.box.addButton(tr("Stop"), role)
        self.results_button = self.box.addButton(tr("Open the results"), role)
        for part, button in (("go", self.go), ("stop", self.halt), ("results", self.results_button)):
            button.setObjectName(f"{name}_{part}")
        self.go.setDefault(True)
        self.go.clicked.connect(self._start)
        self.halt.clicked.connect(self.stopped.emit)
        self.results_button.clicked.connect(self._open_results)
        self.box.rejected.connect(self.close)

    def value(self) -> Any:
        """The request.

        Raises
        ------
        InputError
            If it cannot be given yet, saying why.
        """
        raise NotImplementedError

    def field_values(self) -> dict[str, Any]:
        """What the next dialog may suggest, as plain JSON."""
        raise NotImplementedError

    def restore_fields(self, values: Mapping[str, Any]) -> None:
        """Suggest what was given before; what is not understood is left out."""
        raise NotImplementedError

    def show_task(self, task: Task) -> None:
        """Show how far the work is."""
        self.bar.setRange(0, task.total)
        self.bar.setValue(task.done)
        count = tr("{at:,} of {total:,}", at=task.done, total=task.total) if task.total else ""
        self.state.setText(", ".join(filter(None, [f"{tr(task.title)} {count}".strip(), task.message])))

    def show_partial(self, value: object) -> None:
        """Show a partial result of the work."""

    def finish(self, sentence: str, done: bool = False) -> None:
        """The work has ended, in whichever way; the fields can be edited again."""
        self._set_running(False)
        self.judge()
        self.state.setText(sentence)
        self.results_button.setVisible(done)

    def arrange(self, form: QFormLayout, *below: QWidget, fields: tuple[QWidget, ...]) -> None:
        """Place the form, what stands below it, and the progress; `fields` are disabled while it runs."""
        self._fields = fields
        form.setVerticalSpacing(7)
        layout = QVBoxLayout(self)
        layout.addLayout(form)
        for widget in below:
            layout.addWidget(widget)
        layout.addStretch(1)
        for widget in (self.state, self.bar, self.box):
            layout.addWidget(widget)
        for hidden in (self.bar, self.halt, self.results_button):
            hidden.hide()

    def judge(self) -> None:
        """Say what is missing, and allow to run where nothing is."""
        if self._running:
            return
        self.results_button.hide()
        try:
            self.value()
        except InputError as error:
            sentence = str(error)
        else:
            sentence = ""
        self.state.setText(sentence)
        self.go.setEnabled(not sentence)

    def _set_running(self, running: bool) -> None:
        self._running = running
        for widget in (self.folder, *self._fields, self.go):
            widget.setEnabled(not running)
        self.halt.setVisible(running)
        self.bar.setVisible(running)

    def _start(self) -> None:
        request = self.value()
        self._set_running(True)
        self.results_button.hide()
        self.bar.setRange(0, 0)
        self.state.setText(tr("Starting …"))
        self.started.emit(request)

    def _open_results(self) -> None:
        folder = self.folder.value()
        if folder is not None:
            page = folder / self._page
            QDesktopServices.openUrl(QUrl.fromLocalFile(str(page if page.is_file() else folder)))
