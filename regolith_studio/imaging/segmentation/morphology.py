"""Small faults of a mask mended: specks, thin bridges, cracks, pores."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from regolith_studio.errors import InputError
from regolith_studio.messages import N_

_CROSS: NDArray[np.bool_] = ndimage.generate_binary_structure(3, 1)


@dataclass(frozen=True)
class CleaningSettings:
    """Morphology of the mask, in voxels.

    Parameters
    ----------
    opening
        Removes what is thinner than about twice this: specks and thin bridges between grains.
    closing
        Closes cracks and gaps thinner than about twice this.
    fill_pores
        Fill pores inside grains that have no way out.
    min_voxels
        Drop what has fewer voxels, before and after grains are split.
    """

    opening: int = 0
    closing: int = 0
    fill_pores: bool = True
    min_voxels: int = 64

    def __post_init__(self) -> None:
        for name, value in ((N_("Opening"), self.opening), (N_("Closing"), self.closing)):
            if value not in range(11):
                raise InputError(f"{name} takes 0 to 10 voxels, got {value}.")
        if self.min_voxels < 0:
            raise InputError(f"The smallest number of voxels must not be negative, got {self.min_voxels}.")

    @property
    def margin(self) -> int:
        """Slices beyond a slab that the result in the slab depends on."""
        return 2 * (self.opening + self.closing)


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
