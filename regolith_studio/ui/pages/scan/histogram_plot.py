"""The histogram of grey values with the threshold as a line that can be dragged."""

from collections.abc import Sequence

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Signal
from PySide6.QtWidgets import QWidget

from regolith_studio.imaging.segmentation.thresholding import Histogram
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.widgets.plot import Plot


class HistogramPlot(Plot):
    """How often grey values occur, before and after denoising."""

    levelDragged = Signal(float)  # noqa: N815
    """The line is being dragged, or was let go, at this grey value."""

    def __init__(self, parent: QWidget | None = None) -> None:
        self._scanned: Histogram | None = None
        self._denoised: Histogram | None = None
        self._curves: list[pg.PlotDataItem] = []
        self.line = pg.InfiniteLine(
            angle=90, movable=True, label="{value:.4g}", labelOpts={"position": 0.92, "movable": False}
        )
        super().__init__(
            "Grey value", "Voxels [%]", "Open a volume of grey values to see its histogram.", parent
        )
        self.canvas.setLogMode(x=False, y=True)
        self.canvas.getAxis("left").logTickStrings = _plain_powers
        self.canvas.addItem(self.line, ignoreBounds=True)
        self.canvas.setAccessibleName("Histogram of grey values with the threshold")
        self.line.sigDragged.connect(lambda line: self.levelDragged.emit(float(line.value())))

    def set_scanned(self, seen: Histogram | None) -> None:
        """The volume as it was scanned."""
        self._scanned, self._denoised = seen, None
        self.set_empty(seen is None, "A volume of labels has no histogram of grey values.")
        self.redraw()

    def set_denoised(self, seen: Histogram | None) -> None:
        """The part of the preview, or the volume, without noise."""
        self._denoised = seen
        self.redraw()

    def set_level(self, level: float | None) -> None:
        """Put the line somewhere; announces nothing."""
        self.line.setVisible(level is not None)
        if level is not None and level != self.line.value():
            self.line.setValue(level)

    def set_theme(self, theme: Theme) -> None:
        super().set_theme(theme)
        self.line.setPen(pg.mkPen(theme.accent, width=2))
        self.line.setHoverPen(pg.mkPen(theme.accent, width=4))
        self.line.label.setColor(theme.accent)
        self.line.label.fill = pg.mkBrush(theme.base)

    def redraw(self) -> None:
        for curve in self._curves:
            self.canvas.removeItem(curve)
        shown = [
            (self._scanned, self.theme.particle, "as scanned"),
            (self._denoised, self.theme.fit, "without noise"),
        ]
        self._curves = [
            self.canvas.plot(_edges(seen), _heights(seen), stepMode="center", pen=self.pen(colour, 1.0))
            for seen, colour, _ in shown
            if seen is not None
        ]
        self.set_legend([(colour, label) for seen, colour, label in shown if seen is not None])
        self.line.setZValue(10)


def _plain_powers(values: Sequence[float], scale: float, spacing: float) -> list[str]:  # noqa: ARG001
    """Ticks of the logarithmic axis as plain numbers."""
    return [f"{10.0**value:g}" for value in values]


def _edges(seen: Histogram) -> np.ndarray:
    return np.asarray(seen.edges)


def _heights(seen: Histogram) -> np.ndarray:
    """Share of all voxels, in per cent; empty bins at the foot of the logarithmic axis."""
    share = 100.0 * seen.counts / max(int(seen.counts.sum()), 1)
    return np.asarray(np.maximum(share, 1e-4))
