"""Ways of placing parts beside each other."""

from collections.abc import Sequence

from PySide6.QtCore import QEvent, QObject, QSize, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QBoxLayout,
    QComboBox,
    QHBoxLayout,
    QLabel,
    QScrollArea,
    QSizePolicy,
    QSplitter,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.ui.translation import tr

CONTROLS_WIDTH = 290
FOLDED = 32
"""Pixels of height that are kept for buttons which find no room beside a box."""


def side_by_side(parts: Sequence[QWidget], sizes: Sequence[int], stretch: int) -> QSplitter:
    """Parts in a row with movable borders; the one numbered `stretch` takes what room is left."""
    return _splitter(Qt.Orientation.Horizontal, parts, sizes, stretch)


def stacked(parts: Sequence[QWidget], sizes: Sequence[int], stretch: int) -> QSplitter:
    """Parts in a column with movable borders."""
    return _splitter(Qt.Orientation.Vertical, parts, sizes, stretch)


def equal_parts(direction: Qt.Orientation, parts: Sequence[QWidget]) -> QSplitter:
    """Parts of the same size with movable borders, which all take their share of what room is left."""
    made = _splitter(direction, parts, [1000] * len(parts), 0)
    for number in range(len(parts)):
        made.setStretchFactor(number, 1)
    return made


def tabs(name: str, pages: Sequence[tuple[QWidget, str]]) -> QTabWidget:
    """Pages of which one is seen."""
    made = QTabWidget()
    made.setObjectName(name)
    made.setMinimumHeight(120)
    made.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Ignored)
    for page, title in pages:
        made.addTab(page, title)
    return made


def scrolled_column(panels: Sequence[QWidget]) -> QScrollArea:
    """Panels below each other, with a scroll bar where they do not fit."""
    inside = QWidget()
    column = QVBoxLayout(inside)
    column.setSpacing(20)
    column.setContentsMargins(4, 10, 12, 10)
    for panel in panels:
        column.addWidget(panel)
    column.addStretch(1)
    area = _Column()
    area.setObjectName("controls")
    area.setWidgetResizable(True)
    area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    area.setWidget(inside)
    area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    return area


class _Column(QScrollArea):
    """As wide as what is in it needs, in any language and size of letters.

    What height is left when it gets its size is for texts that have use for it; later, nothing moves.
    """

    _shared = 0
    """Height that has been shared among the texts."""

    def minimumSizeHint(self) -> QSize:
        inside = self.widget()
        needed = inside.minimumSizeHint().width() if inside is not None else 0
        bar = self.verticalScrollBar().sizeHint().width()
        return QSize(max(CONTROLS_WIDTH - 30, needed + bar), super().minimumSizeHint().height())

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.LayoutRequest:
            self.updateGeometry()
        return super().eventFilter(watched, event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._share_height()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._shared = 0
            self._share_height()

    def _share_height(self) -> None:
        inside = self.widget()
        if self.height() == self._shared or inside is None:
            return
        self._shared = self.height()
        texts = inside.findChildren(SteadyTexts)
        for each in texts:
            each.take_spare(0)
        left = self.height() - inside.sizeHint().height() - FOLDED
        for each in texts:
            left -= each.line * each.take_spare(left // each.line)


class TwoParts(QWidget):
    """Controls in a row, of which the last ones stand below the first ones where there is no room.

    Parameters
    ----------
    first, last
        Boxes among the first ones take what room there is.
    margins
        Left, top, right, bottom.
    """

    def __init__(
        self, first: Sequence[QWidget], last: Sequence[QWidget], margins: tuple[int, int, int, int]
    ) -> None:
        super().__init__()
        self._box = QBoxLayout(QBoxLayout.Direction.LeftToRight, self)
        self._box.setContentsMargins(*margins)
        self._parts = [QHBoxLayout(), QHBoxLayout()]
        for part, row in zip((first, last), self._parts, strict=True):
            for each in part:
                row.addWidget(each, int(isinstance(each, QComboBox)))
        self._box.addLayout(self._parts[0], 1)
        self._box.addLayout(self._parts[1])

    def minimumSizeHint(self) -> QSize:
        least, margins = [part.minimumSize().width() for part in self._parts], self._box.contentsMargins()
        return QSize(max(least) + margins.left() + margins.right(), super().minimumSizeHint().height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        margins = self._box.contentsMargins()
        needed = sum(part.sizeHint().width() for part in self._parts) + self._box.spacing()
        narrow = self.width() < needed + margins.left() + margins.right()
        way = QBoxLayout.Direction
        self._box.setDirection(way.TopToBottom if narrow else way.LeftToRight)


class SteadyTexts(QScrollArea):
    """Texts in the room of so many lines, whatever they say: no control moves when they change.

    More lines than that are scrolled to, by the mouse or, with the focus, by the arrow keys.

    Parameters
    ----------
    texts
        Below each other; those that are hidden take no room.
    lines
        That are seen at once.
    most
        Lines that are seen where a column is high enough for them, see :func:`scrolled_column`.
    """

    def __init__(self, texts: Sequence[QLabel], lines: int, most: int = 0) -> None:
        super().__init__()
        self._lines, self._spare, self._most = lines, 0, max(lines, most)
        self._inside = QWidget()
        column = QVBoxLayout(self._inside)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(2)
        for text in texts:
            text.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
            column.addWidget(text)
        column.addStretch(1)
        self.setProperty("role", "texts")
        self.setWidgetResizable(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setAccessibleName(tr("Remarks"))
        self.setWidget(self._inside)
        self.verticalScrollBar().rangeChanged.connect(self._overflow)

    @property
    def line(self) -> int:
        """Height of one line."""
        return self.fontMetrics().lineSpacing()

    def take_spare(self, lines: int) -> int:
        """Show more lines than usual, if that many are of use; returns how many are taken."""
        taken = max(0, min(lines, self._most - self._lines))
        if taken != self._spare:
            self._spare = taken
            self.updateGeometry()
        return taken

    def sizeHint(self) -> QSize:
        lines = (self._lines + self._spare) * self.line
        return QSize(super().sizeHint().width(), lines + 2 * self.frameWidth())

    def minimumSizeHint(self) -> QSize:
        bar = self.verticalScrollBar().sizeHint().width()
        return QSize(self._inside.minimumSizeHint().width() + bar, self.sizeHint().height())

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self.updateGeometry()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._overflow()

    def _overflow(self, *_range: int) -> None:
        """Tab comes here only where there is something to scroll."""
        more = self.verticalScrollBar().maximum() > 0
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus if more else Qt.FocusPolicy.NoFocus)


def padded(part: QWidget, left: int, top: int, right: int, bottom: int) -> QWidget:
    """A part with room around it."""
    frame = QWidget()
    layout = QVBoxLayout(frame)
    layout.setContentsMargins(left, top, right, bottom)
    layout.addWidget(part)
    return frame


def _splitter(
    direction: Qt.Orientation, parts: Sequence[QWidget], sizes: Sequence[int], stretch: int
) -> QSplitter:
    made = QSplitter(direction)
    made.setChildrenCollapsible(False)
    made.setHandleWidth(7)
    for number, part in enumerate(parts):
        made.addWidget(part)
        made.setStretchFactor(number, 1 if number == stretch else 0)
    made.setSizes(list(sizes))
    return made
