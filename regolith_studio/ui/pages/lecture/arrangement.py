"""Places the parts of a lesson: views with plots below them, and at the right the text with its formulas."""

from collections.abc import Sequence

from PySide6.QtWidgets import QSplitter, QVBoxLayout, QWidget

from regolith_studio.ui.layout import Splitter, scrolled, side_by_side, stacked

VIEWS, PLOTS = 560, 240
"""Initial heights in pixels."""
MIN_PLOT = 150
"""Least height of a plot below texts that need more."""
PICTURES, TEXTS = 1000, 560
"""Initial widths in pixels."""


def lesson_columns(
    name: str,
    views: Sequence[QWidget],
    plots: Sequence[QWidget],
    texts: Sequence[QWidget],
    under_texts: QWidget | None = None,
) -> QSplitter:
    """All plots stay in sight; only texts are scrolled where they are too long.

    Parameters
    ----------
    name
        Of the borders in the preferences.
    under_texts
        A plot below the texts.
    """
    column_of_texts = QWidget()
    column = QVBoxLayout(column_of_texts)
    column.setContentsMargins(10, 6, 6, 6)
    column.setSpacing(6)
    for each in texts:
        column.addWidget(each)
    column.addStretch(1)
    pictures = stacked([_row(views), _row(plots)], [VIEWS, PLOTS], stretch=0)
    right: QWidget = scrolled(column_of_texts)
    if under_texts is not None:
        both = right = stacked([right, under_texts], [VIEWS, PLOTS], stretch=0)
        both.setObjectName(f"{name}_texts")
        both.fit = _TextsAbovePlot(both, column_of_texts).place
    pictures.setObjectName(f"{name}_rows")
    columns = side_by_side([pictures, right], [PICTURES, TEXTS], stretch=0)
    columns.setObjectName(f"{name}_columns")
    columns.setStretchFactor(1, 1)
    return columns


class _TextsAbovePlot:
    """Gives the texts the height of the longest so far, if there is so much, and the plot the rest."""

    def __init__(self, both: Splitter, texts: QWidget) -> None:
        self._both, self._texts = both, texts
        self._width, self._longest = 0, 0

    def place(self) -> None:
        """Place the border between them."""
        if self._texts.width() != self._width:
            self._width, self._longest = self._texts.width(), 0
        height = sum(self._both.sizes())
        self._longest = max(self._longest, self._texts.minimumSizeHint().height())
        texts = max(round(height * VIEWS / (VIEWS + PLOTS)), min(self._longest, height - MIN_PLOT))
        self._both.setSizes([texts, height - texts])


def _row(parts: Sequence[QWidget]) -> QSplitter:
    row = side_by_side(parts, [500] * len(parts), stretch=0)
    for place in range(row.count()):
        row.setStretchFactor(place, 1)
    return row
