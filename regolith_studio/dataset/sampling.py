"""Draw particles from a dataset (class by weight, size, orientation), and place them without contacts."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import MICROMETRE, ExportOptions
from regolith_studio.dataset.lifting_cylinder import scaled_cylinder
from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.io.tables import csv_bytes

COLUMNS = ("class", "name", "diameter_um", "scale_um", "qw", "qx", "qy", "qz")
"""Of the table of drawn particles; `scale_um` is the factor from the unit-volume shape."""
BLOCK = 100_000
"""Particles whose rows are in memory at a time."""


@dataclass(frozen=True, eq=False)
class DrawnParticles:
    """Particles drawn from a dataset.

    - ``class_index``: which representative, shape (n,).
    - ``diameter``: equivalent diameter in micrometres, shape (n,).
    - ``orientation``: unit quaternions (w, x, y, z) from the shape's to the particle's axes, uniformly
      distributed, shape (n, 4).
    """

    class_index: IntArray
    diameter: FloatArray
    orientation: FloatArray

    @property
    def scale(self) -> FloatArray:
        """Factor from the unit-volume shape to the particle, in micrometres, shape (n,)."""
        return np.asarray(self.diameter * (np.pi / 6) ** (1 / 3))


def sample_dataset(dataset: Dataset, n: int, seed: int) -> DrawnParticles:
    """`n` independent particles, drawn by number whatever the weighting of the dataset.

    Raises InputError if `n` is negative.
    """
    if n < 0:
        raise InputError(f"The number of particles must not be negative, got {n}.")
    generator = np.random.default_rng(np.random.SeedSequence(seed))
    chosen = generator.choice(len(dataset), size=n, p=dataset.class_weights("number"))
    shares = generator.random(n)
    diameters = np.empty(n)
    for index, representative in enumerate(dataset.representatives):
        mine = chosen == index
        diameters[mine] = representative.sizes.weighted("number").quantile(shares[mine])
    orientation = random_quaternions(n, np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(1,))))
    return DrawnParticles(chosen.astype(np.int64), diameters, orientation)


def random_quaternions(n: int, generator: np.random.Generator) -> FloatArray:
    """Uniform random rotations: normalised Gaussian vectors in four dimensions with w >= 0, shape (n, 4)."""
    values = generator.standard_normal((n, 4))
    values /= np.linalg.norm(values, axis=1, keepdims=True)
    return np.asarray(values * np.where(values[:, :1] < 0.0, -1.0, 1.0))


def rotation_matrices(quaternions: FloatArray) -> FloatArray:
    """Rotation matrices of unit quaternions (w, x, y, z), shape (n, 3, 3); columns are the rotated axes."""
    return np.asarray(Rotation.from_quat(quaternions[:, [1, 2, 3, 0]]).as_matrix())


def drawn_rows(dataset: Dataset, drawn: DrawnParticles) -> list[dict[str, object]]:
    """One record a particle: class, name, diameter and scale in micrometres, quaternion."""
    table = np.column_stack([drawn.diameter, drawn.scale, drawn.orientation]).tolist()
    return [
        dict(zip(COLUMNS, (which, dataset.representatives[which].name, *row), strict=True))
        for which, row in zip(drawn.class_index.tolist(), table, strict=True)
    ]


def drawn_csv(dataset: Dataset, drawn: DrawnParticles) -> Iterator[bytes]:
    """The same as comma-separated values, in blocks of :data:`BLOCK` particles."""
    yield csv_bytes([COLUMNS])
    for first in range(0, len(drawn.diameter), BLOCK):
        block = slice(first, first + BLOCK)
        part = DrawnParticles(drawn.class_index[block], drawn.diameter[block], drawn.orientation[block])
        yield csv_bytes(tuple(row.values()) for row in drawn_rows(dataset, part))


MIN_WIDTH = 3.0
"""Minimum diameter of the cylinder in units of the lattice spacing."""

SPACING = 1.02
"""Lattice spacing in units of the maximum circumscribed diameter."""


@dataclass(frozen=True, eq=False)
class PackedParticles:
    """Particles in SI units after coarse graining, without contacts.

    - ``class_index``: which representative, shape (n,).
    - ``diameter``: equivalent diameter in metres, shape (n,).
    - ``position``: of the centroids in metres, z up from 0, shape (n, 3).
    - ``orientation``: quaternions (w, x, y, z), shape (n, 4).
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

    ``within``: inner diameter in metres of an upright cylinder about the z axis that contains all; a square
    column if not given.

    Raises InputError if a particle is too large for the cylinder.
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
    # 1e-9: by rounding, a cylinder of exactly three spacings held one particle a layer and made a tower of 66
    # cm.
    reach = int(free / spacing + 1e-9)
    steps = np.arange(-reach, reach + 1) * spacing
    grid = np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)
    return np.asarray(grid[np.linalg.norm(grid, axis=1) <= free * (1 + 1e-9)])
