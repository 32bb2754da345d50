"""The card of a result with its values, state and button, and the controller of the job behind it."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any

from PySide6.QtCore import QEvent, QSize, Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QBoxLayout, QFrame, QGridLayout, QHBoxLayout, QLabel, QPushButton, QWidget

from regolith_studio.jobs.events import Failed, Job
from regolith_studio.messages import N_
from regolith_studio.session.tasks import Task
from regolith_studio.ui.layout import named
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.translation import Markup, number_text, tr
from regolith_studio.ui.widgets.labels import FixedHeightText, hint_label, with_subscripts

MAGNIFICATION = 1.75
"""Size of the figures in units of the widget's font."""
LINES = 3
"""Visible lines of the sentence."""
WIDEST_FIGURE, SENTENCE_DIGITS = "0.0000", 40
"""What a figure has room for, and digits of room beside the figures without which the sentence goes below."""
MANY = 500
"""Steps of a task from which on its progress is shown in per cent."""
MIN_LINES = 34
"""Lines of text that a window must be high enough for if the sentence is to go below the figures."""


class ResultState(Enum):
    """Whether there is a result, and whether it belongs to the present choices."""

    NONE = ""
    RUNNING = N_("Running")
    CURRENT = "current"
    STALE = N_("Outdated")
    STOPPED = N_("Stopped")
    FAILED = N_("Failed")


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


def progress_text(task: Task) -> str:
    """How much is done: in steps, or in per cent where these are many."""
    if task.total >= MANY:
        return number_text(task.done / task.total, ".0%")
    return tr("{at} of {total}", at=task.done, total=task.total)


class TaskClock:
    """Measures the time that a task has been running, without its pauses."""

    def __init__(self, number: int = 0) -> None:
        self.number = number
        self._worked, self._since, self._running = 0.0, time.monotonic(), True

    def show(self, task: Task) -> str:
        """Time left, or that the task is paused or about to end."""
        self._worked, self._since = self._seconds(), time.monotonic()
        self._running = not task.paused
        if task.stopping:
            return tr("Stopping …")
        return tr("paused") if task.paused else time_left(task.done, task.total, self._worked)

    def _seconds(self) -> float:
        return self._worked + (time.monotonic() - self._since if self._running else 0.0)


@dataclass(frozen=True)
class ResultRecord:
    """A result as its card shows it.

    - ``values``: as text, one for each caption; empty where there is no value.
    - ``made_from``: sample and number of particles.
    - ``made_with``: method and its settings.
    - ``state``: values are dimmed unless it is ``CURRENT``.
    - ``note``: what the values mean, or why there are none.
    """

    values: tuple[str, ...] = ()
    made_from: str = ""
    made_with: str = ""
    state: ResultState = ResultState.NONE
    note: str = ""

    def sentences(self, progress: str = "") -> str:
        """State with its progress, origin and note as a text."""
        state = "" if self.state in (ResultState.NONE, ResultState.CURRENT) else tr(self.state.value)
        if self.state is ResultState.RUNNING:
            state = ", ".join(filter(None, (state, progress)))
        origin = ", ".join(each for each in (self.made_from, self.made_with) if each)
        return "\n".join(each for each in (": ".join(filter(None, (state, origin))), self.note) if each)


def as_earlier(record: ResultRecord) -> ResultRecord:
    """The record of a result that a later job has not replaced, marked so."""
    mark, origin = tr("earlier result"), record.made_from
    return record if origin.startswith(mark) else replace(record, made_from=f"{mark}, {origin}")


def failed_record(before: ResultRecord, sentence: str) -> ResultRecord:
    """What a job that has failed leaves of the record that was shown before it, with the reason."""
    kept = as_earlier(before) if before.values else before
    return replace(kept, state=ResultState.FAILED, note=sentence)


