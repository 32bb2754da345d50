"""Plots as files."""

import csv
import xml.etree.ElementTree as ElementTree

import pytest
from PIL import Image
from PySide6.QtCore import QPointF
from PySide6.QtWidgets import QApplication

from regolith_studio.errors import FileError, InputError
from regolith_studio.ui.widgets.plots.bars import BarPlot, BarSeries
from regolith_studio.ui.widgets.plots.base import Plot
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve


@pytest.fixture
def curves(shown):
    plot = CurvePlot("Degree l<sub>max</sub>", "RMSRE [%]", "Nothing yet.")
    small = PlotCurve("D<sub>min</sub>", "#0072b2", (1.0, 2.0), (0.5, 0.25))
    plot.set_curves([small, PlotCurve("V", "#000000", (1.0,), (3.0,))])
    plot.resize(400, 260)
    return shown(plot)


def test_that_a_figure_is_saved_at_three_pixels_for_one(curves, tmp_path):
    curves.save_figure(tmp_path / "plot.png")
    with Image.open(tmp_path / "plot.png") as picture:
        assert picture.size == tuple(3 * each for each in curves._page.size().toTuple())
        assert len(picture.convert("RGB").getcolors(1 << 20)) > 8


def test_that_a_figure_is_saved_as_lines_and_letters(curves, tmp_path):
    curves.save_figure(tmp_path / "plot.svg")
    words = {each.tag.rpartition("}")[2] for each in ElementTree.parse(tmp_path / "plot.svg").iter()}
    assert {"path", "text"} & words
    curves.save_figure(tmp_path / "plot.pdf")
    assert (tmp_path / "plot.pdf").read_bytes().startswith(b"%PDF-")


def test_that_the_numbers_are_those_of_the_curves(curves, tmp_path):
    curves.save_numbers(tmp_path / "plot.csv")
    with (tmp_path / "plot.csv").open(newline="", encoding="utf-8") as lines:
        head, *rows = csv.reader(lines)
    assert head == ["curve", "Degree lₘₐₓ", "RMSRE [%]"]
    assert [(name, float(x), float(y)) for name, x, y in rows] == [
        ("Dₘᵢₙ", 1.0, 0.5),
        ("Dₘᵢₙ", 2.0, 0.25),
        ("V", 1.0, 3.0),
    ]


def test_that_bars_are_a_row_a_category(shown, tmp_path):
    plot = shown(BarPlot("Descriptor", "Error [%]", "Nothing yet."))
    fit, hull = BarSeries("fit", "#0072b2", (1.0, 2.0)), BarSeries("hull", "#d55e00", (3.0, 4.0))
    plot.set_bars(("V", "S"), (fit, hull))
    plot.save_numbers(tmp_path / "bars.csv")
    with (tmp_path / "bars.csv").open(newline="", encoding="utf-8") as lines:
        head, volume, _ = csv.reader(lines)
    assert head == ["category", "fit [%]", "hull [%]"]
    assert [volume[0], *map(float, volume[1:])] == ["V", 1.0, 3.0]


def test_that_a_plot_without_numbers_offers_the_figure_alone(shown, curves):
    assert _offered(curves) == ["Save &figure …", "Save &numbers …"]
    assert _offered(shown(Plot("x", "y", "Nothing yet."))) == ["Save &figure …"]


def _offered(plot):
    menu = plot.menu()
    words = [action.text() for action in menu.actions()]
    menu.deleteLater()
    return words


def test_that_what_cannot_be_saved_is_one_sentence(curves, tmp_path):
    with pytest.raises(InputError, match=r"Figures are saved as \.png, \.svg, \.pdf, not as \.doc\."):
        curves.save_figure(tmp_path / "plot.doc")
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match=r"cannot be written"):
        curves.save_figure(tmp_path / "file" / "plot.png")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_that_a_point_of_a_curve_tells_its_values_when_pointed_at(curves):
    view = curves.canvas.getViewBox()
    QApplication.processEvents()
    there = view.mapViewToScene(QPointF(2.0, 0.25))
    assert curves.value_at(there) == "Dₘᵢₙ\nDegree lₘₐₓ: 2\nRMSRE [%]: 0.25"
    curves.canvas.scene().sigMouseMoved.emit(there)
    assert curves.canvas.toolTip() == curves.value_at(there)
    assert curves.value_at(there + QPointF(0.0, -60.0)) == ""


def test_that_a_curve_on_a_logarithmic_axis_tells_its_values_too(shown):
    plot = CurvePlot("x", "y", "Nothing yet.", log_y=True)
    plot.set_curves([PlotCurve("f", "#0072b2", (1.0, 2.0, 3.0), (1.0, 100.0, 10.0))])
    plot.resize(400, 260)
    shown(plot)
    QApplication.processEvents()
    assert plot.value_at(plot.canvas.getViewBox().mapViewToScene(QPointF(2.0, 2.0))).endswith("y: 100")
