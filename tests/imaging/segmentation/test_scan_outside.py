"""Outside of a scanner's circle a volume holds one value, which is neither grain nor air."""

import numpy as np
import pytest

from regolith_studio.errors import InputError
from regolith_studio.imaging.extraction import extract_particles
from regolith_studio.imaging.label_table import ScanCircle
from regolith_studio.imaging.segmentation.scan_outside import background_filled, find_outside
from regolith_studio.imaging.segmentation.segment import SegmentationSettings, preview, segment
from regolith_studio.imaging.segmentation.thresholding import hidden_class
from regolith_studio.imaging.settings import ExtractionSettings, Surface, ThresholdSettings
from regolith_studio.imaging.volume import Volume
from regolith_studio.imaging.volume_slabs import ScratchArrays
from regolith_studio.jobs.scan_jobs import scan_of

AT = np.moveaxis(np.indices((56, 56, 32)), 0, -1).astype(float)
IN_CIRCLE = np.hypot(AT[..., 0] - 27.5, AT[..., 1] - 27.5) < 27.0


def balls(brightness: list[float], radius: float = 5.0) -> np.ndarray:
    """Balls on a ring, in air of 100 with noise of 5."""
    values = 100 + 5 * np.random.default_rng(0).standard_normal(AT.shape[:3])
    for k, bright in enumerate(brightness):
        turn = 2 * np.pi * k / len(brightness)
        centre = np.array([27.5 + 16 * np.cos(turn), 27.5 + 16 * np.sin(turn), 16.0])
        values[np.linalg.norm(AT - centre, axis=-1) < radius] += bright
    return values


@pytest.mark.parametrize(
    ("dtype", "value"),
    [("float32", np.nan), ("float32", 0.0), ("uint8", 0), ("uint8", 255), ("int16", -32768)],
)
def test_that_what_fills_the_outside_of_the_circle_is_found_and_changes_no_grain(
    dtype: str, value: float
) -> None:
    values = balls([60.0] * 5)
    without = Volume(values.astype(dtype), (1, 1, 1), "grey", "scan")
    with np.errstate(invalid="ignore"):
        padded = Volume(np.where(IN_CIRCLE, values, value).astype(dtype), (1, 1, 1), "grey", "scan")
    assert find_outside(without) is None
    outside = find_outside(padded)
    assert outside is not None
    assert outside.share == pytest.approx(1 - IN_CIRCLE.mean())
    assert np.isnan(outside.value) if np.isnan(value) else outside.value == value
    filled = background_filled(padded, outside, ThresholdSettings(), ScratchArrays())
    assert np.array_equal(filled.array[IN_CIRCLE], padded.array[IN_CIRCLE])
    assert filled.array[~IN_CIRCLE].mean() == pytest.approx(100, abs=1)
    found = segment(padded, outside=outside)
    assert found.sizes == pytest.approx(segment(without).sizes, abs=8)
    assert found.seen.counts.sum() == IN_CIRCLE.sum()
    assert np.array_equal(found.labels.array < 0, ~IN_CIRCLE)


def test_that_a_scan_whose_air_is_clipped_has_no_outside() -> None:
    values = np.clip(balls([60.0] * 5) - 100, 0, 255).astype(np.uint8)
    assert find_outside(Volume(values, (1, 1, 1), "grey", "clipped")) is None


@pytest.mark.parametrize(("brightness", "hidden"), [([900, 900] + [90] * 6, True), ([90] * 8, False)])
def test_that_dim_grains_below_the_threshold_are_a_class_of_their_own(
    brightness: list[float], hidden: bool
) -> None:
    found = segment(Volume(balls(brightness).astype(np.float32), (1, 1, 1), "grey", "scan"))
    assert found.n_grains == (2 if hidden else 8)
    classes = hidden_class(found.seen, found.level, ThresholdSettings())
    assert (classes is not None) == hidden
    if classes is not None:
        assert classes[0] == pytest.approx(100, abs=8)
        assert classes[1] == pytest.approx(190, abs=8)
        assert 115 < classes[2] < 175


