"""Curves over a common axis."""

import math

import pytest

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
