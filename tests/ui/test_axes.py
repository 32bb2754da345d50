"""Axes of plots: nothing on them is cut, and their numbers are those of the data."""

import itertools

import pytest
from PySide6.QtCore import QPointF
from PySide6.QtGui import QFont, QFontMetricsF

from regolith_studio.ui.theme import DARK, LIGHT
from regolith_studio.ui.widgets.labels import plain_symbol
from regolith_studio.ui.widgets.plots.bars import BarPlot, BarSeries
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve

NAMES = tuple(map(plain_symbol, ("V", "S", "D_min", "D_max", "AR", "CH", "J")))
TINY = 6.5
"""Points below which letters of twice the usual size must not fall."""


@pytest.fixture
def curve(shown):
    plot = CurvePlot("Step", "Relative error of each descriptor [%]", "nothing")
    plot.set_curves([PlotCurve("one", "#0072b2", (0.0, 1.0, 2.0), (0.2, 0.6, 0.4))])
    return shown(plot)


@pytest.mark.parametrize("points", [9.0, 18.0])
@pytest.mark.parametrize("height", [130, 200, 500])
def test_that_the_label_of_an_axis_has_room_on_it_at_any_height(curve, app, points, height):
    font = QFont(curve.font())
    font.setPointSizeF(points)
    curve.setFont(font)
    curve.resize(300, height)
    app.processEvents()
    axis = curve.axes["left"]
    assert axis.label.boundingRect().width() <= axis.size().height()
    said, whole = axis.label.toPlainText().strip(), "Relative error of each descriptor [%]"
    shorter = said == "[%]" or (said.endswith("…") and 3 * len(said) >= 2 * len(whole))
    assert said == whole or (shorter and height < 500)
    if (height, points) == (130, 18.0):
        assert said == "[%]"


def test_that_the_numbers_at_an_axis_stay_those_of_the_data_when_theme_and_letters_change(curve, app):
    axis = curve.axes["left"]
    large = QFont(curve.font())
    large.setPointSizeF(15.0)
    for change in (
        lambda: curve.set_theme(DARK),
        lambda: curve.setFont(large),
        lambda: curve.set_theme(LIGHT),
    ):
        change()
        app.processEvents()
        values = [value for value in axis.tickValues(*axis.range, 200.0)[0][1] if value > 0]
        read = axis.tickStrings(values, axis.autoSIPrefixScale * axis.scale, 0.1)
        assert [float(each) for each in read] == pytest.approx(values)


def test_that_large_numbers_at_an_axis_do_not_lie_upon_each_other(curve, app):
    font = QFont(curve.font())
    font.setPointSizeF(20.0)
    curve.setFont(font)
    curve.resize(400, 160)
    app.processEvents()
    curve.grab()  # the range follows when it is painted
    axis = curve.axes["left"]
    (low, high), length = axis.range, axis.size().height()
    spacing = axis.tickSpacing(low, high, length)[0][0]
    assert spacing / (high - low) * length >= QFontMetricsF(curve.small_font()).ascent()


@pytest.mark.parametrize("points", [9.0, 18.0])
def test_that_names_below_bars_stay_legible_and_have_room(shown, app, points):
    plot = shown(BarPlot("Descriptor", "Error [%]", "nothing"))
    font = QFont(plot.font())
    font.setPointSizeF(points)
    plot.setFont(font)
    plot.set_bars(NAMES, [BarSeries("fit", "#0072b2", (1.0,) * len(NAMES))])
    plot.resize(330, 300)
    app.processEvents()
    axis = plot.axes["bottom"]
    letters = axis.style["tickFont"]
    assert letters.pointSizeF() >= (TINY if points > 9.0 else 6.0)
    view = axis.linkedView()
    at = {name: view.mapViewToScene(QPointF(place, 0.0)).x() for place, name in axis._tickLevels[0]}
    for row in (0, 1):
        ends = 0.0
        for name, middle in at.items():
            if name.startswith("\n") == bool(row):
                half = QFontMetricsF(letters).horizontalAdvance(name.strip()) / 2
                assert middle - half >= ends
                ends = middle + half


def test_that_an_axis_is_drawn_anew_when_its_range_changes(curve, app):
    """Its numbers stood still while the curve went on."""
    app.processEvents()
    curve.grab()
    before = [axis.picture for axis in curve.axes.values()]
    curve.set_curves([PlotCurve("one", "#0072b2", (0.0, 100.0, 200.0), (20.0, 60.0, 40.0))])
    app.processEvents()
    curve.grab()
    for axis, old in zip(curve.axes.values(), before, strict=True):
        assert axis.range == list(axis.linkedView().viewRange()[axis.orientation == "left"])
        assert axis.picture is not old


def test_that_numbers_below_an_axis_do_not_touch_in_large_letters(curve, app):
    large = QFont(curve.font())
    large.setPointSizeF(24.0)
    curve.setFont(large)
    curve.set_curves([PlotCurve("one", "#0072b2", (0.0, 100.0), (0.2, 0.6))])
    curve.resize(320, 240)
    app.processEvents()
    axis = curve.axes["bottom"]
    (low, high), length = axis.range, axis.size().width()
    spacing = axis.tickSpacing(low, high, length)[0][0]
    widest = QFontMetricsF(axis._tick_font).horizontalAdvance("100")
    assert spacing / (high - low) * length > widest


@pytest.mark.parametrize("height", [120, 240, 1200])
def test_that_the_numbers_at_a_logarithmic_axis_do_not_touch(shown, app, height):
    plot = CurvePlot("Number", "Distance", "nothing", log_y=True)
    plot.set_curves([PlotCurve("one", "#0072b2", (0.0, 50.0, 70.0), (0.9, 0.1, 0.01))])
    shown(plot)
    plot.resize(400, height)
    app.processEvents()
    plot.grab()
    axis = plot.axes["left"]
    (low, high), length = axis.range, axis.size().height()
    words = {}
    for spacing, values in axis.tickValues(low, high, length):
        words |= dict(zip(values, axis.tickStrings(values, 1.0, spacing), strict=True))
    assert {"0.1", "0.01"} <= set(words.values())
    seen = sorted(value for value, word in words.items() if word)
    gaps = [length * (b - a) / (high - low) for a, b in itertools.pairwise(seen)]
    assert min(gap for gap in gaps if gap > 0.1) >= QFontMetricsF(plot.small_font()).ascent()
    if height == 1200:
        assert "0.7" in words.values()


def test_that_numbers_at_an_axis_are_all_written_in_one_way(curve):
    axis = curve.axes["bottom"]
    assert axis.tickStrings([0.0, 2e5, 8e5], 1.0, 2e5) == ["0", "200000", "800000"]
    assert axis.tickStrings([0.0, 2e5, 8e5, 1e6], 1.0, 2e5) == ["0", "2e5", "8e5", "1e6"]
    assert axis.tickStrings([1.0004e6, 1.0008e6], 1.0, 400.0) == ["1.0004e6", "1.0008e6"]
    assert axis.tickStrings([-5e-5, 0.0, 5e-5, 1e-4], 1.0, 5e-5) == ["-5e-5", "0", "5e-5", "1e-4"]
