"""Table with a row per particle and a column per descriptor; sortable, filterable, multiple selection."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QItemSelectionModel, QModelIndex, Qt, Signal
from PySide6.QtWidgets import QAbstractItemView, QWidget

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.messages import N_
from regolith_studio.session.results import ParticleEntry
from regolith_studio.session.sample_table import Filter, form_of, has_weights, health_sentences, health_word
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import inert, number_text, tr, translate
from regolith_studio.ui.widgets.labels import plain_symbol, short_number
from regolith_studio.ui.widgets.table import (
    RIGHT,
    UNSORTED,
    ListTable,
    ParticleTableModel,
    definition,
    health_pixmaps,
)

HEALTH, FORM = "health", "form"
WEIGHT = "weight"
HEALTH_WORDS = (*(N_("sound"), N_("coarse"), N_("repaired"), N_("doubtful"), N_("unsound"), N_("unknown")),)
FORM_WORDS = (N_("equant"), N_("disc"), N_("rod"), N_("blade"))
WORDS = 4
"""Text columns, which precede those of numbers."""


@dataclass(frozen=True)
class SampleColumn:
    """Key, header and tool tip of a column; functions for its sort key and text."""

    key: str
    title: str
    tip: str
    value: Callable[[ParticleEntry], Any]
    text: Callable[[ParticleEntry], str]


def columns() -> tuple[SampleColumn, ...]:
    """Name, health, group and form, the available descriptors of the catalogue, and the weight."""
    words: tuple[tuple[str, str, str, Callable[[ParticleEntry], str]], ...] = (
        ("name", tr("Particle"), tr("Name of the file or of the grain"), lambda entry: entry.id),
        (
            HEALTH,
            tr("Health"),
            tr("Of the mesh; the tool tip of a cell lists what was found and repaired"),
            health_word,
        ),
        ("group", tr("Group"), tr("Sample or size fraction"), lambda entry: entry.particle.group),
        (FORM, tr("Form"), tr("Zingg's class: equant, disc, rod or blade"), form_of),
    )
    numbers = [row for row in CATALOGUE.values() if not row.costly]
    return (
        *(SampleColumn(key, title, tip, text, text) for key, title, tip, text in words),
        *(
            SampleColumn(
                row.key,
                plain_symbol(row.symbol) + row.unit_suffix,
                definition(row.key),
                _Number(row.key),
                _Formatted(row.key),
            )
            for row in numbers
        ),
        SampleColumn(
            WEIGHT,
            tr("weight"),
            tr(
                "Number of grains that it represents: large ones are more often cut by the border of the scan"
            ),
            lambda entry: entry.particle.weight,
            lambda entry: number_text(entry.particle.weight, ".3g"),
        ),
    )


class _Number:
    def __init__(self, key: str) -> None:
        self._key = key

    def __call__(self, entry: ParticleEntry) -> float:
        return float(entry.descriptors[self._key]) if entry.descriptors else -math.inf


class _Formatted(_Number):
    def __call__(self, entry: ParticleEntry) -> str:  # type: ignore[override]
        if not entry.descriptors:
            return "…"
        return short_number(entry.descriptors[self._key])


class SampleTableModel(ParticleTableModel):
    """Item model of the table."""

    def __init__(self, parent: QWidget) -> None:
        self.columns = columns()
        super().__init__(len(self.columns), parent)
        self._icons: dict[str, Any] = {}

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self._icons = health_pixmaps(theme)

    def value(self, entry: ParticleEntry, column: int) -> Any:
        return self.columns[column].value(entry)

    def cell(self, entry: ParticleEntry, column: int, role: int) -> Any:
        asked = self.columns[column]
        match role:
            case Qt.ItemDataRole.DisplayRole:
                return tr(asked.text(entry)) if asked.key in (HEALTH, FORM) else asked.text(entry)
            case Qt.ItemDataRole.DecorationRole if asked.key == HEALTH:
                return self._icons.get(health_word(entry))
            case Qt.ItemDataRole.ToolTipRole:
                return _tip(entry) if asked.key == HEALTH else inert(asked.text(entry))
            case Qt.ItemDataRole.TextAlignmentRole if column >= WORDS:
                return RIGHT
        return None

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> Any:
        if orientation == Qt.Orientation.Horizontal:
            match role:
                case Qt.ItemDataRole.DisplayRole:
                    return self.columns[section].title
                case Qt.ItemDataRole.ToolTipRole:
                    return self.columns[section].tip
                case Qt.ItemDataRole.TextAlignmentRole if section >= WORDS:
                    return RIGHT
        return None


def _tip(entry: ParticleEntry) -> str:
    return "\n".join(map(translate, health_sentences(entry)))


class SampleTable(ListTable):
    """Emits which particles are selected, and which one is current."""

    chosenChanged = Signal(list)  # noqa: N815
    currentChosen = Signal(str)  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("sample_table")
        self.setAccessibleName(tr("All particles"))
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.model_ = SampleTableModel(self)
        self.model_.set_theme(current_theme())
        self.setModel(self.model_)
        self.setSortingEnabled(True)
        self.horizontalHeader().setSortIndicator(UNSORTED, Qt.SortOrder.AscendingOrder)
        self._quiet = False
        self.selectionModel().selectionChanged.connect(lambda *_: self._announce())
        self.selectionModel().currentRowChanged.connect(lambda index, _old: self._announce_current(index))

    def set_entries(self, entries: tuple[ParticleEntry, ...]) -> None:
        """Show other particles and keep the selection."""
        chosen = self.chosen()
        self._quiet = True
        self.model_.set_entries(entries)
        self.setColumnHidden(2, len({entry.particle.group for entry in entries}) < 2)
        self.setColumnHidden(len(self.model_.columns) - 1, not has_weights(entries))
        self._quiet = False
        self.choose(chosen)
        self.fit_columns()

    def set_filter(self, keeps: Filter | None) -> None:
        """Show only the particles for which this is true."""
        chosen = self.chosen()
        self._quiet = True
        self.model_.set_filter(keeps)
        self._quiet = False
        self.choose(chosen)
        self._announce()

    def visible_entries(self) -> list[ParticleEntry]:
        """The listed particles, in the order of the rows."""
        return list(self.model_.rows)

    def chosen(self) -> list[str]:
        """Ids of the selected rows, from top to bottom."""
        rows = sorted(index.row() for index in self.selectionModel().selectedRows())
        return [self.model_.rows[row].id for row in rows]

    def choose(self, ids: Sequence[str], current: str = "") -> None:
        """Select these rows without emitting a signal."""
        wanted, flags = set(ids), QItemSelectionModel.SelectionFlag
        self._quiet = True
        self.selectionModel().clearSelection()
        for row, entry in enumerate(self.visible_entries()):
            index = self.model_.index(row, 0)
            if entry.id == current:
                self.selectionModel().setCurrentIndex(index, flags.NoUpdate)
                self.scrollTo(index)
            if entry.id in wanted:
                self.selectionModel().select(index, flags.Select | flags.Rows)
        self._quiet = False

    def _by_content(self) -> list[int]:
        return list(range(self.model_.columnCount()))

    def stretch(self) -> None:
        """Disabled: the table is scrolled horizontally."""

    def _announce(self) -> None:
        if not self._quiet:
            self.chosenChanged.emit(self.chosen())

    def _announce_current(self, index: QModelIndex) -> None:
        if not self._quiet and index.isValid():
            self.currentChosen.emit(self.model_.rows[index.row()].id)
