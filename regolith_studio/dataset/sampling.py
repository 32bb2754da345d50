"""Draw particles from a dataset: class by weight, size (section 2.5), and uniform orientation."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from regolith_studio.dataset.dataset import Dataset
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

    Parameters
    ----------
    class_index
        Which representative, shape (n,).
    diameter
        Equivalent diameter in micrometres, shape (n,).
    orientation
        Unit quaternions (w, x, y, z) from the shape's to the particle's axes, uniformly distributed,
        shape (n, 4).
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

    Raises
    ------
    InputError
        If `n` is negative.
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
