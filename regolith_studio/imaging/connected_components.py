"""Connected components of masks, and of volumes that are processed slab by slab (union-find across slabs)."""

from dataclasses import dataclass
from typing import Any

import cc3d
import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from regolith_studio.geometry.arrays import IntArray
from regolith_studio.imaging.bounding_boxes import Box, box_between

_components: Any = cc3d.connected_components
_statistics: Any = cc3d.statistics


def connected_components(mask: NDArray[np.bool_]) -> tuple[NDArray[Any], int]:
    """Number of the face-connected component of each voxel, 0 outside, and the number of components."""
    bodies, count = _components(mask.view(np.uint8), connectivity=6, return_N=True, binary_image=True)
    return bodies, int(count)


def largest_component(mask: NDArray[np.bool_]) -> tuple[NDArray[np.bool_], int]:
    """The largest face-connected component of a mask, and the number of components."""
    bodies, count = connected_components(mask)
    if count < 2:
        return mask, count
    return np.asarray(bodies == np.bincount(bodies.ravel())[1:].argmax() + 1), count


def pores_filled(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The mask with its pores: empty components that do not reach the border of the array."""
    hollows, count = connected_components(~mask)
    if count == 0:
        return mask
    is_open = np.zeros(count + 1, dtype=bool)
    for axis in range(3):
        for end in (0, -1):
            is_open[np.unique(np.moveaxis(hollows, axis, 0)[end])] = True
    is_open[0] = False
    return np.asarray(~is_open[hollows]) if not is_open[1:].all() else mask


@dataclass(frozen=True, eq=False)
class ConnectedComponents:
    """The components of a volume, after its last slab.

    Parameters
    ----------
    body_of
        Body of each provisional number, 1 to n; entry 0 is 0.
    sizes
        Voxels of each body, shape (n,).
    low, high
        First voxel of each box along x, y, z and the one after its last, shape (n, 3).
    """

    body_of: IntArray
    sizes: IntArray
    low: IntArray
    high: IntArray

    def box(self, body: int) -> Box:
        """Box of a body, numbered from 1."""
        return box_between(self.low[body - 1].tolist(), self.high[body - 1].tolist())


class ComponentCounter:
    """Numbers the components of one slab after the other."""

    def __init__(self) -> None:
        self._count = 0
        self._links: list[IntArray] = []
        self._sizes: list[IntArray] = []
        self._low: list[IntArray] = []
        self._high: list[IntArray] = []
        self._face: NDArray[np.int32] | None = None

    def numbered(self, mask: NDArray[np.bool_], first: int) -> NDArray[np.int32]:
        """Provisional numbers of the next slab's bodies, which differ from those of all slabs before.

        Parameters
        ----------
        mask
            Shape (nx, ny, thickness).
        first
            z of its first slice.
        """
        bodies, count = connected_components(mask)
        self._remember(bodies, count, first)
        numbers = bodies.astype(np.int32)
        numbers[bodies > 0] += self._count
        if self._face is not None:
            touching = (self._face > 0) & (numbers[:, :, 0] > 0)
            pairs = np.column_stack([self._face[touching], numbers[:, :, 0][touching]])
            self._links.append(np.unique(pairs, axis=0).astype(np.int64))
        self._face = numbers[:, :, -1].copy()
        self._count += count
        return numbers

    def finish(self) -> ConnectedComponents:
        """The components, in the order of their first voxels."""
        links = np.concatenate([np.empty((0, 2), dtype=np.int64), *self._links])
        shape = (self._count + 1, self._count + 1)
        graph = sparse.coo_array((np.ones(len(links), dtype=np.int8), tuple(links.T)), shape=shape)
        n_bodies, found = csgraph.connected_components(graph, directed=False)
        body_of: IntArray = found.astype(np.int64)
        sizes = np.zeros(n_bodies, dtype=np.int64)
        low = np.full((n_bodies, 3), np.iinfo(np.int64).max)
        high = np.zeros((n_bodies, 3), dtype=np.int64)
        if self._count:
            np.add.at(sizes, body_of[1:], np.concatenate(self._sizes))
            np.minimum.at(low, body_of[1:], np.concatenate(self._low))
            np.maximum.at(high, body_of[1:], np.concatenate(self._high))
        return ConnectedComponents(body_of, sizes[1:], low[1:], high[1:])

    def _remember(self, bodies: NDArray[Any], count: int, first: int) -> None:
        if count == 0:
            return
        seen = _statistics(bodies)
        boxes = seen["bounding_boxes"][1:]
        shift = np.array([0, 0, first])
        self._sizes.append(np.asarray(seen["voxel_counts"][1:], dtype=np.int64))
        self._low.append(np.array([[side.start for side in box] for box in boxes]) + shift)
        self._high.append(np.array([[side.stop for side in box] for box in boxes]) + shift)
