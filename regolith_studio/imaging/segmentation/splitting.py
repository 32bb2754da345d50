"""Touching grains parted: a watershed of the distance to the surface, one connected body at a time.

A grain is a hill of the distance map, a neck between two grains a pass. Rough grains have several
peaks; a peak that stands out from its pass by h or less is taken for roughness and joined to its
neighbour. h is the one control against over-segmentation (too small) and grains that stick
together (too large).
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage, sparse
from scipy.sparse import csgraph
from skimage import segmentation

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray
from regolith_studio.imaging.bounding_boxes import Box, box_between, grown, n_voxels, within
from regolith_studio.imaging.connected_components import ConnectedComponents, pores_filled
from regolith_studio.imaging.segmentation.watershed import WatershedBasins, find_basins
from regolith_studio.imaging.volume_slabs import ParallelMap

OpenEnds = tuple[tuple[bool, bool], ...]
"""For each axis, whether a mask goes on beyond the array at its low and its high end."""
_CLOSED: OpenEnds = ((False, False),) * 3
_ATTEMPTS = 3
_expand_labels: Any = segmentation.expand_labels


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


@dataclass(frozen=True, eq=False)
class Tile:
    """A body, or a tile of one with its margin: all that its grains follow from; picklable.

    Parameters
    ----------
    mask
        Voxels of the body, shape (nx, ny, nz).
    core
        Where the tile is in the mask: grains whose peak lies there are the tile's own.
    edges, settings, continued
        As in :func:`split`.
    ends
        Where the mask cuts the body.
    final
        Whether grains that are cut are taken as they are.
    """

    mask: BoolArray
    core: Box
    edges: FloatArray
    settings: SplittingSettings
    continued: OpenEnds
    ends: OpenEnds
    final: bool


def grains_of_tile(tile: Tile) -> NDArray[np.int32] | None:
    """A tile's own grains, 1 to n, and 0 elsewhere, shape of its mask; ``None`` if one is cut by its ends."""
    grains, sites = split(tile.mask, tile.edges, tile.settings, tile.continued)
    own = _inside(sites, tile.core)
    if not tile.final and own[_touching(grains, tile.ends) - 1].any():
        return None
    number = np.zeros(len(own) + 1, dtype=np.int32)
    number[1:][own] = 1 + np.arange(np.count_nonzero(own))
    return number[grains]


@dataclass(frozen=True)
class _Piece:
    """A core of a body, and the body's box."""

    body: int
    box: Box
    core: Box

    def outer(self, margin: int) -> Box:
        """The core with a margin within the body's box."""
        return grown(self.core, margin, self.box)


