"""Tables as the window uses them: rows to choose from, the first column taking what room is left."""

from collections.abc import Iterator

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QResizeEvent, QShowEvent
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableView

_LEAST = 70
_NAME = 18
"""Digits that the first column is granted, at most, before others stay; an icon has room in it."""


class FontRowHeight(QObject):
    """Keeps the rows of a table as high as its letters, whatever size these take.

    Parameters
    ----------
    spare
        Pixels between two lines.
    """

    def __init__(self, table: QTableView, spare: int) -> None:
        super().__init__(table)
        self._table, self._spare, self._lines = table, spare, 1
        table.installEventFilter(self)
        self._fit()

    def set_lines(self, lines: int) -> None:
        """Another number of lines in each row."""
        self._lines = lines
        self._fit()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.FontChange:
            self._fit()
        return super().eventFilter(watched, event)

    def _fit(self) -> None:
        height = self._lines * self._table.fontMetrics().height() + self._spare
        rows = self._table.verticalHeader()
        if rows.defaultSectionSize() != height:
            rows.setDefaultSectionSize(height)


MEASURED = 100
"""Rows, from the first one that is seen, that say how wide columns must be."""


class ListTable(QTableView):
    """One row can be chosen; no grid, no row numbers, compact rows.

    Parameters
    ----------
    dispensable
        Columns that are left out, in this order, while there is no room for the names in the first one.
    """

    _unfitted = True
    """Content or letters have changed while nobody saw the table."""
    _measured = False
    """Columns are as wide as their present content."""

    def __init__(self, dispensable: tuple[int, ...] = ()) -> None:
        super().__init__()
        self._dispensable = dispensable
        self._left_out: dict[int, int] = {}
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setShowGrid(False)
        self.setTabKeyNavigation(False)
        self.setWordWrap(False)
        self.setTextElideMode(Qt.TextElideMode.ElideMiddle)  # names of a sample differ at their end
        self.verticalHeader().hide()
        FontRowHeight(self, 9)
        header = self.horizontalHeader()
        header.setHighlightSections(False)
        header.setResizeContentsPrecision(MEASURED)
        header.setMinimumSectionSize(30)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        header.setSectionResizeMode(QHeaderView.ResizeMode.Interactive)

    def fit_columns(self) -> None:
        """All columns as wide as their content, the first one as wide as there is room; once it is seen."""
        self._measured, self._unfitted = False, not self.isVisible()
        if self.isVisible():
            self._fit()

    def measure_unseen(self) -> Iterator[None]:
        """Measure what :meth:`fit_columns` will need once the table is seen, column by column."""
        self._measured = True  # unless the content changes meanwhile
        for column in self._left_out:
            self.setColumnHidden(column, False)
        self._left_out.clear()
        for column in self._by_content():
            self.resizeColumnToContents(column)
            yield

    def _fit(self) -> None:
        if not self._measured:
            for _ in self.measure_unseen():
                pass
        self.stretch()

    def stretch(self) -> None:
        """The first column as wide as there is room."""
        header = self.horizontalHeader()
        taken = self._make_room()
        if header.count():
            header.resizeSection(0, max(_LEAST, self.viewport().width() - taken))

    def _make_room(self) -> int:
        """Leave out what must be, bring back what need not; returns the width of the columns that stay."""
        header = self.horizontalHeader()
        widths = {column: header.sectionSize(column) for column in self._by_content()} | self._left_out
        names = min(self.sizeHintForColumn(0), self.fontMetrics().horizontalAdvance("0" * _NAME))
        for column in self._dispensable:
            if column not in widths:  # hidden for another reason
                continue
            short = self.viewport().width() - sum(widths.values()) < names
            if short:
                self._left_out[column] = widths.pop(column)
            elif column in self._left_out:
                del self._left_out[column]
            if self.isColumnHidden(column) != short:
                self.setColumnHidden(column, short)
        return sum(widths.values())

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if not self._unfitted:
            self.stretch()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self.fit_columns()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        if self._unfitted:
            self._unfitted = False
            self._fit()

    def _by_content(self) -> list[int]:
        """Columns that are as wide as their content."""
        header = self.horizontalHeader()
        return [at for at in range(1, header.count()) if not header.isSectionHidden(at)]
