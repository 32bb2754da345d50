"""Gallery of polyhedra with a row per loss function and a column per particle, as in Fig. 7."""

from collections.abc import Sequence

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QSize, Qt, QTimer
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QStackedLayout,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTableWidget,
    QTableWidgetItem,
    QWidget,
)

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.jobs.study_jobs import GalleryCell
from regolith_studio.messages import N_
from regolith_studio.session.choices import Choices
from regolith_studio.session.results import ParticleEntry
from regolith_studio.studies.coarsening import CoarseningStudy
from regolith_studio.studies.loss_variants import LossVariant
from regolith_studio.ui.pages.studies.plots import coarsening_record, study_card, study_panel
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import inert, number_text, tr
from regolith_studio.ui.widgets.heat_table import centred_hint
from regolith_studio.ui.widgets.result_view import ResultRecord
from regolith_studio.ui.widgets.thumbnails import Painting, paint_thumbnail, thumbnail

SIZE = 120
FONT_SIZE = 22
"""Pixels below a picture."""
WAITING = N_(
    "Six particles from the selected one on, and below them their polyhedra, one row per loss function."
)
Index = QModelIndex | QPersistentModelIndex
MAX_PARTICLES = 6
"""Maximum number of columns."""


class GalleryPanel(QWidget):
    """A table of thumbnails that is filled while polyhedra are computed."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("solid_gallery")
        self._cells: tuple[GalleryCell, ...] = ()
        self._particles: tuple[ParticleEntry, ...] = ()
        self._theme = current_theme()
        self._painting: tuple[int, Painting] | None = None
        self._timer = QTimer(self, interval=0)
        self._timer.timeout.connect(self._paint_on)
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
        self.card = study_card("solids", tr("Polyhedra"))
        study_panel(self, self.card, self._parts)

    def clear(self) -> None:
        """Show that there are no polyhedra."""
        self._cells, self._particles = (), ()
        self._timer.stop()
        self._stack.setCurrentIndex(0)

    def begin(self, particles: Sequence[ParticleEntry], labels: Sequence[str]) -> None:
        """Show particles, and below them empty cells for each loss."""
        self._cells, self._particles = (), tuple(particles)
        self._stack.setCurrentWidget(self.table)
        self.table.clear()
        self.table.setRowCount(1 + len(labels))
        self.table.setColumnCount(len(particles))
        self.table.setVerticalHeaderLabels([tr("Particle"), *labels])
        self.table.setHorizontalHeaderLabels([entry.id for entry in particles])
        self._paint_particles()

    def show_cells(self, cells: Sequence[GalleryCell]) -> None:
        """Fill the cells of new polyhedra."""
        for cell in cells[len(self._cells) :]:
            self.table.setItem(cell.row + 1, cell.column, self._cell(cell))
        self._cells = tuple(cells)

    def value(self) -> tuple[GalleryCell, ...]:
        """The polyhedra that are shown."""
        return self._cells

    @property
    def total(self) -> int:
        """How many there will be."""
        return len(self._particles) * (self.table.rowCount() - 1)

    def record(self, choices: Choices, rows: Sequence[LossVariant]) -> ResultRecord:
        """How many polyhedra there are, and what they were made from and with."""
        study = CoarseningStudy(tuple(rows), tuple(entry.id for entry in self._particles))
        return coarsening_record(study, choices, (f"{len(self._cells)} / {self.total}",))

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        if theme != self._theme:
            self._theme = theme
            for cell in self._cells:
                self.table.setItem(cell.row + 1, cell.column, self._cell(cell))
            self._paint_particles()

    def _paint_particles(self) -> None:
        """Begin to paint the first row, in steps, as particles may have many triangles."""
        self._painting = None
        self._waiting = list(range(len(self._particles)))
        self._timer.start()

    def _paint_on(self) -> None:
        if self._painting is None:
            if not self._waiting:
                self._timer.stop()
                return
            column = self._waiting.pop(0)
            mesh = self._particles[column].particle.mesh
            self._painting = column, paint_thumbnail(mesh, self._theme.particle, SIZE)
        column, painting = self._painting
        try:
            next(painting)
        except StopIteration as end:
            item = QTableWidgetItem()
            item.setIcon(QIcon(end.value))
            self.table.setItem(0, column, item)
            self._painting = None

    def _cell(self, cell: GalleryCell) -> QTableWidgetItem:
        found = cell.outcome.coarsened
        item = QTableWidgetItem()
        item.setTextAlignment(Qt.AlignmentFlag.AlignCenter)
        if found is None:
            item.setText("–")
            item.setToolTip(inert(cell.outcome.problem or ""))
            return item
        item.setIcon(QIcon(thumbnail(found.mesh, self._theme.polyhedron, SIZE)))
        item.setText(f"Jaccard {number_text(found.jaccard_distance, '.1%')}")
        worst = "\n".join(
            f"{tr(CATALOGUE[key].label)}: {number_text(error, '.2%')}" for key, error in found.errors.items()
        )
        item.setToolTip(
            tr(
                "{count} facets, Jaccard distance {distance:.1%}, loss of this row {loss:.3g}",
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
