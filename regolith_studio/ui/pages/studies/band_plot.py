"""Curves and points with error bars of bootstrap intervals."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF

from regolith_studio.ui.translation import tr
from regolith_studio.ui.translation.numbers import number_text
from regolith_studio.ui.widgets.plots.base import Numbers
from regolith_studio.ui.widgets.plots.curves import HOVER_DISTANCE, CurvePlot, PlotCurve
from regolith_studio.ui.widgets.plots.export import plain_text

Values = tuple[float, ...]


@dataclass(frozen=True)
class Series:
    """Points with intervals.

    Parameters
    ----------
    label, colour
        For the legend; rich text and hexadecimal RGB.
    x, y
        The points.
    low, high
        Ends of the interval of each y.
    left, right
        Ends of the interval of each x; empty if x is not measured.
    line
        Whether the points are joined.
    """

    label: str
    colour: str
    x: Values
    y: Values
    low: Values
    high: Values
    left: Values = ()
    right: Values = ()
    line: bool = True


class BandPlot(CurvePlot):
    """Points with error bars; tool tips show values and intervals."""

    def __init__(self, x: str, y: str, placeholder: str, log_y: bool = False) -> None:
        self._series: tuple[Series, ...] = ()
        self._bars: list[pg.PlotDataItem] = []
        super().__init__(x, y, placeholder, log_y)

    @property
    def series(self) -> tuple[Series, ...]:
        """The series that are drawn."""
        return self._series

    def set_series(self, series: Sequence[Series], behind: Sequence[PlotCurve] = ()) -> None:
        """Draw other series, and curves behind them."""
        self._series = tuple(series)
        points = [PlotCurve(s.label, s.colour, s.x, s.y, markers=True, line=s.line) for s in self._series]
        self.set_curves([*behind, *points])

    def numbers(self) -> Numbers:
        x, y = self._labels
        rows: list[tuple[str | float, ...]] = [
            (plain_text(s.label), px, left, right, py, low, high)
            for s in self._series
            for px, left, right, py, low, high in zip(
                s.x, s.left or s.x, s.right or s.x, s.y, s.low, s.high, strict=True
            )
        ]
        return ("curve", x, f"{x}, low", f"{x}, high", y, f"{y}, low", f"{y}, high"), rows

    def redraw(self) -> None:
        super().redraw()
        while self._bars:
            self.canvas.removeItem(self._bars.pop())
        for s in self._series:
            self._draw_bars(s.colour, np.repeat(s.x, 2), np.column_stack([s.low, s.high]).ravel())
            if s.left:
                self._draw_bars(s.colour, np.column_stack([s.left, s.right]).ravel(), np.repeat(s.y, 2))

    def value_at(self, place: QPointF) -> str:
        """Values and intervals of the nearest point; empty if it is far."""
        best, words = HOVER_DISTANCE, ""
        for s in self._series:
            for number, (x, y) in enumerate(zip(s.x, s.y, strict=True)):
                seen = self.scene_position(x, y)
                away = float(np.hypot(seen.x() - place.x(), seen.y() - place.y()))
                if away < best:
                    best, words = away, self._words(s, number)
        return words

    def scene_position(self, x: float, y: float) -> QPointF:
        """Position of a point in the scene."""
        with np.errstate(divide="ignore", invalid="ignore"):
            high = float(np.log10(y)) if self._log_y else y
        place: QPointF = self.canvas.getViewBox().mapViewToScene(QPointF(x, high))
        return place

    def _words(self, s: Series, n: int) -> str:
        x, y = (plain_text(label) for label in self._labels)
        across = " " + _interval(s.left[n], s.right[n]) if s.left else ""
        return (
            f"{plain_text(s.label)}\n{x}: {number_text(s.x[n], '.4g')}{across}\n"
            f"{y}: {number_text(s.y[n], '.4g')} {_interval(s.low[n], s.high[n])}"
        )

    def _draw_bars(self, colour: str, x: "np.typing.NDArray[np.float64]", y: object) -> None:
        ends = (np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        self._bars.append(self.canvas.plot(*ends, connect="pairs", pen=self.pen(colour)))


def _interval(low: float, high: float) -> str:
    return tr("({low:.4g} to {high:.4g})", low=low, high=high)
