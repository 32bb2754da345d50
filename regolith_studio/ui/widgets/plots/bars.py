"""Grouped bar plots."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF
from PySide6.QtGui import QColor, QFont, QFontMetrics, QResizeEvent

from regolith_studio.ui.translation import number_text, tr
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
        """The bars that are drawn."""
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
