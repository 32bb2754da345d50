"""A form for Tables 1 and 2: values in the units of the paper, and a mark where the paper gives none."""

import dataclasses
from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import QDoubleSpinBox, QFormLayout, QLabel, QWidget

from regolith_studio.dataset.parameters import NOT_GIVEN
from regolith_studio.ui.translation import tr


class ParameterForm(QWidget):
    """Edits one frozen dataclass of numbers whose fields say unit, factor, range and source.

    Parameters
    ----------
    kind
        The dataclass; its defaults are shown first.
    name
        Begins the object names of the editors.
    """

    valueChanged = Signal()  # noqa: N815

    def __init__(self, kind: type[Any], name: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._kind = kind
        self._editors: dict[str, QDoubleSpinBox] = {}
        form = QFormLayout(self)
        form.setContentsMargins(0, 0, 0, 0)
        form.setVerticalSpacing(4)
        for each in dataclasses.fields(kind):
            editor = self._editors[each.name] = _editor(each.metadata)
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
        """The dataclass in SI; values that were not touched keep their exact default."""
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
        """Show the defaults with these changes; what is not known or not possible is left out."""
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


def _editor(metadata: Mapping[str, Any]) -> QDoubleSpinBox:
    editor = QDoubleSpinBox()
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
