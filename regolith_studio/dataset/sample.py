"""Draws particles from a dataset, as section 2.5 says: a class by its weight, then a size."""

from dataclasses import dataclass

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class DrawnParticles:
    """Particles drawn from a dataset.

    Parameters
    ----------
    class_index
        Which representative, shape (n,).
    diameter
        Equivalent diameter in micrometres, shape (n,).
    """

    class_index: IntArray
    diameter: FloatArray

    @property
    def scale(self) -> FloatArray:
        """Factor from the unit-volume shape to the particle, in micrometres, shape (n,)."""
        return np.asarray(self.diameter * (np.pi / 6) ** (1 / 3))


def sample_dataset(dataset: Dataset, n: int, seed: int) -> DrawnParticles:
    """`n` independent particles, counted one by one whatever the dataset's weights count.

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
    return DrawnParticles(chosen.astype(np.int64), diameters)
