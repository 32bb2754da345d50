"""Formulas in matplotlib's mathtext, drawn as vector outlines in the text colour of the theme."""

from contextlib import suppress
from functools import cache
from threading import Thread
from weakref import WeakKeyDictionary

import shiboken6
from matplotlib.path import Path as OutlinePath
from matplotlib.textpath import TextPath
from PySide6.QtCore import QCoreApplication, QObject, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QPainter, QPainterPath, QPaintEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from regolith_studio.studies.matplotlib_lock import MATPLOTLIB_LOCK

EM = 100.0
"""Font size of the outlines, which are scaled when drawn."""
MAGNIFICATION = 1.25
"""Size of the letters of a formula in units of the widget's font."""
LEADING = 0.62
"""Space between two lines in units of the letters."""
MIN_SCALE = 0.55
"""A formula is scaled down to the available height at most by this factor; to the width without limit."""
MIN_HEIGHT = 0.75
"""Minimum height of the widget as a share of its size hint."""
THREAD_NAME = "formulas"
"""Name of the thread that makes outlines."""
CACHE_SIZE = 512
"""Lines whose outlines are kept."""

_outlines: dict[str, QPainterPath] = {}


class FormulaLabel(QWidget):
    """Lines of mathtext from top to bottom, scaled with the font of the widget.

    An outline takes up to 40 ms to make: missing ones are made by a thread, one at a time, and nothing is
    drawn until all are there; :func:`prepare` makes them ahead.

    Parameters
    ----------
    words
        Accessible name.
    """

    def __init__(self, words: str) -> None:
        super().__init__()
        self._words = words
        self._lines: tuple[str, ...] = ()
        self._asked: tuple[str, ...] = ()
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Maximum)
        self.setAccessibleName(words)

    def lines(self) -> tuple[str, ...]:
        """The lines as mathtext, which may not be visible yet."""
        return self._asked

    def set_lines(self, *lines: str) -> None:
        """Show other lines as soon as their outlines are made."""
        if lines == self._asked:
            return
        self._asked = lines
        self.setToolTip(self._words)
        self.setAccessibleDescription("; ".join(lines).replace("$", ""))
        if all(line in _outlines for line in lines):
            self.take()
        else:
            self.update()
            _outline_maker().want(self)

    def missing(self) -> str | None:
        """A line without outline, if there is one."""
        return next((line for line in self._asked if line not in _outlines), None)

    def take(self) -> None:
        """Show the lines of :meth:`set_lines`."""
        self._lines = self._asked
        self.updateGeometry()
        self.update()

    def sizeHint(self) -> QSize:
        scale = self._scale()
        widest = max((outline(line).boundingRect().right() for line in self._lines), default=0.0)
        return QSize(round(widest * scale) + 2, round(self._height() * scale) + 2)

    def minimumSizeHint(self) -> QSize:
        return QSize(40, round(MIN_HEIGHT * self.sizeHint().height()))

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: ARG002
        if not self._lines or self._lines != self._asked:
            return
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(self.palette().windowText())
        natural = self._scale()
        widest = max(outline(line).boundingRect().right() for line in self._lines)
        wide = (self.width() - 2) / max(widest * natural, 1.0)
        high = (self.height() - 2) / max(self._height() * natural, 1.0)
        scale = natural * min(max(MIN_SCALE, min(1.0, high)), wide)
        painter.translate(1, (self.height() - self._height() * scale) / 2)
        painter.scale(scale, scale)
        for line in self._lines:
            path, box = outline(line), _line_box(line)
            painter.translate(0, -box.top())
            painter.drawPath(path)
            painter.translate(0, box.bottom() + LEADING * EM)
        painter.end()

    def _scale(self) -> float:
        """Pixels of the widget for one unit of an outline."""
        return MAGNIFICATION * self.fontMetrics().height() / 1.35 / EM

    def _height(self) -> float:
        """Of all lines, in units of the outlines."""
        boxes = [_line_box(line).height() for line in self._lines]
        return sum(boxes) + LEADING * EM * max(0, len(boxes) - 1)


