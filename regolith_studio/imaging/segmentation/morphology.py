"""Small faults of a mask mended: specks, thin bridges, cracks, pores."""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from regolith_studio.imaging.settings import CleaningSettings

_CROSS: NDArray[np.bool_] = ndimage.generate_binary_structure(3, 1)


def cleaned(mask: NDArray[np.bool_], settings: CleaningSettings) -> NDArray[np.bool_]:
    """The mask closed, then opened, by steps of the six neighbours; the border counts as continued."""
    width = settings.margin
    if width == 0:
        return mask
    padded = np.pad(mask, width, mode="edge")
    if settings.closing:
        padded = ndimage.binary_closing(padded, _CROSS, settings.closing)
    if settings.opening:
        padded = ndimage.binary_opening(padded, _CROSS, settings.opening)
    inner = tuple(slice(width, -width) for _ in range(3))
    return np.asarray(padded[inner], dtype=np.bool_)
