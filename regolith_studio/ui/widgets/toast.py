"""Messages at the lower edge of the window that disappear after some seconds."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from PySide6.QtCore import QEvent, QObject, Qt, QTimer, Signal
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFrame,
    QLabel,
    QPlainTextEdit,
    QPushButton,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.errors import RegolithError
from regolith_studio.readers.particles import FileProblem
from regolith_studio.session.session import Session
from regolith_studio.ui.bindings import Bindings
from regolith_studio.ui.layout import dialog_buttons, hbox, named
from regolith_studio.ui.translation import inert, tr, translate

NOTE_SECONDS = 6
PROBLEM_SECONDS = 20
_MARGIN = 14


class Toast(QFrame):
    """Shows one message at a time at the lower edge of its parent, in the middle, with details on demand.

    ``shown`` carries kind, sentence and details of every message.
    """

    shown = Signal(str, str, str)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("toast")
        self.setProperty("role", "toast")
        self.setAutoFillBackground(True)
        self._details = self._queue = ""
        self._ending: Callable[[], str] = str
        self.sentence = named(QLabel(), "toast_sentence")
        self.sentence.setWordWrap(True)
        self.sentence.setMinimumWidth(300)
        self.sentence.setTextFormat(Qt.TextFormat.PlainText)
        self.more = named(QPushButton(tr("Details …")), "toast_details")
        self.more.clicked.connect(self._show_details)
        dismiss = named(QToolButton(), spoken=tr("Close this message"))
        dismiss.setText("✕")
        dismiss.setAutoRaise(True)
        dismiss.clicked.connect(self.hide)
        hbox((self.sentence, 1), self.more, dismiss, parent=self, margins=(12, 8, 8, 8))
        self._timer = QTimer(self, singleShot=True)
        self._timer.timeout.connect(self.hide)
        parent.installEventFilter(self)
        self.hide()

    def note(self, sentence: str, details: str = "") -> None:
        self._show_message("note", sentence, details, NOTE_SECONDS)

    def notes(self, sentences: Sequence[str]) -> None:
        self.note("\n".join(map(translate, sentences)))

    def problem(self, sentence: str, details: str = "") -> None:
        self._show_message("problem", translate(sentence), details, PROBLEM_SECONDS)

    def follow(self, session: Session, bindings: Bindings) -> None:
        """Hide the message of a task from when the next task of its queue begins."""

        def hide_old() -> None:
            if self._queue in {task.queue for task in session.tasks}:
                self.hide()

        self._ending = lambda: session.ending_queue
        bindings.listen("tasks", hide_old)

    @contextmanager
    def reporting(self) -> Iterator[None]:
        """Report what is refused in a ``with`` statement, which ends there."""
        try:
            yield
        except RegolithError as error:
            self.problem(str(error))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize and self.isVisible():
            self._place()
        return super().eventFilter(watched, event)

    def hideEvent(self, event: QEvent) -> None:
        self._timer.stop()
        self._queue = ""
        super().hideEvent(event)  # type: ignore[arg-type]

    def _show_message(self, kind: str, sentence: str, details: str, seconds: int) -> None:
        self.setProperty("kind", kind)
        self.style().unpolish(self)
        self.style().polish(self)
        self._details, self._queue = details, self._ending()
        self.sentence.setText(sentence)
        self.more.setVisible(bool(details))
        self.setAccessibleName(sentence)
        self.show()
        self._place()
        self.raise_()
        self._timer.start(1000 * seconds)
        self.shown.emit(kind, sentence, details)

    def _place(self) -> None:
        parent = self.parentWidget()
        assert parent is not None, "a toast is made with its parent"
        width = min(560, parent.width() - 2 * _MARGIN)
        self.resize(width, self.heightForWidth(width) if self.hasHeightForWidth() else 40)
        left = (parent.width() - self.width()) // 2  # the buttons at the right stay free
        self.move(left, parent.height() - self.height() - 40)

    def _show_details(self) -> None:
        self._timer.stop()
        show_details(self.window(), self.sentence.text(), self._details)
        self.hide()


def show_details(parent: QWidget, sentence: str, details: str) -> None:
    """Show a dialog with the whole report, which can be copied."""
    dialog = QDialog(parent)
    dialog.setWindowTitle(tr("Message"))
    dialog.resize(680, 380)
    layout = QVBoxLayout(dialog)
    first = QLabel(inert(sentence))
    first.setWordWrap(True)
    text = named(QPlainTextEdit(details), spoken=tr("Details"))
    text.setReadOnly(True)
    buttons = dialog_buttons(dialog)
    copy = buttons.addButton(tr("Copy report"), QDialogButtonBox.ButtonRole.ActionRole)
    copy.clicked.connect(text.selectAll)
    copy.clicked.connect(text.copy)
    for widget in (first, text, buttons):
        layout.addWidget(widget)
    dialog.exec()
    dialog.deleteLater()


def report_file_problems(toast: Toast, problems: Sequence[FileProblem]) -> None:
    """One sentence on the screen: the only one, or the first and how many more there are; all on demand."""
    first = translate(problems[0].sentence)
    if len(problems) == 1:
        toast.problem(first, problems[0].with_path)
        return
    toast.problem(
        tr("{count} were left out. The first: {sentence}", count=len(problems), sentence=first),
        "\n".join(problem.with_path for problem in problems),
    )
