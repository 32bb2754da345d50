"""A read-only table of a study."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableWidget, QTableWidgetItem

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.io.tables import Cell, Table
from regolith_studio.shape_models.models import MODELS
from regolith_studio.ui.translation import mark, tr
from regolith_studio.ui.translation.sentences import retold

WORDS = {
    "wasserstein": "W",
    "wasserstein_low": mark("from"),
    "wasserstein_high": mark("to"),
    "floor": mark("Floor"),
    "floor_p5": mark("5th"),
    "floor_p95": mark("95th"),
    "kolmogorov_smirnov": "KS",
    "kolmogorov_smirnov_low": mark("KS from"),
    "kolmogorov_smirnov_high": mark("KS to"),
    "kolmogorov_smirnov_floor": mark("KS floor"),
    "wasserstein_in_floors": mark("W / floor"),
    "kolmogorov_smirnov_in_floors": mark("KS / floor"),
    "energy_distance": mark("Energy distance"),
}
"""Short headers; tool tips have the long ones."""
OTHER_WORDS = (
    *(mark("Model"), mark("Weighting"), mark("Descriptor"), mark("First"), mark("Second")),
    *(mark("Target"), mark("Value"), mark("Wanted"), mark("Reached")),
)
"""Headers that equal the names of their columns, marked for translation."""
TIPS = (
    *(mark("model"), mark("weighting"), mark("descriptor"), mark("first"), mark("second")),
    *(mark("target"), mark("value"), mark("wanted"), mark("reached")),
    *(mark("wasserstein"), mark("wasserstein low"), mark("wasserstein high")),
    *(mark("floor"), mark("floor p5"), mark("floor p95")),
    *(mark("kolmogorov smirnov"), mark("kolmogorov smirnov low"), mark("kolmogorov smirnov high")),
    *(mark("kolmogorov smirnov floor"), mark("wasserstein in floors")),
    *(mark("kolmogorov smirnov in floors"), mark("energy distance")),
)
"""Names of all columns, marked for translation."""


class StudyTableView(QTableWidget):
    """Shows a :class:`~regolith_studio.io.tables.Table` with labels for keys of models and descriptors."""

    def __init__(self, name: str, spoken: str) -> None:
        super().__init__()
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
            item = QTableWidgetItem(f"{tr(words)}{unit}")
            item.setToolTip(f"{tr(column.name.replace('_', ' '))}{unit}")
            self.setHorizontalHeaderItem(at, item)
        for row, cells in enumerate(table.rows):
            for at, cell in enumerate(cells):
                self.setItem(row, at, _item(cell))
        self.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)


def _item(cell: Cell) -> QTableWidgetItem:
    if isinstance(cell, str):
        known = {key: model.label for key, model in MODELS.items()}
        descriptor = CATALOGUE.get(cell)
        return QTableWidgetItem(retold(known.get(cell, descriptor.label if descriptor else cell)))
    item = QTableWidgetItem("" if cell is None else f"{cell:.3g}")
    item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
    return item
