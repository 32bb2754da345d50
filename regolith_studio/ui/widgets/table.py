"""Tables with a row for each particle: columns, model and view, tips of descriptors."""

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import (
    QAbstractTableModel,
    QItemSelectionModel,
    QModelIndex,
    QObject,
    QPersistentModelIndex,
    Qt,
    Signal,
)
from PySide6.QtGui import QKeyEvent, QPixmap, QResizeEvent

from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import CATALOGUE, Descriptor
from regolith_studio.io.file_names import natural_key
from regolith_studio.messages import N_
from regolith_studio.session.results import ParticleEntry
from regolith_studio.session.sample_table import (
    Filter,
    form_of,
    has_weights,
    health_sentences,
    health_word,
    intervals_of,
)
from regolith_studio.ui.theme import Theme, current_theme, pixmap
from regolith_studio.ui.translation import inert, number_text, tr, translate
from regolith_studio.ui.widgets.labels import plain_symbol, short_number
from regolith_studio.ui.widgets.text_table import RIGHT, FittedTable

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
HEALTH, GROUP, FORM, WEIGHT = "health", "group", "form", "weight"
"""Keys of columns."""
HEALTH_WORDS = (*(N_("sound"), N_("coarse"), N_("repaired"), N_("doubtful"), N_("unsound"), N_("unknown")),)
FORM_WORDS = (N_("equant"), N_("disc"), N_("rod"), N_("blade"))
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


@dataclass(frozen=True)
class ParticleColumn:
    """Key, header and tool tip of a column; functions for its cells: sort key, text; numbers stand right."""

    key: str
    title: str
    tip: str
    value: Callable[[ParticleEntry], Any]
    text: Callable[[ParticleEntry], str]
    numeric: bool = False
    note: Callable[[ParticleEntry], str] | None = None
    """Tool tip of a cell, in place of its text."""


def particle_columns(*keys: str) -> tuple[ParticleColumn, ...]:
    """The columns of these keys, all by default: name, health, group, form, descriptors and weight."""
    descriptors = {row.key: _descriptor_column(row) for row in CATALOGUE.values() if not row.costly}
    columns = {column.key: column for column in (*_text_columns(), *descriptors.values(), _weight_column())}
    return tuple(columns[key] for key in keys or columns)


def _text_columns() -> Iterator[ParticleColumn]:
    name_tip = tr("Name of the file or of the grain")
    yield ParticleColumn("name", tr("Particle"), name_tip, lambda entry: entry.id, lambda entry: entry.id)
    health_tip = tr("Of the mesh; the tool tip of a cell lists what was found and repaired")
    yield ParticleColumn(HEALTH, tr("Health"), health_tip, health_word, lambda entry: tr(health_word(entry)))
    group: Callable[[ParticleEntry], str] = lambda entry: entry.particle.group  # noqa: E731
    yield ParticleColumn(GROUP, tr("Group"), tr("Sample or size fraction"), group, group)
    form_tip = tr("Zingg's class: equant, disc, rod or blade")
    yield ParticleColumn(FORM, tr("Form"), form_tip, form_of, lambda entry: tr(form_of(entry)))


def _descriptor_column(row: Descriptor) -> ParticleColumn:
    def value(entry: ParticleEntry) -> float:
        return float(entry.descriptors[row.key]) if entry.descriptors else -math.inf

    def text(entry: ParticleEntry) -> str:
        return short_number(entry.descriptors[row.key]) if entry.descriptors else "…"

    def note(entry: ParticleEntry) -> str:
        if row.key not in (ends := intervals_of(entry)):
            return text(entry)
        low, high = map(short_number, ends[row.key])
        return tr(
            "{value}; {low} to {high} in 90 % of grains of this size and noise",
            value=text(entry),
            low=low,
            high=high,
        )

    title = plain_symbol(row.symbol) + row.unit_suffix
    return ParticleColumn(row.key, title, definition(row.key), value, text, numeric=True, note=note)


def _weight_column() -> ParticleColumn:
    return ParticleColumn(
        WEIGHT,
        tr("weight"),
        tr("Number of grains that it represents: large ones are more often cut by the border of the scan"),
        lambda entry: entry.particle.weight,
        lambda entry: number_text(entry.particle.weight, ".3g"),
        numeric=True,
    )


PADDING = 6
"""Pixels between a number and the column before it, beside those of the style."""


