"""Brings calls from worker threads into the thread of the window."""

from collections.abc import Callable

from PySide6.QtCore import QObject, Qt, Signal

Call = Callable[[], None]


class MainThreadInvoker(QObject):
    """``post`` may be called from any thread; the function runs soon, in order, where this object lives."""

    _posted = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._open = True
        self._posted.connect(self._run, Qt.ConnectionType.QueuedConnection)

    def post(self, call: Call) -> None:
        """Run `call` in the thread of the window; dropped when the window has closed."""
        if self._open:
            self._posted.emit(call)

    def close(self) -> None:
        """Run nothing any more."""
        self._open = False

    def _run(self, call: Call) -> None:
        if self._open:
            call()