class ResultView(QFrame):
    """Large figures with captions, and sentences beside them, or below where there is little room.

    Its height does not change with what it shows.

    - ``name``: object name.
    - ``captions``: one below each figure.
    - ``start``, ``again``, ``done``: text of the button without a result, with one, and with one of the
      present choices (by default as `again`); without `start` there is no button.
    - ``lead``: size of the first figure in units of the widget's font.
    - ``lines``: visible lines of the sentences.
    """

    startRequested = Signal()  # noqa: N815
    stopRequested = Signal()  # noqa: N815

    def __init__(
        self,
        name: str,
        captions: Sequence[str],
        start: str = "",
        again: str = "",
        done: str = "",
        lead: float = MAGNIFICATION,
        lines: int = LINES,
    ) -> None:
        super().__init__()
        self.setObjectName(name)
        self.setProperty("role", "card")
        self._start, self._again, self._done, self._lead = start, again, done, lead
        self._record = ResultRecord()
        self._clock, self._progress, self._stopping = TaskClock(), "", False
        self._problem = ""
        self.figures = tuple(QLabel("–") for _ in captions)
        self.captions = tuple(hint_label(caption) for caption in captions)
        self.sentence = hint_label()
        self.sentence.setObjectName(f"{name}_sentence")
        self.button = named(QPushButton(start, self), f"{name}_button")
        self.button.clicked.connect(self._act)
        self._ends: list[QWidget] = []
        self._widest: dict[int, str] = {}
        self._place(lines)
        self._enlarge()
        self.button.setVisible(bool(start))
        if start:
            self.add(self.button)

    def _place(self, lines: int) -> None:
        grid = self._grid = QGridLayout()
        grid.setHorizontalSpacing(16)
        grid.setVerticalSpacing(0)
        bottom = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignBottom
        for column, (figure, caption) in enumerate(zip(self.figures, self.captions, strict=True)):
            caption.setWordWrap(False)
            figure.setAccessibleName(caption.text())
            grid.addWidget(figure, 0, column, bottom)
            grid.addWidget(caption, 1, column)
        self._parts = QBoxLayout(QBoxLayout.Direction.LeftToRight)
        self._parts.addLayout(grid)
        self._words = FixedHeightText((self.sentence,), lines)
        self._parts.addWidget(self._words, 1)
        row = self._row = QHBoxLayout(self)
        row.setContentsMargins(12, 5, 10, 5)
        row.addLayout(self._parts, 1)
        self._parts.setSpacing(16)
        row.setSpacing(16)

    @property
    def record(self) -> ResultRecord:
        return self._record

    def show_record(self, record: ResultRecord) -> None:
        """Show another result, or another state of it."""
        self._record = record
        values = record.values or ("–",) * len(self.figures)
        for label, text in zip(self.figures, values, strict=True):
            label.setText(text)
            label.setEnabled(record.state is ResultState.CURRENT)
        self._describe()

    def show_task(self, task: Task | None) -> None:
        """Show how far a task is and the time that is left, or that none is running."""
        self._progress, self._stopping = "", task is not None and task.stopping
        if task is not None:
            if self._clock.number != task.id:
                self._clock = TaskClock(task.id)
            steps = progress_text(task) if task.total > 1 else ""
            self._progress = ", ".join(filter(None, (steps, self._clock.show(task))))
        self._describe()

    def _describe(self) -> None:
        words = with_subscripts(self._record.sentences(self._progress))
        self.sentence.setText(Markup(words.replace("\n", "<br>")) if isinstance(words, Markup) else words)
        self._name_button()

    def set_start(self, text: str) -> None:
        """Set the text of the button without a result, and with one if there is none for that."""
        self._start = text
        self._name_button()

    def _name_button(self) -> None:
        state = self._record.state
        again = self._again or self._start
        texts = self._start, again, self._done or again
        without = state in (ResultState.NONE, ResultState.FAILED)
        start = self._start if without else texts[2] if state is ResultState.CURRENT else again
        running = state is ResultState.RUNNING
        stops = tr("Stop"), tr("Stopping …")
        widest = self.button.minimumWidth()  # of all its texts, so that it is in its place for the next click
        for text in (*texts, *stops, stops[self._stopping] if running else start):
            self.button.setText(text)
            widest = max(widest, self.button.sizeHint().width())
        self.button.setMinimumWidth(widest)
        self.button.setEnabled(not self._stopping if running else not self._problem)
        self.button.setToolTip("" if running else self._problem)

    def set_startable(self, problem: str = "") -> None:
        """Let the button start something, unless there is a problem, which is its tool tip then."""
        self._problem = problem
        self._name_button()

    def add(self, part: QWidget) -> None:
        self._ends.append(part)
        self._row.addWidget(part)

    def caption(self, place: int, text: str, tip: str = "") -> None:
        """Set the caption of a figure, and what it means."""
        self.captions[place].setText(text)
        for part in (self.captions[place], self.figures[place]):
            part.setToolTip(tip)

    def reserve(self, place: int, text: str) -> None:
        """Keep room for a figure of so much text, whose first value would widen the column of the card."""
        self._widest[place] = text
        self._enlarge()

    def _act(self) -> None:
        running = self._record.state is ResultState.RUNNING
        (self.stopRequested if running else self.startRequested).emit()

    def minimumSizeHint(self) -> QSize:
        """As narrow as the figures, or the sentence where it is below them."""
        inside = max(self._grid.minimumSize().width(), self._words.minimumSizeHint().width())
        return QSize(self._outer_width() + inside, super().minimumSizeHint().height())

    def _outer_width(self) -> int:
        """Width of the margins, and of the buttons at the end with the space before them."""
        margins = self._row.contentsMargins()
        widths = (max(each.minimumWidth(), each.minimumSizeHint().width()) for each in self._ends)
        ends = sum(width + self._row.spacing() for width in widths)
        return margins.left() + margins.right() + ends

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.place_sentence(self.width())

    def place_sentence(self, width: int) -> None:
        """Put the sentence beside the figures, or below where a card of this width has no room for it.

        Where three quarters of the usual width are not left beside its buttons, these come below.
        """
        figures = sum(each.fontMetrics().horizontalAdvance(WIDEST_FIGURE) + 16 for each in self.figures)
        words = self.fontMetrics().horizontalAdvance("0" * SENTENCE_DIGITS)
        high = self.window().height() >= MIN_LINES * self.fontMetrics().height()
        cramped = width < self._outer_width() + self._grid.minimumSize().width() + words // 2
        below = cramped or (high and width < figures + words)
        column = bool(self._ends) and width - self._outer_width() < 3 * words // 4
        for layout, stacked in ((self._parts, below), (self._row, column)):
            direction = QBoxLayout.Direction.TopToBottom if stacked else QBoxLayout.Direction.LeftToRight
            if direction != layout.direction():
                layout.setDirection(direction)
                layout.setSpacing(4 if stacked else 16)
                self._row.invalidate()
                self.updateGeometry()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self._enlarge()
            self.button.setMinimumWidth(0)
            self._name_button()

    def _enlarge(self) -> None:
        for place, figure in enumerate(self.figures):
            font = self.font()
            font.setPointSizeF((MAGNIFICATION if place else self._lead) * font.pointSizeF())
            font.setBold(True)
            figure.setFont(font)
            widest = self._widest.get(place, "")
            figure.setMinimumWidth(figure.fontMetrics().horizontalAdvance(widest))


