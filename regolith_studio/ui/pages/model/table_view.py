"""A read-only table of a study."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableWidget, QTableWidgetItem

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.io.tables import Cell, Table
from regolith_studio.messages import N_
from regolith_studio.shape_models.models import MODELS
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.translation.numbers import number_text

WORDS = {
    "wasserstein": "W",
    "wasserstein_low": N_("from"),
    "wasserstein_high": N_("to"),
    "floor": N_("Noise"),
    "floor_p5": N_("5th"),
    "floor_p95": N_("95th"),
    "kolmogorov_smirnov": "KS",
    "kolmogorov_smirnov_low": N_("KS from"),
    "kolmogorov_smirnov_high": N_("KS to"),
    "kolmogorov_smirnov_floor": N_("KS noise"),
    "wasserstein_in_floors": N_("W / noise"),
    "kolmogorov_smirnov_in_floors": N_("KS / noise"),
    "energy_distance": N_("Energy distance"),
}
"""Short headers; tool tips have the long ones."""
OTHER_WORDS = (
    *(N_("Model"), N_("Weighting"), N_("Descriptor"), N_("First"), N_("Second")),
    *(N_("Target"), N_("Value"), N_("Requested"), N_("Reached")),
)
"""Headers that equal the names of their columns, marked for translation."""
TIPS = (
    *(N_("model"), N_("weighting"), N_("descriptor"), N_("first"), N_("second")),
    *(N_("target"), N_("value"), N_("wanted"), N_("reached")),
    *(N_("wasserstein"), N_("wasserstein low"), N_("wasserstein high")),
    *(N_("floor"), N_("floor p5"), N_("floor p95")),
    *(N_("kolmogorov smirnov"), N_("kolmogorov smirnov low"), N_("kolmogorov smirnov high")),
    *(N_("kolmogorov smirnov floor"), N_("wasserstein in floors")),
    *(N_("kolmogorov smirnov in floors"), N_("energy distance")),
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


TEXTS = (*(N_("yes"), N_("no"), N_("number"), N_("volume")), *(N_("measured particles"), N_("figures")))
"""Cells of the tables that are translated."""


def _item(cell: Cell) -> QTableWidgetItem:
    if isinstance(cell, str):
        known = {key: model.label for key, model in MODELS.items()}
        descriptor = CATALOGUE.get(cell)
        return QTableWidgetItem(translate(known.get(cell, descriptor.label if descriptor else cell)))
    item = QTableWidgetItem("" if cell is None else number_text(cell, ".3g"))
    item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
    return item
