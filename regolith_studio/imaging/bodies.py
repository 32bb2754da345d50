"""Connected bodies of a mask, and the pores in them."""

from typing import Any

import cc3d
import numpy as np
from numpy.typing import NDArray

_components: Any = cc3d.connected_components


def connected_bodies(mask: NDArray[np.bool_]) -> tuple[NDArray[Any], int]:
    """Number of each face-connected body, 0 outside, and how many there are."""
    bodies, count = _components(mask.view(np.uint8), connectivity=6, return_N=True, binary_image=True)
    return bodies, int(count)


def largest_body(mask: NDArray[np.bool_]) -> tuple[NDArray[np.bool_], int]:
    """The largest face-connected body of a mask, and the number of bodies."""
    bodies, count = connected_bodies(mask)
    if count < 2:
        return mask, count
    return np.asarray(bodies == np.bincount(bodies.ravel())[1:].argmax() + 1), count


def pores_filled(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The mask with what it encloses: hollows from which no way over faces leads to the array's border."""
    hollows, count = connected_bodies(~mask)
    if count == 0:
        return mask
    is_open = np.zeros(count + 1, dtype=bool)
    for axis in range(3):
        for end in (0, -1):
            is_open[np.unique(np.moveaxis(hollows, axis, 0)[end])] = True
    is_open[0] = False
    return np.asarray(~is_open[hollows]) if not is_open[1:].all() else mask
