"""Line plots: curves with symbols over common axes, with a tool tip at each point."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF
from PySide6.QtGui import QColor

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.ui.translation import number_text, tr
from regolith_studio.ui.widgets.plots.base import Numbers, Plot, PlotCanvas, plain_text

SYMBOL = 5
"""Diameter of a symbol in pixels."""
HOVER_DISTANCE = 24.0
"""Pixels from a point within which the tool tip shows its values."""

LEAST_SPAN = 2e-3
"""Least height of a linear axis, as a share of its largest number: the numbers of less have no room at the
axis, and a change in the last digits would fill the plot."""


class CurveItems:
    """Graphics items of a curve: a line, and a scatter item only for curves with symbols.

    :class:`pyqtgraph.PlotDataItem` always creates both, at several times the cost.

    ``log_y``: whether the y axis is logarithmic.
    """

    def __init__(self, canvas: PlotCanvas, log_y: bool) -> None:
        self._canvas, self._log_y = canvas, log_y
        self.line = pg.PlotCurveItem(antialias=True, connect="finite")
        self.points: pg.ScatterPlotItem | None = None
        canvas.addItem(self.line)

    def draw(self, x: Sequence[float], y: Sequence[float], pen: object, symbols: str = "") -> None:
        """Draw other points.

        - ``x``, ``y``: the line is interrupted where one is not finite or, on a logarithmic axis, not
          positive.
        - ``pen``: of the line; ``None`` for none.
        - ``symbols``: colour of the symbols; empty for none.
        """
        across, up = self._coordinates(x, y)
        self.line.setData(across, up, pen=pen)
        self.line.setVisible(pen is not None)
        if not symbols:
            self._remove_points()
            return
        if self.points is None:
            self.points = pg.ScatterPlotItem(size=SYMBOL, pen=None, antialias=True)
            self._canvas.addItem(self.points)
        seen = np.isfinite(across) & np.isfinite(up)
        self.points.setData(across[seen], up[seen], brush=QColor(symbols))

    def remove(self) -> None:
        self._canvas.removeItem(self.line)
        self._remove_points()

    def _remove_points(self) -> None:
        if self.points is not None:
            self._canvas.removeItem(self.points)
            self.points = None

    def _coordinates(self, x: Sequence[float], y: Sequence[float]) -> tuple[FloatArray, FloatArray]:
        """Coordinates on the axes; empty if no point is finite, as the automatic range needs one."""
        across, up = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
        if self._log_y:
            up = np.log10(np.where(up > 0.0, up, np.nan))
        some = bool((np.isfinite(across) & np.isfinite(up)).any())
        return (across, up) if some else (across[:0], up[:0])


@dataclass(frozen=True)
class PlotCurve:
    """A line through points.

    - ``label``: for the legend; rich text; empty for no entry.
    - ``colour``: hexadecimal RGB.
    - ``x``, ``y``: the points; NaN breaks the line.
    - ``markers``: whether the points themselves are drawn.
    - ``dash``: whether the line is dashed.
    - ``line``: whether there is a line, or only markers.
    """

    label: str
    colour: str
    x: tuple[float, ...]
    y: tuple[float, ...]
    markers: bool = False
    dash: bool = False
    line: bool = True


def plain_decades(values: Sequence[float], _scale: float, _spacing: float) -> list[str]:
    """Tick labels of a logarithmic axis as plain numbers."""
    return [f"{10.0**value:.3g}" for value in values]


class CurvePlot(Plot):
    """Curves with automatic axes; the tool tip shows the values of a point.

    ``log_y``: whether the y axis is logarithmic.
    """

    def __init__(self, x: str, y: str, placeholder: str, log_y: bool = False) -> None:
        self._curves: tuple[PlotCurve, ...] = ()
        self._drawn: list[tuple[PlotCurve, CurveItems]] = []
        self._marker: float | None = None
        self._line: pg.InfiniteLine | None = None
        self._log_y = log_y
        super().__init__(x, y, placeholder)
        self.canvas.setLogMode(x=False, y=log_y)
        self.canvas.getAxis("left").logTickStrings = plain_decades

    @property
    def curves(self) -> tuple[PlotCurve, ...]:
        return self._curves

    def set_curves(self, curves: Sequence[PlotCurve]) -> None:
        self._curves = tuple(curves)
        self.set_empty(not any(curve.x for curve in curves))
        self.redraw()

    def numbers(self) -> Numbers:
        rows: list[tuple[str | float, ...]] = [
            (plain_text(curve.label), float(x), float(y))
            for curve in self._curves
            for x, y in zip(curve.x, curve.y, strict=True)
        ]
        return (tr("curve"), *self._labels), rows

    def set_marker(self, x: float | None) -> None:
        """Draw a vertical line at `x`, or remove it."""
        self._marker = x
        self._draw_marker()

    def redraw(self) -> None:
        wanted = [curve for curve in self._curves if curve.x]
        while len(self._drawn) > len(wanted):
            self._drawn.pop()[1].remove()
        for at, curve in enumerate(wanted):
            if at == len(self._drawn):
                self._drawn.append((curve, CurveItems(self.canvas, self._log_y)))
            elif curve == self._drawn[at][0]:
                continue
            pen = self.pen(curve.colour, dash=curve.dash) if curve.line else None
            items = self._drawn[at][1]
            items.draw(curve.x, curve.y, pen, curve.colour if curve.markers else "")
            self._drawn[at] = (curve, items)
        self._limit_span()
        self.count_axis.whole = all(
            float(x).is_integer() or math.isnan(x) for curve in self._curves for x in curve.x
        )
        self.set_legend([(curve.colour, curve.label) for curve in self._curves if curve.label])
        self._draw_marker()

    def _limit_span(self) -> None:
        heights = np.abs([y for curve in self._curves for y in curve.y])
        largest = float(np.max(heights, initial=0.0, where=np.isfinite(heights)))
        if not self._log_y:
            self.canvas.getViewBox().setLimits(minYRange=LEAST_SPAN * largest)

    def value_at(self, place: QPointF) -> str:
        """Label and values of the nearest point of a curve; empty if it is far."""
        view = self.canvas.getViewBox()
        best, words = HOVER_DISTANCE, ""
        for curve in self._curves:
            x, y = np.asarray(curve.x, dtype=float), np.asarray(curve.y, dtype=float)
            if not len(x):
                continue
            with np.errstate(divide="ignore", invalid="ignore"):
                high = np.log10(y) if self._log_y else y
            origin = view.mapViewToScene(QPointF(0.0, 0.0))
            step = view.mapViewToScene(QPointF(1.0, 1.0)) - origin
            away = np.hypot(origin.x() + x * step.x() - place.x(), origin.y() + high * step.y() - place.y())
            if not np.isfinite(away).any():
                continue
            nearest = int(np.nanargmin(away))
            if away[nearest] < best:
                best = float(away[nearest])
                label = plain_text(curve.label)
                words = f"{label}\n" if label else ""
                words += f"{plain_text(self._labels[0])}: {number_text(x[nearest], '.5g')}\n"
                words += f"{plain_text(self._labels[1])}: {number_text(y[nearest], '.5g')}"
        return words

    def _draw_marker(self) -> None:
        if self._marker is None:
            if self._line is not None:
                self.canvas.removeItem(self._line)
                self._line = None
            return
        pen = self.pen(self.theme.muted, dash=True)
        if self._line is None:
            self._line = pg.InfiniteLine(self._marker, pen=pen)
            self.canvas.addItem(self._line, ignoreBounds=True)
        else:
            self._line.setPen(pen)
            self._line.setValue(self._marker)
