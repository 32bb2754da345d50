"""Tables as the window uses them: rows to choose from, the first column taking what room is left."""

from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QResizeEvent, QShowEvent
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableView

_LEAST = 70


class ListTable(QTableView):
    """One row can be chosen; no grid, no row numbers, compact rows."""

    _unfitted = False
    """Letters have changed while nobody saw the table."""

    def __init__(self) -> None:
        super().__init__()
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setShowGrid(False)
        self.setTabKeyNavigation(False)
        self.setWordWrap(False)
        self.setTextElideMode(Qt.TextElideMode.ElideMiddle)  # names of a sample differ at their end
        self.verticalHeader().hide()
        self.verticalHeader().setDefaultSectionSize(self.fontMetrics().height() + 9)
        header = self.horizontalHeader()
        header.setHighlightSections(False)
        header.setMinimumSectionSize(30)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        header.setSectionResizeMode(QHeaderView.ResizeMode.Interactive)

    def fit_columns(self) -> None:
        """All columns as wide as their content, the first one as wide as there is room."""
        header = self.horizontalHeader()
        shown = [at for at in range(1, header.count()) if not header.isSectionHidden(at)]
        for column in shown:
            self.resizeColumnToContents(column)
        taken = sum(header.sectionSize(column) for column in shown)
        if header.count():
            header.resizeSection(0, max(_LEAST, self.viewport().width() - taken))

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.fit_columns()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._unfitted = not self.isVisible()
            if self.isVisible():
                self.fit_columns()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        if self._unfitted:
            self._unfitted = False
            self.fit_columns()
