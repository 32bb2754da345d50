"""A table of texts, of whose rows one can be selected."""

from collections.abc import Sequence

from PySide6.QtCore import QEvent, QSignalBlocker, Qt, Signal
from PySide6.QtGui import QShowEvent, QStandardItem, QStandardItemModel
from PySide6.QtWidgets import QAbstractItemView, QTableView

from regolith_studio.ui.translation import inert
from regolith_studio.ui.widgets.table import RIGHT, FontRowHeight


class TextTable(QTableView):
    """Rows of texts; ``chosen`` carries the number of the row that the user has selected.

    ``name``, ``spoken``: object name and accessible name. ``headings``: of the columns; texts are aligned
    right but for the first column.
    """

    chosen = Signal(int)

    def __init__(self, name: str, spoken: str, headings: Sequence[str]) -> None:
        super().__init__()
        self.setObjectName(name)
        self.setAccessibleName(spoken)
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setShowGrid(False)
        self.setTabKeyNavigation(False)
        self.setWordWrap(False)
        self.setTextElideMode(Qt.TextElideMode.ElideMiddle)
        self.verticalHeader().hide()
        FontRowHeight(self, 9)
        self.horizontalHeader().setHighlightSections(False)
        self.horizontalHeader().setStretchLastSection(True)
        self.rows = QStandardItemModel(0, len(headings), self)
        self.rows.setHorizontalHeaderLabels(list(headings))
        self.setModel(self.rows)
        self.selectionModel().selectionChanged.connect(self._announce)

    def set_rows(self, rows: Sequence[Sequence[str]], tips: Sequence[str]) -> None:
        """Show other rows with their tool tips."""
        with QSignalBlocker(self.selectionModel()):
            self.rows.setRowCount(0)
            for texts, tip in zip(rows, tips, strict=True):
                items = [QStandardItem(text) for text in texts]
                for column, item in enumerate(items):
                    item.setToolTip(inert(tip))
                    if column:
                        item.setData(RIGHT, Qt.ItemDataRole.TextAlignmentRole)
                self.rows.appendRow(items)
        self.resizeColumnsToContents()

    def selected(self) -> int | None:
        """Number of the selected row."""
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

    def text(self, row: int, column: int) -> str:
        """Text of a cell."""
        return self.rows.item(row, column).text()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self.resizeColumnsToContents()  # the style sheet's font is known only now

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self.resizeColumnsToContents()

    def _announce(self) -> None:
        if (row := self.selected()) is not None:
            self.chosen.emit(row)