class RunController:
    """Runs one job at a time in the background, with its state on a card, which several may share.

    Parameters
    ----------
    card
        Its button starts what `start` does, and stops the job.
    queue
        Of the job.
    start
        Called by the button; ``None`` where another controller of the card does what it starts.
    stopped
        Note on the card of a job that was stopped.
    warning
        What closing the window would interrupt, which the list of tasks does not say.
    changed
        Called with whether the job is running.
    """

    def __init__(
        self,
        context: PageContext,
        card: ResultView,
        queue: str,
        start: Callable[[], object] | None,
        stopped: str = "",
        warning: str = "",
        changed: Callable[[bool], object] = lambda _running: None,
    ) -> None:
        self._context, self._card, self._queue = context, card, queue
        self._warning, self._stop_note, self._changed = warning, stopped, changed
        self._task, self.running = 0, False
        self._ended: ResultState | None = None
        self._earlier = ResultRecord()
        if start is not None:
            card.startRequested.connect(start)
        card.stopRequested.connect(self.stop)
        context.bindings.refresh("tasks", self._follow, slow=True)

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
        earlier: ResultRecord | None = None,
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
        earlier
            Shown again, as an earlier result, if the job ends without one; by default what the card shows.
        """
        self._earlier = earlier or self._card.record
        self._on_end, self._ended = ended or (lambda: None), None
        self._set_running(True)
        self._card.show_task(None)
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
        if self.running:
            self._context.session.cancel(self._task)
            self._follow()

    def forget(self) -> None:
        """Stop the job silently, and clear the card: its input is there no more."""
        self._context.stop(self._queue)
        self._task, self._ended = 0, None
        self._set_running(False)
        self._show(ResultRecord())

    def set_outdated(self, outdated: bool) -> None:
        """Mark the result as one of other choices than the present, or as the present one again."""
        if self._card.record.values and self._ended is not None:
            self._show(self._card.record, ResultState.STALE if outdated else self._ended)

    def _follow(self) -> None:
        """Show how far the job is."""
        for task in self._context.session.tasks:
            if task.id == self._task:
                self._card.show_task(task)

    def _finish(self, show: Callable[[Any], ResultRecord | None], result: Any) -> None:
        self._set_running(False)
        self._ended = ResultState.CURRENT
        self._show(show(result), self._ended)

    def _fail(self, failure: Failed) -> None:
        self._set_running(False)
        self._on_end()
        self._ended = ResultState.FAILED
        self._show(replace(self._record_left(), state=self._ended, note=failure.sentence))
        self._context.toast.problem(failure.sentence, failure.details)

    def _stop(self) -> None:
        self._set_running(False)
        self._on_end()
        self._ended = ResultState.STOPPED
        note = self._stop_note or self._card.record.note
        self._show(replace(self._record_left(), state=self._ended, note=note))

    def _record_left(self) -> ResultRecord:
        """What a job that has failed or was stopped leaves: its partial result, else the earlier one."""
        partial, earlier = self._card.record, self._earlier
        return partial if partial.values or not earlier.values else as_earlier(earlier)

    def _set_running(self, running: bool) -> None:
        self.running = running
        self._changed(running)

    def _show(self, record: ResultRecord | None, state: ResultState | None = None) -> None:
        if record is not None:
            self._card.show_record(record if state is None else replace(record, state=state))
