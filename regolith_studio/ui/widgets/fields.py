"""Fields and sliders of numbers, with the decimal sign of the language, and combo boxes that elide."""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QEvent, QRect, QSignalBlocker, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QPaintEvent, QValidator
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QGridLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QSizePolicy,
    QSlider,
    QSpinBox,
    QStyle,
    QStyleOptionButton,
    QStyleOptionComboBox,
    QStylePainter,
    QWidget,
)

from regolith_studio.ui.layout import named
from regolith_studio.ui.translation import tr

MARGIN = 2
"""Pixels between the frame and the text of a combo box."""


ELIDED_LETTERS = 22
"""Width in mean letters down to which a check box elides its label."""
MOST_LETTERS = 38
"""Width in mean letters up to which a box asks for room for its longest label: own presets have any name."""


class ElidedComboBox(QComboBox):
    """A combo box that may be narrower than its labels, which are elided in the middle or at the end.

    With :attr:`prefers_whole` its size hint has room for the longest label.
    """

    prefers_whole = False

    def __init__(self, elide: Qt.TextElideMode = Qt.TextElideMode.ElideRight) -> None:
        super().__init__()
        self._elide = elide
        self.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.setMinimumContentsLength(12)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:  # for which Qt forgets but one of its two size hints
            super().changeEvent(QEvent(QEvent.Type.StyleChange))

    def whole_width(self) -> int:
        labels = (self.itemText(row) for row in range(self.count()))
        widest = max(map(self.fontMetrics().horizontalAdvance, labels), default=0)
        return widest + 1 + self.width() - text_room(self)  # advances are rounded to pixels

    def sizeHint(self) -> QSize:
        hint = super().sizeHint()
        most = MOST_LETTERS * self.fontMetrics().averageCharWidth()
        return hint.expandedTo(QSize(min(self.whole_width(), most), 0)) if self.prefers_whole else hint

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: ARG002
        option = QStyleOptionComboBox()
        self.initStyleOption(option)
        option.currentText = self.fontMetrics().elidedText(self.currentText(), self._elide, text_room(self))
        painter = QStylePainter(self)
        painter.drawComplexControl(QStyle.ComplexControl.CC_ComboBox, option)
        painter.drawControl(QStyle.ControlElement.CE_ComboBoxLabel, option)
        painter.end()


def show_whole(dialog: QWidget) -> None:
    """Let a dialog be as wide as the longest labels of its combo boxes."""
    for box in dialog.findChildren(ElidedComboBox):
        box.prefers_whole = True


