"""Curves over a common axis."""

import math

import pytest
from PySide6.QtGui import QColor

from regolith_studio.ui.theme import DARK
from regolith_studio.ui.widgets.curve_plot import Curve, CurvePlot


@pytest.mark.parametrize(("log_y", "values"), [(True, (0.0, 0.0)), (False, (math.nan, math.nan))])
def test_that_points_without_a_place_on_the_axes_leave_the_others_in_sight(shown, app, log_y, values):
    plot = shown(CurvePlot("Step", "Loss", "Nothing yet.", log_y=log_y))
    seen = Curve("seen", "#0072b2", (1.0, 2.0), (0.5, 0.25), markers=True)
    plot.set_curves([Curve("nowhere", "#000000", (1.0, 2.0), values, markers=True), seen])
    app.processEvents()
    (left, right), _ = plot.canvas.viewRange()
    assert left <= 1.0
    assert right >= 2.0
    assert [item.xData is None for item in plot._items] == [True, False]
    plot.set_curves([Curve("nowhere", "#000000", (1.0, 2.0), values, markers=True)])
    app.processEvents()
    assert plot.numbers()[1][0][1] == 1.0


@pytest.mark.parametrize(("x", "between"), [((0.0, 1.0, 2.0), False), ((0.0, 0.5, 2.0), True)])
def test_that_no_tick_lies_between_steps_that_are_counted(shown, app, x, between):
    plot = shown(CurvePlot("Step", "Loss", "Nothing yet."))
    plot.set_curves([Curve("loss", "#0072b2", x, (0.3, 0.2, 0.1))])
    app.processEvents()
    axis = plot.canvas.getAxis("bottom")
    (left, right), _ = plot.canvas.viewRange()
    ticks = [value for _, values in axis.tickValues(left, right, axis.width()) for value in values]
    assert any(not float(tick).is_integer() for tick in ticks) is between


def test_that_a_curve_is_drawn_when_it_has_changed_and_not_again_before(shown, monkeypatch):
    plot = shown(CurvePlot("Step", "Loss", "Nothing yet."))
    kept, falling = (
        Curve("kept", "#0072b2", (0.0, 1.0), (1.0, 1.0)),
        Curve("falls", "#d55e00", (0.0,), (2.0,)),
    )
    plot.set_curves([kept, falling])
    drawn = []
    for item in plot._items:
        usual = item.setData
        monkeypatch.setattr(
            item, "setData", lambda usual=usual, **given: drawn.append(given) or usual(**given)
        )
    plot.set_curves([kept, Curve("falls", "#d55e00", (0.0, 1.0), (2.0, 0.5), markers=True, line=False)])
    assert [given["symbol"] for given in drawn] == ["o"]
    item = plot._items[1]
    assert item.getData()[1].tolist() == [2.0, 0.5]
    assert item.opts["pen"] is None
    assert item.scatter.isVisible()
    plot.set_theme(DARK)
    plot.set_curves([kept])
    assert len(drawn) == 1
    plot.set_curves([kept, falling])
    assert [each.getData()[1].tolist() for each in plot._items] == [[1.0, 1.0], [2.0]]


def test_that_the_marker_moves_and_goes(shown):
    plot = shown(CurvePlot("Step", "Loss", "Nothing yet."))
    plot.set_marker(2.0)
    line = plot._line
    plot.set_marker(3.0)
    plot.set_theme(DARK)
    assert plot._line is line
    assert line.value() == 3.0
    assert line.pen.color() == QColor(DARK.muted)
    plot.set_marker(None)
    assert line.scene() is None
    assert plot._line is None
