"""Initial state: a column of particles in the cylinder with random orientations, none touching another."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.geometry.arrays import FloatArray, IntArray

# The column of 500 particles is 21.6 d high: 25.6 with cells of twice the side, 19.3 with half of it, which
# takes four times as long.
CELL = 0.06
"""Side of a cell of the height map in mean diameters."""
# Four times as many lower the column by a seventh and take twice as long; a quarter raises it by a fifth.
TRIALS = 24
"""Random candidate positions for a particle."""
STEEP = 1e-9
"""Vertical component of the unit normal below which a facet bounds a particle sideways only."""


@dataclass(frozen=True, eq=False)
class Footprint:
    """What a particle covers of the height map: cells about its centre, and its underside and top there.

    ``cells``: indices relative to the cell of the centre, shape (m, 2). ``lower``, ``upper``: heights
    relative to the centre in metres, below and above all of the particle in a cell, shape (m,).
    """

    cells: IntArray
    lower: FloatArray
    upper: FloatArray


def loose_column(prepared: PreparedCase) -> ParticleState:
    """Initial state of a simulation; equal cases give equal states.

    Each particle is lowered vertically with a random orientation until something lies below it, at the lowest
    of a few random positions. What lies there is kept as a height map of the cylinder's cross-section, where
    particles are wider by half the diagonal of a cell; so no two overlap.
    """
    generator = _generator(prepared, 0)
    turns = Rotation.random(len(prepared), random_state=_generator(prepared, 1))
    matrices, radius = turns.as_matrix(), prepared.case.test.diameter / 2
    cell = CELL * prepared.mean_diameter
    # The border of a footprint reaches two cells beyond the particle, and its centre is rounded to one.
    middle = int(np.ceil((radius + enclosing_radii(prepared).max()) / cell)) + 3
    surface = np.zeros((2 * middle + 1, 2 * middle + 1))
    planes = facet_planes(prepared)
    places = np.empty((len(prepared), 3))
    for k, (kind, matrix) in enumerate(zip(prepared.class_index, matrices, strict=True)):
        # Otherwise all centres would lie on the grid of the height map.
        shift = generator.uniform(-0.5, 0.5, 2)
        if planes:
            footprint = _footprint(
                planes[kind], prepared.shapes[kind], matrix, prepared.scales[k], shift, cell
            )
        else:
            footprint = _footprint_of_sphere(prepared.diameters[k] / 2, shift, cell)
        room = max(radius / cell - 1.0 - np.linalg.norm(footprint.cells, axis=1).max(), 0.0)
        away, angle = room * np.sqrt(generator.random(TRIALS)), generator.uniform(0.0, 2 * np.pi, TRIALS)
        centres = np.rint(away[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])).astype(np.int64)
        rows, columns = np.moveaxis(centres[:, None, :] + footprint.cells + middle, 2, 0)
        heights = (surface[rows, columns] - footprint.lower).max(axis=1)
        best = int(heights.argmin())
        surface[rows[best], columns[best]] = heights[best] + footprint.upper
        places[k] = *((centres[best] + shift) * cell), heights[best]
    orientations = turns.as_quat(scalar_first=True)
    return ParticleState(places, prepared.diameters, orientations, prepared.class_index, 0.0, 0.0, "fill")


def no_particles() -> ParticleState:
    """The empty cylinder before it is filled."""
    none = np.empty((0, 3))
    return ParticleState(none, none[:, 0], np.empty((0, 4)), np.empty(0, dtype=np.int64), 0.0, 0.0, "fill")


def enclosing_radii(prepared: PreparedCase) -> FloatArray:
    """Radius of each particle's circumscribed sphere about its centre in metres, shape (n,)."""
    if prepared.case.shapes == "spheres":
        return np.asarray(prepared.diameters / 2)
    furthest = np.array([np.linalg.norm(shape, axis=1).max() for shape in prepared.shapes])
    return np.asarray(furthest[prepared.class_index] * prepared.scales)


def facet_planes(prepared: PreparedCase) -> list[list[FloatArray]]:
    """Planes (normal, offset) of the facets of each convex part of each shape; none of spheres."""
    if prepared.case.shapes == "spheres":
        return []
    return [[ConvexHull(part).equations for part in parts] for parts in prepared.part_vertices]


def _footprint(
    parts: list[FloatArray],
    vertices: FloatArray,
    turn: FloatArray,
    scale: float,
    shift: FloatArray,
    cell: float,
) -> Footprint:
    """Of a particle whose centre lies `shift` cells off the centre of a cell."""
    reach = int(np.ceil(scale * np.abs(vertices @ turn[:2].T).max() / cell)) + 2
    cells = _square(reach)
    x, y = ((cells - shift) * cell).T
    lower, upper = np.full(len(cells), np.inf), np.full(len(cells), -np.inf)
    for equations in parts:
        normals = equations[:, :3] @ turn.T
        offsets = -scale * equations[:, 3] + cell / np.sqrt(2) * np.hypot(normals[:, 0], normals[:, 1])
        beyond = normals[:, :1] * x + normals[:, 1:2] * y - offsets[:, None]
        down, up = normals[:, 2] < -STEEP, normals[:, 2] > STEEP
        low = (beyond[down] / -normals[down, 2:]).max(axis=0)
        high = (beyond[up] / -normals[up, 2:]).min(axis=0)
        covered = (low <= high) & (beyond[~(down | up)] <= 0.0).all(axis=0)
        lower[covered] = np.minimum(lower, low)[covered]
        upper[covered] = np.maximum(upper, high)[covered]
    covered = lower <= upper
    return Footprint(cells[covered], lower[covered], upper[covered])


def _footprint_of_sphere(radius: float, shift: FloatArray, cell: float) -> Footprint:
    """Of a sphere whose centre lies `shift` cells off the centre of a cell."""
    cells = _square(int(np.ceil(radius / cell)) + 2)
    away = np.maximum(cell * (np.linalg.norm(cells - shift, axis=1) - np.sqrt(0.5)), 0.0)
    covered = away < radius
    half = np.sqrt(radius**2 - away[covered] ** 2)
    return Footprint(cells[covered], -half, half)


def _square(reach: int) -> IntArray:
    """Indices of the cells of a square about a cell, shape (m, 2)."""
    side = np.arange(-reach, reach + 1)
    return np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)


def _generator(prepared: PreparedCase, stream: int) -> np.random.Generator:
    return np.random.default_rng(np.random.SeedSequence(prepared.case.seed, spawn_key=(2, stream)))
