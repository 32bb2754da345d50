"""Presets: a list that marks modified values, resets them and saves own ones, and a form with such a list."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QEvent, QSignalBlocker, Qt, Signal
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QFormLayout, QInputDialog, QMenu, QPushButton, QToolButton, QWidget

from regolith_studio.errors import InputError
from regolith_studio.messages import N_
from regolith_studio.session.preferences import UserPresets
from regolith_studio.ui.layout import control_row, named, vbox
from regolith_studio.ui.translation import inert, tr
from regolith_studio.ui.widgets.fields import ChoiceBox
from regolith_studio.ui.widgets.forms import ParameterForm

MODIFIED = N_("{preset} (modified)")
SHIPPED = "paper"
"""Key of the preset with the values of the paper."""


@dataclass(frozen=True)
class PresetEntry:
    """A preset in the list.

    ``key``: identifies the preset in signals; `label` is displayed, `tip` is its tool tip. ``own``: whether
    the user has saved it and may delete it.
    """

    key: str
    label: str
    tip: str = ""
    own: bool = False


class PresetBar(QWidget):
    """Shows presets and emits what the user requests; its owner keeps values and presets.

    - ``name``: object name of the list, and prefix of those of the buttons.
    - ``accessible``: accessible name of the list.
    - ``title``: a heading to which the buttons are added, with the list below; else they stand behind the
      list.
    """

    chosen = Signal(str)
    resetRequested = Signal()  # noqa: N815
    saveRequested = Signal(str)  # noqa: N815
    deleteRequested = Signal(str)  # noqa: N815

    def __init__(self, name: str, accessible: str, title: QWidget | None = None) -> None:
        super().__init__()
        self._entries: tuple[PresetEntry, ...] = ()
        middle = Qt.TextElideMode.ElideMiddle  # the mark at the end must be seen
        self.box = ChoiceBox(name, accessible, (), middle, capital=False)
        self.reset = named(QPushButton(tr("Reset")), tip=tr("Back to the values of the preset"))
        self.more = QToolButton()
        self.more.setObjectName(f"{name}_more")
        self.more.setAccessibleName(tr("Save or delete a preset"))
        self.more.setToolTip(tr("Save or delete a preset of your own"))
        self.more.setText("⋯")
        self.more.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.more.setMenu(self._menu())
        self._make_room()
        layout = vbox(control_row(title or self.box, self.reset, self.more), parent=self)
        if title is not None:
            layout.addWidget(self.box)
        self.box.activated.connect(lambda _: self.chosen.emit(self.current()))
        self.reset.clicked.connect(self.resetRequested)

    def current(self) -> str:
        """Key of the selected preset; empty for none."""
        return self.box.value() or ""

    def set_entries(self, entries: Sequence[PresetEntry]) -> None:
        if tuple(entries) == self._entries:
            return
        self._entries = tuple(entries)
        with QSignalBlocker(self.box):
            self.box.clear()
            for row, entry in enumerate(self._entries):
                self.box.addItem(entry.label, entry.key)
                self.box.setItemData(row, entry.tip, Qt.ItemDataRole.ToolTipRole)

    def show_state(self, key: str, modified: bool) -> None:
        """Select the preset of the values, and mark whether they are modified."""
        with QSignalBlocker(self.box):
            self.box.setCurrentIndex(self.box.findData(key))
            for row, entry in enumerate(self._entries):
                moved = modified and entry.key == key
                self.box.setItemText(row, tr(MODIFIED, preset=entry.label) if moved else entry.label)
        self.box.setToolTip(inert(self.box.currentText()))  # whole, where the box is narrow
        self.reset.setEnabled(modified)
        own = any(entry.own and entry.key == key for entry in self._entries)
        self.delete.setEnabled(own)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._make_room()

    def _make_room(self) -> None:
        self.reset.setMaximumWidth(self.reset.fontMetrics().horizontalAdvance(self.reset.text()) + 16)

    def ask_name(self) -> None:
        """Ask for a name and request to save the values under it."""
        dialog = named(QInputDialog(self), "preset_name")
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


class PresetForm(ParameterForm):
    """A :class:`ParameterForm` with a :class:`PresetBar`; forms of one dataclass share their presets.

    - ``kind``: the dataclass; its defaults are the shipped preset.
    - ``name``: prefix of the editors' object names.
    - ``label``: of the shipped preset.
    """

    def __init__(self, kind: type[Any], name: str, label: str) -> None:
        self._own = UserPresets(kind.__name__.lower())
        self._chosen = SHIPPED
        self._known: dict[str, dict[str, Any]] = {SHIPPED: {}}
        self._label = label
        self.bar = PresetBar(f"{name}_preset", tr("Preset of {label}", label=label))
        self.bar.reset.setObjectName(f"{name}_preset_reset")
        super().__init__(kind, name)
        layout = self.layout()
        assert isinstance(layout, QFormLayout), "the form is one"
        layout.insertRow(0, self.bar)
        self.bar.chosen.connect(self._take)
        self.bar.resetRequested.connect(lambda: self._take(self._chosen))
        self.bar.saveRequested.connect(self.save_as)
        self.bar.deleteRequested.connect(self.delete)
        self.valueChanged.connect(self._show_mark)
        self._list()

    def setValue(self, value: Any) -> None:
        """Show these values without emitting a signal."""
        super().setValue(value)
        self._show_mark()

    def is_modified(self) -> bool:
        """Whether the values differ from those of the preset."""
        return self.changes() != self._known[self._chosen]

    def save_as(self, name: str) -> None:
        self._own.save(name, self.changes())
        self._list()
        self._chosen = f"own:{name}"
        self._show_mark()

    def delete(self, key: str) -> None:
        """Delete an own preset; the values stay."""
        self._own.remove(key.removeprefix("own:"))
        self._chosen = SHIPPED
        self._list()

    def _list(self) -> None:
        kept = {f"own:{name}": values for name, values in self._own.all().items()}
        self._known = {SHIPPED: {}} | {
            key: dict(values) for key, values in kept.items() if self._fits(values)
        }
        tip = tr("Published values; * where none is published")
        entries = [PresetEntry(SHIPPED, self._label, tip)]
        entries += [
            PresetEntry(key, key.removeprefix("own:"), tr("Own preset"), own=True)
            for key in self._known
            if key != SHIPPED
        ]
        self.bar.set_entries(entries)
        self._show_mark()

    def _fits(self, values: Mapping[str, Any]) -> bool:
        try:
            self._kind(**{name: float(value) for name, value in values.items()})
        except (InputError, TypeError, ValueError):
            return False
        return True

    def _take(self, key: str) -> None:
        self._chosen = key
        self.restore(self._known[key])
        self.valueChanged.emit(self.changes())

    def _show_mark(self) -> None:
        self.bar.show_state(self._chosen, self.is_modified())