def test_that_a_named_value_overrules_what_is_found() -> None:
    values = np.where(IN_CIRCLE, balls([60.0] * 5), 7).astype(np.uint8)
    values[:8, :, :] = 3  # so that no value fills all corners
    volume = Volume(values, (1, 1, 1), "grey", "scan")
    assert find_outside(volume) is None
    outside = find_outside(volume, "7")
    assert outside is not None
    assert outside.share == pytest.approx((values == 7).mean())
    assert find_outside(Volume(np.where(IN_CIRCLE, values, 9), (1, 1, 1), "grey", "scan"), "none") is None
    with pytest.raises(InputError, match="No part of scan is filled with 250"):
        find_outside(volume, "250")


def test_that_the_outside_has_no_part_in_histogram_contrast_and_preview() -> None:
    values = balls([60.0] * 5).astype(np.uint8)
    padded = scan_of(Volume(np.where(IN_CIRCLE, values, 255).astype(np.uint8), (1, 1, 1), "grey", "scan"))
    assert padded.histogram is not None
    assert padded.histogram.counts.sum() == IN_CIRCLE.sum()
    assert padded.contrast[1] < 200
    box = (
        slice(34, 56),
        slice(16, 40),
        slice(4, 28),
    )  # a ball, and some of what is outside
    found = preview(
        padded.volume, box, SegmentationSettings(), padded.level(SegmentationSettings()), padded.outside
    )
    assert found.n_grains == 1
    assert found.seen.counts.sum() == IN_CIRCLE[box].sum()
    assert scan_of(padded.volume, outside="none").contrast[1] == 255


@pytest.mark.parametrize("surface", ["grey", "mask"])
def test_that_a_grain_cut_by_the_circle_is_one_at_the_border_and_none_is_changed(surface: Surface) -> None:
    values = balls([60.0] * 5)
    centre = np.array([27.5, 27.5 - 26.0, 16.0])
    values[np.linalg.norm(AT - centre, axis=-1) < 5.0] += 60.0
    volume = Volume(np.where(IN_CIRCLE, values, np.nan).astype(np.float32), (1, 1, 1), "grey", "scan")
    found = segment(volume, outside=find_outside(volume))
    made = extract_particles(found.labels, ExtractionSettings(surface=surface), grey=volume)
    assert len(made.found) == 5
    assert len(made.border) == 1
    whole = Volume(values.astype(np.float32), (1, 1, 1), "grey", "scan")
    expected = extract_particles(segment(whole).labels, ExtractionSettings(surface=surface), grey=whole)
    volumes = [each.mesh.volume for each in expected.particles]
    assert [each.mesh.volume for each in made.particles] == pytest.approx(volumes, rel=0.02)


def test_that_the_places_of_a_disc_in_a_circle_are_those_of_a_smaller_circle() -> None:
    x, y = np.indices((401, 401)) - 200.0
    circle = ScanCircle.of(np.hypot(x, y) < 200.0)
    at = np.indices((81, 81)) - 40.0
    expected = (1 - 41 / 200.5) ** 2  # pixels have corners, and one lies between the disc and the edge
    assert circle.share_inside(np.hypot(*at) < 40.0) == pytest.approx(expected, rel=0.01)
    long = np.ones((81, 1), dtype=bool)  # the erosion by a segment of length 2 a is a lens
    half = np.arccos(41 / 200)
    assert circle.share_inside(long) == pytest.approx((2 * half - np.sin(2 * half)) / np.pi, rel=0.02)


def test_that_a_slice_that_is_seen_whole_has_the_places_of_the_border_correction() -> None:
    share = ScanCircle.of(np.ones((100, 60), dtype=bool)).share_inside(np.ones((9, 19), dtype=bool))
    assert share == pytest.approx((1 - 10 / 100) * (1 - 20 / 60), rel=0.01)
