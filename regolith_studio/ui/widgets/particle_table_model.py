"""Item model with a row per particle, filtered and sorted, and the icons of its column of health."""

from collections.abc import Callable, Sequence
from typing import Any

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QObject, QPersistentModelIndex, Qt
from PySide6.QtGui import QPixmap

from regolith_studio.io.natural_order import natural_key
from regolith_studio.session.results import ParticleEntry
from regolith_studio.ui.icons import pixmap
from regolith_studio.ui.theme import Theme

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
