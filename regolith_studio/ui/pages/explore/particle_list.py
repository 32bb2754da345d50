"""List of the open particles."""

from collections.abc import Mapping, Sequence
from typing import Any

from PySide6.QtCore import QPoint, Qt, Signal
from PySide6.QtWidgets import QMenu, QVBoxLayout, QWidget

from regolith_studio.session.results import ParticleEntry
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import heading, hint_label
from regolith_studio.ui.widgets.table import ParticleTable, particle_columns

COLUMNS = ("name", "group", "volume", "sphericity", "aspect_ratio")


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
        self.table = ParticleTable(particle_columns(*COLUMNS))
        self.table.setObjectName("particle_table")
        self.table.setAccessibleName(tr("Particles"))
        self.table.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.table.customContextMenuRequested.connect(self._show_menu)
        self.table.currentChosen.connect(self._choose)
        self._selected = ""
        self.title = heading(tr("Particles"))
        self.title.setWordWrap(True)
        self.hint = hint_label(tr("Drop mesh files or folders anywhere in the window to open them."))
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.title)
        layout.addWidget(self.table, 1)
        layout.addWidget(self.hint)

    def value(self) -> dict[str, str]:
        """The id of the current particle."""
        return {"selected": self._selected}

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Set the current particle."""
        self._selected = value["selected"]
        self._mark()

    def entries(self) -> tuple[ParticleEntry, ...]:
        """The listed particles."""
        return self.table.particles.entries

    def set_entries(self, entries: Sequence[ParticleEntry]) -> None:
        """List other particles, or the same ones with new data."""
        if tuple(entries) != self.entries():
            self.table.set_entries(entries)
            self._mark()
            self.title.setText(_title(entries))

    def _show_menu(self, place: QPoint) -> None:
        index = self.table.indexAt(place)
        if not index.isValid():
            return
        name = self.table.particles.rows[index.row()].id
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.addAction(tr("Change length unit …"), lambda: self.unitRequested.emit(name))
        menu.popup(self.table.viewport().mapToGlobal(place))

    def _mark(self) -> None:
        if any(entry.id == self._selected for entry in self.entries()):
            self.table.choose([self._selected], self._selected)

    def _choose(self, name: str) -> None:
        self._selected = name
        self.valueChanged.emit(self.value())
        self.editingFinished.emit()
