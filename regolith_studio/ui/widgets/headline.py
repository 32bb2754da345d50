"""The results of a page in large figures, with a sentence that says what they mean."""

from collections.abc import Sequence

from PySide6.QtCore import QEvent, Qt
from PySide6.QtWidgets import QFrame, QGridLayout, QHBoxLayout, QLabel, QWidget

from regolith_studio.ui.widgets.fixed_height_text import FixedHeightText
from regolith_studio.ui.widgets.labels import remark

MAGNIFICATION = 1.75
"""Size of the figures in units of the widget's font."""
LINES = 3
"""Visible lines of the sentence."""


class Headline(QFrame):
    """Large figures with captions, and a sentence beside them; keeps its height whatever it shows.

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
        grid = QGridLayout()
        grid.setHorizontalSpacing(16)
        grid.setVerticalSpacing(0)
        for column, (figure, caption) in enumerate(zip(self.figures, self.captions, strict=True)):
            caption.setWordWrap(False)
            figure.setAccessibleName(caption.text())
            grid.addWidget(figure, 0, column, Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignBottom)
            grid.addWidget(caption, 1, column)
        row = self._row = QHBoxLayout(self)
        row.setContentsMargins(12, 5, 10, 5)
        row.setSpacing(16)
        row.addLayout(grid)
        row.addWidget(FixedHeightText((self.sentence,), LINES), 1)
        self._enlarge()

    def show_values(self, figures: Sequence[str], sentence: str, *, fresh: bool = True) -> None:
        """Show other figures; those of a result that is being replaced are dimmed."""
        for label, text in zip(self.figures, figures, strict=True):
            label.setText(text)
            label.setEnabled(fresh)
        self.sentence.setText(sentence)

    def add(self, part: QWidget) -> None:
        """Put a button at the end."""
        self._row.addWidget(part)

    def caption(self, place: int, text: str, tip: str = "") -> None:
        """Set the caption of a figure, and what it means."""
        self.captions[place].setText(text)
        for part in (self.captions[place], self.figures[place]):
            part.setToolTip(tip)

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