class ElidedCheckBox(QCheckBox):
    """A check box that may be narrower than its label, which is elided."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)

    def minimumSizeHint(self) -> QSize:
        hint = super().minimumSizeHint()
        return QSize(min(hint.width(), ELIDED_LETTERS * self.fontMetrics().averageCharWidth()), hint.height())

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: ARG002
        option = QStyleOptionButton()
        self.initStyleOption(option)
        room = self.style().subElementRect(QStyle.SubElement.SE_CheckBoxContents, option, self).width()
        option.text = self.fontMetrics().elidedText(self.text(), Qt.TextElideMode.ElideRight, room)
        QStylePainter(self).drawControl(QStyle.ControlElement.CE_CheckBox, option)


Entries = Mapping[Any, str] | Iterable[tuple[Any, str]]
"""Values and their labels, which are translated."""


class ChoiceBox(ElidedComboBox):
    """Selects one of some values; `capital` begins their labels with one."""

    def __init__(
        self,
        name: str,
        spoken: str,
        entries: Entries,
        elide: Qt.TextElideMode = Qt.TextElideMode.ElideRight,
        *,
        capital: bool = True,
    ) -> None:
        super().__init__(elide)
        named(self, name, spoken)
        self._capital = capital
        self._add(entries)

    def value(self) -> Any:
        return self.currentData()

    def setValue(self, value: Any) -> None:
        """Select a value without emitting a signal; an unknown one is ignored."""
        with QSignalBlocker(self):
            self.choose(value)

    def choose(self, value: Any) -> None:
        """Select a value as a user would; an unknown one is ignored."""
        if (place := self.findData(value)) >= 0:
            self.setCurrentIndex(place)

    def offer(self, entries: Entries) -> None:
        """Offer other values; the selected one stays if it is among them, and no signal is emitted."""
        chosen = self.value()
        with QSignalBlocker(self):
            self.clear()
            self._add(entries)
            self.choose(chosen)

    def _add(self, entries: Entries) -> None:
        for value, label in entries.items() if isinstance(entries, Mapping) else entries:
            words = tr(label)
            self.addItem(words[:1].upper() + words[1:] if self._capital else words, value)


def choice(name: str, spoken: str, entries: Entries) -> ChoiceBox:
    """A box whose labels are shown as they are, as wide as the longest if it can be."""
    box = ChoiceBox(name, spoken, entries, capital=False)
    box.prefers_whole = True
    return box


def text_room(box: QComboBox) -> int:
    """Width of the label of a combo box in pixels."""
    option = QStyleOptionComboBox()
    box.initStyleOption(option)
    option.rect = QRect(0, 0, box.width(), box.height())
    style, part = box.style(), QStyle.SubControl.SC_ComboBoxEditField
    return style.subControlRect(QStyle.ComplexControl.CC_ComboBox, option, part, box).width() - MARGIN


class DecimalField(QDoubleSpinBox):
    """Edits a number; ``0.5`` and ``0,5`` are a half in every language.

    Qt's own box takes the other sign for that of thousands and drops it, which makes 5 of it.
    """

    pads = True
    """Whether all decimals are shown, also zeros at the end."""

    def textFromValue(self, value: float) -> str:
        text, point = super().textFromValue(value), self.locale().decimalPoint()
        return text if self.pads or point not in text else text.rstrip("0").rstrip(point)

    def validate(self, text: str, pos: int) -> tuple[QValidator.State, str, int]:
        return super().validate(self._with_own_sign(text), pos)

    def valueFromText(self, text: str) -> float:
        return super().valueFromText(self._with_own_sign(text))

    def _with_own_sign(self, text: str) -> str:
        point = self.locale().decimalPoint()
        return text.replace("," if point == "." else ".", point)


class NumbersLine(QLineEdit):
    """Edits a list of numbers, as ``0.2, 0.4``; shown as ``0,2; 0,4`` where numbers have a decimal comma.

    There a comma with a space behind it separates too, and a list with points is taken as it is.
    """

    def __init__(self, value: str = "") -> None:
        super().__init__()
        self.setValue(value)

    def minimumSizeHint(self) -> QSize:
        """Wide enough for a list of three numbers."""
        least = super().minimumSizeHint()
        return QSize(least.width() + self.fontMetrics().horizontalAdvance("0.2, 0.4, 0.8"), least.height())

    def value(self) -> str:
        """The list with decimal points, and commas between the numbers."""
        text = self.text()
        if self.locale().decimalPoint() == "." or ("." in text and ";" not in text):
            return text.replace(";", ",")
        parts = re.split(r";|,\s", text)
        return ", ".join(part.strip().replace(",", ".") for part in parts)

    def setValue(self, value: str) -> None:
        """Show a list that is written with decimal points, and commas between the numbers."""
        if self.locale().decimalPoint() == ",":
            value = re.sub(r",\s*", "; ", value).replace(".", ",")
        self.setText(value)


def whole_field(name: str, spoken: str, low: int, high: int, value: int | None = None) -> QSpinBox:
    """A field of a whole number, by its object name and accessible name."""
    field = named(QSpinBox(), name, spoken)
    field.setRange(low, high)
    field.setValue(low if value is None else value)
    return field


def decimal_field(
    name: str, spoken: str, low: float, high: float, value: float, suffix: str = "", decimals: int = 2
) -> DecimalField:
    """A field of a number, as :func:`whole_field`."""
    field = named(DecimalField(), name, spoken)
    field.setDecimals(decimals)
    field.setRange(low, high)
    field.setSuffix(suffix)
    field.setValue(value)
    return field


THROTTLE = 30
"""Minimum milliseconds between two ``valueChanged``; the first is emitted at once, the last always."""


MIN_TEXT = "0000.00"
"""Text that every field has room for."""
ARROWS = 28
"""Width of arrows and frame of a field in pixels."""


@dataclass(frozen=True)
class NumberSpec:
    """Range, step and texts of a number; the texts are translated when displayed.

    - ``label``: rich text before the slider; empty for none.
    - ``name``: accessible name.
    - ``minimum``, ``maximum``: range of the slider.
    - ``step``: smallest change; the number is an integer if it is one.
    - ``limit``: largest number that can be typed; `maximum` if not given.
    - ``suffix``: unit, with a leading blank.
    - ``tip``: tool tip.
    """

    label: str
    name: str
    minimum: float
    maximum: float
    step: float = 1
    limit: float | None = None
    suffix: str = ""
    tip: str = ""

    @property
    def whole(self) -> bool:
        return float(self.step).is_integer()

    @property
    def decimals(self) -> int:
        return 0 if self.whole else len(f"{self.step:.6f}".rstrip("0").split(".")[1])


class NumberSlider(QWidget):
    """Edits one number. ``valueChanged`` is emitted for changes by the user only, and throttled.

    ``editingFinished`` follows when the slider is released or a typed number is confirmed.
    """

    valueChanged = Signal(object)  # noqa: N815
    editingFinished = Signal()  # noqa: N815

    def __init__(self, spec: NumberSpec) -> None:
        super().__init__()
        self.spec = spec
        self.label = QLabel(tr(spec.label))
        self.slider = QSlider(Qt.Orientation.Horizontal)
        self.field = QSpinBox() if spec.whole else DecimalField()
        self._timer = QTimer(self, interval=THROTTLE, singleShot=True)
        self._emitted: float | int | None = None
        self._configure()
        self._make_room()
        layout = QGridLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setHorizontalSpacing(8)
        layout.addWidget(self.label, 0, 0)
        layout.addWidget(self.slider, 0, 1)
        layout.addWidget(self.field, 0, 2)
        layout.setColumnStretch(1, 1)
        self.label.setVisible(bool(spec.label))
        self.slider.valueChanged.connect(self._on_slider)
        self.slider.sliderReleased.connect(self._finish)
        self.field.valueChanged.connect(self._on_field)
        self.field.editingFinished.connect(self._finish)
        self._timer.timeout.connect(self._emit_value)
        self.setValue(spec.minimum)

    def value(self) -> float | int:
        return self.field.value()

    def setValue(self, value: float) -> None:
        """Set the number without emitting a signal."""
        self._timer.stop()
        with QSignalBlocker(self.field), QSignalBlocker(self.slider):
            self.field.setValue(int(value) if self.spec.whole else float(value))  # type: ignore[arg-type]
            self.slider.setValue(self._ticks(self.field.value()))
        self._emitted = self.field.value()

    def step_by(self, step: float) -> None:
        """Let arrows and keys change the number by more than its smallest step, whose zeros are not shown."""
        if isinstance(self.field, DecimalField):
            self.field.pads = False
            self.field.setSingleStep(step)
        self.slider.setSingleStep(self._ticks(step))

    def set_range(self, minimum: float, maximum: float) -> None:
        """Set the range of slider and field without emitting a signal."""
        with QSignalBlocker(self.field), QSignalBlocker(self.slider):
            self.field.setRange(minimum, maximum)  # type: ignore[arg-type]
            self.slider.setRange(self._ticks(minimum), self._ticks(maximum))
            self.slider.setPageStep(max(1, (self.slider.maximum() - self.slider.minimum()) // 10))

    def _configure(self) -> None:
        spec, field = self.spec, self.field
        limit = spec.maximum if spec.limit is None else spec.limit
        if isinstance(field, QDoubleSpinBox):
            field.setDecimals(spec.decimals)
            field.setRange(spec.minimum, limit)
            field.setSingleStep(spec.step)
        else:
            field.setRange(int(spec.minimum), int(limit))
            field.setSingleStep(int(spec.step))
        field.setSuffix(spec.suffix and tr(spec.suffix))
        field.setKeyboardTracking(False)
        field.setAlignment(Qt.AlignmentFlag.AlignRight)
        field.setAccessibleName(tr(spec.name))
        self._widest = max(MIN_TEXT, f"-{limit:.{spec.decimals}f}{field.suffix()}", key=len)
        self.slider.setRange(self._ticks(spec.minimum), self._ticks(spec.maximum))
        self.slider.setPageStep(max(1, (self.slider.maximum() - self.slider.minimum()) // 10))
        self.slider.setAccessibleName(tr("{name}, slider", name=tr(spec.name)))
        self.slider.setMinimumWidth(60)
        self.label.setBuddy(field)
        self.setFocusProxy(self.slider)
        for part in (self.label, self.slider, field):
            part.setToolTip(tr(spec.tip))

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._make_room()

    def _make_room(self) -> None:
        """Set the width of the field to that of the longest number in the present font."""
        self.field.setFixedWidth(self.field.fontMetrics().horizontalAdvance(self._widest) + ARROWS)

    def _ticks(self, value: float) -> int:
        return round(value / self.spec.step)

    def _on_slider(self, ticks: int) -> None:
        with QSignalBlocker(self.field):
            value = ticks * self.spec.step
            self.field.setValue(int(value) if self.spec.whole else value)  # type: ignore[arg-type]
        self._throttle()

    def _on_field(self, value: float) -> None:
        with QSignalBlocker(self.slider):
            self.slider.setValue(self._ticks(value))
        self._throttle()

    def _throttle(self) -> None:
        if not self._timer.isActive():
            self._emit_value()

    def _emit_value(self) -> None:
        """Emit the value if it is new, and start the throttle."""
        value = self.value()
        if value != self._emitted:
            self._emitted = value
            self._timer.start()
            self.valueChanged.emit(value)

    def _finish(self) -> None:
        self._emit_value()
        self._timer.stop()
        self.editingFinished.emit()


def align_labels(sliders: Iterable[NumberSlider]) -> None:
    """Give the labels of several sliders the same width."""
    each = list(sliders)
    for slider in each:
        slider.label.setMinimumWidth(0)  # a label wants at least that
    widest = max((slider.label.sizeHint().width() for slider in each), default=0)
    for slider in each:
        slider.label.setFixedWidth(widest)


class StepPlayer(QWidget):
    """A slider over steps, and a button that plays them by a timer.

    - ``name``: of the slider; ``spoken``: its accessible name.
    - ``interval``: milliseconds between two steps.
    - ``is_ready``: whether a step can be shown at once; while it plays, it waits for that.
    """

    stepChanged = Signal(int)  # noqa: N815

    def __init__(
        self, name: str, spoken: str, interval: int, is_ready: Callable[[int], bool] = lambda _step: True
    ) -> None:
        super().__init__()
        self._is_ready = is_ready
        self.slider = named(QSlider(Qt.Orientation.Horizontal), name, spoken)
        self.play = QPushButton(tr("Play"))
        self._timer = QTimer(self, interval=interval)
        self._timer.timeout.connect(self._next)
        self.play.clicked.connect(self.toggle)
        self.slider.valueChanged.connect(self.stepChanged)

    @property
    def step(self) -> int:
        return self.slider.value()

    @property
    def playing(self) -> bool:
        return self._timer.isActive()

    @property
    def has_steps(self) -> bool:
        """Whether there are several steps."""
        return self.slider.maximum() > 0

    def set_count(self, count: int, at: int = 0) -> None:
        """Set the number of steps and the current one without emitting a signal."""
        with QSignalBlocker(self.slider):
            self.slider.setRange(0, max(0, count - 1))
            self.slider.setValue(at)
        for part in (self.play, self.slider):
            part.setEnabled(count > 1)

    def toggle(self) -> None:
        """Play, from the beginning if the end is reached, or pause."""
        if self.playing:
            self.pause()
        elif self.has_steps:
            if self.step == self.slider.maximum():
                self.slider.setValue(0)
            self.play.setText(tr("Pause"))
            self._timer.start()

    def pause(self) -> None:
        self._timer.stop()
        self.play.setText(tr("Play"))

    def _next(self) -> None:
        if self.step >= self.slider.maximum():
            self.pause()
        elif self._is_ready(self.step + 1):
            self.slider.setValue(self.step + 1)
