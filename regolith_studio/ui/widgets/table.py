"""Tables with columns of descriptors, and the model of those with a row for each particle."""

from collections.abc import Callable, Sequence
from typing import Any

from PySide6.QtCore import QAbstractTableModel, QEvent, QModelIndex, QObject, QPersistentModelIndex, Qt
from PySide6.QtGui import QPixmap, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableView

from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.io.natural_order import natural_key
from regolith_studio.messages import N_
from regolith_studio.session.results import ParticleEntry
from regolith_studio.ui.icons import pixmap
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import plain_symbol

EQUATIONS = {"sphericity": 1, "aspect_ratio": 2, JACCARD: 7}
"""Numbers in the paper, by key."""
DEFINITIONS = {
    "volume": N_("volume that the surface encloses"),
    "surface_area": N_("area of the surface"),
    "convex_hull_volume": N_("volume of the convex hull"),
    JACCARD: N_("1 − volume of the intersection / volume of the union"),
}
"""In place of a formula that only repeats the symbol."""


def definition(key: str) -> str:
    """Symbol, name, definition and equation of a descriptor or of the Jaccard distance."""
    symbol = "J" if key == JACCARD else plain_symbol(CATALOGUE[key].symbol)
    name = tr("Jaccard distance") if key == JACCARD else tr(CATALOGUE[key].label)
    formula = tr(DEFINITIONS[key]) if key in DEFINITIONS else tr(CATALOGUE[key].formula)
    words = tr("{symbol}, {name}: {formula}", symbol=symbol, name=name, formula=plain_symbol(formula))
    return tr("{words} (Eq. {number})", words=words, number=EQUATIONS[key]) if key in EQUATIONS else words


Index = QModelIndex | QPersistentModelIndex
NOWHERE = QModelIndex()
UNSORTED = -1
RIGHT = int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
HEALTH_ICONS = {
    "sound": "sound",
    "coarse": "doubtful",
    "repaired": "doubtful",
    "doubtful": "doubtful",
    "unsound": "unsound",
    "unknown": "unknown",
}
"""Icon name for each value of :func:`regolith_studio.session.sample_table.health_word`."""
ICON_SIZE = 15
_ROLES = frozenset(
    int(role)
    for role in (
        Qt.ItemDataRole.DisplayRole,
        Qt.ItemDataRole.DecorationRole,
        Qt.ItemDataRole.ToolTipRole,
        Qt.ItemDataRole.TextAlignmentRole,
    )
)
"""Roles that have data; views ask for four more at each paint."""


class ParticleTableModel(QAbstractTableModel):
    """Particles as rows, sorted and filtered; subclasses define the columns.

    Sorting and filtering is done here because a QSortFilterProxyModel calls three methods of a Python model
    for each of seven roles of a cell at each paint, and two for each comparison.
    """

    def __init__(self, n_columns: int, parent: QObject) -> None:
        super().__init__(parent)
        self.entries: tuple[ParticleEntry, ...] = ()
        """All particles, in the order given."""
        self.rows: tuple[ParticleEntry, ...] = ()
        """The particles that are listed, from top to bottom."""
        self._n_columns = n_columns
        self._column, self._order = UNSORTED, Qt.SortOrder.AscendingOrder
        self._keeps: Callable[[ParticleEntry], bool] | None = None

    def value(self, entry: ParticleEntry, column: int) -> Any:
        """Sort key of a column."""
        raise NotImplementedError

    def set_entries(self, entries: Sequence[ParticleEntry]) -> None:
        """List other particles, or the same ones with new data."""
        self.entries = tuple(entries)
        rows = self._arranged()
        if not rows or {entry.id for entry in rows} != {entry.id for entry in self.rows}:
            self._reset(rows)
            return
        self._move(rows)
        self.dataChanged.emit(self.index(0, 0), self.index(len(rows) - 1, self._n_columns - 1))

    def set_filter(self, keeps: Callable[[ParticleEntry], bool] | None) -> None:
        """List only the particles for which this is true."""
        self._keeps = keeps
        self._reset(self._arranged())

    def sort(self, column: int, order: Qt.SortOrder = Qt.SortOrder.AscendingOrder) -> None:
        """Sort by a column (stable); :data:`UNSORTED` restores the order given."""
        self._column, self._order = column, order
        self._move(self._arranged())

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        if role not in _ROLES:
            return None
        return self.cell(self.rows[index.row()], index.column(), role)

    def cell(self, entry: ParticleEntry, column: int, role: int) -> Any:
        """Text, icon, alignment or tool tip of a cell, by role; ``None`` where it has none."""
        raise NotImplementedError

    def index(self, row: int, column: int, parent: Index = NOWHERE) -> QModelIndex:
        """As Qt's, which calls `rowCount` and `columnCount` for each cell that is painted or measured."""
        there = 0 <= row < len(self.rows) and 0 <= column < self._n_columns and not parent.isValid()
        return self.createIndex(row, column) if there else QModelIndex()

    def rowCount(self, parent: Index = NOWHERE) -> int:
        return 0 if parent.isValid() else len(self.rows)

    def columnCount(self, parent: Index = NOWHERE) -> int:
        return 0 if parent.isValid() else self._n_columns

    def _arranged(self) -> tuple[ParticleEntry, ...]:
        kept = [entry for entry in self.entries if self._keeps is None or self._keeps(entry)]
        if self._column != UNSORTED:
            falling = self._order == Qt.SortOrder.DescendingOrder
            kept.sort(key=self._sort_key, reverse=falling)
        return tuple(kept)

    def _sort_key(self, entry: ParticleEntry) -> Any:
        value = self.value(entry, self._column)
        return natural_key(value) if isinstance(value, str) else value

    def _reset(self, rows: tuple[ParticleEntry, ...]) -> None:
        self.beginResetModel()
        self.rows = rows
        self.endResetModel()

    def _move(self, rows: tuple[ParticleEntry, ...]) -> None:
        """List the same particles in another order; the selection is kept."""
        before = [entry.id for entry in self.rows]
        places = {entry.id: row for row, entry in enumerate(rows)}
        if before == list(places):
            self.rows = rows
            return
        self.layoutAboutToBeChanged.emit()
        old = self.persistentIndexList()
        self.rows = rows
        new = [self.index(places[before[index.row()]], index.column()) for index in old]
        self.changePersistentIndexList(old, new)
        self.layoutChanged.emit()


