"""The histogram of a scan says what stands under the pointer, and gives its numbers away."""

import csv

import numpy as np
import pytest
from PySide6.QtCore import QPointF

from regolith_studio.imaging.segmentation.thresholding import Histogram, histogram
from regolith_studio.ui.pages.scan.slices import HistogramPlot

GREYS = np.repeat(np.arange(60, 70, dtype=np.uint8), np.arange(1, 11))


@pytest.fixture
def plot(shown):
    made = HistogramPlot()
    made.set_scanned(histogram(GREYS))
    made.resize(420, 260)
    return shown(made)


def at(plot, value):
    """The words at a grey value, in the middle of the plot's height."""
    box = plot.canvas.getViewBox()
    box.updateAutoRange()
    low, high = box.viewRange()[1]
    return plot.value_at(box.mapViewToScene(QPointF(value, (low + high) / 2)))


def test_that_the_pointer_reads_grey_value_and_share(plot):
    assert at(plot, 62.0) == "Grey value 62\nas scanned: 5.45 % of voxels"
    assert at(plot, 62.4) == at(plot, 61.6)
    assert at(plot, 69.0).endswith("18.2 % of voxels")


def test_that_both_histograms_are_read_where_both_are_drawn(plot):
    plot.set_denoised(histogram(np.array([62, 62, 62, 63], dtype=np.uint8)))
    assert at(plot, 62.0).splitlines()[1:] == [
        "as scanned: 5.45 % of voxels",
        "denoised: 75 % of voxels",
    ]
    assert len(at(plot, 68.0).splitlines()) == 2


def test_that_nothing_is_read_beyond_the_histogram_or_without_one(plot):
    assert plot.value_at(QPointF(-50.0, -50.0)) == ""
    plot.set_scanned(Histogram(np.array([4, 6]), np.array([0.0, 0.25, 0.5])))
    assert at(plot, 0.3) == "Grey values 0.25 to 0.5\nas scanned: 60 % of voxels"
    assert at(plot, 0.52) == ""
    plot.set_scanned(None)
    assert at(plot, 0.3) == ""


def test_that_its_numbers_are_saved(plot, tmp_path):
    plot.save_numbers(tmp_path / "histogram.csv")
    with (tmp_path / "histogram.csv").open(newline="", encoding="utf-8") as lines:
        head, first, *_ = csv.reader(lines)
    assert head == ["Histogram", "From", "To", "Voxels"]
    assert (first[0], *map(float, first[1:])) == ("as scanned", 59.5, 60.5, 1.0)
