"""Touching grains parted: a watershed of the distance to the surface, one connected body at a time.

A grain is a hill of the distance map, a neck between two grains a pass. Rough grains have several
peaks; a peak that stands out from its pass by h or less is taken for roughness and joined to its
neighbour. h is the one control against over-segmentation (too small) and grains that stick
together (too large).

The watershed takes one pass and gives the persistence of every basin.
Voxels are taken from the highest to the lowest. One without a neighbour that was taken before is a
peak and founds a basin; any other joins the neighbour to which the way is steepest. Where two
basins meet for the first time, the pass between them is as high as that voxel, and the lower of the
two highest peaks behind it stands out by ``peak - pass``: its persistence, or dynamics (Grimaud 1992).
Joining every pair of basins whose persistence is at most h gives the watershed of the h-maxima
(Soille 2003, section 6.3.5), for any h, without flooding again.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage, sparse
from scipy.sparse import csgraph
from skimage import segmentation

from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.geometry.kernels import inner_kernel, kernel
from regolith_studio.imaging.connected_components import ConnectedComponents, pores_filled
from regolith_studio.imaging.settings import SplittingSettings, TileSettings
from regolith_studio.imaging.volume import Box, box_between, grown, n_voxels, within
from regolith_studio.imaging.volume_slabs import ParallelMap, SharedArray, in_batches

_STEPS = np.array(
    [(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if (x, y, z) != (0, 0, 0)],
    dtype=np.int64,
)


@dataclass(frozen=True, eq=False)
class WatershedBasins:
    """The basins of a height map, and how they meet.

    - ``basins``: 1 to n where heights are positive, in the order of falling peaks, else 0; shape (nx, ny,
      nz).
    - ``sites``: voxel of each basin's peak, shape (n, 3).
    - ``peaks``: height of each basin's peak, shape (n,).
    - ``pairs``: basins that meet, from 0, shape (m, 2).
    - ``summits``, ``passes``: for each meeting the lower of the highest peaks on its two sides, and the
      pass, shape (m,).
    """

    basins: NDArray[np.int32]
    sites: IntArray
    peaks: FloatArray
    pairs: IntArray
    summits: FloatArray
    passes: FloatArray


def find_basins(heights: NDArray[np.float32], step_lengths: FloatArray) -> "WatershedBasins":
    """Basins of `heights`, and how they meet.

    ``heights``: shape (nx, ny, nz); 0 and less is dry land that belongs to no basin. ``step_lengths``:
    distance of neighbouring voxels along x, y and z, shape (3,).
    """
    padded = np.pad(heights, 1)
    flat = padded.reshape(-1)
    wet = np.flatnonzero(flat > 0.0)
    # Stable, so that plateaus are flooded in the order of their voxels on every machine.
    order = wet[np.argsort(-flat[wet], kind="stable")]
    strides = np.array([padded.shape[1] * padded.shape[2], padded.shape[2], 1])
    offsets = np.ascontiguousarray(_STEPS @ strides)
    distances = np.sqrt(((_STEPS * step_lengths) ** 2).sum(axis=1))
    basins = np.zeros(flat.size, dtype=np.int32)
    founders, pairs, ridges = _flooded(flat, order, offsets, distances, basins)
    inner = np.ascontiguousarray(basins.reshape(padded.shape)[1:-1, 1:-1, 1:-1])
    sites = np.column_stack(np.unravel_index(founders, padded.shape)) - 1
    return WatershedBasins(inner, sites, flat[founders].astype(np.float64), pairs, ridges[:, 0], ridges[:, 1])


@inner_kernel
def _root(parents: NDArray[np.int32], basin: int) -> int:
    while parents[basin] != basin:
        parents[basin] = parents[parents[basin]]
        basin = parents[basin]
    return basin


def _flooded(
    heights: NDArray[np.float32],
    order: IntArray,
    offsets: IntArray,
    distances: FloatArray,
    basins: NDArray[np.int32],
) -> tuple[IntArray, IntArray, FloatArray]:
    """Fills `basins` (flat, padded by one); returns peak voxels, pairs that meet, their ridges."""
    # Arrays grow here and not in the kernel: one that returns arrays runs Python's code to make them, where
    # Ctrl+C would end the interpreter.
    size, counts, taken = 1024, np.zeros(2, np.int64), 0
    founders, parents = np.empty(size, np.int64), np.empty(size, np.int32)
    meetings, ridges = np.empty((size, 2), np.int64), np.empty((size, 2))
    while True:
        taken = _flood(
            heights, order, offsets, distances, basins, founders, parents, meetings, ridges, counts, taken
        )
        if taken == len(order):
            break
        founders, parents, meetings, ridges = (
            np.concatenate([each, np.empty_like(each)]) for each in (founders, parents, meetings, ridges)
        )
    n_basins, n_meetings = counts
    return founders[:n_basins].copy(), meetings[:n_meetings].copy(), ridges[:n_meetings].copy()


@kernel
def _flood(
    heights: NDArray[np.float32],
    order: IntArray,
    offsets: IntArray,
    distances: FloatArray,
    basins: NDArray[np.int32],
    founders: IntArray,
    parents: NDArray[np.int32],
    meetings: IntArray,
    ridges: FloatArray,
    counts: IntArray,
    taken: int,
) -> int:
    """Flood the voxels of `order` from number `taken` on, until a further basin has no place; the new number.

    Fills basins, peak voxels, pairs that meet, their ridges and `counts`, the numbers of basins and of pairs.
    Each meeting joins two trees of basins, so there are fewer of them than of basins.
    """
    n_basins, n_meetings = counts[0], counts[1]
    for place in range(taken, len(order)):
        voxel = order[place]
        height = heights[voxel]
        best, steepest = -1, -1.0
        for step in range(len(offsets)):
            there = basins[voxel + offsets[step]]
            if there > 0:
                slope = (heights[voxel + offsets[step]] - height) / distances[step]
                if slope > steepest:
                    best, steepest = there - 1, slope
        if best < 0:
            if n_basins == len(founders):
                counts[0], counts[1] = n_basins, n_meetings
                return place
            founders[n_basins] = voxel
            parents[n_basins] = n_basins
            n_basins += 1
            basins[voxel] = n_basins
            continue
        basins[voxel] = best + 1
        mine = _root(parents, best)
        for step in range(len(offsets)):
            there = basins[voxel + offsets[step]]
            if there == 0 or there == best + 1:
                continue
            theirs = _root(parents, there - 1)
            if theirs == mine:
                continue
            meetings[n_meetings, 0], meetings[n_meetings, 1] = best, there - 1
            if heights[founders[theirs]] > heights[founders[mine]]:
                mine, theirs = theirs, mine
            parents[theirs] = mine
            ridges[n_meetings, 0] = heights[founders[theirs]]
            ridges[n_meetings, 1] = height
            n_meetings += 1
    counts[0], counts[1] = n_basins, n_meetings
    return len(order)


OpenEnds = tuple[tuple[bool, bool], ...]
"""For each axis, whether a mask goes on beyond the array at its low and its high end."""
_CLOSED: OpenEnds = ((False, False),) * 3
_ATTEMPTS = 3
_expand_labels: Any = segmentation.expand_labels


def joined(flooded: WatershedBasins, settings: SplittingSettings) -> IntArray:
    """Grain of each basin, 1 to the number of grains; entry 0 is 0, shape (n + 1,)."""
    bump = np.maximum(settings.h_maxima, settings.relative * flooded.summits)
    joins = (flooded.summits - flooded.passes <= bump) | (not settings.enabled)
    first, second = flooded.pairs[joins].T
    shape = (len(flooded.peaks), len(flooded.peaks))
    links = sparse.coo_array((np.ones(len(first), dtype=np.int8), (first, second)), shape=shape)
    _, grains = csgraph.connected_components(links, directed=False)
    return np.concatenate([[0], np.asarray(grains, dtype=np.int64) + 1])


def distance_map(
    mask: NDArray[np.bool_], edges: FloatArray, continued: OpenEnds = _CLOSED
) -> NDArray[np.float32]:
    """Distance of each voxel of the mask to the nearest one outside, in mean voxel edges.

    - ``edges``: of a voxel along x, y and z, in any unit, shape (3,).
    - ``continued``: where the mask may go on beyond the array, as at the border of a scan, the array's end
      is no surface; elsewhere what is beyond counts as empty.
    """
    rim = tuple((int(not low), int(not high)) for low, high in continued)
    padded = np.pad(mask, rim)
    distance: Any = ndimage.distance_transform_edt(padded, sampling=in_mean_edges(edges))
    inner = tuple(slice(low, n - high) for (low, high), n in zip(rim, padded.shape, strict=True))
    return np.ascontiguousarray(distance[inner], dtype=np.float32)


def split(
    mask: NDArray[np.bool_], edges: FloatArray, settings: SplittingSettings, continued: OpenEnds = _CLOSED
) -> tuple[IntArray, IntArray]:
    """Grain of each voxel of a mask, 1 to n, 0 outside; and the voxel of each grain's peak, shape (n, 3)."""
    flooded = find_basins(distance_map(mask, edges, continued), in_mean_edges(edges))
    grain_of_basin = joined(flooded, settings)
    _, highest = np.unique(grain_of_basin[1:], return_index=True)
    return grain_of_basin[flooded.basins], flooded.sites[highest]