class ParticleTableModel(QAbstractTableModel):
    """Particles as rows, sorted and filtered; the column of their health, or else the first, has its icon.

    Sorting and filtering is done here because a QSortFilterProxyModel calls three methods of a Python model
    for each of seven roles of a cell at each paint, and two for each comparison.
    """

    def __init__(self, columns: Sequence[ParticleColumn], parent: QObject) -> None:
        super().__init__(parent)
        self.columns = tuple(columns)
        self.entries: tuple[ParticleEntry, ...] = ()
        """All particles, in the order given."""
        self.rows: tuple[ParticleEntry, ...] = ()
        """The particles that are listed, from top to bottom."""
        self._icon_column = self.column(HEALTH) if HEALTH in [each.key for each in columns] else 0
        self._icons: dict[str, QPixmap] = {}
        self._column, self._order = UNSORTED, Qt.SortOrder.AscendingOrder
        self._keeps: Callable[[ParticleEntry], bool] | None = None

    def column(self, key: str) -> int:
        return [each.key for each in self.columns].index(key)

    def set_theme(self, theme: Theme) -> None:
        colours = {
            "sound": theme.good,
            "doubtful": theme.doubtful,
            "unsound": theme.bad,
            "unknown": theme.muted,
        }
        self._icons = {word: pixmap(name, colours[name], ICON_SIZE) for word, name in HEALTH_ICONS.items()}

    def set_entries(self, entries: Sequence[ParticleEntry]) -> None:
        """List other particles, or the same ones with new data."""
        self.entries = tuple(entries)
        rows = self._arranged()
        if not rows or {entry.id for entry in rows} != {entry.id for entry in self.rows}:
            self._reset(rows)
            return
        self._move(rows)
        self.dataChanged.emit(self.index(0, 0), self.index(len(rows) - 1, len(self.columns) - 1))

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
        entry, column = self.rows[index.row()], self.columns[index.column()]
        has_icon = index.column() == self._icon_column
        match role:
            case Qt.ItemDataRole.DisplayRole:
                return column.text(entry)
            case Qt.ItemDataRole.DecorationRole if has_icon:
                return self._icons.get(health_word(entry))
            case Qt.ItemDataRole.ToolTipRole:
                return self._health(entry) if has_icon else inert((column.note or column.text)(entry))
            case Qt.ItemDataRole.TextAlignmentRole if column.numeric:
                return RIGHT
        return None

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> Any:
        column = self.columns[section] if orientation == Qt.Orientation.Horizontal else None
        match role:
            case Qt.ItemDataRole.DisplayRole if column:
                return column.title
            case Qt.ItemDataRole.ToolTipRole if column:
                return column.tip
            case Qt.ItemDataRole.TextAlignmentRole if column and column.numeric:
                return RIGHT
        return None

    def _health(self, entry: ParticleEntry) -> str:
        """Sentences on the mesh; behind the name and the numbers, whose columns may be hidden."""
        sentences = list(map(translate, health_sentences(entry)))
        if self.columns[self._icon_column].key == HEALTH:
            return "\n".join(sentences)
        numbers = [f"{each.title} {each.text(entry)}" for each in self.columns if each.numeric]
        return inert("\n".join([entry.id, ", ".join(numbers), *sentences]))

    def index(self, row: int, column: int, parent: Index = NOWHERE) -> QModelIndex:
        """As Qt's, which calls `rowCount` and `columnCount` for each cell that is painted or measured."""
        there = 0 <= row < len(self.rows) and 0 <= column < len(self.columns) and not parent.isValid()
        return self.createIndex(row, column) if there else QModelIndex()

    def rowCount(self, parent: Index = NOWHERE) -> int:
        return 0 if parent.isValid() else len(self.rows)

    def columnCount(self, parent: Index = NOWHERE) -> int:
        return 0 if parent.isValid() else len(self.columns)

    def _arranged(self) -> tuple[ParticleEntry, ...]:
        kept = [entry for entry in self.entries if self._keeps is None or self._keeps(entry)]
        if self._column != UNSORTED:
            falling = self._order == Qt.SortOrder.DescendingOrder
            kept.sort(key=self._sort_key, reverse=falling)
        return tuple(kept)

    def _sort_key(self, entry: ParticleEntry) -> Any:
        value = self.columns[self._column].value(entry)
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


MEASURED = 100
"""Number of visible rows whose contents determine the width of columns."""


