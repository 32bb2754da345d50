"""Gallery of polyhedra with a row per loss function and a column per particle, as in Fig. 7."""

from collections.abc import Sequence

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QSize, Qt
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QStackedLayout,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.jobs.study_jobs import GalleryCell
from regolith_studio.messages import N_
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import inert, number_text, tr
from regolith_studio.ui.widgets.heat_table import centred_hint
from regolith_studio.ui.widgets.study_frame import StudyFrame
from regolith_studio.ui.widgets.thumbnails import thumbnail

SIZE = 120
FONT_SIZE = 22
"""Pixels below a picture."""
WAITING = N_("The polyhedra of six particles, one row per loss function.")
Index = QModelIndex | QPersistentModelIndex
MAX_PARTICLES = 6
"""Maximum number of columns."""


class GalleryPanel(QWidget):
    """A table of thumbnails that is filled while polyhedra are computed."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("solid_gallery")
        self._cells: tuple[GalleryCell, ...] = ()
        self._colour = current_theme().polyhedron
        self.table = QTableWidget()
        self.table.setAccessibleName(tr("Polyhedra by loss function and particle"))
        self.table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        self.table.setShowGrid(False)
        self.table.setItemDelegate(_PictureAbove(self.table))
        self.table.setIconSize(self.table.iconSize().expandedTo(picture_size()))
        self.table.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        self.table.verticalHeader().setDefaultSectionSize(SIZE + FONT_SIZE)
        self.table.verticalHeader().setMaximumWidth(190)
        self.table.verticalHeader().setDefaultAlignment(
            Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter | Qt.TextFlag.TextWordWrap
        )
        self._parts = QWidget()
        self._stack = QStackedLayout(self._parts)
        self._stack.addWidget(centred_hint(tr(WAITING)))
        self._stack.addWidget(self.table)
        self.frame = StudyFrame("solids", self._parts)
        self.frame.set_hint(tr("for the particle on screen and those after it, one row per loss function"))
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.frame, 1)

    def begin(self, names: Sequence[str], labels: Sequence[str]) -> None:
        """Show empty cells for these particles and losses."""
        self._cells = ()
        self._stack.setCurrentWidget(self.table)
        self.table.clear()
        self.table.setRowCount(len(labels))
        self.table.setColumnCount(len(names))
        self.table.setVerticalHeaderLabels(list(labels))
        self.table.setHorizontalHeaderLabels(list(names))

    def show_cells(self, cells: Sequence[GalleryCell]) -> None:
        """Fill the cells of new polyhedra."""
        for cell in cells[len(self._cells) :]:
            self.table.setItem(cell.row, cell.column, self._cell(cell))
        self._cells = tuple(cells)

    def value(self) -> tuple[GalleryCell, ...]:
        """The polyhedra that are shown."""
        return self._cells

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        if theme.polyhedron != self._colour:
            self._colour = theme.polyhedron
            for cell in self._cells:
                self.table.setItem(cell.row, cell.column, self._cell(cell))

    def _cell(self, cell: GalleryCell) -> QTableWidgetItem:
        found = cell.outcome.coarsened
        item = QTableWidgetItem()
        item.setTextAlignment(Qt.AlignmentFlag.AlignCenter)
        if found is None:
            item.setText("–")
            item.setToolTip(inert(cell.outcome.problem or ""))
            return item
        item.setIcon(QIcon(thumbnail(found.mesh, self._colour, SIZE)))
        item.setText(f"J {number_text(found.jaccard_distance, '.1%')}")
        worst = "\n".join(
            f"{tr(CATALOGUE[key].label)}: {number_text(error, '.2%')}" for key, error in found.errors.items()
        )
        item.setToolTip(
            tr(
                "{count} facets, Jaccard distance J = {distance:.1%}, loss of this row {loss:.3g}",
                count=found.n_facets,
                distance=found.jaccard_distance,
                loss=found.loss,
            )
            + f"\n{worst}"
        )
        return item


class _PictureAbove(QStyledItemDelegate):
    """Places the text of a cell below its picture."""

    def initStyleOption(self, option: QStyleOptionViewItem, index: Index) -> None:
        super().initStyleOption(option, index)
        option.decorationPosition = QStyleOptionViewItem.Position.Top
        option.decorationAlignment = Qt.AlignmentFlag.AlignCenter
        option.displayAlignment = Qt.AlignmentFlag.AlignCenter


def picture_size() -> QSize:
    """Size of a thumbnail."""
    return QSize(SIZE, SIZE)
