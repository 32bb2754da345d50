"""Canvas and axes of plots: a pyqtgraph view box without menus, labels that fit, logarithmic limits."""

import html
import math
from collections.abc import Mapping, Sequence
from typing import Any

import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtGui import QFont, QFontMetricsF, QResizeEvent
from PySide6.QtWidgets import QGraphicsGridLayout, QSizePolicy

from regolith_studio.ui.translation.numbers import localized
from regolith_studio.ui.widgets.plots.export import plain_text

CANVAS_MARGIN = 1.0
"""Pixels around box and axes."""
MIN_LABEL_SCALE = 0.5
"""An axis label shrinks to this share of its font size; a longer one is elided."""
FONT_STEP = 0.5
"""Points between two font sizes that are tried."""
AXIS_LABEL_MARGIN = 8.0
"""Pixels around the text of an axis label, both sides together; pyqtgraph adds a blank behind it."""
DENSE_TICKS_HEIGHT = 14.0
"""Font height in pixels up to which ticks have the density that pyqtgraph chooses."""
MAX_DECADES = 300.0
"""Limit of a logarithmic axis in powers of ten: pyqtgraph computes ten to the power of its ends."""
_PLACES = {"bottom": (1, 1), "left": (0, 0)}
_BOX = (0, 1)


class PlotCanvas(pg.GraphicsView):  # type: ignore[misc]
    """Items in a view box with an axis at the left and one below, without mouse interaction or menus.

    Replaces :class:`pyqtgraph.PlotWidget`, whose form of options costs 10 ms and 0.3 MB for each plot, and
    has dozens of widgets that are polished again at every change of the style sheet.

    Parameters
    ----------
    axes
        The axes "left" and "bottom".
    """

    def __init__(self, axes: Mapping[str, pg.AxisItem]) -> None:
        self._axes = dict(axes)
        self._items: list[Any] = []
        self._log = (False, False)
        super().__init__(background=None)
        self.setCacheMode(self.CacheModeFlag.CacheNone)  # the ground is plain, a picture of it holds memory
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setFrameShape(self.Shape.NoFrame)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.NoContextMenu)
        self._whole = pg.GraphicsWidget()
        self._box = pg.ViewBox(parent=self._whole, enableMenu=False, enableMouse=False)
        self._arrange()
        self.setCentralItem(self._whole)

    def _arrange(self) -> None:
        grid = QGraphicsGridLayout()
        grid.setContentsMargins(CANVAS_MARGIN, CANVAS_MARGIN, CANVAS_MARGIN, CANVAS_MARGIN)
        grid.setSpacing(0)
        grid.addItem(self._box, *_BOX)
        for side, place in _PLACES.items():
            axis = self._axes[side]
            axis.linkToView(self._box)
            grid.addItem(axis, *place)
            axis.setZValue(0.5)  # above pictures, below what is set higher
            axis.setFlag(axis.GraphicsItemFlag.ItemNegativeZStacksBehindParent)
        grid.setRowStretchFactor(_BOX[0], 100)
        grid.setColumnStretchFactor(_BOX[1], 100)
        self._whole.setLayout(grid)

    def getViewBox(self) -> pg.ViewBox:
        """The view box, which maps between coordinates of items and of the scene."""
        return self._box

    def getAxis(self, side: str) -> pg.AxisItem:
        """The axis "left" or "bottom"."""
        return self._axes[side]

    def addItem(self, item: Any, ignoreBounds: bool = False) -> None:
        """Add an item; with `ignoreBounds` it does not change the range of the axes."""
        self._items.append(item)
        self._box.addItem(item, ignoreBounds=ignoreBounds)
        if hasattr(item, "setLogMode"):
            item.setLogMode(*self._log)

    def removeItem(self, item: Any) -> None:
        """Remove an item, if it is there."""
        if item in self._items:
            self._items.remove(item)
            self._box.removeItem(item)

    def plot(self, *data: Any, **options: Any) -> pg.PlotDataItem:
        """Draw a curve with these data and options of :class:`pyqtgraph.PlotDataItem`."""
        curve = pg.PlotDataItem(*data, **options)
        self.addItem(curve)
        return curve

    def setLogMode(self, x: bool, y: bool) -> None:
        """Make the axes logarithmic or linear, with all present and later items.

        A logarithmic axis cannot be dragged to where numbers overflow.
        """
        if (x, y) == self._log:
            return
        self._log = (x, y)
        for item in self._items:
            if hasattr(item, "setLogMode"):
                item.setLogMode(x, y)
        for axis in self._axes.values():
            axis.setLogMode(x, y)
        right, top = MAX_DECADES if x else None, MAX_DECADES if y else None
        self._box.setLimits(xMin=right and -right, xMax=right, yMin=top and -top, yMax=top)
        self._box.enableAutoRange()

    def setRange(self, *ranges: Any, **options: Any) -> None:
        """Set the visible range, see :meth:`pyqtgraph.ViewBox.setRange`."""
        self._box.setRange(*ranges, **options)

    def setXRange(self, low: float, high: float, padding: float | None = None) -> None:
        """Set the visible range of x."""
        self._box.setXRange(low, high, padding=padding)

    def setYRange(self, low: float, high: float, padding: float | None = None) -> None:
        """Set the visible range of y."""
        self._box.setYRange(low, high, padding=padding)

    def viewRange(self) -> list[list[float]]:
        """The visible ranges of x and y."""
        seen: list[list[float]] = self._box.viewRange()
        return seen

    def enableAutoRange(self) -> None:
        """Let both axes follow the data."""
        self._box.enableAutoRange()

    def setLimits(self, **limits: float | None) -> None:
        """Set the limits of the axes, see :meth:`pyqtgraph.ViewBox.setLimits`."""
        self._box.setLimits(**limits)

    def setAspectLocked(self, locked: bool) -> None:
        """Set whether x and y have the same scale."""
        self._box.setAspectLocked(locked)


