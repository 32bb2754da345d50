"""A power spectrum whose bars can be dragged, on a logarithmic scale."""

import math

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QObject, QPointF, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent

from regolith_studio.ui.translation import localized, number_text, tr
from regolith_studio.ui.widgets.plots.base import Numbers, Plot

THROTTLE = 30
"""Minimum milliseconds between two ``valueChanged`` while a bar is dragged; the last is always emitted."""
LOG_MIN, LOG_MAX = -3.0, 1.8
"""Range of the decimal logarithm of amplitudes in per cent."""
KEY_FACTOR = 1.1


class SpectrumEditor(Plot):
    """Bars of sqrt(A_l) / mu in per cent, l = 1, 2, ...; edited by dragging or by the arrow keys.

    ``valueChanged`` is emitted for changes by the user only.
    """

    valueChanged = Signal(object)  # noqa: N815
    editingFinished = Signal()  # noqa: N815

    def __init__(self, placeholder: str) -> None:
        self._values: NDArray[np.float64] = np.empty(0)
        self._fitted: NDArray[np.float64] = np.empty(0)
        self._editable = False
        self._chosen = 0
        self._items: list[pg.BarGraphItem] = []
        super().__init__(tr("Degree l"), tr("Amplitude √A<sub>l</sub> / μ [%]"), placeholder)
        self._timer = QTimer(self, interval=THROTTLE, singleShot=True)
        self._timer.timeout.connect(self._emit_value)
        self._due = False
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName(
            tr("Spectrum of the model; left and right choose a degree, up and down change it")
        )
        self.canvas.viewport().installEventFilter(self)

    def value(self) -> NDArray[np.float64]:
        """Amplitudes relative to the mean radius, shape (l_max,)."""
        return self._values.copy()

    def setValue(self, values: NDArray[np.float64], editable: bool = True) -> None:
        """Show amplitudes, to which :meth:`reset` returns; emits no signal."""
        self._values, self._fitted = np.array(values, dtype=np.float64), np.array(values, dtype=np.float64)
        self._editable = editable
        self._chosen = min(self._chosen, max(0, len(values) - 1))
        self._timer.stop()
        self._due = False
        self.set_hint("")
        self.canvas.viewport().setCursor(
            Qt.CursorShape.SizeVerCursor if editable else Qt.CursorShape.ArrowCursor
        )
        self.set_empty(not len(values))
        self.redraw()

    def is_changed(self) -> bool:
        """Whether the user has changed a bar."""
        return bool((self._values != self._fitted).any())

    def reset(self) -> None:
        """Return to the amplitudes of :meth:`setValue`."""
        if self.is_changed():
            self._values = self._fitted.copy()
            self._changed()
            self.editingFinished.emit()

    def redraw(self) -> None:
        for item in self._items:
            self.canvas.removeItem(item)
        self._items = []
        if not len(self._values):
            return
        degrees = np.arange(1, len(self._values) + 1)
        for values, width, colour in (
            (self._fitted, 0.86, self.theme.border),
            (self._values, 0.62, self.theme.fit),
        ):
            heights = np.log10(np.maximum(100 * values, 1e-12)) - LOG_MIN
            bars = pg.BarGraphItem(
                x=degrees,
                y0=LOG_MIN,
                height=np.clip(heights, 0.0, LOG_MAX - LOG_MIN),
                width=width,
                brush=QColor(colour),
                pen=pg.mkPen(None),
            )
            self.canvas.addItem(bars)
            self._items.append(bars)
        self._draw_axes(len(degrees))

    def _draw_axes(self, count: int) -> None:
        decades = range(math.ceil(LOG_MIN), math.floor(LOG_MAX) + 1)
        self.canvas.getAxis("left").setTicks(
            [[(decade, number_text(10.0**decade, "g")) for decade in decades]]
        )
        step = 1 if count <= 15 else 5
        self.canvas.getAxis("bottom").setTicks(
            [[(d, str(d)) for d in range(1, count + 1) if d % step == 0 or d == 1]]
        )
        self.canvas.setRange(
            xRange=(0.3, count + 0.7), yRange=(LOG_MIN, LOG_MAX), padding=0.0, disableAutoRange=True
        )
        entries = [(self.theme.fit, tr("drag the bars") if self._editable else tr("as fitted"))]
        self.set_legend([*entries, (self.theme.border, tr("as fitted"))] if self.is_changed() else entries)

    def value_at(self, place: QPointF) -> str:
        seen = self.canvas.getViewBox().mapSceneToView(place)
        degree = round(seen.x())
        if not 1 <= degree <= len(self._values):
            return ""
        return localized(f"l = {degree}: {100 * self._values[degree - 1]:.3g} %")

    def numbers(self) -> Numbers:
        rows: list[tuple[str | float, ...]] = [
            (degree, 100.0 * float(value), 100.0 * float(fitted))
            for degree, (value, fitted) in enumerate(zip(self._values, self._fitted, strict=True), start=1)
        ]
        return ("l", tr("amplitude [%]"), tr("as fitted [%]")), rows

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if not self._editable or not isinstance(event, QMouseEvent) or not len(self._values):
            return super().eventFilter(watched, event)
        held = event.buttons() & Qt.MouseButton.LeftButton
        match event.type():
            case QEvent.Type.MouseButtonPress if event.button() == Qt.MouseButton.LeftButton:
                self.setFocus(Qt.FocusReason.MouseFocusReason)
                self._chosen = self._degree_at(event.position())
                self._drag_to(event.position())
                return True
            case QEvent.Type.MouseMove if held:
                self._drag_to(event.position())
                return True
            case QEvent.Type.MouseButtonRelease if event.button() == Qt.MouseButton.LeftButton:
                self._finish()
                return True
        return super().eventFilter(watched, event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        steps = {Qt.Key.Key_Left: -1, Qt.Key.Key_Right: 1}
        factors = {Qt.Key.Key_Up: KEY_FACTOR, Qt.Key.Key_Down: 1 / KEY_FACTOR}
        if not self._editable or not len(self._values):
            super().keyPressEvent(event)
        elif event.key() in steps:
            self._chosen = (self._chosen + steps[Qt.Key(event.key())]) % len(self._values)
            self.set_hint(self._words())
        elif event.key() in factors:
            self._put(float(self._values[self._chosen]) * factors[Qt.Key(event.key())])
            self._finish()
        else:
            super().keyPressEvent(event)

    def _degree_at(self, place: QPointF) -> int:
        return int(np.clip(round(self._seen(place).x()) - 1, 0, len(self._values) - 1))

    def _drag_to(self, place: QPointF) -> None:
        self._put(10.0 ** float(np.clip(self._seen(place).y(), LOG_MIN, LOG_MAX)) / 100)

    def _seen(self, place: QPointF) -> QPointF:
        seen: QPointF = self.canvas.getViewBox().mapSceneToView(self.canvas.mapToScene(place.toPoint()))
        return seen

    def _put(self, value: float) -> None:
        self._values[self._chosen] = np.clip(value, 10.0 ** (LOG_MIN - 2), 10.0 ** (LOG_MAX - 2))
        self.set_hint(self._words())
        self._changed()

    def _words(self) -> str:
        return localized(f"l = {self._chosen + 1}: {100 * self._values[self._chosen]:.3g} %")

    def _changed(self) -> None:
        self.redraw()
        self._due = True
        if not self._timer.isActive():
            self._emit_value()

    def _emit_value(self) -> None:
        if self._due:
            self._due = False
            self._timer.start()
            self.valueChanged.emit(self.value())

    def _finish(self) -> None:
        self._timer.stop()
        self._emit_value()
        self._timer.stop()
        self.editingFinished.emit()
