"""Table of the descriptors of particle, fit and polyhedron, with units."""

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
from regolith_studio.messages import N_
from regolith_studio.session.results import Results
from regolith_studio.ui.translation import tr
from regolith_studio.ui.translation.numbers import number_text
from regolith_studio.ui.widgets.definitions import definition
from regolith_studio.ui.widgets.labels import plain_symbol, short_number
from regolith_studio.ui.widgets.table import FontRowHeight

COLUMNS = (N_("Particle"), N_("Fit"), N_("Polyhedron"))
NARROW_COLUMNS = (N_("Particle"), N_("Fit"), N_("Solid"))
_MIN_LABEL_WIDTH = 490
_NARROW_DIGITS = 44
"""Width in digits below which headers and numbers are short."""
_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
DIGITS, NARROW_DIGITS = 4, 3
"""Significant digits of the numbers; tool tips have six."""


class DescriptorTablePanel(QWidget):
    """A table with a row per descriptor of the catalogue."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("descriptor_table")
        self._keys = [key for key, row in CATALOGUE.items() if not row.costly]
        self.table = QTableWidget(len(self._keys), len(COLUMNS))
        self.table.setAccessibleName(tr("Descriptors"))
        self.table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        self.table.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.table.setShowGrid(False)
        self.table.setFrameShape(self.table.Shape.NoFrame)
        header = self.table.horizontalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        header.setDefaultAlignment(_RIGHT)
        FontRowHeight(self.table, 9)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.table)
        self._values: tuple[Mapping[str, float] | None, ...] = (None,) * len(COLUMNS)
        self._name_rows()

    def show_results(self, results: Results) -> None:
        """Fill the table from these results."""
        done = results.coarsened
        achieved = done.achieved if done else None
        self._values = (results.particle_descriptors, results.fit_descriptors, achieved)
        self._fill()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._name_rows()
        self._fill()

    @property
    def _narrow(self) -> bool:
        return self.width() < self.fontMetrics().horizontalAdvance("0" * _NARROW_DIGITS)

    def _fill(self) -> None:
        digits = NARROW_DIGITS if self._narrow else DIGITS
        for column, values in enumerate(self._values):
            for row, key in enumerate(self._keys):
                self.table.setItem(row, column, _cell(values, key, digits))

    def _name_rows(self) -> None:
        for column, name in enumerate(NARROW_COLUMNS if self._narrow else COLUMNS):
            head = QTableWidgetItem(tr(name))
            head.setToolTip(tr(COLUMNS[column]))
            head.setTextAlignment(_RIGHT)
            self.table.setHorizontalHeaderItem(column, head)
        for number, key in enumerate(self._keys):
            row = CATALOGUE[key]
            short = plain_symbol(row.symbol) + row.unit_suffix
            item = QTableWidgetItem(f"{tr(row.label)} {short}" if self.width() > _MIN_LABEL_WIDTH else short)
            item.setToolTip(definition(key))
            self.table.setVerticalHeaderItem(number, item)


def _cell(values: Mapping[str, float] | None, key: str, digits: int) -> QTableWidgetItem:
    known = values is not None and key in values
    item = QTableWidgetItem(short_number(values[key], digits) if values is not None and known else "–")
    if values is not None and known:
        item.setToolTip(number_text(values[key], ".6g"))
    item.setTextAlignment(_RIGHT)
    return item
