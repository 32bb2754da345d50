"""The results of a page in large figures, with a sentence that says what they mean."""

from collections.abc import Sequence

from PySide6.QtCore import QEvent, QSize, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QBoxLayout, QFrame, QGridLayout, QHBoxLayout, QLabel, QWidget

from regolith_studio.ui.widgets.fixed_height_text import FixedHeightText
from regolith_studio.ui.widgets.labels import remark

MAGNIFICATION = 1.75
"""Size of the figures in units of the widget's font."""
LINES = 3
"""Visible lines of the sentence."""
WIDEST_FIGURE, SENTENCE_DIGITS = "0.0000", 40
"""What a figure has room for, and digits of room beside the figures without which the sentence goes below."""
MIN_LINES = 34
"""Lines of text that a window must be high enough for if the sentence is to go below the figures."""


class Headline(QFrame):
    """Large figures with captions, and a sentence beside them, or below where there is little room.

    Its height does not change with what it shows.

    Parameters
    ----------
    name
        Object name.
    captions
        One below each figure.
    """

    def __init__(self, name: str, captions: Sequence[str]) -> None:
        super().__init__()
        self.setObjectName(name)
        self.setProperty("role", "card")
        self.figures = tuple(QLabel("–") for _ in captions)
        self.captions = tuple(remark(caption) for caption in captions)
        self.sentence = remark()
        self.sentence.setObjectName(f"{name}_sentence")
        self._ends: list[QWidget] = []
        grid = self._grid = QGridLayout()
        grid.setHorizontalSpacing(16)
        grid.setVerticalSpacing(0)
        for column, (figure, caption) in enumerate(zip(self.figures, self.captions, strict=True)):
            caption.setWordWrap(False)
            figure.setAccessibleName(caption.text())
            grid.addWidget(figure, 0, column, Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignBottom)
            grid.addWidget(caption, 1, column)
        self._parts = QBoxLayout(QBoxLayout.Direction.LeftToRight)
        self._parts.addLayout(grid)
        self._words = FixedHeightText((self.sentence,), LINES)
        self._parts.addWidget(self._words, 1)
        row = self._row = QHBoxLayout(self)
        row.setContentsMargins(12, 5, 10, 5)
        row.addLayout(self._parts, 1)
        self._parts.setSpacing(16)
        row.setSpacing(16)
        self._enlarge()

    def show_values(self, figures: Sequence[str], sentence: str, *, fresh: bool = True) -> None:
        """Show other figures; those of a result that is being replaced are dimmed."""
        for label, text in zip(self.figures, figures, strict=True):
            label.setText(text)
            label.setEnabled(fresh)
        self.sentence.setText(sentence)

    def add(self, part: QWidget) -> None:
        """Put a button at the end."""
        self._ends.append(part)
        self._row.addWidget(part)

    def caption(self, place: int, text: str, tip: str = "") -> None:
        """Set the caption of a figure, and what it means."""
        self.captions[place].setText(text)
        for part in (self.captions[place], self.figures[place]):
            part.setToolTip(tip)

    def minimumSizeHint(self) -> QSize:
        """As narrow as the figures, or the sentence where it is below them."""
        inside = max(self._grid.minimumSize().width(), self._words.minimumSizeHint().width())
        return QSize(self._outer_width() + inside, super().minimumSizeHint().height())

    def _outer_width(self) -> int:
        """Width of the margins, and of the buttons at the end with the space before them."""
        margins = self._row.contentsMargins()
        ends = sum(each.minimumSizeHint().width() + self._row.spacing() for each in self._ends)
        return margins.left() + margins.right() + ends

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.place_sentence(self.width())

    def place_sentence(self, width: int) -> None:
        """Put the sentence beside the figures, or below where a card of this width has no room for it."""
        figure = self.figures[0].fontMetrics().horizontalAdvance(WIDEST_FIGURE) + 16
        words = self.fontMetrics().horizontalAdvance("0" * SENTENCE_DIGITS)
        high = self.window().height() >= MIN_LINES * self.fontMetrics().height()
        cramped = width < self._outer_width() + self._grid.minimumSize().width() + words // 2
        below = cramped or (high and width < len(self.figures) * figure + words)
        way = QBoxLayout.Direction.TopToBottom if below else QBoxLayout.Direction.LeftToRight
        if way != self._parts.direction():
            self._parts.setDirection(way)
            self._parts.setSpacing(4 if below else 16)
            self._row.invalidate()
            self.updateGeometry()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self._enlarge()

    def _enlarge(self) -> None:
        font = self.font()
        font.setPointSizeF(MAGNIFICATION * font.pointSizeF())
        font.setBold(True)
        for figure in self.figures:
            figure.setFont(font)
