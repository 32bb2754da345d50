"""Axes of plots: labels that are never cut, and counts without ticks between two steps."""

import html

import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtGui import QFont, QFontMetricsF, QResizeEvent

from regolith_studio.ui.widgets.plot_files import plain_text

SHARE = 0.5
"""A label shrinks to the axis, but not below this share of its size; then it ends in dots."""
STEP = 0.5
"""Points between two sizes."""
MARGIN = 8.0
"""Pixels about the letters of a label, both sides together; pyqtgraph puts a blank behind them."""
ROOMY = 14.0
"""Height of letters, in pixels, up to which ticks are as dense as pyqtgraph likes them."""


class FittedAxis(pg.AxisItem):  # type: ignore[misc]
    """An axis whose label has room on it: in smaller letters or shortened where the axis is short."""

    _wanted = ("", "", QFont())
    _shown: tuple[str, float] | None = None

    def __init__(self, orientation: str) -> None:
        super().__init__(orientation)
        self.autoSIPrefix = False  # so that another range is drawn without asking for a prefix

    def name_it(self, text: str, colour: str, font: QFont) -> None:
        """Label the axis with rich text in a colour, in letters of this font where there is room."""
        self._wanted, self._shown = (text, colour, font), None
        self._fit()

    def set_tick_letters(self, font: QFont) -> None:
        """Numbers in this font; fewer of them where it is large."""
        self.setTickFont(font)
        self.setTickDensity(min(1.0, ROOMY / QFontMetricsF(font).height()))

    def resizeEvent(self, event: QResizeEvent | None = None) -> None:
        self._fit()
        super().resizeEvent(event)

    def updateAutoSIPrefix(self) -> None:
        """Nothing: pyqtgraph multiplies numbers below one by a thousand whenever it is told not to."""

    def _fit(self) -> None:
        text, colour, font = self._wanted
        if not text:
            return
        rich, points = fitted(text, font, self._length() - MARGIN)
        if (rich, points) != self._shown:
            self._shown = (rich, points)
            self.setLabel(rich, color=colour, **{"font-size": f"{points:.1f}pt"})

    def _length(self) -> float:
        size = self.size()
        return float(size.height() if self.orientation in ("left", "right") else size.width())


class CountAxis(FittedAxis):
    """An axis whose ticks lie at whole numbers while :attr:`whole` is set, and anywhere otherwise."""

    whole = False

    def tickSpacing(self, low: float, high: float, length: float) -> list[tuple[float, float]]:
        """Spacings and offsets of major and minor ticks, none below one where only whole numbers exist."""
        levels: list[tuple[float, float]] = super().tickSpacing(low, high, length)
        if not (self.whole and levels):
            return levels
        return [level for level in levels if level[0] >= 1.0] or [(1.0, 0.0)]


def fitted(text: str, font: QFont, room: float) -> tuple[str, float]:
    """Rich text and its size in points so that it takes at most so many pixels, if it can."""
    plain, size = plain_text(text), font.pointSizeF()
    smaller = QFont(font)
    while (letters := QFontMetricsF(smaller)).horizontalAdvance(plain + " ") > room:
        if smaller.pointSizeF() - STEP < SHARE * size:
            left = max(room - letters.horizontalAdvance(" "), 0.0)
            dotted = letters.elidedText(plain, Qt.TextElideMode.ElideRight, left)
            return html.escape(dotted), smaller.pointSizeF()
        smaller.setPointSizeF(smaller.pointSizeF() - STEP)
    return text, smaller.pointSizeF()
