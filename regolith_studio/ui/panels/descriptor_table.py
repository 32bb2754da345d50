"""The descriptors themselves, with their units: particle, fit, polyhedron."""

from collections.abc import Mapping

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.descriptors.catalogue import CATALOGUE, Descriptor
from regolith_studio.session.results import Results
from regolith_studio.ui.widgets.labels import plain_symbol

_POWERS = {0: "", 1: " [µm]", 2: " [µm²]", 3: " [µm³]", 5: " [µm⁵]"}
COLUMNS = ("Particle", "Fit", "Polyhedron")


def row_title(row: Descriptor) -> str:
    """Label, symbol and unit of one descriptor."""
    return f"{row.label} {plain_symbol(row.symbol)}{_POWERS.get(row.dimension, '')}"


class DescriptorTablePanel(QWidget):
    """One row a descriptor of the catalogue."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("descriptor_table")
        self._keys = [key for key, row in CATALOGUE.items() if not row.costly and row.dimension in _POWERS]
        self.table = QTableWidget(len(self._keys), len(COLUMNS))
        self.table.setAccessibleName("Descriptors")
        self.table.setHorizontalHeaderLabels(COLUMNS)
        self.table.setVerticalHeaderLabels([row_title(CATALOGUE[key]) for key in self._keys])
        self.table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        self.table.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.table.setShowGrid(False)
        self.table.setFrameShape(self.table.Shape.NoFrame)
        self.table.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        self.table.verticalHeader().setDefaultSectionSize(self.table.fontMetrics().height() + 6)
        for number, key in enumerate(self._keys):
            if (item := self.table.verticalHeaderItem(number)) is not None:
                item.setToolTip(CATALOGUE[key].formula)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.table)

    def show_results(self, results: Results) -> None:
        """Fill the table from these results."""
        done = results.coarsened
        found = (results.particle_descriptors, results.fit_descriptors, done.achieved if done else None)
        for column, values in enumerate(found):
            for row, key in enumerate(self._keys):
                self.table.setItem(row, column, _cell(values, key))


def _cell(values: Mapping[str, float] | None, key: str) -> QTableWidgetItem:
    text = f"{values[key]:,.4g}" if values is not None and key in values else "–"
    item = QTableWidgetItem(text)
    item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
    return item
