"""The descriptors themselves, with their units: particle, fit, polyhedron."""

from collections.abc import Mapping

from PySide6.QtCore import Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.session.results import Results
from regolith_studio.ui.translation import mark, tr
from regolith_studio.ui.widgets.labels import plain_symbol

_UNITS = {0: "", 1: " [µm]", 2: " [µm²]", 3: " [µm³]", 5: " [µm⁵]"}
COLUMNS = (mark("Particle"), mark("Fit"), mark("Polyhedron"))
_ROOM_FOR_LABELS = 440


class DescriptorTablePanel(QWidget):
    """One row a descriptor of the catalogue."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("descriptor_table")
        self._keys = [key for key, row in CATALOGUE.items() if not row.costly and row.dimension in _UNITS]
        self.table = QTableWidget(len(self._keys), len(COLUMNS))
        self.table.setAccessibleName(tr("Descriptors"))
        self.table.setHorizontalHeaderLabels([tr(each) for each in COLUMNS])
        self.table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        self.table.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.table.setShowGrid(False)
        self.table.setFrameShape(self.table.Shape.NoFrame)
        header, rows = self.table.horizontalHeader(), self.table.verticalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        rows.setDefaultSectionSize(self.table.fontMetrics().height() + 6)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.table)
        self._name_rows()

    def show_results(self, results: Results) -> None:
        """Fill the table from these results."""
        done = results.coarsened
        found = (results.particle_descriptors, results.fit_descriptors, done.achieved if done else None)
        for column, values in enumerate(found):
            for row, key in enumerate(self._keys):
                self.table.setItem(row, column, _cell(values, key))

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._name_rows()

    def _name_rows(self) -> None:
        for number, key in enumerate(self._keys):
            row = CATALOGUE[key]
            short = plain_symbol(row.symbol) + _UNITS[row.dimension]
            item = QTableWidgetItem(f"{tr(row.label)} {short}" if self.width() > _ROOM_FOR_LABELS else short)
            item.setToolTip(f"{tr(row.label)}: {tr(row.formula)}")
            self.table.setVerticalHeaderItem(number, item)


def _cell(values: Mapping[str, float] | None, key: str) -> QTableWidgetItem:
    text = f"{values[key]:,.4g}" if values is not None and key in values else "–"
    item = QTableWidgetItem(text)
    item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
    return item
