"""Outside of a scanner's circle a volume holds one value, which is neither grain nor air."""

import numpy as np
import pytest

from regolith_studio.imaging.scan_outside import background_filled, find_outside
from regolith_studio.imaging.segmentation.segment import segment
from regolith_studio.imaging.segmentation.thresholding import ThresholdSettings, hidden_class
from regolith_studio.imaging.volume import Volume
from regolith_studio.imaging.volume_slabs import ScratchArrays

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
    assert segment(filled).sizes == pytest.approx(segment(without).sizes, abs=8)


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
