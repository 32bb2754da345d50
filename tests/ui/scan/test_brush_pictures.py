"""The second shipped scan from strokes to corrected grains, in the four pictures of the guide.

``REGOLITH_STUDIO_UPDATE=1`` writes the pictures anew.
"""

import os

import numpy as np
import pytest
from PIL import Image

from regolith_studio.imaging.segmentation.strokes import Stroke
from regolith_studio.imaging.volume import sample_file
from regolith_studio.readers.volumes.read import read_volume
from tests.ui.scan.mouse import paint, press
from tests.ui.test_guide_pictures import DRIFT, IMAGES, drift, pictures_on_request, steady, window  # noqa: F401

SECONDS = 170.0
PLACE = (40, 90, 81)
"""Each slice through it holds strokes."""


@pytest.fixture
def page(window):  # noqa: F811
    """The page in the whole window."""
    return window.go("scan")


@pytest.fixture
def pictured(page, window, wait, tmp_path):  # noqa: F811
    """Compares the page with a picture of the guide."""

    def run(name):
        window.toast.hide()
        taken, shipped = tmp_path / f"{name}.png", IMAGES / f"brush_{name}.png"
        assert steady(page, wait).save(str(taken))
        with Image.open(taken) as now:
            if os.environ.get("REGOLITH_STUDIO_UPDATE"):
                now.convert("RGB").quantize(200, dither=Image.Dither.NONE).save(shipped, optimize=True)
            with Image.open(shipped) as before:
                assert drift(now, before) < DRIFT, name

    return run


@pytest.mark.slow
def test_that_the_guide_shows_the_way_from_strokes_to_corrected_grains(page, pictured, wait):
    page.opening.open_gradient()
    wait(lambda: page.scan is not None, SECONDS)
    page.slices.go_to(PLACE)
    wait(lambda: page.preview.found is not None, SECONDS)

    painted = read_volume(sample_file("strokes", "gradient")).array
    page.tabs.setCurrentWidget(page.brush)
    page.brush.paint.click()
    page.brush.overlay.setCurrentIndex(page.brush.overlay.findData("none"))
    for label in (0, 1):
        page.painting._push((*page.painting.strokes, Stroke(np.argwhere(painted == label + 1), label)))
    wait(lambda: page.painting.training is not None and len(page.slices._predicted) == 3, SECONDS)
    wait(lambda: all(each.grain.shape == (128, 128) for each in page.slices._predicted.values()), SECONDS)
    pictured("strokes")
    page.brush.overlay.setCurrentIndex(page.brush.overlay.findData("probability"))
    pictured("probability")

    press(page.brush.use)
    page.tabs.setCurrentWidget(page.controls)
    press(page.workflow.search)
    wait(lambda: page.grains is not None and page.slices._surface is not None, SECONDS)
    assert page.grains.n_grains == 30
    pictured("grains")

    page.tabs.setCurrentWidget(page.edits)
    page.edits.tools["cut"].click()
    across, down = PLACE[:2]
    grain = np.argwhere(page.grains.labels.array[:, :, PLACE[2]] > 0)
    x, y = grain[np.abs(grain - (across, down)).sum(axis=1).argmin()].tolist()
    paint(page.slices.views[0], [(x, max(y - 14, 1)), (x, min(y + 14, 126))])
    wait(lambda: page.grains is not None and page.grains.n_grains == 31, SECONDS)
    wait(lambda: page.slices._surface[0] is page.grains.labels, SECONDS)
    assert len(page.slices._highlighted) >= 1
    pictured("correction")
