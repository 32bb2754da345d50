"""The canvas of plots draws what pyqtgraph's own plot widget draws, without what that carries beside it."""

import numpy as np
import pyqtgraph as pg
import pytest
from PySide6.QtCore import QSize
from PySide6.QtWidgets import QApplication

from regolith_studio.ui.widgets.plots.base import CANVAS_MARGIN, LAST_LABEL, CountAxis, FittedAxis, PlotCanvas

STEPS = np.arange(1.0, 9.0)


def axes():
    return {"bottom": CountAxis("bottom"), "left": FittedAxis("left")}


def theirs():
    widget = pg.PlotWidget(background=None, enableMenu=False, axisItems=axes())
    widget.setMouseEnabled(x=False, y=False)
    widget.hideButtons()
    # The only difference: room for the label of the last tick.
    widget.getPlotItem().layout.setContentsMargins(CANVAS_MARGIN, CANVAS_MARGIN, LAST_LABEL, CANVAS_MARGIN)
    return widget


def filled(canvas, log):
    """The picture of a canvas with a curve, bars and a line, in one size and colour."""
    canvas.setBackground("w")
    canvas.getAxis("left").setGrid(60)
    canvas.plot(STEPS, 10.0**STEPS, pen="b", symbol="o")
    canvas.setLogMode(x=False, y=log)
    canvas.plot(STEPS, 5.0**STEPS, pen="r")
    canvas.addItem(pg.BarGraphItem(x=STEPS, height=STEPS, width=0.5, brush="g"))
    canvas.addItem(pg.InfiniteLine(40.0), ignoreBounds=True)
    return canvas


def shot(canvas, follows):
    """The picture once the axes have taken their room; only then the range depends on nothing else."""
    canvas.resize(QSize(420, 260))
    for _ in range(3):
        canvas.grab()
        QApplication.processEvents()
    if follows:
        canvas.getViewBox().updateAutoRange()
    return canvas.grab().toImage()


@pytest.mark.parametrize(
    ("act", "log"), [("follows", False), ("follows", True), ("is set", True), ("is locked", False)]
)
def test_that_the_same_is_drawn_as_by_the_widget_of_pyqtgraph(shown, log, act):
    pictures, ranges = [], []
    for canvas in (shown(theirs()), shown(PlotCanvas(axes()))):
        filled(canvas, log)
        if act == "is set":
            canvas.setRange(xRange=(0.0, 12.0), yRange=(1.0, 7.0), padding=0.0, disableAutoRange=True)
        if act == "is locked":
            canvas.getViewBox().setAspectLocked(True)
            canvas.getViewBox().setLimits(xMin=-0.5)
        pictures.append(shot(canvas, act == "follows"))
        ranges.append(canvas.getViewBox().viewRange())
    assert np.allclose(*ranges)
    assert pictures[0] == pictures[1]
