"""Builds pages step by step, so that the window answers between two steps."""

import time
from collections.abc import Callable, Generator

from PySide6.QtCore import QObject, QTimer
from PySide6.QtWidgets import QWidget

from regolith_studio.ui.page import PageWidget

Steps = Generator[None, None, PageWidget]

SLICE = 0.006
"""Seconds after which no further step is taken before others have had their turn; one always is."""
POLISHED_AT_ONCE = 25
"""Widgets that take their style between two steps."""


class PageBuilder(QObject):
    """Takes the steps of pages that are wanted, between the events of the window or all at once.

    Parameters
    ----------
    steps
        Begins to build the page of a key.
    built
        Told key and widget when one is complete.
    """

    def __init__(
        self,
        steps: Callable[[str], Steps],
        built: Callable[[str, PageWidget], None],
        parent: QObject,
    ) -> None:
        super().__init__(parent)
        self._steps, self._built = steps, built
        self._begun: dict[str, Steps] = {}
        self._timer = QTimer(self, interval=0)
        self._timer.timeout.connect(self._go_on)

    def want(self, key: str) -> None:
        """Build a page before all others that are under way, as soon as there is nothing else to do."""
        begun = self._begun.pop(key, None) or self._steps(key)
        self._begun = {key: begun, **self._begun}
        self._timer.start()

    def finish(self, key: str) -> PageWidget:
        """Build a page now, or what is left of it."""
        steps = self._begun.pop(key, None) or self._steps(key)
        while True:
            try:
                next(steps)
            except StopIteration as end:
                return self._complete(key, end.value)

    def finish_all(self) -> None:
        """Leave no page half built: what has graphics memory must be able to give it back."""
        self._timer.stop()
        for key in list(self._begun):
            self.finish(key)

    def _go_on(self) -> None:
        end = time.perf_counter() + SLICE
        if self._begun:  # a page that was needed at once may have been the last
            self._step()
        while self._begun and time.perf_counter() < end:
            self._step()
        if not self._begun:
            self._timer.stop()

    def _step(self) -> None:
        key, steps = next(iter(self._begun.items()))
        try:
            next(steps)
        except StopIteration as end:
            del self._begun[key]
            self._complete(key, end.value)
        except Exception:
            del self._begun[key]
            raise

    def _complete(self, key: str, widget: PageWidget) -> PageWidget:
        self._built(key, widget)
        return widget


def polish(widget: QWidget) -> Generator[None, None, None]:
    """Give a widget that is not seen yet, and all in it, their style; some at each step."""
    for number, part in enumerate([widget, *widget.findChildren(QWidget)]):
        part.ensurePolished()
        if number % POLISHED_AT_ONCE == POLISHED_AT_ONCE - 1:
            yield
