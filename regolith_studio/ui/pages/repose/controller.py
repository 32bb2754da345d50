"""What run, study and calibration of the page share: one job at a time, its card, and its form."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox, QFormLayout, QSpinBox, QVBoxLayout, QWidget

from regolith_studio.jobs.events import Failed, Job
from regolith_studio.ui.layout import equal_parts
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.numbers import DecimalField, NumbersLine
from regolith_studio.ui.widgets.result_view import ResultRecord, ResultState, ResultView

Field = QComboBox | NumbersLine | QSpinBox | DecimalField


class RunController:
    """Runs one job at a time in the background, with its state on a card.

    Parameters
    ----------
    card
        Its button starts what `start` does, and stops the job.
    queue
        Of the job.
    warning
        What closing the window would interrupt.
    stopped
        Note on the card of a job that was stopped.
    start
        Called by the button.
    changed
        Called with whether the job is running.
    """

    def __init__(
        self,
        context: PageContext,
        card: ResultView,
        queue: str,
        warning: str,
        stopped: str,
        start: Callable[[], object],
        changed: Callable[[bool], object],
    ) -> None:
        self._context, self._card, self._queue = context, card, queue
        self._warning, self._stop_note, self._changed = warning, stopped, changed
        self._task, self.running = 0, False
        card.startRequested.connect(start)
        card.stopRequested.connect(self.stop)

    def busy(self) -> str:
        """What closing the window would interrupt; empty for nothing."""
        return self._warning if self.running else ""

    def start(
        self,
        title: str,
        job: Job,
        show: Callable[[Any], ResultRecord | None],
        note: str = "",
        ended: Callable[[], object] | None = None,
    ) -> None:
        """Start a job.

        Parameters
        ----------
        show
            Shows a partial or the final result, and returns the record of its card.
        note
            On the card until there is a result.
        ended
            Called when the job has failed or was stopped.
        """
        self._ended = ended or (lambda: None)
        self._set_running(True)
        self._show(ResultRecord(state=ResultState.RUNNING, note=note))
        self._task = self._context.start(
            title,
            job,
            lambda result: self._finish(show, result),
            partial=lambda result: self._show(show(result), ResultState.RUNNING),
            failed=self._fail,
            stopped=self._stop,
            queue=self._queue,
        )

    def stop(self) -> None:
        """Stop the job."""
        self._context.session.cancel(self._task)

    def _finish(self, show: Callable[[Any], ResultRecord | None], result: Any) -> None:
        self._set_running(False)
        self._show(show(result), ResultState.CURRENT)

    def _fail(self, failure: Failed) -> None:
        self._set_running(False)
        self._ended()
        self._show(replace(self._card.record, state=ResultState.FAILED, note=failure.sentence))
        self._context.toast.problem(failure.sentence, failure.details)

    def _stop(self) -> None:
        self._set_running(False)
        self._ended()
        self._show(replace(self._card.record, state=ResultState.STOPPED, note=self._stop_note))

    def _set_running(self, running: bool) -> None:
        self.running = running
        self._changed(running)

    def _show(self, record: ResultRecord | None, state: ResultState | None = None) -> None:
        if record is not None:
            self._card.show_record(record if state is None else replace(record, state=state))


class RunPanel(QWidget):
    """The form of a series of runs below the card of its result, and views beside it.

    Parameters
    ----------
    name
        Object name.
    fields
        Label and field, by the name in project files.
    """

    def __init__(
        self,
        name: str,
        card: ResultView,
        fields: Mapping[str, tuple[str, Field]],
        views: Sequence[QWidget],
    ) -> None:
        super().__init__()
        self.setObjectName(name)
        self.card, self._fields = card, {key: field for key, (_, field) in fields.items()}
        form = QFormLayout()
        form.setContentsMargins(8, 6, 0, 0)
        form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        for label, field in fields.values():
            form.addRow(label, field)
        left = QWidget()
        left.setLayout(form)
        row = equal_parts(Qt.Orientation.Horizontal, (left, *views))
        row.setObjectName(f"{name}_parts")
        column = QVBoxLayout(self)
        column.setContentsMargins(4, 4, 4, 4)
        column.addWidget(card)
        column.addWidget(row, 1)

    def set_running(self, running: bool) -> None:
        """Set whether it is running: the form is not edited then."""
        for field in self._fields.values():
            field.setEnabled(not running)

    def state(self) -> dict[str, Any]:
        """The values as plain JSON."""
        return {name: _value(field) for name, field in self._fields.items()}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Show what :meth:`state` returned; unknown values are ignored."""
        for name, field in self._fields.items():
            if name in state:
                _restore(field, state[name])


def keys_box(entries: Mapping[str, tuple[str, str]], name: str, spoken: str) -> QComboBox:
    """A choice of keys by their labels."""
    box = QComboBox()
    box.setObjectName(name)
    box.setAccessibleName(spoken)
    for key, (label, _) in entries.items():
        box.addItem(tr(label), key)
    return box


def count_box(name: str, spoken: str, maximum: int) -> QSpinBox:
    """A number from 1 on."""
    box = QSpinBox()
    box.setObjectName(name)
    box.setAccessibleName(spoken)
    box.setRange(1, maximum)
    return box


def _value(field: Field) -> Any:
    return field.currentData() if isinstance(field, QComboBox) else field.value()


def _restore(field: Field, value: Any) -> None:
    if isinstance(field, QComboBox):
        if (place := field.findData(value)) >= 0:
            field.setCurrentIndex(place)
    elif isinstance(field, NumbersLine):
        field.setValue(str(value))
    elif isinstance(value, int | float):
        if isinstance(field, QSpinBox):
            field.setValue(int(value))
        else:
            field.setValue(float(value))
