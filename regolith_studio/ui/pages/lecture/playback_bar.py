"""Playback controls of a lesson: play, pause, single steps, speed."""

from collections.abc import Callable

from PySide6.QtCore import QEvent, QSignalBlocker, Qt, QTimer, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QSlider, QWidget

from regolith_studio.messages import N_
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.numbers import NumberSlider, NumberSpec

SPEED = NumberSpec(
    N_("Speed"),
    N_("Steps per second"),
    0.5,
    20.0,
    0.5,
    suffix=" /s",
    tip=N_("Steps per second during playback."),
)
USUAL_SPEED = 2.0


class PlaybackBar(QWidget):
    """Selects one of several steps, manually or by a timer.

    - ``name``: prefix of the object names.
    - ``noun``: what one step is called, such as ``step``.
    - ``is_ready``: whether a step can be shown at once; while it plays, it waits for that.
    """

    stepChanged = Signal(int)  # noqa: N815

    def __init__(self, name: str, noun: str, is_ready: Callable[[int], bool] = lambda _step: True) -> None:
        super().__init__()
        self._is_ready = is_ready
        self._noun = noun
        self.back, self.play, self.forward = QPushButton("◀"), QPushButton(tr("Play")), QPushButton("▶")
        self.first = QPushButton("|◀")
        for button, key, words in (
            (self.first, "first", tr("To the beginning")),
            (self.back, "back", tr("One step back")),
            (self.play, "play", tr("Play or pause")),
            (self.forward, "forward", tr("One step")),
        ):
            button.setObjectName(f"{name}_{key}")
            button.setAccessibleName(words)
            button.setToolTip(words)
        self.slider = QSlider(Qt.Orientation.Horizontal)
        self.slider.setObjectName(f"{name}_step")
        self.slider.setAccessibleName(tr("Number of the {noun}", noun=tr(noun)))
        self.speed = NumberSlider(SPEED)
        self.speed.setObjectName(f"{name}_speed")
        self.speed.setMaximumWidth(300)
        self.clock = QLabel()
        self._timer = QTimer(self)
        self._timer.timeout.connect(self._next)
        self._arrange()
        self.first.clicked.connect(lambda: self.go(0))
        self.back.clicked.connect(lambda: self.go(self.step - 1))
        self.forward.clicked.connect(lambda: self.go(self.step + 1))
        self.play.clicked.connect(self.toggle)
        self.slider.valueChanged.connect(self._changed)
        self.speed.valueChanged.connect(lambda _: self._timer.setInterval(self._interval()))
        self.speed.setValue(USUAL_SPEED)
        self.set_count(0)

    @property
    def step(self) -> int:
        """The current step."""
        return self.slider.value()

    @property
    def playing(self) -> bool:
        """Whether the timer is running."""
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
        for part in (self.first, self.back, self.play, self.forward, self.slider):
            part.setEnabled(count > 1)
        self._reserve_width()
        self._show_position()

    def extend(self, count: int) -> None:
        """Set a larger number of steps; the current one stays."""
        self.set_count(count, self.step)

    def go(self, step: int) -> None:
        """Go to a step and pause."""
        self.pause()
        self.slider.setValue(step)

    def toggle(self) -> None:
        """Play, from the beginning if the end is reached, or pause."""
        if self.playing:
            self.pause()
        elif self.has_steps:
            if self.step == self.slider.maximum():
                self.slider.setValue(0)
            self.play.setText(tr("Pause"))
            self._timer.start(self._interval())

    def pause(self) -> None:
        """Stop the timer."""
        self._timer.stop()
        self.play.setText(tr("Play"))

    def _interval(self) -> int:
        return round(1000 / max(float(self.speed.value()), 0.1))

    def _next(self) -> None:
        if self.step >= self.slider.maximum():
            self.pause()
        elif self._is_ready(self.step + 1):
            self.slider.setValue(self.step + 1)

    def _changed(self, step: int) -> None:
        self._show_position()
        self.stepChanged.emit(step)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._reserve_width()

    def _reserve_width(self) -> None:
        """Reserve width for the longest texts, so that the slider does not move."""
        last = self.slider.maximum()
        widest = self._words("0" * len(str(last)))
        self.clock.setMinimumWidth(self.clock.fontMetrics().horizontalAdvance(widest) + 4)
        metrics, now = self.play.fontMetrics(), self.play.text()
        longest = max(metrics.horizontalAdvance(text) for text in (tr("Play"), tr("Pause")))
        self.play.setMinimumWidth(self.play.sizeHint().width() - metrics.horizontalAdvance(now) + longest)

    def _show_position(self) -> None:
        self.clock.setText(self._words(self.step))

    def _words(self, at: object) -> str:
        return tr("{noun} {at} of {last}", noun=tr(self._noun), at=at, last=self.slider.maximum())

    def _arrange(self) -> None:
        row = QHBoxLayout(self)
        row.setContentsMargins(8, 4, 8, 4)
        row.setSpacing(8)
        for part in (self.first, self.back, self.play, self.forward):
            row.addWidget(part)
        row.addWidget(self.slider, 1)
        row.addWidget(self.clock)
        row.addWidget(self.speed)