def in_mean_edges(edges: FloatArray) -> FloatArray:
    """Voxel edges divided by their geometric mean."""
    return np.asarray(edges / np.prod(edges) ** (1 / 3), dtype=np.float64)


@dataclass(frozen=True, eq=False)
class Tile:
    """A body, or a tile of one with its margin, in an array of bodies: all that its grains follow from.

    - ``numbers``: body of each voxel of the volume.
    - ``body``: its number.
    - ``box``, ``core``: box of the body, and of the tile: grains whose peak lies there are the tile's own.
    - ``margin``: looked at around the tile, within the body's box.
    """

    numbers: SharedArray
    body: int
    box: Box
    core: Box
    margin: int = 0

    @property
    def outer(self) -> Box:
        """The tile with its margin."""
        return grown(self.core, self.margin, self.box)

    @property
    def is_whole(self) -> bool:
        """Whether the body is not cut into tiles."""
        return self.core == self.box

    def region(self) -> NDArray[Any]:
        """Bodies in the tile and its margin."""
        return np.asarray(self.numbers.array[self.outer])

    def continued(self) -> OpenEnds:
        """Ends at which grains may go on: the border of the scan, and where a tile cuts the body."""
        x, y, z = (
            (side.start == 0 or cut_low, side.stop == n or cut_high)
            for side, n, (cut_low, cut_high) in zip(
                self.outer, self.numbers.shape, _ends(self.outer, self.box), strict=True
            )
        )
        return x, y, z


