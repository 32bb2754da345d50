"""A slider with a number field: the slider for looking around, the field for exact values."""

from collections.abc import Iterable
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QSignalBlocker, Qt, QTimer, Signal
from PySide6.QtWidgets import QDoubleSpinBox, QGridLayout, QLabel, QSlider, QSpinBox, QWidget

from regolith_studio.ui.translation import tr

THROTTLE = 30
"""Milliseconds between two announcements while a slider is dragged: the first at once, the last always."""


LEAST_ROOM = "0000.00"
"""What a field has room for, whatever its range."""
ARROWS = 28
"""Pixels that arrows and frame take in a field."""


@dataclass(frozen=True)
class NumberSpec:
    """What number is asked for; words are translated where they are shown.

    Parameters
    ----------
    label
        Rich text before the slider; empty for none.
    name
        Plain words for screen readers.
    minimum, maximum
        Ends of the slider.
    step
        Smallest change; whole numbers if it is whole.
    limit
        Largest number that can be typed; `maximum` if not given.
    suffix
        Unit behind the number, with its leading blank.
    tip
        Shown when the mouse rests.
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
        """Whether only whole numbers are meant."""
        return float(self.step).is_integer()

    @property
    def decimals(self) -> int:
        """Digits after the point that the step needs."""
        return 0 if self.whole else len(f"{self.step:.6f}".rstrip("0").split(".")[1])


class NumberSlider(QWidget):
    """Edits one number. ``valueChanged`` is for changes by the user only, and throttled.

    ``editingFinished`` follows when the slider is let go or a typed number is confirmed.
    """

    valueChanged = Signal(object)  # noqa: N815
    editingFinished = Signal()  # noqa: N815

    def __init__(self, spec: NumberSpec) -> None:
        super().__init__()
        self.spec = spec
        self.label = QLabel(tr(spec.label))
        self.slider = QSlider(Qt.Orientation.Horizontal)
        self.field = QSpinBox() if spec.whole else QDoubleSpinBox()
        self._timer = QTimer(self, interval=THROTTLE, singleShot=True)
        self._announced: float | int | None = None
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
        self.slider.valueChanged.connect(self._slid)
        self.slider.sliderReleased.connect(self._finish)
        self.field.valueChanged.connect(self._typed)
        self.field.editingFinished.connect(self._finish)
        self._timer.timeout.connect(self._announce)
        self.setValue(spec.minimum)

    def value(self) -> float | int:
        """The number in the field."""
        return self.field.value()

    def setValue(self, value: float) -> None:
        """Show a number; announces nothing."""
        self._timer.stop()
        with QSignalBlocker(self.field), QSignalBlocker(self.slider):
            self.field.setValue(int(value) if self.spec.whole else float(value))  # type: ignore[arg-type]
            self.slider.setValue(self._ticks(self.field.value()))
        self._announced = self.field.value()

    def set_range(self, minimum: float, maximum: float) -> None:
        """Other ends of the slider and of the field; announces nothing."""
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
        self._widest = max(LEAST_ROOM, f"-{limit:.{spec.decimals}f}{field.suffix()}", key=len)
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
        """For the longest number, in letters of the present size."""
        self.field.setFixedWidth(self.field.fontMetrics().horizontalAdvance(self._widest) + ARROWS)

    def _ticks(self, value: float) -> int:
        return round(value / self.spec.step)

    def _slid(self, ticks: int) -> None:
        with QSignalBlocker(self.field):
            value = ticks * self.spec.step
            self.field.setValue(int(value) if self.spec.whole else value)  # type: ignore[arg-type]
        self._wait()

    def _typed(self, value: float) -> None:
        with QSignalBlocker(self.slider):
            self.slider.setValue(self._ticks(value))
        self._wait()

    def _wait(self) -> None:
        if not self._timer.isActive():
            self._announce()

    def _announce(self) -> None:
        """Tell the value, if it is new, and nothing more for a while."""
        value = self.value()
        if value != self._announced:
            self._announced = value
            self._timer.start()
            self.valueChanged.emit(value)

    def _finish(self) -> None:
        self._announce()
        self._timer.stop()
        self.editingFinished.emit()


def align_labels(sliders: Iterable[NumberSlider], least: int = 0) -> None:
    """Let sliders below each other begin at one place, behind the widest label or so many pixels."""
    each = list(sliders)
    widest = max((slider.label.sizeHint().width() for slider in each), default=0)
    for slider in each:
        slider.label.setFixedWidth(max(widest, least))
