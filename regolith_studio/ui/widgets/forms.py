"""Forms built from the fields of a dataclass: settings of a method, and physical parameters with units."""

import dataclasses
from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QFormLayout,
    QLabel,
    QLineEdit,
    QSpinBox,
    QWidget,
)

from regolith_studio.dataset.parameters import NOT_GIVEN
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import rich_symbol
from regolith_studio.ui.widgets.numbers import DecimalField

Scalar = bool | int | float | str
LARGEST_NUMBER = 2**31 - 1
"""Of a whole number in a box of Qt."""


class SettingsForm(QWidget):
    """Edits the settings of one dataclass; its value holds those that differ from their defaults.

    A field's ``metadata`` may have ``label``, ``minimum``, ``maximum``, ``step``, ``decimals``, ``tip`` and
    ``choices``.

    Parameters
    ----------
    choices
        Label of each key of further texts, by the name of the field.
    """

    valueChanged = Signal(dict)  # noqa: N815

    def __init__(self, kind: type[Any], choices: Mapping[str, Mapping[str, str]] | None = None) -> None:
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
            known = {"choices": choices[each.name]} if choices and each.name in choices else {}
            editor = self._editors[each.name] = _setting_editor(each.default, {**each.metadata, **known})
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
        """Settings that differ from their defaults, by name."""
        now = {name: _read(editor) for name, editor in self._editors.items()}
        return {name: value for name, value in now.items() if value != self._defaults[name]}

    def setValue(self, value: Mapping[str, Scalar]) -> None:
        """Show these settings, the others at their defaults; announces nothing."""
        for name, editor in self._editors.items():
            with QSignalBlocker(editor):
                _write(editor, value.get(name, self._defaults[name]))

    def is_empty(self) -> bool:
        """Whether the dataclass has no settings that can be edited."""
        return not self._editors


def _setting_editor(default: Scalar, metadata: Mapping[str, Any]) -> QWidget:
    if isinstance(default, bool):
        return QCheckBox()
    if isinstance(default, str):
        if "choices" not in metadata:
            return QLineEdit()
        combo = QComboBox()
        choices = metadata["choices"]
        labels = choices if isinstance(choices, Mapping) else dict(zip(choices, choices, strict=True))
        for key, label in labels.items():
            combo.addItem(tr(str(label)), str(key))
        return combo
    if isinstance(default, int):
        whole = QSpinBox()
        highest = min(int(metadata.get("maximum", 1_000_000)), LARGEST_NUMBER)
        whole.setRange(int(metadata.get("minimum", 0)), highest)
        whole.setKeyboardTracking(False)
        return whole
    number = DecimalField()
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


class ParameterForm(QWidget):
    """Edits a frozen dataclass of numbers in the units of the paper; a star marks those that it omits.

    Each field's ``metadata`` has ``label``, ``unit``, ``factor``, ``minimum``, ``maximum`` and ``source``.

    Parameters
    ----------
    kind
        The dataclass; its defaults are shown first.
    name
        Begins the object names of the editors.
    """

    valueChanged = Signal()  # noqa: N815

    def __init__(self, kind: type[Any], name: str) -> None:
        super().__init__()
        self._kind = kind
        self._editors: dict[str, QDoubleSpinBox] = {}
        form = QFormLayout(self)
        form.setContentsMargins(0, 0, 0, 0)
        form.setVerticalSpacing(4)
        for each in dataclasses.fields(kind):
            editor = self._editors[each.name] = _number_editor(each.metadata)
            editor.setObjectName(f"{name}_{each.name}")
            words = tr(str(each.metadata["label"]))
            label = QLabel(words)
            missing = each.metadata["source"] == NOT_GIVEN
            if missing:
                label.setText(f"{label.text()} *")
            tip = f"{words}: {tr(str(each.metadata['source']))}"
            label.setToolTip(tip)
            editor.setToolTip(tip)
            editor.setAccessibleName(tip)
            label.setBuddy(editor)
            form.addRow(label, editor)
            editor.valueChanged.connect(lambda *_: self.valueChanged.emit())
        self.setValue(kind())

    def value(self) -> Any:
        """The dataclass in SI; unchanged values keep their exact default."""
        return self._kind(**{name: self._read(name) for name in self._editors})

    def setValue(self, value: Any) -> None:
        """Show these values; announces nothing."""
        for each in dataclasses.fields(self._kind):
            with QSignalBlocker(self._editors[each.name]):
                self._editors[each.name].setValue(getattr(value, each.name) * each.metadata["factor"])

    def changes(self) -> dict[str, float]:
        """Values that are not the defaults, in SI, by name."""
        return {
            each.name: number
            for each in dataclasses.fields(self._kind)
            if (number := self._read(each.name)) != each.default
        }

    def restore(self, changes: Mapping[str, Any]) -> None:
        """Show the defaults with these changes; unknown names are ignored."""
        known = {each.name for each in dataclasses.fields(self._kind)}
        kept = {key: float(value) for key, value in changes.items() if key in known}
        self.setValue(self._kind(**kept))

    def _read(self, name: str) -> float:
        each = next(one for one in dataclasses.fields(self._kind) if one.name == name)
        shown = self._editors[name].value()
        default = float(each.default)  # type: ignore[arg-type]
        factor = float(each.metadata["factor"])
        digits = self._editors[name].decimals()
        return default if shown == round(default * factor, digits) else shown / factor


def _number_editor(metadata: Mapping[str, Any]) -> DecimalField:
    editor = DecimalField()
    editor.setDecimals(3)
    factor = float(metadata["factor"])
    editor.setRange(
        max(0.001, metadata["minimum"] * factor) if metadata["minimum"] else 0.0, metadata["maximum"] * factor
    )
    editor.setSuffix(f" {metadata['unit']}" if metadata["unit"] else "")
    editor.setStepType(QDoubleSpinBox.StepType.AdaptiveDecimalStepType)
    editor.setKeyboardTracking(False)
    editor.setMinimumWidth(80)
    return editor