def health_pixmaps(theme: Theme) -> dict[str, QPixmap]:
    """The icons in the colours of a theme, by value of health."""
    colours = {
        "sound": theme.good,
        "doubtful": theme.doubtful,
        "unsound": theme.bad,
        "unknown": theme.muted,
    }
    return {word: pixmap(name, colours[name], ICON_SIZE) for word, name in HEALTH_ICONS.items()}


_LEAST = 70
_NAME = 18
"""Width in digits that the first column may require before others are hidden; includes an icon."""


class FontRowHeight(QObject):
    """Keeps the row height of a table that of its font.

    Parameters
    ----------
    spare
        Additional pixels of a row.
    """

    def __init__(self, table: QTableView, spare: int) -> None:
        super().__init__(table)
        self._table, self._spare, self._lines = table, spare, 1
        table.installEventFilter(self)
        self._fit()

    def set_lines(self, lines: int) -> None:
        """Set the number of text lines in each row."""
        self._lines = lines
        self._fit()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.FontChange:
            self._fit()
        return super().eventFilter(watched, event)

    def _fit(self) -> None:
        height = self._lines * self._table.fontMetrics().height() + self._spare
        rows = self._table.verticalHeader()
        if rows.defaultSectionSize() != height:
            rows.setDefaultSectionSize(height)


MEASURED = 100
"""Number of visible rows whose contents determine the width of columns."""


class ListTable(QTableView):
    """A table with single row selection, compact rows, without grid and row numbers.

    Parameters
    ----------
    dispensable
        Columns that are hidden, in this order, while the names in the first one do not fit.
    """

    _unfitted = True
    """Contents or font have changed while the table was hidden."""

    def __init__(self, dispensable: tuple[int, ...] = ()) -> None:
        super().__init__()
        self._dispensable = dispensable
        self._left_out: dict[int, int] = {}
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setShowGrid(False)
        self.setTabKeyNavigation(False)
        self.setWordWrap(False)
        self.setTextElideMode(Qt.TextElideMode.ElideMiddle)  # names of a sample differ at their end
        self.verticalHeader().hide()
        FontRowHeight(self, 9)
        header = self.horizontalHeader()
        header.setHighlightSections(False)
        header.setResizeContentsPrecision(MEASURED)
        header.setMinimumSectionSize(30)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        header.setSectionResizeMode(QHeaderView.ResizeMode.Interactive)

    def fit_columns(self) -> None:
        """Fit the columns to their contents and stretch the first one, as soon as the table is visible."""
        self._unfitted = not self.isVisible()
        if self.isVisible():
            self._fit()

    def _fit(self) -> None:
        for column in self._left_out:
            self.setColumnHidden(column, False)
        self._left_out.clear()
        for column in self._by_content():
            self.resizeColumnToContents(column)
        self.stretch()

    def stretch(self) -> None:
        """Stretch the first column."""
        header = self.horizontalHeader()
        taken = self._make_room()
        if header.count():
            header.resizeSection(0, max(_LEAST, self.viewport().width() - taken))

    def _make_room(self) -> int:
        """Hide or show dispensable columns; returns the width of all but the first."""
        header = self.horizontalHeader()
        widths = {column: header.sectionSize(column) for column in self._by_content()} | self._left_out
        names = min(self.sizeHintForColumn(0), self.fontMetrics().horizontalAdvance("0" * _NAME))
        for column in self._dispensable:
            if column not in widths:  # hidden for another reason
                continue
            short = self.viewport().width() - sum(widths.values()) < names
            if short:
                self._left_out[column] = widths.pop(column)
            elif column in self._left_out:
                del self._left_out[column]
            if self.isColumnHidden(column) != short:
                self.setColumnHidden(column, short)
        return sum(widths.values())

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if not self._unfitted:
            self.stretch()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self.fit_columns()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        if self._unfitted:
            self._unfitted = False
            self._fit()

    def _by_content(self) -> list[int]:
        """Visible columns but the first."""
        header = self.horizontalHeader()
        return [at for at in range(1, header.count()) if not header.isSectionHidden(at)]
