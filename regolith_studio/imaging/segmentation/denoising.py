"""Noise out of grey values, edges kept."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from skimage import restoration

from regolith_studio.imaging.settings import DenoiseSettings

_denoise_nl_means: Any = restoration.denoise_nl_means


def noise_of(slices: NDArray[Any]) -> float:
    """Standard deviation of the noise of the middle slice; shape (nx, ny, nz).

    The difference of two Laplacians is blind to planes and edges along the axes (Immerkaer 1996);
    its median instead of its mean is blind to the other edges too.
    """
    middle = slices[:, :, slices.shape[2] // 2].astype(np.float64)
    response = np.diff(np.diff(middle, 2, axis=0), 2, axis=1)
    return float(np.median(np.abs(response)) / (6.0 * 0.67448975)) if response.size else 0.0


def denoised(values: NDArray[Any], settings: DenoiseSettings, noise: float | None = None) -> NDArray[Any]:
    """The grey values without noise, in their own type; shape (nx, ny, nz).

    Parameters
    ----------
    noise
        Its standard deviation for non-local means; by default :func:`noise_of` these values.
        To be given where slabs of one volume must agree.
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
