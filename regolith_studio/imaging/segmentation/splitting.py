"""Touching grains parted: a watershed of the distance to the surface, one connected body at a time.

A grain is a hill of the distance map, a neck between two grains a pass. Rough grains have several
peaks; a peak that stands out from its pass by h or less is taken for roughness and joined to its
neighbour. h is the one control against over-segmentation (too small) and grains that stick
together (too large).
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage, sparse
from scipy.sparse import csgraph

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.imaging.segmentation.flooding import Flooded, flood

Continued = tuple[tuple[bool, bool], ...]
"""For each axis, whether a mask goes on beyond the array at its low and its high end."""
_CLOSED: Continued = ((False, False),) * 3


@dataclass(frozen=True)
class SplittingSettings:
    """How touching grains are parted.

    Parameters
    ----------
    enabled
        Otherwise each connected body is one grain.
    h_maxima
        Persistence up to which a peak of the distance map is no grain of its own, in voxels.
    relative
        The same as a share of the peak's height, 0 to 1; the larger of the two counts. Large grains
        have larger bumps, so that a mixture of sizes is parted better with some of both.
    """

    enabled: bool = True
    h_maxima: float = 0.8
    relative: float = 0.1

    def __post_init__(self) -> None:
        if not 0.0 <= self.h_maxima < np.inf:
            raise InputError(f"The h of the h-maxima must not be negative, got {self.h_maxima}.")
        if not 0.0 <= self.relative <= 1.0:
            raise InputError(f"The relative h of the h-maxima is a share, 0 to 1, got {self.relative}.")


def joined(flooded: Flooded, settings: SplittingSettings) -> IntArray:
    """Grain of each basin, 1 to the number of grains; entry 0 is 0, shape (n + 1,)."""
    bump = np.maximum(settings.h_maxima, settings.relative * flooded.summits)
    joins = (flooded.summits - flooded.passes <= bump) | (not settings.enabled)
    first, second = flooded.pairs[joins].T
    shape = (len(flooded.peaks), len(flooded.peaks))
    links = sparse.coo_array((np.ones(len(first), dtype=np.int8), (first, second)), shape=shape)
    _, grains = csgraph.connected_components(links, directed=False)
    return np.concatenate([[0], np.asarray(grains, dtype=np.int64) + 1])


def distance_map(
    mask: NDArray[np.bool_], edges: FloatArray, continued: Continued = _CLOSED
) -> NDArray[np.float32]:
    """Distance of each voxel of the mask to the nearest one outside, in mean voxel edges.

    Parameters
    ----------
    edges
        Of a voxel along x, y and z, in any unit, shape (3,).
    continued
        Where the mask may go on beyond the array, as at the border of a scan, the array's end is no
        surface; elsewhere what is beyond counts as empty.
    """
    rim = tuple((int(not low), int(not high)) for low, high in continued)
    padded = np.pad(mask, rim)
    distance: Any = ndimage.distance_transform_edt(padded, sampling=in_mean_edges(edges))
    inner = tuple(slice(low, n - high) for (low, high), n in zip(rim, padded.shape, strict=True))
    return np.ascontiguousarray(distance[inner], dtype=np.float32)


def split(
    mask: NDArray[np.bool_], edges: FloatArray, settings: SplittingSettings, continued: Continued = _CLOSED
) -> tuple[IntArray, IntArray]:
    """Grain of each voxel of a mask, 1 to n, 0 outside; and the voxel of each grain's peak, shape (n, 3)."""
    flooded = flood(distance_map(mask, edges, continued), in_mean_edges(edges))
    grain_of_basin = joined(flooded, settings)
    _, highest = np.unique(grain_of_basin[1:], return_index=True)
    return grain_of_basin[flooded.basins], flooded.sites[highest]


def in_mean_edges(edges: FloatArray) -> FloatArray:
    """Voxel edges divided by their geometric mean."""
    return np.asarray(edges / np.prod(edges) ** (1 / 3), dtype=np.float64)
