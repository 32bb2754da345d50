"""Denoising, thresholds and cleaning: against skimage and scipy on whole volumes."""

import numpy as np
import pytest
from scipy import ndimage
from skimage import filters

from regolith_studio.errors import InputError
from regolith_studio.imaging.segmentation.denoising import denoised, noise_of
from regolith_studio.imaging.segmentation.thresholding import (
    Histogram,
    cleaned,
    grain_voxels,
    histogram,
    level_of,
)
from regolith_studio.imaging.settings import (
    DENOISE_METHODS,
    CleaningSettings,
    DenoiseSettings,
    ThresholdSettings,
)
from regolith_studio.imaging.volume import sample_volume


def step(noise: float, dtype=np.float32, size: int = 32) -> tuple[np.ndarray, np.ndarray]:
    clean = np.where(np.arange(size) < size // 2, 60.0, 160.0)[:, None, None] * np.ones((size, size, size))
    noisy = clean + noise * np.random.default_rng(0).standard_normal(clean.shape)
    return clean, noisy.astype(dtype)


@pytest.mark.parametrize("sigma", [2.0, 9.0])
def test_that_the_noise_is_measured(sigma: float) -> None:
    assert noise_of(step(sigma, size=64)[1]) == pytest.approx(sigma, rel=0.05)


@pytest.mark.parametrize("method", [method for method in DENOISE_METHODS if method != "none"])
@pytest.mark.parametrize("dtype", [np.uint8, np.float32])
def test_that_denoising_takes_noise_and_leaves_brightness(method, dtype) -> None:
    clean, noisy = step(9.0, dtype)
    quiet = denoised(noisy, DenoiseSettings(method))
    assert quiet.dtype == dtype
    flat = np.s_[4:12, 4:-4, 4:-4]
    assert quiet[flat].std() < 0.5 * noisy[flat].std()
    assert quiet[flat].mean() == pytest.approx(clean[flat].mean(), abs=1.0)


def test_that_median_and_non_local_means_keep_an_edge_better_than_a_gaussian() -> None:
    clean, noisy = step(6.0)
    edge = np.s_[14:18, 4:-4, 4:-4]
    wrong = {
        method: np.abs(denoised(noisy, DenoiseSettings(method, sigma=1.0)) - clean)[edge].mean()
        for method in DENOISE_METHODS
    }
    assert wrong["median"] < 0.5 * wrong["gaussian"]
    assert wrong["non-local-means"] < 0.5 * wrong["gaussian"]
    assert wrong["non-local-means"] < wrong["none"]


@pytest.mark.parametrize("method", DENOISE_METHODS)
def test_that_a_slab_with_its_margin_is_denoised_as_in_the_whole(method) -> None:
    values = sample_volume("grey").array[:40, :40, :60].astype(np.float32)
    settings = DenoiseSettings(method)
    whole = denoised(values, settings, noise=8.0)
    slab = denoised(values[:, :, 20 - settings.margin : 40 + settings.margin], settings, noise=8.0)
    inner = slab[:, :, settings.margin : settings.margin + 20]
    assert np.abs(inner - whole[:, :, 20:40]).max() < 0.05


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
def test_that_otsu_is_that_of_skimage(dtype) -> None:
    values = sample_volume("grey").array.astype(dtype)
    level = level_of(histogram(values), ThresholdSettings(), values.dtype)
    mask = grain_voxels(values, level, ThresholdSettings())
    assert np.mean(mask != (values > filters.threshold_otsu(values))) < 1e-3


@pytest.mark.parametrize("boundary", [1, 2])
def test_that_multi_otsu_is_that_of_skimage(boundary: int) -> None:
    values = sample_volume("grey").array
    settings = ThresholdSettings("multi-otsu", classes=3, boundary=boundary)
    level = level_of(histogram(values), settings, values.dtype)
    assert level == pytest.approx(filters.threshold_multiotsu(values, 3)[boundary - 1], abs=1.0)


def test_that_a_manual_level_and_a_probability_are_taken_as_given() -> None:
    seen = histogram(np.arange(10, dtype=np.uint8))
    assert level_of(seen, ThresholdSettings("manual", 7.0), np.dtype(np.uint8)) == 7.0
    assert level_of(seen, ThresholdSettings("probability", 0.5), np.dtype(np.uint8)) == 127.5
    assert level_of(seen, ThresholdSettings("probability", 0.4), np.dtype(np.float32)) == 0.4
    values = np.array([[[1.0, 7.0, 9.0]]])
    assert grain_voxels(values, 7.0, ThresholdSettings("manual", 7.0)).tolist() == [[[False, True, True]]]
    dark = ThresholdSettings("manual", 7.0, dark=True)
    assert grain_voxels(values, 7.0, dark).tolist() == [[[True, False, False]]]


def test_that_histograms_of_slabs_add_up_to_that_of_the_whole() -> None:
    values = sample_volume("grey").array
    whole = histogram(values)
    parts = histogram(values[:, :, :50], whole.edges) + histogram(values[:, :, 50:], whole.edges)
    assert np.array_equal(parts.counts, whole.counts)
    assert np.array_equal(whole.counts, np.bincount(values.ravel())[values.min() : values.max() + 1])
    with pytest.raises(ValueError, match="same bins"):
        _ = whole + Histogram(np.zeros(2, int), np.arange(3.0))


def test_that_values_that_are_no_numbers_do_not_count() -> None:
    values = np.array([[[np.nan, 1.0, 2.0, np.inf]]])
    assert histogram(values).counts.sum() == 2
    with pytest.raises(InputError, match="no finite"):
        histogram(np.full((2, 2, 2), np.nan))


def test_that_a_uniform_volume_has_no_automatic_threshold() -> None:
    with pytest.raises(InputError, match="only 1 grey values"):
        level_of(histogram(np.full((3, 3, 3), 7, dtype=np.uint8)), ThresholdSettings(), np.dtype(np.uint8))


def test_that_opening_takes_specks_and_bridges_and_closing_takes_cracks() -> None:
    mask = np.zeros((40, 20, 20), dtype=bool)
    mask[4:16, 4:16, 4:16] = mask[22:36, 4:16, 4:16] = True
    mask[16:22, 9:11, 9:11] = True
    mask[1, 1, 1] = True
    opened = cleaned(mask, CleaningSettings(opening=2))
    assert ndimage.label(opened)[1] == 2
    assert not opened[1, 1, 1]
    cracked = mask.copy()
    cracked[10, :, :] = False
    assert ndimage.label(cleaned(cracked, CleaningSettings(closing=1)))[1] == 2
    assert cleaned(mask, CleaningSettings()) is mask


def test_that_cleaning_does_not_nibble_at_grains_that_the_border_cuts() -> None:
    mask = np.zeros((20, 20, 20), dtype=bool)
    mask[:8, 6:14, 6:14] = True
    whole = np.zeros((36, 20, 20), dtype=bool)
    whole[8:24, 6:14, 6:14] = True
    settings = CleaningSettings(opening=2, closing=1)
    assert np.array_equal(cleaned(mask, settings)[:5], cleaned(whole, settings)[16:21])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: DenoiseSettings("mean"), "method must be one of median"),
        (lambda: DenoiseSettings(size=4), "odd number"),
        (lambda: DenoiseSettings(sigma=-1), "sigma"),
        (lambda: DenoiseSettings(strength=0), "strength"),
        (lambda: DenoiseSettings(reach=0), "reach"),
        (lambda: ThresholdSettings("li"), "method must be one of otsu"),
        (lambda: ThresholdSettings(value=np.nan), "value must be a number"),
        (lambda: ThresholdSettings("probability", 1.5), "between 0 and 1"),
        (lambda: ThresholdSettings("multi-otsu", boundary=3), "3 to 5 classes"),
        (lambda: CleaningSettings(opening=-1), "opening must be a whole number from 0 to 10"),
        (lambda: CleaningSettings(min_voxels=-1), "min_voxels"),
    ],
)
def test_that_settings_without_meaning_are_refused(make, message) -> None:
    with pytest.raises(InputError, match=message):
        make()