class _OutlineMaker(QObject):
    """Makes the outlines of all labels, one line after the other, in a thread."""

    _ended = Signal(str)
    """A line is finished, or has failed."""

    def __init__(self, parent: QObject | None) -> None:
        super().__init__(parent)
        self._labels: WeakKeyDictionary[FormulaLabel, None] = WeakKeyDictionary()
        self._ahead: tuple[str, ...] = ()
        self._busy = False
        self._ended.connect(self._go_on, Qt.ConnectionType.QueuedConnection)

    def want(self, label: FormulaLabel) -> None:
        """Make the outlines that a label lacks."""
        self._labels[label] = None
        if not self._busy:
            self._begin()

    def prepare(self, lines: tuple[str, ...]) -> None:
        """Make the outlines of other lines once no label lacks any; replaces what was to be prepared."""
        self._ahead = lines
        if not self._busy:
            self._begin()

    @property
    def idle(self) -> bool:
        """Whether no outline is being made or waited for."""
        return not self._busy

    def _begin(self) -> None:
        for label in list(self._labels):
            if shiboken6.isValid(label) and (line := label.missing()) is not None:
                self._start(line)
                return
            del self._labels[label]
            if shiboken6.isValid(label):
                label.take()
        self._ahead = tuple(each for each in self._ahead if each not in _outlines)
        if self._ahead:
            self._start(self._ahead[0])

    def _start(self, line: str) -> None:
        self._busy = True
        Thread(target=self._set, args=(line,), daemon=True, name=THREAD_NAME).start()

    def _set(self, line: str) -> None:
        """Run in the thread; the signal has no receiver if the program has ended meanwhile."""
        try:
            outline(line)
        finally:
            with suppress(RuntimeError):
                self._ended.emit(line)

    def _go_on(self, line: str) -> None:
        self._busy = False
        if line not in _outlines:  # the thread has raised
            for label in [each for each in self._labels if line in each.lines()]:
                del self._labels[label]
            self._ahead = tuple(each for each in self._ahead if each != line)
        self._begin()


@cache
def _outline_maker() -> _OutlineMaker:
    return _OutlineMaker(QCoreApplication.instance())


def prepare(lines: tuple[str, ...]) -> bool:
    """Whether the outlines of these lines are made; if not, they are being made."""
    if all(line in _outlines for line in lines):
        return True
    _outline_maker().prepare(lines)
    return False


def all_outlines() -> bool:
    """Whether every formula shows its latest lines."""
    return _outline_maker().idle


def outline(line: str) -> QPainterPath:
    """Outlines of a line of mathtext, the base line at y = 0, y downwards.

    Raises
    ------
    ValueError
        If it is not valid mathtext.
    """
    if line not in _outlines:
        made = _outlined(line)
        if len(_outlines) >= CACHE_SIZE:
            _outlines.pop(next(iter(_outlines)), None)  # another thread may prepare formulas
        _outlines[line] = made
    return _outlines[line]


def _outlined(line: str) -> QPainterPath:
    made = QPainterPath()
    made.setFillRule(Qt.FillRule.WindingFill)
    if not line:
        return made
    with MATPLOTLIB_LOCK:
        letters = TextPath((0, 0), line, size=EM)
    for points, code in letters.iter_segments():
        x = [float(each) for each in points[0::2]]
        y = [-float(each) for each in points[1::2]]
        if code == OutlinePath.MOVETO:
            made.moveTo(x[0], y[0])
        elif code == OutlinePath.LINETO:
            made.lineTo(x[0], y[0])
        elif code == OutlinePath.CURVE3:
            made.quadTo(x[0], y[0], x[1], y[1])
        elif code == OutlinePath.CURVE4:
            made.cubicTo(x[0], y[0], x[1], y[1], x[2], y[2])
        elif code == OutlinePath.CLOSEPOLY:
            made.closeSubpath()
    return made


def _line_box(line: str) -> QRectF:
    """Bounding box of a line, at least as high as a letter with a descender."""
    least = QRectF(0.0, -0.75 * EM, 1.0, 0.95 * EM)
    return outline(line).boundingRect().united(least)
