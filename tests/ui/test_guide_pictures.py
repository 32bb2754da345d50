"""PictureExport of the guide: taken from the window, compared with those that are shipped.

``REGOLITH_STUDIO_UPDATE=1`` writes them anew. Letters differ between machines, so small pictures are
compared, in grey: what moved, came or went is seen, the shape of a letter is not.
"""

import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from PySide6.QtTest import QTest

IMAGES = Path(__file__).resolve().parents[2] / "docs" / "images"
SECONDS = 170.0
SMALL = (74, 45)
DRIFT = 6.0
"""Mean difference of grey values, of 255, beyond which a picture no longer shows the window."""

DOINGS = {
    "sample": (),
    "scan": ("sample_volume", "find_grains"),
    "model": ("fit_model", "draw"),
    "studies": ("run_all",),
    "dataset": ("find",),
    "lecture": ("forward", "forward", "forward"),
}
"""Pages with the commands that fill them."""


@pytest.fixture
def pictures_on_request():
    """The guide shows what views draw."""


@pytest.fixture
def window(sample_window, preferences):
    preferences.window["theme"] = "light"
    return sample_window(1480, 900, "exact")


def steady(window, wait):
    """What the window shows once it shows the same for a while: layouts and small pictures follow later."""
    seen = []

    def still():
        QTest.qWait(300)
        seen.append(window.grab().toImage())
        return len(seen) > 1 and seen[-1] == seen[-2]

    wait(still)
    return seen[-1]


def small(picture):
    return np.asarray(picture.convert("L").resize(SMALL, Image.Resampling.BOX), dtype=float)


def drift(one, other):
    """Mean difference of two pictures, in grey values."""
    return np.abs(small(one) - small(other)).mean()


@pytest.mark.slow
@pytest.mark.parametrize("page", DOINGS)
def test_that_the_guide_shows_the_page_as_it_is(page, window, wait, settled, tmp_path):
    window.go(page)
    for name in DOINGS[page]:
        settled(window, SECONDS)
        window.menus.by_name[f"{page}.{name}"].trigger()
    settled(window, SECONDS)
    window.toast.hide()
    taken = tmp_path / "now.png"
    assert steady(window, wait).save(str(taken))
    shipped = IMAGES / f"page_{page}.png"
    with Image.open(taken) as now:
        if os.environ.get("REGOLITH_STUDIO_UPDATE"):
            now.convert("RGB").save(shipped, optimize=True)
        with Image.open(shipped) as before:
            assert drift(now, before) < DRIFT


@pytest.mark.slow
def test_that_a_page_that_has_changed_is_told_from_one_that_has_not():
    with Image.open(IMAGES / "page_sample.png") as one, Image.open(IMAGES / "page_model.png") as other:
        assert drift(one, other) > DRIFT
        assert drift(one, one) == 0.0
