"""The form of a series of runs, which study and calibration share."""

from collections.abc import Mapping, Sequence
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox, QFormLayout, QSpinBox, QVBoxLayout, QWidget

from regolith_studio.ui.layout import equal_parts
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.numbers import DecimalField, NumbersLine
from regolith_studio.ui.widgets.result_view import ResultView

Field = QComboBox | NumbersLine | QSpinBox | DecimalField


class RunPanel(QWidget):
    """The form of a series of runs below the card of its result, and views beside it.

    Parameters
    ----------
    name
        Object name.
    fields
        Label and field, by the name in project files.
    """

    def __init__(
        self,
        name: str,
        card: ResultView,
        fields: Mapping[str, tuple[str, Field]],
        views: Sequence[QWidget],
    ) -> None:
        super().__init__()
        self.setObjectName(name)
        self.card, self._fields = card, {key: field for key, (_, field) in fields.items()}
        form = QFormLayout()
        form.setContentsMargins(8, 6, 0, 0)
        form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        for label, field in fields.values():
            form.addRow(label, field)
        left = QWidget()
        left.setLayout(form)
        row = equal_parts(Qt.Orientation.Horizontal, (left, *views))
        row.setObjectName(f"{name}_parts")
        column = QVBoxLayout(self)
        column.setContentsMargins(4, 4, 4, 4)
        column.addWidget(card)
        column.addWidget(row, 1)

    def set_running(self, running: bool) -> None:
        """Set whether it is running: the form is not edited then."""
        for field in self._fields.values():
            field.setEnabled(not running)

    def state(self) -> dict[str, Any]:
        """The values as plain JSON."""
        return {name: _value(field) for name, field in self._fields.items()}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Show what :meth:`state` returned; unknown values are ignored."""
        for name, field in self._fields.items():
            if name in state:
                _restore(field, state[name])


def keys_box(entries: Mapping[str, tuple[str, str]], name: str, spoken: str) -> QComboBox:
    """A choice of keys by their labels."""
    box = QComboBox()
    box.setObjectName(name)
    box.setAccessibleName(spoken)
    for key, (label, _) in entries.items():
        box.addItem(tr(label), key)
    return box


def count_box(name: str, spoken: str, maximum: int) -> QSpinBox:
    """A number from 1 on."""
    box = QSpinBox()
    box.setObjectName(name)
    box.setAccessibleName(spoken)
    box.setRange(1, maximum)
    return box


def _value(field: Field) -> Any:
    return field.currentData() if isinstance(field, QComboBox) else field.value()


def _restore(field: Field, value: Any) -> None:
    if isinstance(field, QComboBox):
        if (place := field.findData(value)) >= 0:
            field.setCurrentIndex(place)
    elif isinstance(field, NumbersLine):
        field.setValue(str(value))
    elif isinstance(value, int | float):
        if isinstance(field, QSpinBox):
            field.setValue(int(value))
        else:
            field.setValue(float(value))
