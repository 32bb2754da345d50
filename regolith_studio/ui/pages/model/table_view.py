"""A table of a study, to be read."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableWidget, QTableWidgetItem, QWidget

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.model.models import MODELS
from regolith_studio.studies.tables import Cell, Table

WORDS = {
    "wasserstein": "W",
    "wasserstein_low": "from",
    "wasserstein_high": "to",
    "floor": "Floor",
    "floor_p5": "5th",
    "floor_p95": "95th",
    "kolmogorov_smirnov": "KS",
    "kolmogorov_smirnov_low": "KS from",
    "kolmogorov_smirnov_high": "KS to",
    "kolmogorov_smirnov_floor": "KS floor",
    "wasserstein_in_floors": "W / floor",
    "kolmogorov_smirnov_in_floors": "KS / floor",
    "energy_distance": "Energy distance",
}
"""Short headers; the long ones stand in their tips."""


class TableView(QTableWidget):
    """Shows a :class:`~regolith_studio.studies.tables.Table`; keys of models and descriptors become words."""

    def __init__(self, name: str, spoken: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName(spoken)
        self.setShowGrid(False)
        self.verticalHeader().hide()
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)

    def show_table(self, table: Table) -> None:
        """Show another table."""
        self.setColumnCount(len(table.columns))
        self.setRowCount(len(table.rows))
        for at, column in enumerate(table.columns):
            unit = f" [{column.unit}]" if column.unit else ""
            words = WORDS.get(column.name, column.name.replace("_", " ").capitalize())
            item = QTableWidgetItem(f"{words}{unit}")
            item.setToolTip(f"{column.name.replace('_', ' ')}{unit}")
            self.setHorizontalHeaderItem(at, item)
        for row, cells in enumerate(table.rows):
            for at, cell in enumerate(cells):
                self.setItem(row, at, _item(cell))
        self.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)


def _item(cell: Cell) -> QTableWidgetItem:
    if isinstance(cell, str):
        known = {key: model.label for key, model in MODELS.items()}
        descriptor = CATALOGUE.get(cell)
        return QTableWidgetItem(known.get(cell, descriptor.label if descriptor else cell))
    item = QTableWidgetItem("" if cell is None else f"{cell:.3g}")
    item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
    return item
