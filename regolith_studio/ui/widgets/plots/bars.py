"""Grouped bars, and a spectrum whose bars can be dragged."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QObject, QPointF, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QFont, QFontMetrics, QKeyEvent, QMouseEvent, QResizeEvent

from regolith_studio.ui.translation import localized, number_text, tr
from regolith_studio.ui.widgets.plots.base import Numbers, Plot

GAP = 3
"""Pixels between the names of two categories."""
MIN_POINTS = 6.0
"""Smallest font size."""
MIN_SCALE = 0.75
"""Smallest font size of names on a single line, as a share of the usual size."""


@dataclass(frozen=True)
class BarSeries:
    """The bars of one colour.

    - ``label``: for the legend.
    - ``colour``: hexadecimal RGB.
    - ``values``: one for each category; NaN for none.
    - ``faint``: drawn half transparent, for a result that is being replaced.
    - ``bounds``: lower bound of each value, drawn as a line across its bar; empty for none.
    """

    label: str
    colour: str
    values: tuple[float, ...]
    faint: bool = False
    bounds: tuple[float, ...] = ()


class BarPlot(Plot):
    """Bars from zero, side by side within each category; the tool tip shows values."""

    def __init__(self, x: str, y: str, placeholder: str, unit: str = "%") -> None:
        self._categories: tuple[str, ...] = ()
        self._short: tuple[str, ...] = ()
        self._tips: tuple[str, ...] = ()
        self._series: tuple[BarSeries, ...] = ()
        self._items: list[object] = []
        self._unit = unit
        super().__init__(x, y, placeholder)

    @property
    def series(self) -> tuple[BarSeries, ...]:
        return self._series

    def set_bars(
        self,
        categories: Sequence[str],
        series: Sequence[BarSeries],
        short: Sequence[str] = (),
        tips: Sequence[str] = (),
    ) -> None:
        """Draw other bars.

        ``short``: names of the categories for narrow plots. ``tips``: what the categories mean, for the tool
        tip.
        """
        self._categories, self._series = tuple(categories), tuple(series)
        self._short = tuple(short) or self._categories
        self._tips = tuple(tips) or self._categories
        self.set_empty(not any(np.isfinite(each.values).any() for each in series))
        self.redraw()

    def numbers(self) -> Numbers:
        bounded = [each for each in self._series if each.bounds]
        rows: list[tuple[str | float, ...]] = [
            (category, *(each.values[place] for each in self._series), *(b.bounds[place] for b in bounded))
            for place, category in enumerate(self._categories)
        ]
        names = [each.label for each in self._series]
        names += [tr("{name}, not below", name=each.label) for each in bounded]
        return (tr("category"), *(f"{name} [{self._unit}]" for name in names)), rows

    def redraw(self) -> None:
        for item in self._items:
            self.canvas.removeItem(item)
        self._items = []
        width = 0.76 / max(1, len(self._series))
        for number, series in enumerate(self._series):
            colour = QColor(series.colour)
            colour.setAlpha(90 if series.faint else 255)
            places = np.arange(len(series.values)) + (number - (len(self._series) - 1) / 2) * width
            bars = pg.BarGraphItem(
                x=places,
                height=np.nan_to_num(series.values),
                width=width * 0.92,
                brush=colour,
                pen=pg.mkPen(None),
            )
            self.canvas.addItem(bars)
            self._items.append(bars)
            if series.bounds:
                self._draw_bounds(places, np.asarray(series.bounds), width / 2)
        self._name_categories()
        tops = [value for each in self._series for value in each.values if np.isfinite(value)]
        top = max(tops, default=1.0) * 1.12 or 1.0
        self.canvas.setRange(
            xRange=(-0.55, len(self._categories) - 0.45),
            yRange=(0.0, top),
            padding=0.0,
            disableAutoRange=True,
        )
        legend = [(each.colour, each.label) for each in self._series]
        if any(bound > 0.0 for each in self._series for bound in each.bounds):
            legend.append((self.theme.text, tr("lower bound")))
        self.set_legend(legend)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._name_categories()

    def _name_categories(self) -> None:
        """Set the category names: long or short ones, in a smaller font or on two lines if necessary."""
        font = self.small_font()
        room = (self.width() - self.axes["left"].width()) / max(1, len(self._categories)) - GAP
        names = self._categories if _widest(self._categories, font) < room else self._short
        least = max(MIN_POINTS, MIN_SCALE * font.pointSizeF())
        if _widest(names, _shrunk(names, font, room, least)) > room:  # every other name on a second line
            names = tuple(f"\n{name}" if at % 2 else name for at, name in enumerate(names))
            room, least = 2 * room, MIN_POINTS
        self.axes["bottom"].setTickFont(_shrunk(names, font, room, least))
        self.axes["bottom"].setTicks([list(enumerate(names))])

    def _draw_bounds(self, places: np.ndarray[Any, Any], bounds: np.ndarray[Any, Any], reach: float) -> None:
        seen = np.isfinite(bounds) & (bounds > 0.0)
        x = np.column_stack([places[seen] - reach, places[seen] + reach]).ravel()
        line = pg.PlotDataItem(
            x, np.repeat(bounds[seen], 2), connect="pairs", pen=self.pen(self.theme.text, 2.0)
        )
        self.canvas.addItem(line, ignoreBounds=True)
        self._items.append(line)

    def value_at(self, place: QPointF) -> str:
        here = self.canvas.getViewBox().mapSceneToView(place)
        category = round(here.x())
        if not 0 <= category < len(self._categories) or here.y() < 0:
            return ""
        lines = [
            f"{each.label}: {number_text(each.values[category], '.3g')} {self._unit}" for each in self._series
        ]
        lines += [
            tr("not below {bound:.3g} {unit} (line)", bound=each.bounds[category], unit=self._unit)
            for each in self._series
            if each.bounds and each.bounds[category] > 0.0
        ]
        return "\n".join([self._tips[category], *lines])


def _shrunk(names: Sequence[str], font: QFont, room: float, least: float) -> QFont:
    """The largest font in which each name fits, at least `least` points."""
    smaller = QFont(font)
    while _widest(names, smaller) > room and smaller.pointSizeF() > least:
        smaller.setPointSizeF(max(least, smaller.pointSizeF() - 0.5))
    return smaller


def _widest(names: Sequence[str], font: QFont) -> int:
    metrics = QFontMetrics(font)
    return max((metrics.horizontalAdvance(name.strip()) for name in names), default=0)


THROTTLE = 30
"""Minimum milliseconds between two ``valueChanged`` while a bar is dragged; the last is always emitted."""
LOG_MIN, LOG_MAX = -3.0, 1.8
"""Range of the decimal logarithm of amplitudes in per cent."""
KEY_FACTOR = 1.1


class AmplitudePlot(Plot):
    """Bars of amplitudes over their degree l = 1, 2, ..., on a logarithmic scale of per cent."""

    def __init__(self, y: str, placeholder: str) -> None:
        self._bars: list[pg.BarGraphItem] = []
        super().__init__(tr("Degree l"), y, placeholder)

    @property
    def percents(self) -> NDArray[np.float64]:
        """The amplitudes in per cent, shape (l_max,)."""
        raise NotImplementedError

    def draw_bars(
        self, series: Sequence[tuple[NDArray[np.float64], float, str]], low: float, high: float
    ) -> None:
        """Draw per cents, NaN for none, with width and colour of their bars, between two powers of ten."""
        for item in self._bars:
            self.canvas.removeItem(item)
        self._bars = []
        degrees = np.arange(1, len(self.percents) + 1)
        for values, width, colour in series:
            heights = np.log10(np.maximum(np.nan_to_num(values), 1e-12)) - low
            bars = pg.BarGraphItem(
                x=degrees,
                y0=low,
                height=np.clip(heights, 0.0, high - low),
                width=width,
                brush=QColor(colour),
                pen=pg.mkPen(None),
            )
            self.canvas.addItem(bars)
            self._bars.append(bars)
        decades = range(math.ceil(low), math.floor(high) + 1)
        self.canvas.getAxis("left").setTicks(
            [[(decade, number_text(10.0**decade, "g")) for decade in decades]]
        )
        ends = (0.3, len(degrees) + 0.7)
        self.canvas.setRange(xRange=ends, yRange=(low, high), padding=0.0, disableAutoRange=True)

    def value_at(self, place: QPointF) -> str:
        degree = round(self.canvas.getViewBox().mapSceneToView(place).x())
        return self.words_of(degree) if 1 <= degree <= len(self.percents) else ""

    def words_of(self, degree: int) -> str:
        return localized(f"l = {degree}: {self.percents[degree - 1]:.3g} %")


class SpectrumEditor(AmplitudePlot):
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
        super().__init__(tr("Amplitude √A<sub>l</sub> / μ [%]"), placeholder)
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
        return bool((self._values != self._fitted).any())

    def reset(self) -> None:
        """Return to the amplitudes of :meth:`setValue`."""
        if self.is_changed():
            self._values = self._fitted.copy()
            self._changed()
            self.editingFinished.emit()

    def redraw(self) -> None:
        if not len(self._values):
            return
        fitted, changed = 100 * self._fitted, self.percents
        series = [(fitted, 0.86, self.theme.border), (changed, 0.62, self.theme.fit)]
        self.draw_bars(series, LOG_MIN, LOG_MAX)
        count = len(changed)
        step = 1 if count <= 15 else 5
        self.canvas.getAxis("bottom").setTicks(
            [[(d, str(d)) for d in range(1, count + 1) if d % step == 0 or d == 1]]
        )
        entries = [(self.theme.fit, tr("drag the bars") if self._editable else tr("as fitted"))]
        self.set_legend([*entries, (self.theme.border, tr("as fitted"))] if self.is_changed() else entries)

    @property
    def percents(self) -> NDArray[np.float64]:
        return 100 * self._values

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
            self.set_hint(self.words_of(self._chosen + 1))
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
        self.set_hint(self.words_of(self._chosen + 1))
        self._changed()

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
