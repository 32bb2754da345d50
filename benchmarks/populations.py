"""Samples that the benchmarks of populations share, and their descriptors."""

import sys
from functools import partial
from multiprocessing import Pool

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.readers.shape_files import read_shape_source
from regolith_studio.shape_models.materials import materials
from regolith_studio.shape_models.realizations import Realizations
from regolith_studio.shape_models.sample import Sample
from regolith_studio.studies.population import MESH_LEVEL, descriptors_of

CARD, CARD_DEGREE, CARD_PARTICLES = "ma165", 20, 2000


def sample_from(path: str = "") -> Sample:
    """The sample of a fit; without one 2,000 draws from a shipped card, with degrees up to 20."""
    if path:
        content = read_shape_source(path).content
        if not isinstance(content, Sample):
            sys.exit(f"{path} is no fit of measured particles.")
        return content
    draws = materials()[CARD].model(CARD_DEGREE).draw(CARD_PARTICLES, 0)
    return Sample(np.stack([draws.particle(i).values for i in range(len(draws))]))


def realized(sample: Sample) -> Realizations:
    """The particles of a sample as if they were drawn."""
    return Realizations(sample.coefficients, "radius", "measured", 0, sample.unit)


def measured(draws: Realizations, keys: tuple[str, ...], level: int = MESH_LEVEL) -> FloatArray:
    """Descriptors of all particles, by all cores, shape (n, keys)."""
    parts = [draws.chosen(range(i, min(i + 25, len(draws)))) for i in range(0, len(draws), 25)]
    with Pool() as pool:
        return np.concatenate(pool.map(partial(descriptors_of, keys=keys, level=level), parts))