@dataclass(frozen=True, eq=False)
class TileGrains:
    """The grains that a tile has found.

    ``box``: where they lie in the volume. ``grains``: 1 to n, and 0 elsewhere, shape of the box, in the
    smallest type that holds n.
    """

    box: Box
    grains: NDArray[np.unsignedinteger[Any]]


def pores_of_tile(tile: Tile) -> IntArray:
    """Voxels of pores of the tile's body, along x, y and z of the volume, shape (n, 3)."""
    region = tile.region()
    pores = _with_pores(region, tile.body) & (region == 0)
    return np.asarray(np.argwhere(pores) + [side.start for side in tile.outer])


def grains_of_tile(
    tile: Tile, edges: FloatArray, settings: SplittingSettings, fill_pores: bool, final: bool
) -> TileGrains | None:
    """A tile's own grains, or ``None`` if one of them is cut by its ends.

    - ``edges``, ``settings``: as in :func:`split`.
    - ``fill_pores``: whether pores of a whole body become part of it; those of tiles are filled before.
    - ``final``: whether grains that are cut are taken as they are.
    """
    region, outer = tile.region(), tile.outer
    if fill_pores and tile.is_whole:
        mask = _with_pores(region, tile.body) & ((region == 0) | (region == tile.body))
    else:
        mask = np.ascontiguousarray(region == tile.body)
    grains, sites = split(mask, edges, settings, tile.continued())
    own = _inside(sites, within(tile.core, outer))
    if not final and own[_touching(grains, _ends(outer, tile.box)) - 1].any():
        return None
    n_own = int(np.count_nonzero(own))
    number = np.zeros(len(own) + 1, dtype=np.min_scalar_type(n_own))
    number[1:][own] = 1 + np.arange(n_own)
    return _cropped(number[grains], outer)


