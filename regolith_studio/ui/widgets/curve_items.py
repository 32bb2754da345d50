"""One curve on a canvas: a line, and symbols only where there are some."""

from collections.abc import Sequence

import numpy as np
import pyqtgraph as pg
from PySide6.QtGui import QColor

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.ui.widgets.canvas import PlotCanvas

SYMBOL = 5
"""Pixels across a point."""


class CurveItems:
    """What is drawn of a curve; :class:`pyqtgraph.PlotDataItem` always has both, for several times the work.

    Parameters
    ----------
    log_y
        Whether heights are drawn as their logarithms.
    """

    def __init__(self, canvas: PlotCanvas, log_y: bool) -> None:
        self._canvas, self._log_y = canvas, log_y
        self.line = pg.PlotCurveItem(antialias=True, connect="finite")
        self.points: pg.ScatterPlotItem | None = None
        canvas.addItem(self.line)

    def draw(self, x: Sequence[float], y: Sequence[float], pen: object, symbols: str = "") -> None:
        """Draw these points instead.

        Parameters
        ----------
        x, y
            A line is broken where one of them is not finite, or has no place on the axes.
        pen
            Of the line; ``None`` for no line.
        symbols
            Their colour; none where it is empty.
        """
        across, up = self._places(x, y)
        self.line.setData(across, up, pen=pen)
        self.line.setVisible(pen is not None)
        if not symbols:
            self._forget_points()
            return
        if self.points is None:
            self.points = pg.ScatterPlotItem(size=SYMBOL, pen=None, antialias=True)
            self._canvas.addItem(self.points)
        seen = np.isfinite(across) & np.isfinite(up)
        self.points.setData(across[seen], up[seen], brush=QColor(symbols))

    def remove(self) -> None:
        """Draw the curve no longer."""
        self._canvas.removeItem(self.line)
        self._forget_points()

    def _forget_points(self) -> None:
        if self.points is not None:
            self._canvas.removeItem(self.points)
            self.points = None

    def _places(self, x: Sequence[float], y: Sequence[float]) -> tuple[FloatArray, FloatArray]:
        """On the axes; none at all where no point has one: an axis would follow nothing."""
        across, up = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
        if self._log_y:
            up = np.log10(np.where(up > 0.0, up, np.nan))
        some = bool((np.isfinite(across) & np.isfinite(up)).any())
        return (across, up) if some else (across[:0], up[:0])
