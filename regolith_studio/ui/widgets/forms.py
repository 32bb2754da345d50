"""Forms made from the fields of a dataclass: a row each, by its label, unit, range and help."""

import dataclasses
from collections.abc import Callable, Collection, Iterable, Mapping
from contextlib import suppress
from functools import partial
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
from regolith_studio.ui.widgets.fields import ChoiceBox, DecimalField, NumberSlider, NumbersLine, NumberSpec
from regolith_studio.ui.widgets.labels import rich_symbol

Scalar = bool | int | float | str
LARGEST_NUMBER = 2**31 - 1
"""Of a whole number in a box of Qt."""
DECIMALS = 4


class SettingsForm(QWidget):
    """Edits the settings of one dataclass; its value holds those that differ from their defaults.

    A field's ``metadata`` is what :func:`~regolith_studio.settings.setting` makes of its arguments.

    - ``choices``: label of each key of further texts, by the name of the field.
    - ``names``: fields to edit, in this order; all by default.
    - ``prefix``: begins the object names of the editors.
    - ``rows``: takes the rows, so that those of several dataclasses are aligned; a layout of its own by
      default.
    - ``without``: fields that are edited elsewhere.
    """

    valueChanged = Signal(dict)  # noqa: N815
    edited = Signal(dict)
    """The one setting that has been changed, by its name."""
    editingFinished = Signal()  # noqa: N815

    def __init__(
        self,
        kind: type[Any],
        choices: Mapping[str, Mapping[Any, str]] | None = None,
        names: Collection[str] = (),
        prefix: str = "setting_",
        rows: QFormLayout | None = None,
        without: Collection[str] = (),
    ) -> None:
        super().__init__()
        known = {each.name: each for each in dataclasses.fields(kind) if isinstance(each.default, Scalar)}
        self._kind = kind
        self._settings = {name: known[name] for name in names or known if name not in without}
        self.editors: dict[str, Any] = {}
        self.rows = form_layout(self) if rows is None else rows
        for name, each in self._settings.items():
            metadata = dict(each.metadata)
            if choices and name in choices:
                metadata["choices"] = choices[name]
            self._add_row(each, setting_editor(each.default, metadata, f"{prefix}{name}"))
        SettingsForm.setValue(self, {})

    def value(self) -> Any:
        """Settings that differ from their defaults, by name."""
        return {name: value for name, value in self.values().items() if value != self._default(name)}

    def values(self) -> dict[str, Any]:
        """All edited settings, by name."""
        return {name: self._read(name) for name in self.editors}

    def setValue(self, value: Any) -> None:
        """Show these settings, the others at their defaults; announces nothing."""
        for name, editor in self.editors.items():
            with QSignalBlocker(editor):
                _enter(editor, _shown(self._settings[name], value.get(name, self._default(name))))

    def is_empty(self) -> bool:
        """Whether the dataclass has no settings that can be edited."""
        return not self.editors

    def _add_row(self, each: "dataclasses.Field[Any]", editor: QWidget) -> None:
        words = tr(str(each.metadata.get("label", each.name.replace("_", " ").capitalize())))
        self.editors[each.name] = editor
        _signal(editor).connect(partial(self._announce, each.name))
        if isinstance(editor, NumberSlider):  # others change in one step
            editor.editingFinished.connect(self.editingFinished)
        if isinstance(editor, QCheckBox):
            editor.setText(words)
            self.rows.addRow(editor)
        else:
            label = QLabel(rich_symbol(tr(str(each.metadata.get("symbol", words)))))
            label.setToolTip(editor.toolTip())
            label.setBuddy(editor)
            self.rows.addRow(label, editor)

    def _announce(self, name: str, *_: object) -> None:
        self.valueChanged.emit(SettingsForm.value(self))
        self.edited.emit({name: self._read(name)})
        if not isinstance(self.editors[name], NumberSlider):
            self.editingFinished.emit()

    def _default(self, name: str) -> Any:
        return self._settings[name].default

    def _read(self, name: str) -> Any:
        """The value of a setting; one that is shown as its rounded default keeps the exact one."""
        editor, each = self.editors[name], self._settings[name]
        shown = _value(editor)
        if isinstance(each.default, bool | str) or "choices" in each.metadata:
            return shown
        decimals = editor.decimals() if isinstance(editor, QDoubleSpinBox) else DECIMALS
        if shown == round(_shown(each, each.default), decimals):
            return each.default
        factor = each.metadata.get("factor", 1.0)
        return shown if factor == 1.0 else round(shown / factor, 12)


def form_layout(parent: QWidget | None = None) -> QFormLayout:
    """A layout for the rows of forms, without margins."""
    rows = QFormLayout() if parent is None else QFormLayout(parent)
    rows.setContentsMargins(0, 0, 0, 0)
    rows.setVerticalSpacing(4)
    rows.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
    return rows


def setting_editor(default: Any, metadata: Mapping[str, Any], name: str) -> QWidget:
    """An editor by the default and the metadata of a setting; the owner adds its label."""
    words, tip = tr(str(metadata.get("label", ""))), tr(str(metadata.get("tip", "")))
    editor: QWidget
    if "choices" in metadata:
        choices = metadata["choices"]
        labels = choices if isinstance(choices, Mapping) else dict(zip(choices, choices, strict=True))
        editor = ChoiceBox(name, words, labels)
    elif "slider" in metadata:
        editor = NumberSlider(_spec(default, metadata))
        editor.field.setObjectName(name)
        editor.slider.setObjectName(f"{name}_slider")
        return editor
    elif isinstance(default, bool):
        editor = QCheckBox()
    elif isinstance(default, str):
        editor = QLineEdit()
    elif isinstance(default, int):
        editor = _whole_field(metadata)
    else:
        editor = _decimal_field(metadata)
    editor.setObjectName(name)
    editor.setAccessibleName(words)
    editor.setToolTip(tip)
    return editor


