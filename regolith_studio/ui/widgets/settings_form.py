"""A form that builds itself from the fields of a settings dataclass.

A field's ``metadata`` may carry ``label``, ``minimum``, ``maximum``, ``step``, ``tip`` and ``choices``.
"""

import dataclasses
from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import QCheckBox, QComboBox, QDoubleSpinBox, QFormLayout, QLineEdit, QSpinBox, QWidget

from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import rich_symbol

Scalar = bool | int | float | str


class SettingsForm(QWidget):
    """Edits those settings of one dataclass that differ from their defaults."""

    valueChanged = Signal(dict)  # noqa: N815

    def __init__(self, kind: type[Any]) -> None:
        super().__init__()
        self._defaults: dict[str, Scalar] = {}
        self._editors: dict[str, QWidget] = {}
        form = QFormLayout(self)
        form.setContentsMargins(0, 0, 0, 0)
        for each in dataclasses.fields(kind):
            if each.default is dataclasses.MISSING or not isinstance(each.default, Scalar):
                continue
            self._defaults[each.name] = each.default
            label = tr(str(each.metadata.get("label", each.name.replace("_", " ").capitalize())))
            editor = self._editors[each.name] = _editor(each.default, each.metadata)
            editor.setObjectName(f"setting_{each.name}")
            editor.setAccessibleName(label)
            editor.setToolTip(tr(str(each.metadata.get("tip", ""))))
            _signal(editor).connect(lambda *_: self.valueChanged.emit(self.value()))
            if isinstance(editor, QCheckBox):
                editor.setText(label)
                form.addRow(editor)
            else:
                form.addRow(rich_symbol(label), editor)
        self.setValue({})

    def value(self) -> dict[str, Scalar]:
        """Settings that are not at their default, by name."""
        now = {name: _read(editor) for name, editor in self._editors.items()}
        return {name: value for name, value in now.items() if value != self._defaults[name]}

    def setValue(self, value: Mapping[str, Scalar]) -> None:
        """Show these settings, the others at their defaults; announces nothing."""
        for name, editor in self._editors.items():
            with QSignalBlocker(editor):
                _write(editor, value.get(name, self._defaults[name]))

    def is_empty(self) -> bool:
        """Whether there is nothing to set."""
        return not self._editors


def _editor(default: Scalar, metadata: Mapping[str, Any]) -> QWidget:
    if isinstance(default, bool):
        return QCheckBox()
    if isinstance(default, str):
        if "choices" not in metadata:
            return QLineEdit()
        combo = QComboBox()
        for choice in metadata["choices"]:
            combo.addItem(tr(str(choice)), str(choice))
        return combo
    if isinstance(default, int):
        whole = QSpinBox()
        whole.setRange(int(metadata.get("minimum", 0)), int(metadata.get("maximum", 1_000_000)))
        whole.setKeyboardTracking(False)
        return whole
    number = QDoubleSpinBox()
    number.setDecimals(int(metadata.get("decimals", 4)))
    number.setRange(float(metadata.get("minimum", 0.0)), float(metadata.get("maximum", 1e6)))
    number.setSingleStep(float(metadata.get("step", 0.01)))
    number.setKeyboardTracking(False)
    return number


def _signal(editor: QWidget) -> Any:
    match editor:
        case QCheckBox():
            return editor.toggled
        case QComboBox():
            return editor.currentTextChanged
        case QLineEdit():
            return editor.editingFinished
        case QSpinBox() | QDoubleSpinBox():
            return editor.valueChanged
    raise AssertionError("every editor is one of these")


def _read(editor: QWidget) -> Scalar:
    match editor:
        case QCheckBox():
            return editor.isChecked()
        case QComboBox():
            return str(editor.currentData())
        case QLineEdit():
            return editor.text()
        case QSpinBox() | QDoubleSpinBox():
            return editor.value()
    raise AssertionError("every editor is one of these")


def _write(editor: QWidget, value: Scalar) -> None:
    match editor:
        case QCheckBox():
            editor.setChecked(bool(value))
        case QComboBox():
            editor.setCurrentIndex(editor.findData(str(value)))
        case QLineEdit():
            editor.setText(str(value))
        case QSpinBox():
            editor.setValue(int(value))
        case QDoubleSpinBox():
            editor.setValue(float(value))