class GrainSplitter:
    """Parts bodies into grains, in place.

    Pores are filled first and grains written down last, so that no tile depends on what another has found,
    and tiles can be parted by several processes.

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
        bodies: ConnectedComponents,
        edges: FloatArray,
        settings: SplittingSettings,
        fill_pores: bool = True,
        tiles: TileSettings | None = None,
    ) -> None:
        self._numbers, self._bodies, self._edges = numbers, bodies, edges
        self._settings, self._fill = settings, fill_pores
        self._tiles = tiles or TileSettings()
        self._body_of_grain = np.zeros(1024, dtype=np.int64)
        self.n_grains = 0

    def steps(self, min_voxels: int = 0, run: ParallelMap = map) -> Iterator[tuple[int, int]]:
        """Part all bodies of at least `min_voxels`; yields pieces done and pieces in all after each.

        Parameters
        ----------
        run
            Applies :func:`grains_of_tile` to tiles.
        """
        wanted = (np.flatnonzero(self._bodies.sizes >= min_voxels) + 1).tolist()
        pieces = [piece for body in wanted for piece in self._pieces(body)]
        total, done = len(pieces), 0
        for piece in pieces if self._fill else ():
            self._fill_pores(piece)
            yield 0, total
        left = pieces
        for attempt in range(_ATTEMPTS):
            trying, left = left, []
            tiles = (self._tile(piece, attempt) for piece in trying)
            for piece, found in zip(trying, run(grains_of_tile, tiles), strict=True):
                if found is None:
                    left.append(piece)
                    continue
                self._write(piece, self._numbers[self._outer(piece, attempt)], found)
                done += 1
                yield done, total
        for piece in pieces:
            if piece.core != piece.box:
                self._give_away_rest(piece)

    def _pieces(self, body: int) -> list[_Piece]:
        """The whole body, or tiles that hold some of it."""
        box, step = self._bodies.box(body), self._tiles.core
        if n_voxels(box) <= self._tiles.largest or not self._settings.enabled:
            return [_Piece(body, box, box)]
        corners = product(*(range(side.start, side.stop, step) for side in box))
        high = [side.stop for side in box]
        cores = (box_between(low, np.minimum(np.add(low, step), high).tolist()) for low in corners)
        return [_Piece(body, box, core) for core in cores if self._is_body(self._numbers[core], body).any()]

    def _outer(self, piece: _Piece, attempt: int) -> Box:
        return piece.outer(self._tiles.margin * 2**attempt)

    def _fill_pores(self, piece: _Piece) -> None:
        """Give pores the number of a voxel of their body."""
        region = self._numbers[self._outer(piece, 0)]
        own = np.ascontiguousarray(self._is_body(region, piece.body))
        pores = pores_filled(own) & (region == 0)
        if pores.any():
            region[pores] = region[own][0]

    def _tile(self, piece: _Piece, attempt: int) -> Tile:
        outer = self._outer(piece, attempt)
        region = self._numbers[outer]
        mask = np.ascontiguousarray(self._is_body(region, piece.body) | self._is_grain_of(region, piece.body))
        return Tile(
            mask,
            within(piece.core, outer),
            self._edges,
            self._settings,
            self._continued(outer, piece.box),
            _ends(outer, piece.box),
            outer == piece.box or attempt == _ATTEMPTS - 1,
        )

    def _is_body(self, region: NDArray[np.int32], body: int) -> BoolArray:
        """Voxels of a body that belong to no grain yet."""
        return np.asarray(self._bodies.body_of[np.maximum(region, 0)] == body)

    def _is_grain_of(self, region: NDArray[np.int32], body: int) -> BoolArray:
        """Voxels of a body's grains."""
        return np.asarray(self._body_of_grain[np.maximum(-region, 0)] == body)

    def _continued(self, outer: Box, box: Box) -> OpenEnds:
        """Ends at which grains may go on: the border of the scan, and where a tile cuts the body."""
        x, y, z = (
            (side.start == 0 or cut_low, side.stop == n or cut_high)
            for side, n, (cut_low, cut_high) in zip(
                outer, self._numbers.shape, _ends(outer, box), strict=True
            )
        )
        return x, y, z

    def _write(self, piece: _Piece, region: NDArray[np.int32], grains: NDArray[np.int32]) -> None:
        count = int(grains.max(initial=0))
        stop = self.n_grains + count + 1
        if stop > len(self._body_of_grain):
            self._body_of_grain = np.concatenate([self._body_of_grain, np.zeros(stop, dtype=np.int64)])
        self._body_of_grain[self.n_grains + 1 : stop] = piece.body
        free = (grains > 0) & (region >= 0)
        region[free] = -(grains[free] + self.n_grains)
        self.n_grains += count

    def _give_away_rest(self, piece: _Piece) -> None:
        """Voxels that no tile claimed go to the body's nearest grain."""
        region = self._numbers[piece.outer(1)]
        rest = self._is_body(region, piece.body)
        if rest.any():
            grains = np.where(self._is_grain_of(region, piece.body), -region, 0)
            nearest = _expand_labels(grains, distance=float(self._tiles.core))
            region[rest] = -nearest[rest]


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
    found = np.unique(np.concatenate(faces)) if faces else np.empty(0, dtype=np.int64)
    return np.asarray(found[found > 0])