DIGITS = (((2, 3, 4, 5, 6, 7, 8, 9), math.log10(10 / 9)), ((2, 5), math.log10(2)), ((3,), math.log10(3)))
"""Leading digits of the numbers at a logarithmic axis, and their smallest distance in decades."""
WIDER = (1, 2, 4, 10)
"""Multiples of the distance of ticks, until their labels have room."""


class FittedAxis(pg.AxisItem):  # type: ignore[misc]
    """An axis whose label fits its length: with a smaller font or elided where the axis is short."""

    _label = ("", "", QFont())
    _shown: tuple[str, float] | None = None
    _tick_font = QFont()

    def __init__(self, orientation: str) -> None:
        super().__init__(orientation)
        self.autoSIPrefix = False

    def set_label_text(self, text: str, colour: str, font: QFont) -> None:
        """Label the axis with rich text in a colour, in this font where there is room."""
        self._label, self._shown = (text, colour, font), None
        self._fit()

    def set_tick_font(self, font: QFont) -> None:
        """Font of the tick labels; there are fewer of them if it is large."""
        self._tick_font = font
        self.setTickFont(font)
        self.setTickDensity(min(1.0, DENSE_TICKS_HEIGHT / QFontMetricsF(font).height()))

    def resizeEvent(self, event: QResizeEvent | None = None) -> None:
        self._fit()
        super().resizeEvent(event)

    def updateAutoSIPrefix(self) -> None:
        """Disabled: pyqtgraph multiplies numbers below one by a thousand even if `autoSIPrefix` is off."""

    def tickSpacing(self, low: float, high: float, length: float) -> list[tuple[float, float]]:
        """Spacings and offsets of major and minor ticks, so far apart that labels do not touch."""
        levels: list[tuple[float, float]] = super().tickSpacing(low, high, length)
        if self.orientation in ("left", "right") or self.logMode or not levels or high <= low:
            return levels
        widest = QFontMetricsF(self._tick_font).horizontalAdvance(f"{high:.4g} 0")
        wanted = widest * (high - low) / max(length, 1.0)
        step = next((f for f in WIDER if f * levels[0][0] >= wanted), WIDER[-1])
        return [(step * levels[0][0], levels[0][1]), *levels[1:]]

    def _fit(self) -> None:
        text, colour, font = self._label
        if not text:
            return
        rich, points = fit_text(text, font, self._length() - AXIS_LABEL_MARGIN)
        if (rich, points) != self._shown:
            self._shown = (rich, points)
            self.setLabel(rich, color=colour, **{"font-size": f"{points:.1f}pt"})

    def tickStrings(self, values: Sequence[float], scale: float, spacing: float | None) -> list[str]:
        words = [localized(each) for each in super().tickStrings(values, scale, spacing)]
        if not self.logMode or spacing is not None:
            return words
        shown = self._digits_with_room()
        return [
            word if round(10 ** (value % 1.0)) in (1, 10, *shown) else ""
            for word, value in zip(words, values, strict=True)
        ]

    def _digits_with_room(self) -> tuple[int, ...]:
        """Leading digits whose numbers do not touch within a decade of a logarithmic axis."""
        letters = QFontMetricsF(self._tick_font)
        upright = self.orientation in ("left", "right")
        needed = letters.height() if upright else letters.horizontalAdvance("0.0005")
        low, high = self.range
        decade = self._length() / max(high - low, 1e-9)
        return next((digits for digits, gap in DIGITS if gap * decade >= needed), ())

    def _length(self) -> float:
        size = self.size()
        return float(size.height() if self.orientation in ("left", "right") else size.width())


class CountAxis(FittedAxis):
    """An axis with ticks at integers only while :attr:`whole` is set."""

    whole = False

    def tickSpacing(self, low: float, high: float, length: float) -> list[tuple[float, float]]:
        """Spacings and offsets of major and minor ticks, none below one while :attr:`whole` is set."""
        levels: list[tuple[float, float]] = super().tickSpacing(low, high, length)
        if not (self.whole and levels):
            return levels
        return [level for level in levels if level[0] >= 1.0] or [(1.0, 0.0)]


def fit_text(text: str, font: QFont, width: float) -> tuple[str, float]:
    """Rich text and its size in points, so that it is at most `width` pixels wide if possible."""
    plain, size = plain_text(text), font.pointSizeF()
    smaller = QFont(font)
    while (letters := QFontMetricsF(smaller)).horizontalAdvance(plain + " ") > width:
        if smaller.pointSizeF() - FONT_STEP < MIN_LABEL_SCALE * size:
            left = max(width - letters.horizontalAdvance(" "), 0.0)
            dotted = letters.elidedText(plain, Qt.TextElideMode.ElideRight, left)
            return html.escape(dotted), smaller.pointSizeF()
        smaller.setPointSizeF(smaller.pointSizeF() - FONT_STEP)
    return text, smaller.pointSizeF()
