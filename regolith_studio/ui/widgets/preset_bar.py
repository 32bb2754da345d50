"""A list of presets with a mark where values have moved since, a way back, and own presets."""

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QSignalBlocker, Qt, Signal
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QInputDialog, QMenu, QPushButton, QToolButton, QVBoxLayout, QWidget

from regolith_studio.ui.translation import mark, tr
from regolith_studio.ui.widgets.choice_box import ElidedBox, FoldingRow

MODIFIED = mark("{preset} (modified)")


@dataclass(frozen=True)
class PresetEntry:
    """One line of the list.

    Parameters
    ----------
    key
        That is told; `label` is shown, `tip` when the mouse rests.
    own
        Whether the user has saved it, and may delete it.
    """

    key: str
    label: str
    tip: str = ""
    own: bool = False


class PresetBar(QWidget):
    """Tells what is asked for; its owner keeps values and presets.

    Parameters
    ----------
    name
        Object name of the list; begins those of the buttons.
    accessible
        What kind of presets, in plain words.
    """

    chosen = Signal(str)
    resetRequested = Signal()  # noqa: N815
    saveRequested = Signal(str)  # noqa: N815
    deleteRequested = Signal(str)  # noqa: N815

    def __init__(self, name: str, accessible: str) -> None:
        super().__init__()
        self._entries: tuple[PresetEntry, ...] = ()
        self.box = ElidedBox(Qt.TextElideMode.ElideMiddle)  # the mark at the end must be seen
        self.box.setObjectName(name)
        self.box.setAccessibleName(accessible)
        self.reset = QPushButton(tr("Reset"))
        self.reset.setToolTip(tr("Back to the values of the preset"))
        self.more = QToolButton()
        self.more.setText("⋯")
        self.more.setObjectName(f"{name}_more")
        self.more.setAccessibleName(tr("Save or delete a preset"))
        self.more.setToolTip(tr("Save or delete a preset of your own"))
        self.more.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.more.setMenu(self._menu())
        self._make_room()
        self._row = FoldingRow(self.box, (self.reset, self.more))
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self._row)
        self.box.activated.connect(lambda _: self.chosen.emit(self.current()))
        self.reset.clicked.connect(self.resetRequested)

    def current(self) -> str:
        """Key of the line that is chosen; empty where there is none."""
        return str(self.box.currentData() or "")

    def set_entries(self, entries: Sequence[PresetEntry]) -> None:
        """List these."""
        if tuple(entries) == self._entries:
            return
        self._entries = tuple(entries)
        with QSignalBlocker(self.box):
            self.box.clear()
            for row, entry in enumerate(self._entries):
                self.box.addItem(entry.label, entry.key)
                self.box.setItemData(row, entry.tip, Qt.ItemDataRole.ToolTipRole)
        self._row.refold()

    def show_state(self, key: str, modified: bool) -> None:
        """Mark the preset that the values come from, and whether they have moved since."""
        with QSignalBlocker(self.box):
            self.box.setCurrentIndex(self.box.findData(key))
            for row, entry in enumerate(self._entries):
                moved = modified and entry.key == key
                self.box.setItemText(row, tr(MODIFIED, preset=entry.label) if moved else entry.label)
        self.box.setToolTip(self.box.currentText())  # whole, where the box is narrow
        self.reset.setEnabled(modified)
        own = any(entry.own and entry.key == key for entry in self._entries)
        self.delete.setEnabled(own)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._make_room()
            self._row.refold()

    def _make_room(self) -> None:
        """The button is no wider than its word: the list needs what is left."""
        self.reset.setMaximumWidth(self.reset.fontMetrics().horizontalAdvance(self.reset.text()) + 16)

    def ask_name(self) -> None:
        """Ask under which name the present values shall be kept."""
        dialog = QInputDialog(self)
        dialog.setObjectName("preset_name")
        dialog.setWindowTitle(tr("Save as own preset"))
        dialog.setLabelText(tr("Name of the preset:"))
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        mine = next((entry.label for entry in self._entries if entry.own and entry.key == self.current()), "")
        dialog.setTextValue(mine)
        dialog.textValueSelected.connect(lambda name: self.saveRequested.emit(name.strip()))
        dialog.open()

    def _menu(self) -> QMenu:
        menu = QMenu(self)
        self.save = QAction(tr("Save as own preset …"), menu)
        self.delete = QAction(tr("Delete this preset"), menu)
        self.save.triggered.connect(self.ask_name)
        self.delete.triggered.connect(lambda: self.deleteRequested.emit(self.current()))
        menu.addActions([self.save, self.delete])
        return menu
