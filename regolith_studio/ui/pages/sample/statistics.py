"""Statistics of groups of particles, by number or by volume."""

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QComboBox,
    QHeaderView,
    QLabel,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.descriptors.distributions import WEIGHTINGS
from regolith_studio.io.tables import Column, Table
from regolith_studio.messages import N_
from regolith_studio.session.results import ParticleEntry
from regolith_studio.session.sample_table import has_weights, statistics_table
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.definitions import definition
from regolith_studio.ui.widgets.labels import short_number
from regolith_studio.ui.widgets.table import FontRowHeight
from regolith_studio.ui.widgets.wrapping_row import WrappingRow

_WEIGHTING_LABELS = {"number": N_("each counts once"), "volume": N_("weighted by volume")}
_SHORT = {
    "group": N_("group"),
    "count": N_("count"),
    "mean": N_("mean"),
    "standard deviation": N_("std. dev."),
}
QUANTILE = " quantile"
GROUPS = (N_("all"), N_("(no group)"))
"""Group names that are translated."""


class StatisticsPanel(QWidget):
    """A table with a row per group."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("statistics")
        self._entries: tuple[ParticleEntry, ...] = ()
        self.key = QComboBox()
        self.key.setObjectName("statistics_key")
        self.key.setAccessibleName(tr("Descriptor of the statistics"))
        for key, row in CATALOGUE.items():
            if not row.costly:
                self.key.addItem(tr(row.label), key)
                self.key.setItemData(self.key.count() - 1, definition(key), Qt.ItemDataRole.ToolTipRole)
        self.weighting = QComboBox()
        self.weighting.setObjectName("statistics_weighting")
        self.weighting.setAccessibleName(tr("Weighting of the statistics"))
        for weighting in WEIGHTINGS:
            self.weighting.addItem(tr(_WEIGHTING_LABELS[weighting]), weighting)
        self.border = QCheckBox(tr("correct for border grains"))
        self.border.setObjectName("statistics_border")
        self.border.setToolTip(
            tr(
                "Grains cut by the border of the scan were left out, large ones more often than "
                "small ones. The others have larger weights in return (Miles-Lantuéjoul)."
            )
        )
        self.border.setChecked(True)
        self.border.hide()
        self.table = QTableWidget()
        self.table.setAccessibleName(tr("Statistics of groups"))
        self.table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setShowGrid(False)
        self.table.verticalHeader().hide()
        FontRowHeight(self.table, 8)
        self.table.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        choices = (QLabel(tr("Statistics of")), self.key, self.weighting)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(WrappingRow(choices, (self.border,), margins=(0, 0, 0, 0)))
        layout.addWidget(self.table, 1)
        self.key.currentIndexChanged.connect(lambda _at: self._fill())
        self.weighting.currentIndexChanged.connect(lambda _at: self._fill())
        self.border.toggled.connect(lambda _on: self._fill())

    def show_entries(self, entries: Sequence[ParticleEntry]) -> None:
        """Show the statistics of other particles."""
        self._entries = tuple(entries)
        self.border.setVisible(has_weights(entries))
        self._fill()

    def value(self) -> Table:
        """The statistics."""
        return statistics_table(
            self._entries, self.key.currentData(), self.weighting.currentData(), self.border.isChecked()
        )

    def _fill(self) -> None:
        shown = self.value()
        self.table.setColumnCount(len(shown.columns))
        self.table.setRowCount(len(shown.rows))
        self.table.setHorizontalHeaderLabels([_two_lines(each) for each in shown.columns])
        for at, row in enumerate(shown.rows):
            for column, cell in enumerate(row):
                item = QTableWidgetItem(short_number(cell) if isinstance(cell, float) else _word(cell))
                if column:
                    item.setTextAlignment(Qt.AlignmentFlag.AlignCenter)
                self.table.setItem(at, column, item)


def _word(cell: object) -> str:
    """The name of a group, translated if it is one of the program."""
    return tr(str(cell))


def _two_lines(column: Column) -> str:
    """Header with the unit on a second line."""
    name = tr(_SHORT.get(column.name, column.name))
    if column.name.endswith(QUANTILE):
        name = tr("{share} quant.", share=column.name.removesuffix(QUANTILE))
    unit = column.unit
    for plain, sign in (("um", "µm"), ("^2", "²"), ("^3", "³"), ("^5", "⁵")):
        unit = unit.replace(plain, sign)
    return f"{name}\n[{unit}]" if unit else name
