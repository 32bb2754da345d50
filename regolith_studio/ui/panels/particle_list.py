"""List of the open particles: name, group, volume, sphericity, aspect ratio, health of the mesh."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QItemSelectionModel, QModelIndex, QPoint, Qt, Signal
from PySide6.QtWidgets import QMenu, QVBoxLayout, QWidget

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.messages import N_
from regolith_studio.session.results import ParticleEntry
from regolith_studio.session.sample_table import health_sentences, health_word
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import inert, number_text, tr, translate
from regolith_studio.ui.widgets.labels import heading, remark, short_number
from regolith_studio.ui.widgets.table import (
    RIGHT,
    UNSORTED,
    ListTable,
    ParticleTableModel,
    definition,
    health_pixmaps,
)

WORDS = 2
"""Text columns, which precede those of numbers."""


@dataclass(frozen=True)
class ListColumn:
    """A column of the list.

    Parameters
    ----------
    title
        Header, with the unit.
    tip
        Tool tip of the header, or the key of the descriptor that it defines.
    key
        Sort key.
    text
        Text of a cell.
    """

    title: str
    tip: str
    key: Callable[[ParticleEntry], Any]
    text: Callable[[ParticleEntry], str]


def _descriptor(
    key: str, form: Callable[[float], str]
) -> tuple[Callable[[ParticleEntry], Any], Callable[[ParticleEntry], str]]:
    def value(entry: ParticleEntry) -> float:
        return float(entry.descriptors[key]) if entry.descriptors else float("-inf")

    def text(entry: ParticleEntry) -> str:
        return form(entry.descriptors[key]) if entry.descriptors else "…"

    return value, text


COLUMNS = (
    ListColumn(N_("Particle"), N_("Name and health of the mesh"), lambda e: e.id, lambda e: e.id),
    ListColumn(
        N_("Group"),
        N_("Sample or size fraction"),
        lambda e: e.particle.group,
        lambda e: e.particle.group,
    ),
    ListColumn(N_("V [µm³]"), "volume", *_descriptor("volume", lambda v: short_number(v, 3))),
    ListColumn("S", "sphericity", *_descriptor("sphericity", lambda v: number_text(v, ".3f"))),
    ListColumn("AR", "aspect_ratio", *_descriptor("aspect_ratio", lambda v: number_text(v, ".2f"))),
)


class _Model(ParticleTableModel):
    def __init__(self, parent: QWidget) -> None:
        super().__init__(len(COLUMNS), parent)
        self.icons: dict[str, Any] = {}

    def set_theme(self, theme: Theme) -> None:
        self.icons = health_pixmaps(theme)

    def value(self, entry: ParticleEntry, column: int) -> Any:
        return COLUMNS[column].key(entry)

    def cell(self, entry: ParticleEntry, column: int, role: int) -> Any:
        match role:
            case Qt.ItemDataRole.DisplayRole:
                return COLUMNS[column].text(entry)
            case Qt.ItemDataRole.DecorationRole if column == 0:
                return self.icons.get(health_word(entry))
            case Qt.ItemDataRole.ToolTipRole:
                values = [f"{tr(each.title)} {each.text(entry)}" for each in COLUMNS[WORDS:]]
                health = map(translate, health_sentences(entry))
                return inert("\n".join([entry.id, ", ".join(values), *health]))
            case Qt.ItemDataRole.TextAlignmentRole if column >= WORDS:
                return RIGHT
        return None

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> Any:
        if orientation == Qt.Orientation.Horizontal:
            match role:
                case Qt.ItemDataRole.DisplayRole:
                    return tr(COLUMNS[section].title)
                case Qt.ItemDataRole.ToolTipRole:
                    tip = COLUMNS[section].tip
                    return definition(tip) if tip in CATALOGUE else tr(tip)
                case Qt.ItemDataRole.TextAlignmentRole if section >= WORDS:
                    return RIGHT
        return None


def _title(entries: Sequence[ParticleEntry]) -> str:
    if not entries:
        return tr("Particles")
    if all(entry.particle.is_synthetic for entry in entries):
        return tr("Synthetic particles ({count})", count=len(entries))
    return tr("Particles ({count})", count=len(entries))


class ParticleListPanel(QWidget):
    """Selects the current particle."""

    FIELDS = ("selected",)
    valueChanged = Signal(dict)  # noqa: N815
    editingFinished = Signal()  # noqa: N815
    unitRequested = Signal(str)  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("particle_list")
        self._model = _Model(self)
        self._model.set_theme(current_theme())
        self.table = self._make_table()
        self._selected = ""
        self._quiet = False
        self.title = heading(tr("Particles"))
        self.title.setWordWrap(True)
        self.hint = remark(tr("Drop mesh files or folders anywhere in the window to open them."))
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.title)
        layout.addWidget(self.table, 1)
        layout.addWidget(self.hint)
        self.table.selectionModel().currentRowChanged.connect(self._clicked)

    def value(self) -> dict[str, str]:
        """The id of the current particle."""
        return {"selected": self._selected}

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Set the current particle."""
        self._selected = value["selected"]
        self._mark()

    def entries(self) -> tuple[ParticleEntry, ...]:
        """The listed particles."""
        return self._model.entries

    def set_entries(self, entries: Sequence[ParticleEntry]) -> None:
        """List other particles, or the same ones with new data."""
        entries = tuple(entries)
        if entries == self._model.entries:
            return
        self._quiet = True
        self._model.set_entries(entries)
        self.table.setColumnHidden(1, len({entry.particle.group for entry in entries}) < 2)
        self._quiet = False
        self._mark()
        self.table.fit_columns()
        self.title.setText(_title(entries))

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self._model.set_theme(theme)
        self.table.viewport().update()

    def _make_table(self) -> ListTable:
        table = ListTable(tuple(range(len(COLUMNS) - 1, WORDS - 1, -1)))
        table.setObjectName("particle_table")
        table.setAccessibleName(tr("Particles"))
        table.setModel(self._model)
        table.setSortingEnabled(True)
        table.horizontalHeader().setSortIndicator(UNSORTED, Qt.SortOrder.AscendingOrder)
        table.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        table.customContextMenuRequested.connect(self._show_menu)
        return table

    def _show_menu(self, place: QPoint) -> None:
        index = self.table.indexAt(place)
        if not index.isValid():
            return
        name = self._model.rows[index.row()].id
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.addAction(tr("Change length unit …"), lambda: self.unitRequested.emit(name))
        menu.popup(self.table.viewport().mapToGlobal(place))

    def _mark(self) -> None:
        row = next((r for r, entry in enumerate(self._model.rows) if entry.id == self._selected), -1)
        if row < 0:
            return
        index = self._model.index(row, 0)
        self._quiet = True
        flags = QItemSelectionModel.SelectionFlag
        self.table.selectionModel().setCurrentIndex(index, flags.ClearAndSelect | flags.Rows)
        self.table.scrollTo(index)
        self._quiet = False

    def _clicked(self, index: QModelIndex) -> None:
        if self._quiet or not index.isValid():
            return
        self._selected = self._model.rows[index.row()].id
        self.valueChanged.emit(self.value())
        self.editingFinished.emit()
