"""Noise out of grey values, edges kept, slab by slab, with the histogram of what is left."""

from collections.abc import Generator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from skimage import restoration

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.imaging.segmentation.scan_outside import Padding
from regolith_studio.imaging.segmentation.thresholding import (
    Histogram,
    bins_between,
    finite,
    histogram,
    span,
)
from regolith_studio.imaging.settings import DenoiseSettings
from regolith_studio.imaging.volume import Volume
from regolith_studio.imaging.volume_slabs import ParallelMap, ScratchArrays, SharedArray, slab_ranges

_denoise_nl_means: Any = restoration.denoise_nl_means


def noise_of(slices: NDArray[Any]) -> float:
    """Standard deviation of the noise of the middle slice; shape (nx, ny, nz).

    The difference of two Laplacians is blind to planes and edges along the axes (Immerkaer 1996);
    its median instead of its mean is blind to the other edges too.
    """
    middle = slices[:, :, slices.shape[2] // 2].astype(np.float64)
    # 6 is the norm of the mask (1, -2, 1) x (1, -2, 1), .674 the median of |x| of a standard Gaussian.
    response = np.diff(np.diff(middle, 2, axis=0), 2, axis=1)
    return float(np.median(np.abs(response)) / (6.0 * 0.67448975)) if response.size else 0.0


def denoised(values: NDArray[Any], settings: DenoiseSettings, noise: float | None = None) -> NDArray[Any]:
    """The grey values without noise, in their own type; shape (nx, ny, nz).

    ``noise``: its standard deviation for non-local means; by default :func:`noise_of` these values. To be
    given where slabs of one volume must agree.
    """
    match settings.method:
        case "gaussian":
            single = values.astype(np.float32, copy=False)
            return _in_type(ndimage.gaussian_filter(single, settings.sigma, mode="nearest"), values.dtype)
        case "median":
            return np.asarray(ndimage.median_filter(values, settings.size, mode="nearest"))
        case "non-local-means":
            sigma = noise_of(values) if noise is None else noise
            return _in_type(_non_local(values, settings, sigma), values.dtype)
        case _:
            return values


def _non_local(values: NDArray[Any], settings: DenoiseSettings, sigma: float) -> NDArray[np.float32]:
    if sigma <= 0.0:
        return values.astype(np.float32)
    cleaned = _denoise_nl_means(
        values.astype(np.float32),
        patch_size=settings.patch,
        patch_distance=settings.reach,
        h=settings.strength * sigma,
        sigma=sigma,
        fast_mode=True,
        preserve_range=True,
    )
    return np.asarray(cleaned, dtype=np.float32)


def _in_type(values: NDArray[np.float32], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Rounded and clipped where `dtype` is one of whole numbers."""
    if dtype.kind == "f":
        return values.astype(dtype, copy=False)
    if dtype.kind == "b":
        return values > 0.5
    limits = np.iinfo(dtype)
    rounded = np.rint(values, out=values)
    return np.clip(rounded, float(limits.min), float(limits.max)).astype(dtype)


def denoised_volume(
    source: Volume,
    how: DenoiseSettings,
    are_probabilities: bool,
    scratch: ScratchArrays,
    run: ParallelMap,
    padding: Padding | None,
) -> Generator[tuple[int, int], None, tuple[Volume, Histogram, int]]:
    """Grey values without noise (probabilities as they are), their histogram, and how many are not finite.

    ``padding``: what the histogram does not count.
    """
    given = SharedArray(source.array)
    ranges = slab_ranges(source.shape)
    # No filter leaves the range of the values: one pass can filter and count.
    edges, n_not_finite = _bins(given, run)
    middle = source.shape[2] // 2
    noise = noise_of(given.slices(middle, middle + 1)) if how.method == "non-local-means" else 0.0
    values = None
    if how.method != "none" and not are_probabilities:
        values = SharedArray(scratch.zeros(source.shape, source.dtype))
    smooth = partial(_smooth_slab, given, values, how, noise, edges, padding)
    seen = Histogram(np.zeros(len(edges) - 1, dtype=np.int64), edges)
    for done, counts in enumerate(run(smooth, ranges), start=1):
        seen = seen + counts
        yield done, len(ranges)
    denoised = source if values is None else replace(source, array=values.array)
    return denoised, seen, n_not_finite


def _smooth_slab(
    given: SharedArray,
    values: SharedArray | None,
    how: DenoiseSettings,
    noise: float,
    edges: FloatArray,
    padding: Padding | None,
    part: tuple[int, int],
) -> Histogram:
    """Write a slab without noise into `values`, if there are any; returns its histogram."""
    if values is None:
        smooth = given.slices(*part)
    else:
        slab = given.thick(*part, how.margin)
        smooth = denoised(slab.values, how, noise)[:, :, slab.inner]
        values.write(slab.first, smooth)
    return histogram(smooth if padding is None else smooth[~padding.of(part)], edges)


def _bins(given: SharedArray, run: ParallelMap) -> tuple[FloatArray, int]:
    """Edges of the histogram's bins, and the number of voxels that are not finite."""
    spans, n_not_finite = [], 0
    for known, count in run(partial(_span_of_slab, given), slab_ranges(given.shape)):
        spans += known
        n_not_finite += count
    lowest, highest = span(np.array(spans))
    return bins_between(lowest, highest, given.array.dtype), n_not_finite


def _span_of_slab(given: SharedArray, part: tuple[int, int]) -> tuple[list[tuple[float, float]], int]:
    """Lowest and highest finite value of a slab, if there is one, and how many are not finite."""
    slab = given.slices(*part)
    known = finite(slab)
    return [span(known)] if known.size else [], slab.size - known.size
