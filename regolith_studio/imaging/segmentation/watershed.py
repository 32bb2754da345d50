"""Watershed of a height map in one pass, with the persistence of every basin.

Voxels are taken from the highest to the lowest. One without a neighbour that was taken before is a
peak and founds a basin; any other joins the neighbour to which the way is steepest. Where two
basins meet for the first time, the pass between them is as high as that voxel, and the lower of the
two highest peaks behind it stands out by ``peak - pass``: its persistence, or dynamics (Grimaud 1992).
Joining every pair of basins whose persistence is at most h gives the watershed of the h-maxima
(Soille 2003, section 6.3.5), for any h, without flooding again.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.kernels import kernel

_STEPS = np.array(
    [(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if (x, y, z) != (0, 0, 0)],
    dtype=np.int64,
)


@dataclass(frozen=True, eq=False)
class WatershedBasins:
    """The basins of a height map, and how they meet.

    Parameters
    ----------
    basins
        1 to n where heights are positive, in the order of falling peaks, else 0; shape (nx, ny, nz).
    sites
        Voxel of each basin's peak, shape (n, 3).
    peaks
        Height of each basin's peak, shape (n,).
    pairs
        Basins that meet, from 0, shape (m, 2).
    summits, passes
        For each meeting the lower of the highest peaks on its two sides, and the pass, shape (m,).
    """

    basins: NDArray[np.int32]
    sites: IntArray
    peaks: FloatArray
    pairs: IntArray
    summits: FloatArray
    passes: FloatArray


def find_basins(heights: NDArray[np.float32], step_lengths: FloatArray) -> "WatershedBasins":
    """Basins of `heights`, and how they meet.

    Parameters
    ----------
    heights
        Shape (nx, ny, nz); 0 and less is dry land that belongs to no basin.
    step_lengths
        Distance of neighbouring voxels along x, y and z, shape (3,).
    """
    padded = np.pad(heights, 1)
    flat = padded.reshape(-1)
    wet = np.flatnonzero(flat > 0.0)
    order = wet[np.argsort(-flat[wet], kind="stable")]
    strides = np.array([padded.shape[1] * padded.shape[2], padded.shape[2], 1])
    offsets = np.ascontiguousarray(_STEPS @ strides)
    distances = np.sqrt(((_STEPS * step_lengths) ** 2).sum(axis=1))
    basins = np.zeros(flat.size, dtype=np.int32)
    founders, pairs, ridges = _flooded(flat, order, offsets, distances, basins)
    inner = np.ascontiguousarray(basins.reshape(padded.shape)[1:-1, 1:-1, 1:-1])
    sites = np.column_stack(np.unravel_index(founders, padded.shape)) - 1
    return WatershedBasins(inner, sites, flat[founders].astype(np.float64), pairs, ridges[:, 0], ridges[:, 1])


@kernel
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
