"""Samples that the benchmarks of populations share, and their descriptors."""

import sys
from functools import partial
from multiprocessing import Pool

import numpy as np
from numpy.typing import NDArray

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.harmonics.coefficients import degrees, orders
from regolith_studio.harmonics.io import from_complex_rows
from regolith_studio.readers.shape_files import read_shape_source
from regolith_studio.shape_models.materials import materials
from regolith_studio.shape_models.realizations import Realizations
from regolith_studio.shape_models.sample import Sample
from regolith_studio.studies.population import MESH_LEVEL, descriptors_of

ComplexArray = NDArray[np.complex128]
CARD, CARD_DEGREE, CARD_PARTICLES = "ma165", 20, 2000


def sample_from(path: str = "") -> Sample:
    """The sample of a fit, or of tables of complex coefficients (``anm`` in an NPZ file); without a path
    2,000 draws from a shipped card, with degrees up to 20."""
    if path.endswith(".npz"):
        with np.load(path) as tables:
            return Sample(np.stack([_real(row) for row in tables["anm"]]))
    if path:
        content = read_shape_source(path).content
        if not isinstance(content, Sample):
            sys.exit(f"{path} is no fit of measured particles.")
        return content
    draws = materials()[CARD].model(CARD_DEGREE).draw(CARD_PARTICLES, 0)
    return Sample(np.stack([draws.particle(i).values for i in range(len(draws))]))


def _real(row: ComplexArray) -> FloatArray:
    numbers = np.column_stack([degrees(len(row)), orders(len(row)), row.real, row.imag])
    return from_complex_rows(numbers).values


def realized(sample: Sample) -> Realizations:
    """The particles of a sample as if they were drawn."""
    return Realizations(sample.coefficients, "radius", "measured", 0, sample.unit)


def measured(draws: Realizations, keys: tuple[str, ...], level: int = MESH_LEVEL) -> FloatArray:
    """Descriptors of all particles, by all cores, shape (n, keys)."""
    parts = [draws.chosen(range(i, min(i + 25, len(draws)))) for i in range(0, len(draws), 25)]
    with Pool() as pool:
        return np.concatenate(pool.map(partial(descriptors_of, keys=keys, level=level), parts))
