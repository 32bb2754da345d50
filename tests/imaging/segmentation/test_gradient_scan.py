"""The shipped scan with a gradient of grey values: ten strokes against every threshold.

With ``REGOLITH_STUDIO_UPDATE=1`` the picture of the guide is written anew.
"""

import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from scipy import ndimage

from regolith_studio.imaging.segmentation.pixel_classifier import paint_from_labels
from regolith_studio.imaging.segmentation.segment import SegmentationSettings, segment
from regolith_studio.imaging.settings import ThresholdSettings
from regolith_studio.imaging.volume import sample_file, sample_volume
from regolith_studio.readers.volumes.read import read_volume

PICTURE = Path(__file__).parents[3] / "docs" / "images" / "gradient_scan.png"
ACROSS = 40  # the slice along x that holds a stroke through the resin


def overlap(found, truth):
    return float((found & truth).sum() / (found | truth).sum())


def panel(grey, mask=None, colour=(245, 158, 11)):
    """A slice, x to the right and z down, twice as large, with a mask in a colour."""
    rgb = np.repeat(grey.T[:, :, None], 3, axis=2).astype(float)
    if mask is not None:
        rgb[mask.T] = 0.45 * rgb[mask.T] + 0.55 * np.array(colour)
    return np.rint(rgb).astype(np.uint8).repeat(2, axis=0).repeat(2, axis=1)


def test_that_the_strokes_lie_where_they_say():
    truth, painted = sample_volume("labels", "gradient"), read_volume(sample_file("strokes", "gradient"))
    assert painted.kind == "labels"
    assert painted.shape == truth.shape
    assert set(np.unique(painted.array)) == {0, 1, 2}
    assert 0.0005 < np.count_nonzero(painted.array) / painted.array.size < 0.005
    assert (truth.array[painted.array == 2] > 0).all()
    assert (truth.array[painted.array == 1] == 0).all()


@pytest.mark.slow
def test_that_ten_strokes_find_the_grains_which_no_threshold_does():
    grey, labels = sample_volume("grey", "gradient"), sample_volume("labels", "gradient")
    painted, truth = read_volume(sample_file("strokes", "gradient")), labels.array > 0
    median = ndimage.median_filter(grey.array, 3)
    thresholds = {
        overlap(chosen, truth): chosen[ACROSS]
        for image in (grey.array, median)
        for level in range(10, 250, 3)
        for chosen in (image >= level, image < level)
    }
    best = max(thresholds)
    settings = SegmentationSettings(
        threshold=ThresholdSettings("probability"), classifier=paint_from_labels(grey, painted)
    )
    found = np.asarray(segment(grey, settings).labels.array)
    reached, matched = overlap(found > 0, truth), 0
    for number in range(1, int(labels.array.max()) + 1):
        own = labels.array == number
        candidate = np.bincount(found[own]).argmax()
        matched += candidate > 0 and overlap(found == candidate, own) > 0.5
    slices = grey.array[ACROSS]
    strokes = panel(slices, painted.array[ACROSS] == 1, (59, 130, 246))
    parts = [panel(slices), strokes, panel(slices, thresholds[best]), panel(slices, found[ACROSS] > 0)]
    picture = np.concatenate(
        [np.pad(part, ((0, 0), (0, 8), (0, 0)), constant_values=255) for part in parts], 1
    )
    if os.environ.get("REGOLITH_STUDIO_UPDATE"):
        Image.fromarray(picture).save(PICTURE)
    with Image.open(PICTURE) as shipped:
        difference = np.abs(np.asarray(shipped.convert("RGB"), dtype=float) - picture).mean()
    assert best < 0.5, f"the best threshold has an IoU of {best:.3f}"
    assert reached > 0.95, f"ten strokes have an IoU of {reached:.3f}"
    assert matched >= 0.95 * 30, f"{matched} of 30 grains are matched"
    assert difference < 1.0