def _spec(default: Any, metadata: Mapping[str, Any]) -> NumberSpec:
    (low, high), factor = metadata["slider"], metadata.get("factor", 1.0)
    step = metadata.get("step", 1 if isinstance(default, int) else 0.01)
    limit = metadata.get("maximum", LARGEST_NUMBER)
    return NumberSpec(
        "",
        metadata["label"],
        low * factor,
        high * factor,
        step * factor,
        limit=min(limit * factor, LARGEST_NUMBER),
        suffix=f" {metadata['unit']}" if "unit" in metadata else "",
        tip=metadata.get("tip", ""),
    )


def _whole_field(metadata: Mapping[str, Any]) -> QSpinBox:
    field = QSpinBox()
    field.setRange(
        int(metadata.get("minimum", 0)), min(int(metadata.get("maximum", 1_000_000)), LARGEST_NUMBER)
    )
    field.setKeyboardTracking(False)
    return field


def _decimal_field(metadata: Mapping[str, Any]) -> DecimalField:
    field, factor = DecimalField(), metadata.get("factor", 1.0)
    decimals = int(metadata.get("decimals", DECIMALS))
    low = float(metadata.get("minimum", 0.0)) * factor
    field.pads = False
    field.setDecimals(decimals)
    # a positive minimum that would be rounded to 0 is the smallest number that can be shown
    field.setRange(
        max(10.0**-decimals, low) if low > 0.0 else low, float(metadata.get("maximum", 1e6)) * factor
    )
    field.setSuffix(f" {tr(metadata['unit'])}" if metadata.get("unit") else "")
    if "step" in metadata:
        field.setSingleStep(float(metadata["step"]) * factor)
    else:
        field.setStepType(QDoubleSpinBox.StepType.AdaptiveDecimalStepType)
    field.setKeyboardTracking(False)
    field.setMinimumWidth(80)
    return field


def _shown(each: "dataclasses.Field[Any]", value: Any) -> Any:
    """A value in the unit that the form shows."""
    factor = each.metadata.get("factor", 1.0)
    return value if factor == 1.0 else value * factor


def _signal(editor: QWidget) -> Any:
    match editor:
        case QCheckBox():
            return editor.toggled
        case QComboBox():
            return editor.currentIndexChanged
        case QLineEdit():
            return editor.editingFinished
        case QSpinBox() | QDoubleSpinBox() | NumberSlider():
            return editor.valueChanged
    raise AssertionError("every editor is one of these")


def _value(editor: QWidget) -> Any:
    match editor:
        case QCheckBox():
            return editor.isChecked()
        case NumbersLine():
            return editor.value()
        case QLineEdit():
            return editor.text()
        case ChoiceBox() | QSpinBox() | QDoubleSpinBox() | NumberSlider():
            return editor.value()
    raise AssertionError("every editor is one of these")


def _enter(editor: QWidget, value: Any) -> None:
    match editor:
        case QCheckBox():
            editor.setChecked(bool(value))
        case NumbersLine():
            editor.setValue(str(value))
        case QLineEdit():
            editor.setText(str(value))
        case QSpinBox():
            editor.setValue(int(value))
        case ChoiceBox():
            editor.choose(value)
        case QDoubleSpinBox() | NumberSlider():
            editor.setValue(float(value))


def field_values(fields: Mapping[str, QWidget]) -> dict[str, Any]:
    """What fields show, as plain JSON."""
    return {name: _value(field) for name, field in fields.items()}


def enter_values(fields: Mapping[str, QWidget], values: Mapping[str, Any]) -> None:
    """Enter values as a user would; absent ones, and those that are none for their field, are ignored."""
    for name, field in fields.items():
        if name in values:
            with suppress(TypeError, ValueError, OverflowError):
                _enter(field, values[name])


def on_change(fields: Iterable[QWidget], action: Callable[[], object]) -> None:
    """Call `action` whenever one of the fields changes."""
    for field in fields:
        _signal(field).connect(lambda *_: action())


class ParameterForm(SettingsForm):
    """Edits a frozen dataclass of numbers in the units of the paper; a star marks those that it omits.

    Each field's ``metadata`` has a ``source`` too.

    ``kind``: the dataclass; its defaults are shown first. ``name``: begins the object names of the editors.
    """

    def __init__(self, kind: type[Any], name: str) -> None:
        super().__init__(kind, prefix=f"{name}_")
        for each in dataclasses.fields(kind):
            editor, source = self.editors[each.name], str(each.metadata["source"])
            label = self.rows.labelForField(editor)
            assert isinstance(label, QLabel), "every number has one"
            if source == NOT_GIVEN:
                label.setText(f"{label.text()} *")
            tip = f"{tr(str(each.metadata['label']))}: {tr(source)}"
            label.setToolTip(tip)
            editor.setToolTip(tip)
            editor.setAccessibleName(tip)

    def value(self) -> Any:
        """The dataclass in SI; unchanged values keep their exact default."""
        return self._kind(**self.values())

    def setValue(self, value: Any) -> None:
        """Show these values; announces nothing."""
        super().setValue(dataclasses.asdict(value))

    def changes(self) -> dict[str, float]:
        """Values that are not the defaults, in SI, by name."""
        changed: dict[str, float] = SettingsForm.value(self)
        return changed

    def restore(self, changes: Mapping[str, Any]) -> None:
        """Show the defaults with these changes; unknown names are ignored."""
        kept = {key: float(value) for key, value in changes.items() if key in self._settings}
        self.setValue(self._kind(**kept))
