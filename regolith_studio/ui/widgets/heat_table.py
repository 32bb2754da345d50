"""A heat map table of percentages."""

import math
from collections.abc import Sequence

from PySide6.QtCore import QEvent, QRect, Qt
from PySide6.QtGui import QColor, QResizeEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QLabel,
    QStackedLayout,
    QStyle,
    QTableWidget,
    QTableWidgetItem,
    QWidget,
)

from regolith_studio.ui.layout import named
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import inert, localized, tr
from regolith_studio.ui.widgets.text_table import FontRowHeight

_MAX_HEADER_SHARE, _MIN_HEADER_SHARE = 0.33, 0.2
"""Limits of the vertical header's width as a share of the width of the table."""
MIN_COLUMN, MARGINS = 24, 6
"""Minimum width of a column, and the free pixels around its name."""
GRIP = 4
"""Pixels that a header keeps free at its sides beyond its margins."""
SPARE = 11
"""Pixels of a row in addition to its lines of text."""
Bands = tuple[Sequence[Sequence[float]], Sequence[Sequence[float]]]
"""Lower and upper ends of intervals, one for each cell."""


def percentage(share: float) -> str:
    """A share in per cent with one or two decimals; a dash for NaN."""
    percent = 100.0 * share
    if not math.isfinite(percent):
        return "–"
    if percent < 0.005:
        return "0"
    return localized(f"{percent:.2f}" if percent < 1.0 else f"{percent:.1f}")


def _short(share: float) -> str:
    """A share in per cent for the end of an interval, rounded to whole numbers from 10 % on."""
    return f"{100.0 * share:.0f}" if share >= 0.1 else percentage(share)


class HeatTable(QWidget):
    """Shows shares as percentages on a coloured background, or a placeholder text."""

    def __init__(self, placeholder: str) -> None:
        super().__init__()
        self._theme = current_theme()
        self._values: tuple[tuple[float, ...], ...] = ()
        self._bands: Bands | None = None
        self.table = numbers_table(tr("Table of errors"))
        self._rows = FontRowHeight(self.table, SPARE)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(centred_hint(placeholder))
        self._stack.addWidget(self.table)

    def values(self) -> tuple[tuple[float, ...], ...]:
        """The values, as shares."""
        return self._values

    def set_values(
        self,
        rows: Sequence[str],
        columns: Sequence[str],
        values: Sequence[Sequence[float]],
        bands: Bands | None = None,
        tips: Sequence[str] = (),
    ) -> None:
        """Show other shares, each with its interval below; without rows the placeholder is shown.

        ``tips``: tool tips of the columns.
        """
        self._values = tuple(tuple(float(value) for value in row) for row in values)
        self._bands = bands
        self._stack.setCurrentIndex(1 if rows else 0)
        self.table.setRowCount(len(rows))
        self.table.setColumnCount(len(columns))
        self.table.setVerticalHeaderLabels(list(rows))
        self.table.setHorizontalHeaderLabels(list(columns))
        for number, text in enumerate(rows):
            if (item := self.table.verticalHeaderItem(number)) is not None:
                item.setToolTip(inert(text))
        set_head_tips(self.table, tips)
        self._fill()

    def mark_row(self, row: int, tip: str) -> None:
        """Mark the best row, with what makes it the best as its tool tip."""
        if (head := self.table.verticalHeaderItem(row)) is not None:
            head.setText(f"★ {head.text()}")
            head.setToolTip(inert(f"{head.toolTip()}\n{tip}"))
        self._fit_to_font()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit_to_font()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self._fit_to_font()

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme
        self._fill()

    def _fill(self) -> None:
        top = max((value for row in self._values for value in row if math.isfinite(value)), default=0.0)
        for at, row in enumerate(self._values):
            for column, value in enumerate(row):
                text = percentage(value) + self._band(at, column)
                heat = math.sqrt(value / top) if top > 0.0 else 0.0
                self.table.setItem(at, column, self._cell(text, heat))
        self._fit_to_font()

    def _fit_to_font(self) -> None:
        fit_to_font(self.table, self.width(), self._rows, 1 if self._bands is None else 2)

    def _band(self, row: int, column: int) -> str:
        """A second line with the interval, unless its rounded ends are equal."""
        if self._bands is None:
            return ""
        low, high = (_short(end[row][column]) for end in self._bands)
        return "" if low == high else f"\n{low}–{high}"

    def _cell(self, text: str, heat: float) -> QTableWidgetItem:
        item = QTableWidgetItem(text)
        item.setTextAlignment(Qt.AlignmentFlag.AlignCenter)
        if math.isfinite(heat):
            colour = QColor(self._theme.polyhedron)
            colour.setAlphaF(0.75 * min(1.0, heat))
            item.setBackground(colour)
        return item


