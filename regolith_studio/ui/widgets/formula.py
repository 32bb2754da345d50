"""Formulas in matplotlib's mathtext, drawn as vector outlines in the text colour of the theme."""

from collections.abc import Iterable, Sequence
from contextlib import suppress
from functools import cache
from threading import Thread
from weakref import WeakKeyDictionary

import shiboken6
from matplotlib.path import Path as OutlinePath
from matplotlib.textpath import TextPath
from PySide6.QtCore import QCoreApplication, QObject, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QPainter, QPainterPath, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from regolith_studio.studies.figures import MATPLOTLIB_LOCK

EM = 100.0
"""Font size of the outlines, which are scaled when drawn."""
MAGNIFICATION = 1.25
"""Size of the letters of a formula in units of the widget's font."""
LEADING = 0.4
"""Space between two lines in units of the letters."""
GAP, INDENT = 0.12, 1.0
"""Space between two pieces of a line, and before what is continued on the next, in units of the letters."""
MIN_LINE_HEIGHT = 20.0
"""Pixels of the lowest line."""
BREAK = "\u200b"
"""Stands in a line where it may be continued on the next one; the pieces are valid mathtext by themselves."""
THREAD_NAME = "formulas"
"""Name of the thread that makes outlines."""
HIGH_WINDOW = 48, 1.4
"""Height of a window in lines of text from which on formulas are larger, and by how much: as on a wall."""
CACHE_SIZE = 2048
"""Pieces whose outlines are kept."""

LOWEST_LINE = QRectF(0.0, -0.75 * EM, 1.0, 0.95 * EM)
"""Of a row, in units of the outlines: a letter with a descender."""

_outlines: dict[str, QPainterPath] = {}


class FormulaLabel(QWidget):
    """Lines of mathtext from top to bottom, scaled with the font of the widget, broken at its width.

    An outline takes up to 40 ms to make: missing ones are made by a thread, one at a time, and nothing is
    drawn until all are there; :func:`prepare` makes them ahead.

    ``words``: accessible name.
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
        self.setAccessibleDescription("; ".join(lines).replace("$", "").replace(BREAK, ""))
        if all(piece in _outlines for piece in pieces(lines)):
            self.take()
        else:
            self.update()
            _outline_maker().want(self)

    def missing(self) -> str | None:
        """A piece of a line without outline, if there is one."""
        return next((piece for piece in pieces(self._asked) if piece not in _outlines), None)

    def take(self) -> None:
        """Show the lines of :meth:`set_lines`."""
        self._lines = self._asked
        self.updateGeometry()
        self.update()

    def rows(self) -> list[list[tuple[float, str]]]:
        """The pieces of each row and where they begin, in units of the outlines, broken at the width."""
        room = (self.width() - 2) / self._scale()
        return [row for line in self._lines for row in _broken(line.split(BREAK), room)]

    def sizeHint(self) -> QSize:
        scale, rows = self._scale(), self.rows()
        widest = max(map(_row_width, rows), default=0.0)
        return QSize(round(widest * scale) + 2, round(_height(rows) * scale) + 2)

    def minimumSizeHint(self) -> QSize:
        return QSize(40, self.sizeHint().height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if event.size().width() != event.oldSize().width():
            self.updateGeometry()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: ARG002
        if not self._lines or self._lines != self._asked:
            return
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(self.palette().windowText())
        rows = self.rows()
        scale = min(self._scale(), (self.width() - 2) / max(1.0, *map(_row_width, rows)))
        painter.translate(1, (self.height() - _height(rows) * scale) / 2)
        painter.scale(scale, scale)
        for row in rows:
            box = _row_box(row)
            painter.translate(0, -box.top())
            for begin, piece in row:
                painter.drawPath(outline(piece).translated(begin, 0))
            painter.translate(0, box.bottom() + LEADING * EM)
        painter.end()

    def _scale(self) -> float:
        """Pixels of the widget for one unit of an outline."""
        least, height = MIN_LINE_HEIGHT / LOWEST_LINE.height(), self.fontMetrics().height()
        large = HIGH_WINDOW[1] if self.window().height() >= HIGH_WINDOW[0] * height else 1.0
        return max(large * MAGNIFICATION * height / 1.35 / EM, least)


def pieces(lines: Iterable[str]) -> tuple[str, ...]:
    """What the lines consist of between the places where they may be broken."""
    return tuple(piece for line in lines for piece in line.split(BREAK))


def _broken(parts: Sequence[str], room: float) -> list[list[tuple[float, str]]]:
    """Rows of pieces with the place where each begins, none wider than `room` unless it is a single piece."""
    rows: list[list[tuple[float, str]]] = [[]]
    end = 0.0
    for piece in parts:
        begin = end + GAP * EM if rows[-1] else 0.0
        if rows[-1] and begin + outline(piece).boundingRect().right() > room:
            rows.append([])
            begin = INDENT * EM
        rows[-1].append((begin, piece))
        end = begin + outline(piece).boundingRect().right()
    return rows


def _row_width(row: Sequence[tuple[float, str]]) -> float:
    begin, last = row[-1]
    return begin + outline(last).boundingRect().right()


def _row_box(row: Sequence[tuple[float, str]]) -> QRectF:
    """Bounding box of a row, at least as high as a letter with a descender."""
    box = LOWEST_LINE
    for _, piece in row:
        box = box.united(outline(piece).boundingRect())
    return box


def _height(rows: Sequence[Sequence[tuple[float, str]]]) -> float:
    """Of all rows, in units of the outlines."""
    return sum(_row_box(row).height() for row in rows) + LEADING * EM * max(0, len(rows) - 1)


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
            for label in [each for each in self._labels if line in pieces(each.lines())]:
                del self._labels[label]
            self._ahead = tuple(each for each in self._ahead if each != line)
        self._begin()


@cache
def _outline_maker() -> _OutlineMaker:
    return _OutlineMaker(QCoreApplication.instance())


def prepare(lines: tuple[str, ...]) -> bool:
    """Whether the outlines of these lines are made; if not, they are being made."""
    wanted = pieces(lines)
    if all(piece in _outlines for piece in wanted):
        return True
    _outline_maker().prepare(wanted)
    return False


def all_outlines() -> bool:
    return _outline_maker().idle


def outline(line: str) -> QPainterPath:
    """Outlines of a line of mathtext, the base line at y = 0, y downwards."""
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