class ParticleTable(FittedTable):
    """The particles, sorted by a click on a header; emits which rows are selected and which one is current.

    Groups are listed where there are two, weights where one differs from 1. Columns are as wide as their
    contents, and scrolled to where there is no room for them.

    ``columns``: see :func:`particle_columns`. ``scrolls``: else those that have no room are not listed.
    """

    chosenChanged = Signal(list)  # noqa: N815
    currentChosen = Signal(str)  # noqa: N815

    def __init__(self, columns: Sequence[ParticleColumn], *, scrolls: bool = True) -> None:
        super().__init__()
        self.particles = ParticleTableModel(columns, self)
        self._scrolls, self._empty, self._widths = scrolls, frozenset[str](), [0] * len(columns)
        self.setModel(self.particles)
        self.set_theme(current_theme())
        header = self.horizontalHeader()
        header.setResizeContentsPrecision(MEASURED)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self.setSortingEnabled(True)
        self.horizontalHeader().setSortIndicator(UNSORTED, Qt.SortOrder.AscendingOrder)
        self._quiet = False
        self.selectionModel().selectionChanged.connect(lambda *_: self._announce())
        self.selectionModel().currentRowChanged.connect(lambda index, _old: self._announce_current(index))

    def set_theme(self, theme: Theme) -> None:
        self.particles.set_theme(theme)
        self.viewport().update()

    def set_entries(self, entries: Sequence[ParticleEntry]) -> None:
        """List other particles, or the same ones with new data, and keep the selection."""
        with self._kept_selection():
            self.particles.set_entries(entries)
            one_group = len({entry.particle.group for entry in entries}) < 2
            empty = {GROUP: one_group, WEIGHT: not has_weights(entries)}
            self._empty = frozenset(key for key, is_empty in empty.items() if is_empty)
        self.resizeColumnsToContents()

    def resizeColumnsToContents(self) -> None:
        header = self.horizontalHeader()
        for number in range(len(self.particles.columns)):
            self.setColumnHidden(number, False)  # a hidden one has no width
        header.setStretchLastSection(False)
        super().resizeColumnsToContents()
        self._widths = [header.sectionSize(number) + PADDING for number in range(header.count())]
        for number, width in enumerate(self._widths):
            header.resizeSection(number, width)
        header.setStretchLastSection(True)
        self._list_columns()

    def _list_columns(self) -> None:
        """Hide columns without a content, and those without room where the table does not scroll to them."""
        room = self.viewport().width()
        for number, (column, width) in enumerate(zip(self.particles.columns, self._widths, strict=True)):
            empty = column.key in self._empty
            room -= 0 if empty else width
            self.setColumnHidden(number, empty or (not self._scrolls and number > 0 and room < 0))
        if not self._scrolls:
            shown = [number for number in range(len(self._widths)) if not self.isColumnHidden(number)]
            left = self.viewport().width() - sum(self._widths[number] for number in shown)
            self.setColumnWidth(0, self._widths[0] + left)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if not self._scrolls:
            self._list_columns()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Ctrl+Shift with an arrow chooses column and order of the sorting: Qt's header takes no keys."""
        header, key, keys = self.horizontalHeader(), event.key(), Qt.Key
        modifiers = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
        if event.modifiers() & modifiers != modifiers or not keys.Key_Left <= key <= keys.Key_Down:
            super().keyPressEvent(event)
            return
        column, order = header.sortIndicatorSection(), header.sortIndicatorOrder()
        listed = [number for number in range(header.count()) if not header.isSectionHidden(number)]
        if column not in listed:
            column = listed[0]
        elif key in (keys.Key_Left, keys.Key_Right):
            step = 1 if key == keys.Key_Right else -1
            column = listed[(listed.index(column) + step) % len(listed)]
        if key in (keys.Key_Up, keys.Key_Down):
            order = Qt.SortOrder.AscendingOrder if key == keys.Key_Up else Qt.SortOrder.DescendingOrder
        self.sortByColumn(column, order)
        self.scrollTo(self.particles.index(max(self.currentIndex().row(), 0), column))

    def set_filter(self, keeps: Filter | None) -> None:
        """List only the particles for which this is true."""
        with self._kept_selection():
            self.particles.set_filter(keeps)
        self._announce()

    def chosen(self) -> list[str]:
        """Ids of the selected rows, from top to bottom."""
        rows = sorted(index.row() for index in self.selectionModel().selectedRows())
        return [self.particles.rows[row].id for row in rows]

    def choose(self, ids: Sequence[str], current: str = "") -> None:
        """Select these rows without emitting a signal."""
        wanted, flags = set(ids), QItemSelectionModel.SelectionFlag
        was_quiet, self._quiet = self._quiet, True
        self.selectionModel().clearSelection()
        for row, entry in enumerate(self.particles.rows):
            index = self.particles.index(row, 0)
            if entry.id == current:
                self.selectionModel().setCurrentIndex(index, flags.NoUpdate)
                self.scrollTo(index)
            if entry.id in wanted:
                self.selectionModel().select(index, flags.Select | flags.Rows)
        self._quiet = was_quiet

    @contextmanager
    def _kept_selection(self) -> Iterator[None]:
        chosen, self._quiet = self.chosen(), True
        yield
        self.choose(chosen)
        self._quiet = False

    def _announce(self) -> None:
        if not self._quiet:
            self.chosenChanged.emit(self.chosen())

    def _announce_current(self, index: QModelIndex) -> None:
        if not self._quiet and index.isValid():
            self.currentChosen.emit(self.particles.rows[index.row()].id)
