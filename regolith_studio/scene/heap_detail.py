"""Less to draw of a large heap: particles that others hide, and coarse bodies while the view turns."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_erosion

from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.geometry.arrays import FloatArray

MAX_CELLS = 150
"""Of the grid from its middle, which lies on the ground; particles beyond are never hidden."""
MAX_HIDDEN_DIAMETER = 2.0
"""Of a particle that may be hidden, in mean diameters: a larger one reaches out of the layers above it."""


@dataclass(frozen=True)
class HiddenDepth:
    """How deep a particle is hidden.

    Parameters
    ----------
    cell
        Edge of the cells of a grid, in mean diameters.
    layers
        So many layers of cells that hold particles lie around the cell of a hidden particle.
    """

    cell: float
    layers: int


AT_REST = HiddenDepth(2.0, 2)
"""At most three pixels in ten thousand change."""
MOVING = HiddenDepth(2.0, 1)
"""Of a heap of 100,000 particles a fifth is left, and at most one pixel in eighty changes. Smaller cells of a
heap of particles of many sizes are often empty, and then hide nothing."""


def hidden_particles(pile: ParticleState, depth: HiddenDepth) -> NDArray[np.bool_]:
    """Whether others hide a particle from all sides; the ground hides what lies on it from below."""
    if not len(pile):
        return np.zeros(0, dtype=bool)
    mean = float(pile.diameters.mean())
    middle = np.array([*np.median(pile.points[:, :2], axis=0), 0.0])
    cells = np.floor((pile.points - middle) / (depth.cell * mean))
    inside = ((np.abs(cells) < MAX_CELLS) & (cells >= [-MAX_CELLS, -MAX_CELLS, 0])).all(axis=1)
    if not inside.any():
        return np.zeros(len(pile), dtype=bool)
    grid = cells[inside].astype(np.int64)
    grid[:, :2] -= grid[:, :2].min(axis=0)
    grid += depth.layers
    occupied = np.zeros(grid.max(axis=0) + 1 + depth.layers, dtype=bool)
    occupied[tuple(grid.T)] = True
    occupied[:, :, : depth.layers] = True
    core = binary_erosion(occupied, np.ones((3, 3, 3), dtype=bool), iterations=depth.layers)
    hidden = np.zeros(len(pile), dtype=bool)
    hidden[inside] = core[tuple(grid.T)]
    return hidden & (pile.diameters <= MAX_HIDDEN_DIAMETER * mean)


def without(pile: ParticleState, left_out: NDArray[np.bool_]) -> ParticleState:
    """The other particles."""
    kept = np.flatnonzero(~left_out)
    return ParticleState(
        pile.points[kept],
        pile.diameters[kept],
        pile.orientations[kept],
        pile.class_index[kept],
        pile.time,
        pile.wall,
        pile.phase,
    )


def octahedron_of(parts: Sequence[FloatArray]) -> FloatArray:
    """Corners of an octahedron of unit volume with the axes and proportions of a shape, shape (6, 3).

    Parameters
    ----------
    parts
        Vertices of the convex parts of the shape.
    """
    vertices = np.concatenate(list(parts))
    axes = np.linalg.svd(vertices - vertices.mean(axis=0), full_matrices=False)[2]
    along = vertices @ axes.T
    low, high = along.min(axis=0), along.max(axis=0)
    half = (high - low) / 2
    half *= (0.75 / half.prod()) ** (1 / 3)  # an octahedron has the volume 4/3 a b c
    return np.asarray(((low + high) / 2 + np.concatenate([np.diag(half), -np.diag(half)])) @ axes)
