"""What a plot is drawn on: a view box between two axes, without the menus that pyqtgraph's plots carry."""

from collections.abc import Mapping
from typing import Any

import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QGraphicsGridLayout, QSizePolicy

MARGIN = 1.0
"""Pixels around box and axes."""
_PLACES = {"bottom": (1, 1), "left": (0, 0)}
_BOX = (0, 1)


class PlotCanvas(pg.GraphicsView):  # type: ignore[misc]
    """Items in a box with an axis at the left and one below; nothing answers to the mouse by itself.

    Does what :class:`pyqtgraph.PlotWidget` would do, without the form of options that it makes for each plot.

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
        grid.setContentsMargins(MARGIN, MARGIN, MARGIN, MARGIN)
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
        """Where items are drawn; knows how their coordinates lie in the scene."""
        return self._box

    def getAxis(self, side: str) -> pg.AxisItem:
        """The axis "left" or "bottom"."""
        return self._axes[side]

    def addItem(self, item: Any, ignoreBounds: bool = False) -> None:
        """Draw an item; one with `ignoreBounds` does not move the axes."""
        self._items.append(item)
        self._box.addItem(item, ignoreBounds=ignoreBounds)
        if hasattr(item, "setLogMode"):
            item.setLogMode(*self._log)

    def removeItem(self, item: Any) -> None:
        """Draw an item no longer; nothing where it was not drawn."""
        if item in self._items:
            self._items.remove(item)
            self._box.removeItem(item)

    def plot(self, *data: Any, **options: Any) -> pg.PlotDataItem:
        """Draw a curve with these data and options of :class:`pyqtgraph.PlotDataItem`."""
        curve = pg.PlotDataItem(*data, **options)
        self.addItem(curve)
        return curve

    def setLogMode(self, x: bool, y: bool) -> None:
        """Make the axes logarithmic or linear, with all items that are there or come later."""
        if (x, y) == self._log:
            return
        self._log = (x, y)
        for item in self._items:
            if hasattr(item, "setLogMode"):
                item.setLogMode(x, y)
        for axis in self._axes.values():
            axis.setLogMode(x, y)
        self._box.enableAutoRange()

    def setRange(self, *ranges: Any, **options: Any) -> None:
        """What is seen, as :meth:`pyqtgraph.ViewBox.setRange` takes it."""
        self._box.setRange(*ranges, **options)

    def setXRange(self, low: float, high: float, padding: float | None = None) -> None:
        """What is seen along x."""
        self._box.setXRange(low, high, padding=padding)

    def setYRange(self, low: float, high: float, padding: float | None = None) -> None:
        """What is seen along y."""
        self._box.setYRange(low, high, padding=padding)

    def viewRange(self) -> list[list[float]]:
        """Ends of x and ends of y."""
        seen: list[list[float]] = self._box.viewRange()
        return seen

    def enableAutoRange(self) -> None:
        """Let both axes follow the items."""
        self._box.enableAutoRange()

    def setLimits(self, **limits: float | None) -> None:
        """How far the axes may go, as :meth:`pyqtgraph.ViewBox.setLimits` takes it."""
        self._box.setLimits(**limits)

    def setAspectLocked(self, locked: bool) -> None:
        """Whether lengths along x and y are drawn alike."""
        self._box.setAspectLocked(locked)
