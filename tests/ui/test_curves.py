"""Curves over a common axis."""

import math
from itertools import pairwise

import numpy as np
import pytest
from PySide6.QtGui import QColor, QFontMetricsF

from regolith_studio.ui.theme import DARK
from regolith_studio.ui.widgets.plots.curves import LEAST_SPAN, CurveItems, CurvePlot, PlotCurve


@pytest.mark.parametrize(("log_y", "values"), [(True, (0.0, 0.0)), (False, (math.nan, math.nan))])
def test_that_points_without_a_place_on_the_axes_leave_the_others_in_sight(shown, app, log_y, values):
    plot = shown(CurvePlot("Step", "Loss", "Nothing yet.", log_y=log_y))
    seen = PlotCurve("seen", "#0072b2", (1.0, 2.0), (0.5, 0.25), markers=True)
    plot.set_curves([PlotCurve("nowhere", "#000000", (1.0, 2.0), values, markers=True), seen])
    app.processEvents()
    plot.grab()  # the range follows when it is painted
    (left, right), _ = plot.canvas.getViewBox().viewRange()
    assert left <= 1.0
    assert right >= 2.0
    assert [items.points.getData()[0].size for _, items in plot._drawn] == [0, 2]
    plot.set_curves([PlotCurve("nowhere", "#000000", (1.0, 2.0), values, markers=True)])
    app.processEvents()
    assert plot.numbers()[1][0][1] == 1.0


@pytest.mark.parametrize(("x", "between"), [((0.0, 1.0, 2.0), False), ((0.0, 0.5, 2.0), True)])
def test_that_no_tick_lies_between_steps_that_are_counted(shown, app, x, between):
    plot = shown(CurvePlot("Step", "Loss", "Nothing yet."))
    plot.set_curves([PlotCurve("loss", "#0072b2", x, (0.3, 0.2, 0.1))])
    app.processEvents()
    plot.grab()
    axis = plot.canvas.getAxis("bottom")
    (left, right), _ = plot.canvas.getViewBox().viewRange()
    ticks = [value for _, values in axis.tickValues(left, right, axis.width()) for value in values]
    assert any(not float(tick).is_integer() for tick in ticks) is between


def test_that_a_curve_is_drawn_when_it_has_changed_and_not_again_before(shown, monkeypatch):
    plot = shown(CurvePlot("Step", "Loss", "Nothing yet."))
    kept = PlotCurve("kept", "#0072b2", (0.0, 1.0), (1.0, 1.0))
    falling = PlotCurve("falls", "#d55e00", (0.0,), (2.0,))
    plot.set_curves([kept, falling])
    drawn, usual = [], CurveItems.draw

    def watched(items, *given):
        drawn.append(given)
        usual(items, *given)

    monkeypatch.setattr(CurveItems, "draw", watched)
    plot.set_curves([kept, PlotCurve("falls", "#d55e00", (0.0, 1.0), (2.0, 0.5), markers=True, line=False)])
    assert drawn == [((0.0, 1.0), (2.0, 0.5), None, "#d55e00")]
    items = plot._drawn[1][1]
    assert items.points.getData()[1].tolist() == [2.0, 0.5]
    assert items.points.opts["brush"].color() == QColor("#d55e00")
    assert not items.line.isVisible()
    plot.set_theme(DARK)
    plot.set_curves([kept])
    assert len(drawn) == 1
    plot.set_curves([kept, falling, PlotCurve("empty", "#000000", (), ())])
    assert [each.line.getData()[1].tolist() for _, each in plot._drawn] == [[1.0, 1.0], [2.0]]
    assert all(each.points is None for _, each in plot._drawn)
    assert len(plot.curves) == 3


def test_that_lines_and_points_stand_at_the_logarithm_and_have_gaps_where_there_is_none(shown, app):
    plot = shown(CurvePlot("Step", "Loss", "Nothing yet.", log_y=True))
    values = (100.0, 0.0, math.nan, 1e-3, 10.0)
    plot.set_curves([PlotCurve("loss", "#0072b2", tuple(range(5)), values, markers=True)])
    app.processEvents()
    items = plot._drawn[0][1]
    assert items.points.getData()[0].tolist() == [0.0, 3.0, 4.0]
    np.testing.assert_allclose(items.points.getData()[1], [2.0, -3.0, 1.0])
    path = items.line.getPath()
    at = [path.elementAt(place) for place in range(path.elementCount())]
    lines = [((a.x, a.y), (b.x, b.y)) for a, b in pairwise(at) if b.isLineTo() and (a.x, a.y) != (b.x, b.y)]
    assert lines == [((3.0, -3.0), (4.0, 1.0))]
    plot.canvas.grab()  # the range follows the curves when the plot is painted
    _, (low, high) = plot.canvas.getViewBox().viewRange()
    assert low < -3.0 < 2.0 < high < 4.0


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


def test_that_a_change_in_the_last_digits_does_not_fill_the_axis_and_its_numbers_differ(app, shown):
    plot = shown(CurvePlot("Step", "Loss", "Nothing yet."))
    plot.resize(400, 300)
    plot.set_curves([PlotCurve("", "#000000", (0.0, 1.0), (0.135500, 0.135501))])
    app.processEvents()
    low, high = plot.canvas.getViewBox().viewRange()[1]
    assert high - low >= 0.99 * LEAST_SPAN * 0.1355
    axis = plot.canvas.getAxis("left")
    spacing, ticks = axis.tickValues(low, high, axis.size().height())[0]
    words = axis.tickStrings(ticks, 1.0, spacing)
    assert len(words) > 1
    assert len(set(words)) == len(words)
    assert all(QFontMetricsF(plot.small_font()).horizontalAdvance(word) < axis.width() for word in words)


def test_that_a_constant_zero_has_an_axis(app, shown):
    plot = shown(CurvePlot("Step", "Loss", "Nothing yet."))
    plot.set_curves([PlotCurve("", "#000000", (0.0, 1.0), (0.0, 0.0))])
    app.processEvents()
    low, high = plot.canvas.getViewBox().viewRange()[1]
    assert low < 0.0 < high
