"""Angular power spectrum of the particle; bars beyond the chosen l_max are faint."""

import math

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QVBoxLayout, QWidget

from regolith_studio.harmonics.spectrum import power_spectrum
from regolith_studio.session.choices import Choices
from regolith_studio.session.results import Results
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import tr
from regolith_studio.ui.translation.numbers import localized, number_text
from regolith_studio.ui.widgets.plots.base import Numbers, Plot

DECADES = 6.5
"""Range of the axis below the highest bar."""


class SpectrumPlot(Plot):
    """Amplitudes with tool tips."""

    shares: np.ndarray[tuple[int], np.dtype[np.float64]] = np.empty(0)

    def value_at(self, place: QPointF) -> str:
        degree = round(self.canvas.getViewBox().mapSceneToView(place).x())
        return (
            localized(f"l = {degree}: {self.shares[degree - 1]:.3g} %")
            if 1 <= degree <= len(self.shares)
            else ""
        )

    def numbers(self) -> Numbers:
        return ("l", tr("amplitude [%]")), [
            (degree, float(share)) for degree, share in enumerate(self.shares, start=1)
        ]


class SpectrumPanel(QWidget):
    """sqrt(A_l) relative to the mean radius, on a logarithmic scale."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("spectrum")
        self.plot = SpectrumPlot(
            tr("Degree l"),
            tr("Amplitude √A<sub>l</sub> / c<sub>00</sub> [%]"),
            tr("The spectrum appears when the particle is fitted."),
        )
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.plot)
        self._items: list[pg.BarGraphItem] = []
        self._shown: tuple[Results, Choices] | None = None

    def show_results(self, results: Results, choices: Choices) -> None:
        """Draw the spectrum of these results."""
        self._shown = (results, choices)
        self.plot.set_empty(results.fit is None)
        if results.fit is None:
            return
        shares = 100.0 * power_spectrum(results.fit.coefficients).relative_amplitudes[1:]
        self.plot.shares = shares
        self._draw(np.log10(np.maximum(shares, 1e-12)), choices.l_max)
        theme = self.plot.theme
        kept = tr("up to l<sub>max</sub> = {l_max}", l_max=choices.l_max)
        self.plot.set_legend([(theme.fit, kept), (theme.border, tr("above l<sub>max</sub>"))])

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self.plot.set_theme(theme)
        if self._shown:
            self.show_results(*self._shown)

    def _draw(self, logs: np.ndarray[tuple[int], np.dtype[np.float64]], l_max: int) -> None:
        for item in self._items:
            self.plot.canvas.removeItem(item)
        top = math.ceil(float(logs.max()) * 2 + 0.2) / 2
        floor = max(top - DECADES, math.floor(float(logs.min())))
        degrees = np.arange(1, len(logs) + 1)
        self._items = []
        for kept, colour in (
            (degrees <= l_max, self.plot.theme.fit),
            (degrees > l_max, self.plot.theme.border),
        ):
            heights = np.maximum(logs[kept] - floor, 0.0)
            bars = pg.BarGraphItem(
                x=degrees[kept],
                y0=floor,
                height=heights,
                width=0.72,
                brush=QColor(colour),
                pen=pg.mkPen(None),
            )
            self.plot.canvas.addItem(bars)
            self._items.append(bars)
        decades = range(math.ceil(floor), math.floor(top) + 1)
        self.plot.canvas.getAxis("left").setTicks(
            [[(decade, number_text(10.0**decade, "g")) for decade in decades]]
        )
        self.plot.canvas.setRange(
            xRange=(0.3, len(logs) + 0.7), yRange=(floor, top), padding=0.0, disableAutoRange=True
        )
