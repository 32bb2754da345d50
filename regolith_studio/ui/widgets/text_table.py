"""Tables of texts, whose rows and columns are as large as their font needs."""

from collections.abc import Sequence

from PySide6.QtCore import QEvent, QObject, QSignalBlocker, Qt, Signal
from PySide6.QtGui import QShowEvent, QStandardItem, QStandardItemModel
from PySide6.QtWidgets import QAbstractItemView, QTableView

from regolith_studio.ui.translation import inert

RIGHT = int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)


class FontRowHeight(QObject):
    """Keeps the row height of a table that of its font.

    ``spare``: additional pixels of a row.
    """

    def __init__(self, table: QTableView, spare: int) -> None:
        super().__init__(table)
        self._table, self._spare, self._lines = table, spare, 1
        table.installEventFilter(self)
        self._fit()

    def set_lines(self, lines: int) -> None:
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


class FittedTable(QTableView):
    """A table of rows whose columns are as wide as their contents in the font that it is shown in."""

    def __init__(self) -> None:
        super().__init__()
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setShowGrid(False)
        self.setTabKeyNavigation(False)
        self.setWordWrap(False)
        self.setTextElideMode(Qt.TextElideMode.ElideMiddle)  # names of a sample differ at their end
        self.verticalHeader().hide()
        FontRowHeight(self, 9)
        self.horizontalHeader().setHighlightSections(False)
        self.horizontalHeader().setStretchLastSection(True)

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self.resizeColumnsToContents()  # the style sheet's font is known only now

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self.resizeColumnsToContents()


class TextTable(FittedTable):
    """Rows of texts; ``chosen`` carries the number of the row that the user has selected.

    ``name``, ``spoken``: object name and accessible name. ``headings``: of the columns. ``numbers``: texts
    are aligned right but for the first column.
    """

    chosen = Signal(int)

    def __init__(self, name: str, spoken: str, headings: Sequence[str], *, numbers: bool = True) -> None:
        super().__init__()
        self._numbers = numbers
        self.setObjectName(name)
        self.setAccessibleName(spoken)
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        if not numbers:
            self.horizontalHeader().setDefaultAlignment(Qt.AlignmentFlag.AlignLeft)
        self.rows = QStandardItemModel(0, len(headings), self)
        self.rows.setHorizontalHeaderLabels(list(headings))
        self.setModel(self.rows)
        self.selectionModel().selectionChanged.connect(self._announce)

    def set_rows(self, rows: Sequence[Sequence[str]], tips: Sequence[str]) -> None:
        with QSignalBlocker(self.selectionModel()):
            self.rows.setRowCount(0)
            for texts, tip in zip(rows, tips, strict=True):
                items = [QStandardItem(text) for text in texts]
                for column, item in enumerate(items):
                    item.setToolTip(inert(tip))
                    if column and self._numbers:
                        item.setData(RIGHT, Qt.ItemDataRole.TextAlignmentRole)
                self.rows.appendRow(items)
        self.resizeColumnsToContents()

    def selected(self) -> int | None:
        rows = self.selectionModel().selectedRows()
        return rows[0].row() if rows else None

    def select(self, row: int | None) -> None:
        """Select a row, or none, without emitting a signal."""
        with QSignalBlocker(self.selectionModel()):
            if row is None:
                self.clearSelection()
            else:
                self.selectRow(row)
        self.viewport().update()

    def _announce(self) -> None:
        if (row := self.selected()) is not None:
            self.chosen.emit(row)