def _with_pores(region: NDArray[Any], body: int) -> BoolArray:
    return pores_filled(np.ascontiguousarray(region == body))


def _cropped(grains: NDArray[Any], outer: Box) -> TileGrains:
    """Without the empty margins of the box."""
    low, high = [], []
    for axis, side in enumerate(outer):
        other = tuple(each for each in range(3) if each != axis)
        filled = np.flatnonzero(grains.any(axis=other))
        low.append(side.start + (int(filled[0]) if len(filled) else 0))
        high.append(side.start + (int(filled[-1]) + 1 if len(filled) else 0))
    box = box_between(low, high)
    return TileGrains(box, np.ascontiguousarray(grains[within(box, outer)]))


class GrainSplitter:
    """Parts bodies into grains.

    Pores are filled first and grains are written to an array of their own, so that no tile depends on what
    another has found, and tiles can be parted by several processes.

    - ``numbers``: body of each voxel, shape (nx, ny, nz), int32; pores of bodies that are cut into tiles are
      filled.
    - ``labels``: zeros of the same shape; a voxel of grain k becomes -k.
    - ``bodies``: what the numbers stand for.
    - ``edges``: of a voxel, shape (3,).
    - ``settings``: how touching grains are parted.
    - ``fill_pores``: whether pores inside a body become part of it.
    """

    def __init__(
        self,
        numbers: SharedArray,
        labels: NDArray[np.int32],
        bodies: ConnectedComponents,
        edges: FloatArray,
        settings: SplittingSettings,
        fill_pores: bool = True,
        tiles: TileSettings | None = None,
    ) -> None:
        self._numbers, self._labels = numbers, labels
        self._bodies, self._edges = bodies, edges
        self._settings, self._fill = settings, fill_pores
        self._tiles = tiles or TileSettings()
        self._sizes: list[IntArray] = []
        self.n_grains = 0

    @property
    def sizes(self) -> IntArray:
        """Voxels of each grain, shape (n_grains,)."""
        return np.concatenate([np.zeros(0, dtype=np.int64), *self._sizes])

    def steps(self, min_voxels: int = 0, run: ParallelMap = map) -> Iterator[tuple[int, int]]:
        """Part all bodies of at least `min_voxels`; yields pieces done and pieces in all after each.

        ``run``: applies :func:`pores_of_tile` and :func:`grains_of_tile` to tiles.
        """
        bodies = (np.flatnonzero(self._bodies.sizes >= min_voxels) + 1).tolist()
        left = [tile for body in bodies for tile in self._tiles_of(body)]
        cut = [tile for tile in left if not tile.is_whole]
        total, done = len(left), 0
        if self._fill:
            for _ in self._fill_pores(cut, run):
                yield 0, total
        for attempt in range(_ATTEMPTS):
            margin = self._tiles.margin * 2**attempt
            trying, left = [replace(tile, margin=margin) for tile in left], []
            part = partial(
                grains_of_tile,
                edges=self._edges,
                settings=self._settings,
                fill_pores=self._fill,
                final=attempt == _ATTEMPTS - 1,
            )
            for tile, grains in zip(trying, in_batches(run, part, trying, _n_looked_at), strict=True):
                if grains is None:
                    left.append(tile)
                    continue
                self._write(grains)
                done += 1
                yield done, total
        # After all tiles: what one leaves, the next may claim.
        for tile in cut:
            self._give_away_rest(tile)

    def _tiles_of(self, body: int) -> list[Tile]:
        """The whole body, or tiles that hold some of it."""
        box, step = self._bodies.box(body), self._tiles.core
        if n_voxels(box) <= self._tiles.largest or not self._settings.enabled:
            return [Tile(self._numbers, body, box, box)]
        corners = product(*(range(side.start, side.stop, step) for side in box))
        high = [side.stop for side in box]
        cores = (box_between(low, np.minimum(np.add(low, step), high).tolist()) for low in corners)
        tiles = (Tile(self._numbers, body, box, core) for core in cores)
        return [tile for tile in tiles if (tile.region() == body).any()]

    def _fill_pores(self, cut: list[Tile], run: ParallelMap) -> Iterator[None]:
        """Give pores to their body.

        A pore is enclosed by its body whatever else is filled already, so that the order does not count.
        """
        looked = [replace(tile, margin=self._tiles.margin) for tile in cut]
        for tile, pores in zip(cut, in_batches(run, pores_of_tile, looked, _n_looked_at), strict=True):
            place = tuple(pores.T)
            numbers = self._numbers.array
            free = numbers[place] == 0
            numbers[tuple(axis[free] for axis in place)] = tile.body
            yield
        self._numbers.publish()

    def _write(self, grains: TileGrains) -> None:
        """Label the voxels of a tile's grains that no earlier tile has taken."""
        count = int(grains.grains.max(initial=0))
        region = self._labels[grains.box]
        free = (grains.grains > 0) & (region == 0)
        taken = grains.grains[free].astype(np.int32)
        region[free] = -(taken + self.n_grains)
        self._sizes.append(np.bincount(taken, minlength=count + 1)[1:])
        self.n_grains += count

    def _give_away_rest(self, tile: Tile) -> None:
        """Voxels that no tile claimed go to the body's nearest grain."""
        wider = replace(tile, margin=1)
        region, own = self._labels[wider.outer], wider.region() == tile.body
        rest = own & (region == 0)
        if not rest.any():
            return
        nearest = _expand_labels(np.where(own, -region, 0), distance=float(self._tiles.core))[rest]
        region[rest] = -nearest
        given = np.bincount(nearest, minlength=self.n_grains + 1)[1:]
        self._sizes = [self.sizes + given]


def _n_looked_at(tile: Tile) -> int:
    return n_voxels(tile.outer)


def _ends(outer: Box, box: Box) -> OpenEnds:
    """For each axis whether `outer` ends before `box` does, at its low and its high end."""
    x, y, z = ((a.start > b.start, a.stop < b.stop) for a, b in zip(outer, box, strict=True))
    return x, y, z


def _inside(sites: IntArray, box: Box) -> BoolArray:
    low, high = [side.start for side in box], [side.stop for side in box]
    return np.asarray(((sites >= low) & (sites < high)).all(axis=1))


def _touching(grains: IntArray, ends: OpenEnds) -> IntArray:
    """Grains that touch the marked ends of their array."""
    faces = [
        np.moveaxis(grains, axis, 0)[end].ravel()
        for axis, marks in enumerate(ends)
        for end, marked in zip((0, -1), marks, strict=True)
        if marked
    ]
    numbers = np.unique(np.concatenate(faces)) if faces else np.empty(0, dtype=np.int64)
    return np.asarray(numbers[numbers > 0])
