"""Noise out of grey values, edges kept."""

from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from skimage import restoration

from regolith_studio.errors import InputError

DenoiseMethod = Literal["none", "gaussian", "median", "non-local-means"]
DENOISE_METHODS: tuple[DenoiseMethod, ...] = get_args(DenoiseMethod)

_denoise_nl_means: Any = restoration.denoise_nl_means


@dataclass(frozen=True)
class DenoiseSettings:
    """How grey values are smoothed before they are thresholded; lengths in voxels.

    Parameters
    ----------
    method
        ``gaussian`` is fast and rounds edges a little; ``median`` keeps edges and removes single
        outliers; ``non-local-means`` averages similar patches, keeps edges and fine cracks best and
        takes longest.
    sigma
        Standard deviation of the Gaussian.
    size
        Edge of the median's cube; odd.
    strength
        Of the non-local means: patches count as similar up to this many standard deviations of the noise.
    patch, reach
        Of the non-local means: edge of a patch (odd), and how far away patches are searched.
    """

    method: DenoiseMethod = "median"
    sigma: float = 0.8
    size: int = 3
    strength: float = 0.8
    patch: int = 3
    reach: int = 3

    def __post_init__(self) -> None:
        if self.method not in DENOISE_METHODS:
            raise InputError(f"Denoise by one of {', '.join(DENOISE_METHODS)}, not {self.method!r}.")
        if not 0.0 < self.sigma <= 10.0:
            raise InputError(f"The Gaussian's sigma lies between 0 and 10 voxels, got {self.sigma}.")
        if not 0.0 < self.strength <= 10.0:
            raise InputError(f"The strength of non-local means lies between 0 and 10, got {self.strength}.")
        for name, value, high in (("median's size", self.size, 9), ("patch", self.patch, 9)):
            if value not in range(3, high + 1, 2):
                raise InputError(f"The {name} is an odd number from 3 to {high}, got {value}.")
        if self.reach not in range(1, 11):
            raise InputError(f"Patches are searched 1 to 10 voxels away, got {self.reach}.")

    @property
    def margin(self) -> int:
        """Slices beyond a slab that the result in the slab depends on."""
        match self.method:
            case "gaussian":
                return int(4.0 * self.sigma + 0.5)
            case "median":
                return self.size // 2
            case "non-local-means":
                return self.reach + self.patch // 2 + 1
            case _:
                return 0


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
