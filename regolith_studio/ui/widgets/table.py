"""Tables of selectable rows whose first column stretches."""

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QResizeEvent, QShowEvent
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableView

_LEAST = 70
_NAME = 18
"""Width in digits that the first column may require before others are hidden; includes an icon."""


class FontRowHeight(QObject):
    """Keeps the row height of a table that of its font.

    Parameters
    ----------
    spare
        Additional pixels of a row.
    """

    def __init__(self, table: QTableView, spare: int) -> None:
        super().__init__(table)
        self._table, self._spare, self._lines = table, spare, 1
        table.installEventFilter(self)
        self._fit()

    def set_lines(self, lines: int) -> None:
        """Set the number of text lines in each row."""
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
"""Number of visible rows whose contents determine the width of columns."""


class ListTable(QTableView):
    """A table with single row selection, compact rows, without grid and row numbers.

    Parameters
    ----------
    dispensable
        Columns that are hidden, in this order, while the names in the first one do not fit.
    """

    _unfitted = True
    """Contents or font have changed while the table was hidden."""

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
        """Fit the columns to their contents and stretch the first one, as soon as the table is visible."""
        self._unfitted = not self.isVisible()
        if self.isVisible():
            self._fit()

    def _fit(self) -> None:
        for column in self._left_out:
            self.setColumnHidden(column, False)
        self._left_out.clear()
        for column in self._by_content():
            self.resizeColumnToContents(column)
        self.stretch()

    def stretch(self) -> None:
        """Stretch the first column."""
        header = self.horizontalHeader()
        taken = self._make_room()
        if header.count():
            header.resizeSection(0, max(_LEAST, self.viewport().width() - taken))

    def _make_room(self) -> int:
        """Hide or show dispensable columns; returns the width of all but the first."""
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
        """Visible columns but the first."""
        header = self.horizontalHeader()
        return [at for at in range(1, header.count()) if not header.isSectionHidden(at)]
