"""Particles as rows of a table, some of them and in some order."""

from collections.abc import Callable, Sequence
from typing import Any

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QObject, QPersistentModelIndex, Qt

from regolith_studio.session.results import ParticleEntry

Index = QModelIndex | QPersistentModelIndex
NOWHERE = QModelIndex()
UNSORTED = -1
RIGHT = int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
_TOLD = frozenset(
    map(
        int,
        (
            Qt.ItemDataRole.DisplayRole,
            Qt.ItemDataRole.DecorationRole,
            Qt.ItemDataRole.ToolTipRole,
            Qt.ItemDataRole.TextAlignmentRole,
        ),
    )
)
"""What tables tell of a cell; they are asked for four more things at each paint."""


class EntryRows(QAbstractTableModel):
    """Sorts and filters by itself; subclasses say what the columns are.

    A proxy of Qt's before a model in Python asks three of its functions for each of the seven things that it
    wants to know of a cell, at each paint, and sorts by asking for two values at a time.
    """

    def __init__(self, n_columns: int, parent: QObject) -> None:
        super().__init__(parent)
        self.entries: tuple[ParticleEntry, ...] = ()
        """All, in the order in which they were given."""
        self.rows: tuple[ParticleEntry, ...] = ()
        """Those that are listed, from top to bottom."""
        self._n_columns = n_columns
        self._column, self._order = UNSORTED, Qt.SortOrder.AscendingOrder
        self._keeps: Callable[[ParticleEntry], bool] | None = None

    def value(self, entry: ParticleEntry, column: int) -> Any:
        """What a column is sorted by; all values of a column can be compared."""
        raise NotImplementedError

    def set_entries(self, entries: Sequence[ParticleEntry]) -> None:
        """List other particles, or the same ones with more known about them."""
        self.entries = tuple(entries)
        rows = self._arranged()
        if not rows or {entry.id for entry in rows} != {entry.id for entry in self.rows}:
            self._reset(rows)
            return
        self._move(rows)
        self.dataChanged.emit(self.index(0, 0), self.index(len(rows) - 1, self._n_columns - 1))

    def set_filter(self, keeps: Callable[[ParticleEntry], bool] | None) -> None:
        """List only what this keeps."""
        self._keeps = keeps
        self._reset(self._arranged())

    def sort(self, column: int, order: Qt.SortOrder = Qt.SortOrder.AscendingOrder) -> None:
        """Sort by a column, equal ones as they were given; all as they were given with :data:`UNSORTED`."""
        self._column, self._order = column, order
        self._move(self._arranged())

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        if role not in _TOLD:
            return None
        return self.cell(self.rows[index.row()], index.column(), role)

    def cell(self, entry: ParticleEntry, column: int, role: int) -> Any:
        """What is told of a cell: its words, picture, alignment or tool tip; nothing where there is none."""
        raise NotImplementedError

    def index(self, row: int, column: int, parent: Index = NOWHERE) -> QModelIndex:
        """Qt's own asks how many rows and columns there are, for each cell that is painted or measured."""
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
            kept.sort(key=lambda entry: self.value(entry, self._column), reverse=falling)
        return tuple(kept)

    def _reset(self, rows: tuple[ParticleEntry, ...]) -> None:
        self.beginResetModel()
        self.rows = rows
        self.endResetModel()

    def _move(self, rows: tuple[ParticleEntry, ...]) -> None:
        """The same particles in another order; what is chosen stays chosen."""
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
