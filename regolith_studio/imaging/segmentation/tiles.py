"""One body parted into its grains, in pieces where it is too large to be worked on at once.

Densely packed grains touch so often that a single body fills the scan. Such a body is cut into
tiles, each looked at with a margin on all sides. A grain belongs to the tile that holds its peak;
if it is cut by the end of the margin, the margin is widened. Far from a cut the watershed does not
know of it, so that tiles agree on where grains meet; the few voxels on which they do not go to the
nearest grain.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from skimage import segmentation

from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.imaging.bodies import pores_filled
from regolith_studio.imaging.boxes import Box, box_between, grown, n_voxels, within
from regolith_studio.imaging.segmentation.components import Bodies
from regolith_studio.imaging.segmentation.splitting import Continued, SplittingSettings, split

_ATTEMPTS = 3
_expand_labels: Any = segmentation.expand_labels


@dataclass(frozen=True)
class TileSettings:
    """When and how a body is cut into tiles, in voxels.

    Parameters
    ----------
    largest
        Voxels of the box of a body that is not cut.
    core
        Edge of a tile.
    margin
        Looked at around a tile at first; doubled, at most twice, where it cuts a grain.
    """

    largest: int = 2**23
    core: int = 128
    margin: int = 40


class BodySplitter:
    """Parts bodies into grains, in place.

    Parameters
    ----------
    numbers
        Provisional numbers of bodies, shape (nx, ny, nz), int32; a voxel of grain k becomes -k.
    bodies
        What the numbers stand for.
    edges
        Of a voxel, shape (3,).
    settings
        How touching grains are parted.
    fill_pores
        Whether pores inside a body become part of it.
    """

    def __init__(
        self,
        numbers: NDArray[np.int32],
        bodies: Bodies,
        edges: FloatArray,
        settings: SplittingSettings,
        fill_pores: bool = True,
        tiles: TileSettings | None = None,
    ) -> None:
        self._numbers, self._bodies, self._edges = numbers, bodies, edges
        self._settings, self._fill = settings, fill_pores
        self._tiles = tiles or TileSettings()
        self.n_grains = 0

    def steps(self, min_voxels: int = 0) -> Iterator[tuple[int, int]]:
        """Part all bodies of at least `min_voxels`; yields voxels done and voxels in all after each piece."""
        wanted = np.flatnonzero(self._bodies.sizes >= min_voxels) + 1
        total, done = int(self._bodies.sizes[wanted - 1].sum()), 0
        for body in wanted.tolist():
            size = int(self._bodies.sizes[body - 1])
            for share in self._part(body, self._bodies.box(body)):
                yield done + int(size * share), total
            done += size

    def _part(self, body: int, box: Box) -> Iterator[float]:
        """Part one body; yields the share of it that is done."""
        before, cores = self.n_grains, self._cores(box)
        for done, core in enumerate(cores, start=1):
            self._find_grains(body, box, core, before, whole=len(cores) == 1)
            yield done / len(cores)
        if len(cores) > 1:
            for core in cores:
                self._give_away_rest(body, grown(core, 1, box))

    def _cores(self, box: Box) -> list[Box]:
        if n_voxels(box) <= self._tiles.largest or not self._settings.enabled:
            return [box]
        step = self._tiles.core
        corners = product(*(range(side.start, side.stop, step) for side in box))
        high = [side.stop for side in box]
        return [box_between(low, np.minimum(np.add(low, step), high).tolist()) for low in corners]

    def _find_grains(self, body: int, box: Box, core: Box, before: int, whole: bool) -> None:
        """Find the grains whose peak lies in `core` and write them down."""
        for attempt in range(_ATTEMPTS):
            outer = box if whole else grown(core, self._tiles.margin * 2**attempt, box)
            region = self._numbers[outer]
            own = np.ascontiguousarray(self._is_body(region, body) | (region < -before))
            if not own[within(core, outer)].any():
                return
            mask = own | (pores_filled(own) & (region == 0)) if self._fill else own
            grains, sites = split(mask, self._edges, self._settings, self._continued(outer, box))
            owned = _inside(sites, within(core, outer))
            cut = _touching(grains, _ends(outer, box))
            if outer == box or not owned[cut - 1].any():
                break
        self._write(region, grains, owned)

    def _is_body(self, region: NDArray[np.int32], body: int) -> BoolArray:
        return np.asarray(self._bodies.body_of[np.maximum(region, 0)] == body)

    def _continued(self, outer: Box, box: Box) -> Continued:
        """Ends at which grains may go on: the border of the scan, and where a tile cuts the body."""
        x, y, z = (
            (side.start == 0 or cut_low, side.stop == n or cut_high)
            for side, n, (cut_low, cut_high) in zip(
                outer, self._numbers.shape, _ends(outer, box), strict=True
            )
        )
        return x, y, z

    def _write(self, region: NDArray[np.int32], grains: IntArray, owned: BoolArray) -> None:
        number = np.zeros(len(owned) + 1, dtype=np.int32)
        number[1:][owned] = self.n_grains + 1 + np.arange(np.count_nonzero(owned))
        new = number[grains]
        free = (new > 0) & (region >= 0)
        region[free] = -new[free]
        self.n_grains += int(np.count_nonzero(owned))

    def _give_away_rest(self, body: int, box: Box) -> None:
        """Voxels that no tile claimed go to the nearest grain."""
        region = self._numbers[box]
        rest = self._is_body(region, body)
        if rest.any():
            nearest = _expand_labels(np.maximum(-region, 0), distance=float(self._tiles.core))
            region[rest] = -nearest[rest]


def _ends(outer: Box, box: Box) -> Continued:
    """For each axis whether `outer` ends before `box` does, at its low and its high end."""
    x, y, z = ((a.start > b.start, a.stop < b.stop) for a, b in zip(outer, box, strict=True))
    return x, y, z


def _inside(sites: IntArray, box: Box) -> BoolArray:
    low, high = [side.start for side in box], [side.stop for side in box]
    return np.asarray(((sites >= low) & (sites < high)).all(axis=1))


def _touching(grains: IntArray, ends: Continued) -> IntArray:
    """Grains that touch the marked ends of their array."""
    faces = [
        np.moveaxis(grains, axis, 0)[end].ravel()
        for axis, marks in enumerate(ends)
        for end, marked in zip((0, -1), marks, strict=True)
        if marked
    ]
    found = np.unique(np.concatenate(faces)) if faces else np.empty(0, dtype=np.int64)
    return np.asarray(found[found > 0])
