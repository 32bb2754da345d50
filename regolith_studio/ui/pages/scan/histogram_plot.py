"""Histogram of grey values with the threshold as a draggable line."""

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF, Signal

from regolith_studio.imaging.segmentation.thresholding import Histogram
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import tr
from regolith_studio.ui.translation.numbers import number_text
from regolith_studio.ui.widgets.plots.base import Numbers, Plot
from regolith_studio.ui.widgets.plots.curves import plain_decades

MIN_PERCENTAGE = 1e-4
"""Height of empty bins on the logarithmic axis."""


class HistogramPlot(Plot):
    """Histograms before and after denoising."""

    levelDragged = Signal(float)  # noqa: N815
    """Grey value of the line while it is dragged or after it is released."""

    def __init__(self) -> None:
        self._scanned: Histogram | None = None
        self._denoised: Histogram | None = None
        self._curves: list[pg.PlotDataItem] = []
        self.line = pg.InfiniteLine(
            angle=90, movable=True, label="", labelOpts={"position": 0.92, "movable": False}
        )
        super().__init__(
            tr("Grey value"),
            tr("Voxels [%]"),
            tr("Open a volume of grey values to see its histogram."),
        )
        self.canvas.setLogMode(x=False, y=True)
        self.canvas.getAxis("left").logTickStrings = plain_decades
        self.canvas.addItem(self.line, ignoreBounds=True)
        self.canvas.setAccessibleName(tr("Histogram of grey values with the threshold"))
        self.line.sigPositionChanged.connect(
            lambda line: line.label.setText(number_text(float(line.value()), ".4g"))
        )
        self.line.sigDragged.connect(lambda line: self.levelDragged.emit(float(line.value())))

    def set_scanned(self, seen: Histogram | None) -> None:
        """Set the histogram of the scanned volume."""
        self._scanned, self._denoised = seen, None
        self.set_empty(seen is None, tr("A volume of labels has no histogram of grey values."))
        self.redraw()

    def set_denoised(self, seen: Histogram | None) -> None:
        """Set the histogram after denoising, of the preview or of the volume."""
        self._denoised = seen
        self.redraw()

    def set_level(self, level: float | None) -> None:
        """Move the line without emitting a signal."""
        self.line.setVisible(level is not None)
        if level is not None and level != self.line.value():
            self.line.setValue(level)

    def set_theme(self, theme: Theme) -> None:
        super().set_theme(theme)
        self.line.setPen(pg.mkPen(theme.accent, width=2))
        self.line.setHoverPen(pg.mkPen(theme.accent, width=4))
        self.line.label.setColor(theme.accent)
        self.line.label.fill = pg.mkBrush(theme.base)

    def value_at(self, place: QPointF) -> str:
        """Grey values of the bin at a position and their share of the voxels."""
        box = self.canvas.getViewBox()
        if not self._shown() or not box.sceneBoundingRect().contains(place):
            return ""
        value = float(box.mapSceneToView(place).x())
        first, *_ = (seen for seen, _, _ in self._shown())
        found = first.bin_of(value)
        if found is None:
            return ""
        lines = [_bin_text(first, found)]
        for seen, _, label in self._shown():
            place_in = seen.bin_of(value)
            if place_in is not None:
                share = 100 * seen.shares[place_in]
                lines.append(tr("{label}: {share:.3g} % of voxels", label=label, share=share))
        return "\n".join(lines)

    def numbers(self) -> Numbers:
        """Edges of the bins and what is in them."""
        rows: list[tuple[str | float, ...]] = [
            (label, float(low), float(high), int(count))
            for seen, _, label in self._shown()
            for low, high, count in zip(seen.edges[:-1], seen.edges[1:], seen.counts, strict=True)
        ]
        return (tr("Histogram"), tr("From"), tr("To"), tr("Voxels")), rows

    def redraw(self) -> None:
        for curve in self._curves:
            self.canvas.removeItem(curve)
        self._curves = [
            self.canvas.plot(
                seen.edges,
                np.maximum(100 * seen.shares, MIN_PERCENTAGE),
                stepMode="center",
                pen=self.pen(colour, 1.0),
            )
            for seen, colour, _ in self._shown()
        ]
        self.set_legend([(colour, label) for _, colour, label in self._shown()])
        self.line.setZValue(10)

    def _shown(self) -> list[tuple[Histogram, str, str]]:
        """Histograms with their colours and names."""
        known = [
            (self._scanned, self.theme.particle, tr("as scanned")),
            (self._denoised, self.theme.fit, tr("without noise")),
        ]
        return [(seen, colour, label) for seen, colour, label in known if seen is not None]


def _bin_text(seen: Histogram, place: int) -> str:
    low, high = float(seen.edges[place]), float(seen.edges[place + 1])
    if high - low == 1.0 and low % 1.0 == 0.5:
        return tr("Grey value {value:g}", value=low + 0.5)
    return tr("Grey values {low:.4g} to {high:.4g}", low=low, high=high)