def numbers_table(name: str) -> QTableWidget:
    """A read-only table whose columns stretch to its width.

    ``name``: accessible name.
    """
    table = named(QTableWidget(), spoken=name)
    table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
    table.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
    table.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    table.setShowGrid(False)
    table.setFrameShape(table.Shape.NoFrame)
    table.setHorizontalScrollMode(QTableWidget.ScrollMode.ScrollPerPixel)
    table.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
    table.horizontalHeader().setMinimumSectionSize(MIN_COLUMN)
    rows = table.verticalHeader()
    rows.setTextElideMode(Qt.TextElideMode.ElideNone)
    rows.setDefaultAlignment(
        Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter | Qt.TextFlag.TextWordWrap
    )
    return table


def set_head_tips(table: QTableWidget, tips: Sequence[str]) -> None:
    """Set the tool tips of the first columns."""
    for column, tip in enumerate(tips):
        if (item := table.horizontalHeaderItem(column)) is not None:
            item.setToolTip(inert(tip))


def fit_to_font(table: QTableWidget, width: int, heights: FontRowHeight, lines: int) -> None:
    """Make columns at least as wide as their names and cells; a table that is too narrow is scrolled.

    The width of a cell is what its delegate asks for: with less, the longest text is elided.

    ``width``: of the table. The vertical header shrinks first and wraps its names. ``heights``, ``lines``:
    of the rows, and how many lines of text their cells have.
    """
    names, model = table.horizontalHeader().fontMetrics(), table.model()
    width -= table.verticalScrollBar().sizeHint().width()  # which many rows need
    heads = [table.horizontalHeaderItem(column) for column in range(table.columnCount())]
    widths = [names.horizontalAdvance(head.text()) + MARGINS for head in heads if head is not None]
    cells = (model.index(row, at) for row in range(table.rowCount()) for at in range(table.columnCount()))
    least = max([MIN_COLUMN, *widths, *(table.sizeHintForIndex(cell).width() for cell in cells)])
    table.horizontalHeader().setMinimumSectionSize(least)
    left: float = width - least * table.columnCount() - MARGINS
    words = (word for name in _row_names(table) for word in name.split())
    longest = max(map(table.verticalHeader().fontMetrics().horizontalAdvance, words), default=0)
    left = max(left, _MIN_HEADER_SHARE * width, longest + 2 * MARGINS)
    left = min(left, _MAX_HEADER_SHARE * width)
    table.verticalHeader().setMaximumWidth(round(left))
    heights.set_lines(max(lines, _lines_of_names(table, round(left))))


def _row_names(table: QTableWidget) -> list[str]:
    return [each.text() for each in map(table.verticalHeaderItem, range(table.rowCount())) if each]


def _lines_of_names(table: QTableWidget, width: int) -> int:
    """Lines that the longest name of a row takes in a header of this width."""
    rows = table.verticalHeader()
    letters = rows.fontMetrics()
    margin = rows.style().pixelMetric(QStyle.PixelMetric.PM_HeaderMargin, None, rows)
    room = QRect(0, 0, max(width - 2 * margin - GRIP, 1), 10_000)
    wrapped = Qt.TextFlag.TextWordWrap
    heights = [letters.boundingRect(room, wrapped, name).height() for name in _row_names(table)]
    return math.ceil(max(heights, default=0) / letters.lineSpacing())


def centred_hint(text: str) -> QLabel:
    label = named(QLabel(text), role="hint")
    label.setAlignment(Qt.AlignmentFlag.AlignCenter)
    label.setWordWrap(True)
    return label
