"""Connected components of masks, and of volumes whose slabs are numbered apart and joined afterwards."""

from dataclasses import dataclass
from typing import Any

import cc3d
import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from regolith_studio.geometry.arrays import BoolArray, IntArray
from regolith_studio.imaging.volume import Box, box_between

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
class SlabComponents:
    """The components of one slab, numbered from 1.

    - ``sizes``: voxels of each, shape (n,).
    - ``low``, ``high``: first voxel of each box along x, y and z of the volume and the one after its last,
      shape (n, 3).
    - ``has_core``: whether it holds a voxel of the core mask, shape (n,).
    """

    sizes: IntArray
    low: IntArray
    high: IntArray
    has_core: BoolArray


@dataclass(frozen=True, eq=False)
class ConnectedComponents:
    """The components of a volume.

    ``sizes``: voxels of each body, shape (n,). ``low``, ``high``: first voxel of each box along x, y and z
    and the one after its last, shape (n, 3).
    """

    sizes: IntArray
    low: IntArray
    high: IntArray

    def box(self, body: int) -> Box:
        """Box of a body, numbered from 1."""
        return box_between(self.low[body - 1].tolist(), self.high[body - 1].tolist())


def components_of_slab(
    mask: NDArray[np.bool_], first: int, core: NDArray[np.bool_] | None = None
) -> tuple[NDArray[np.int32], SlabComponents]:
    """Number of the component of each voxel in a slab, 0 outside, and what is known of them.

    - ``mask``: shape (nx, ny, thickness).
    - ``first``: z of its first slice in the volume.
    - ``core``: only bodies with a voxel of this mask, of the same shape, are bodies; by default all are.
    """
    numbers, count = connected_components(mask)
    if count == 0:
        none = np.zeros((0, 3), dtype=np.int64)
        return np.zeros(mask.shape, np.int32, order="F"), SlabComponents(
            none[:, 0], none, none, none[:, 0] > 0
        )
    # As arrays: three slices in Python for each component would be far more memory than its numbers.
    seen = _statistics(numbers, no_slice_conversion=True)
    boxes = np.asarray(seen["bounding_boxes"], dtype=np.int64)[1:]
    shift = np.array([0, 0, first])
    sizes = np.asarray(seen["voxel_counts"], dtype=np.int64)[1:]
    has_core = np.ones(count + 1, dtype=bool)
    if core is not None:
        has_core[:] = False
        has_core[np.unique(numbers[core])] = True
    components = SlabComponents(sizes, boxes[:, 0::2] + shift, boxes[:, 1::2] + 1 + shift, has_core[1:])
    return numbers.astype(np.int32), components


class ComponentJoiner:
    """Joins the components of slabs, which are added from the first slab on."""

    def __init__(self) -> None:
        self._count = 0
        self._slabs: list[SlabComponents] = []
        self._links: list[IntArray] = [np.empty((0, 2), dtype=np.int64)]

    def add(self, slab: SlabComponents, below: NDArray[Any] | None, face: NDArray[Any]) -> int:
        """Take the next slab; returns what is added to its numbers to make them differ from all before.

        ``below``, ``face``: numbers in the last slice of the slab before, if there is one, and in the slab's
        first slice.
        """
        if below is not None:
            before = self._count - len(self._slabs[-1].sizes)
            touching = (below > 0) & (face > 0)
            pairs = np.column_stack([below[touching], face[touching]]).astype(np.int64)
            self._links.append(np.unique(pairs, axis=0) + np.array([before, self._count]))
        first = self._count
        self._slabs.append(slab)
        self._count += len(slab.sizes)
        return first

    def finish(self) -> tuple[IntArray, ConnectedComponents]:
        """The body of each number, 0 for none, and the bodies in the order of their first voxels."""
        links = np.concatenate(self._links)
        shape = (self._count + 1, self._count + 1)
        graph = sparse.coo_array((np.ones(len(links), dtype=np.int8), tuple(links.T)), shape=shape)
        # scipy counts components by their lowest node: 0, what is no component, stays 0, and bodies keep
        # their order.
        n_bodies, component_of = csgraph.connected_components(graph, directed=False)
        body_of: IntArray = component_of.astype(np.int64)
        sizes = np.zeros(n_bodies, dtype=np.int64)
        low = np.full((n_bodies, 3), np.iinfo(np.int64).max)
        high = np.zeros((n_bodies, 3), dtype=np.int64)
        kept = np.zeros(n_bodies, dtype=bool)
        if self._count:
            np.logical_or.at(kept, body_of[1:], np.concatenate([slab.has_core for slab in self._slabs]))
            np.add.at(sizes, body_of[1:], np.concatenate([slab.sizes for slab in self._slabs]))
            np.minimum.at(low, body_of[1:], np.concatenate([slab.low for slab in self._slabs]))
            np.maximum.at(high, body_of[1:], np.concatenate([slab.high for slab in self._slabs]))
        number = np.where(kept, np.cumsum(kept), 0)
        return number[body_of], ConnectedComponents(sizes[kept], low[kept], high[kept])
