"""Particles drawn from a dataset and placed on a lattice without contacts, for lists of particles."""

from dataclasses import dataclass

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import ExportOptions
from regolith_studio.dataset.lifting_cylinder import MICROMETRE, scaled_cylinder
from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dataset.sampling import DrawnParticles, rotation_matrices, sample_dataset
from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray

MIN_WIDTH = 3.0
"""Minimum diameter of the cylinder in units of the lattice spacing."""

SPACING = 1.02
"""Lattice spacing in units of the maximum circumscribed diameter."""


@dataclass(frozen=True, eq=False)
class PackedParticles:
    """Particles in SI units after coarse graining, without contacts.

    Parameters
    ----------
    class_index
        Which representative, shape (n,).
    diameter
        Equivalent diameter in metres, shape (n,).
    position
        Of the centroids in metres, z up from 0, shape (n, 3).
    orientation
        Quaternions (w, x, y, z), shape (n, 4).
    """

    class_index: IntArray
    diameter: FloatArray
    position: FloatArray
    orientation: FloatArray

    def __len__(self) -> int:
        return len(self.diameter)

    @property
    def scale(self) -> FloatArray:
        """Factor from the unit-volume shape to metres, shape (n,)."""
        return np.asarray(self.diameter * (np.pi / 6) ** (1 / 3))

    def rotation_of(self, index: int) -> FloatArray:
        """Matrix from the shape's to the global axes, shape (3, 3)."""
        return np.asarray(rotation_matrices(self.orientation[index : index + 1])[0])


def pack_on_lattice(dataset: Dataset, options: ExportOptions, within: float | None = None) -> PackedParticles:
    """Draw ``options.n_particles`` and place them on a cubic lattice.

    Parameters
    ----------
    within
        Inner diameter in metres of an upright cylinder about the z axis that contains all; a square column
        if not given.

    Raises
    ------
    InputError
        If a particle is too large for the cylinder.
    """
    drawn, spacing = _drawn(dataset, options)
    metres = options.coarse_graining_factor * MICROMETRE
    layer = _layer(spacing, within, len(drawn.diameter))
    place = np.arange(len(drawn.diameter))
    height = spacing * (0.5 + place // len(layer))
    return PackedParticles(
        class_index=drawn.class_index,
        diameter=drawn.diameter * metres,
        position=np.column_stack([layer[place % len(layer)], height]),
        orientation=drawn.orientation,
    )


def fitted_cylinder(dataset: Dataset, options: ExportOptions) -> LiftingCylinderTest:
    """The cylinder of the options, smaller if ``options.n_particles`` do not fill it."""
    drawn, spacing = _drawn(dataset, options)
    volume = float(((drawn.scale * options.coarse_graining_factor * MICROMETRE) ** 3).sum())
    return scaled_cylinder(options.test, volume, MIN_WIDTH * spacing)


def _drawn(dataset: Dataset, options: ExportOptions) -> tuple[DrawnParticles, float]:
    """The particles, and the spacing in metres at which none can touch another in any orientation."""
    drawn = sample_dataset(dataset, options.n_particles, options.seed)
    reach = np.array([np.linalg.norm(one.shape.vertices, axis=1).max() for one in dataset.representatives])
    largest = float((reach[drawn.class_index] * drawn.scale).max())
    return drawn, SPACING * 2 * largest * options.coarse_graining_factor * MICROMETRE


def _layer(spacing: float, within: float | None, count: int) -> FloatArray:
    """Positions of one layer about the axis, shape (k, 2), the same for every layer."""
    if within is None:
        side = max(1, round(count ** (1 / 3)))
        line = (np.arange(side) - (side - 1) / 2) * spacing
        return np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)
    free = (within - spacing) / 2
    if free < 0.0:
        raise InputError(
            f"A particle of {spacing * 1e3:.3g} mm does not fit into a cylinder of {within * 1e3:.3g} mm."
        )
    reach = int(free / spacing + 1e-9)
    steps = np.arange(-reach, reach + 1) * spacing
    grid = np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)
    return np.asarray(grid[np.linalg.norm(grid, axis=1) <= free * (1 + 1e-9)])
