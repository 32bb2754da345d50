"""Texts that change without moving anything."""

from collections.abc import Sequence

from PySide6.QtCore import QEvent, QSize, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QLabel, QScrollArea, QSizePolicy, QVBoxLayout, QWidget

from regolith_studio.ui.translation import tr


class FixedHeightText(QScrollArea):
    """Texts in the room of so many lines, whatever they say: no control moves when they change.

    More lines than that are scrolled to, by the mouse or, with the focus, by the arrow keys.

    Parameters
    ----------
    texts
        Below each other; those that are hidden take no room.
    lines
        That are seen at once.
    most
        Lines that are seen where a column is high enough for them, see
        :func:`~regolith_studio.ui.layout.scrolled_column`.
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

    def take_spare_lines(self, lines: int) -> int:
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
