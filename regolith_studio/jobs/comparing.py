"""Descriptors of measured and of drawn particles, side by side for a plot of their distributions."""

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from regolith_studio.descriptors.distributions import Distribution
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.shape_models.draws import Draws
from regolith_studio.shape_models.sample import Sample
from regolith_studio.studies.population import KEYS
from regolith_studio.studies.population_work import STEP, descriptors_of

MOST = 1000
"""Particles of either kind that are measured at most."""


@dataclass(frozen=True, eq=False)
class Compared:
    """Descriptors of both kinds.

    Parameters
    ----------
    keys
        Of the columns.
    measured, drawn
        Shape (n, keys), without particles that bound no solid; `measured` is empty where the source of a
        model holds no particles.
    """

    keys: tuple[str, ...]
    measured: FloatArray
    drawn: FloatArray

    def distributions(self, key: str, weighting: str = "number") -> tuple[Distribution | None, Distribution]:
        """One descriptor of the measured, if there are any, and of the drawn particles.

        Parameters
        ----------
        weighting
            ``number``, or ``volume``: each particle counts by its volume.
        """
        drawn = self._distribution(self.drawn, key, weighting)
        return (self._distribution(self.measured, key, weighting) if len(self.measured) else None), drawn

    def _distribution(self, table: FloatArray, key: str, weighting: str) -> Distribution:
        sizes = table[:, self.keys.index("equivalent_radius")]
        weights = sizes**3 if weighting == "volume" else np.ones(len(table))
        return Distribution(table[:, self.keys.index(key)], weights)


def compare_distributions(sample: Sample | None, draws: Draws) -> Steps:
    """Measure both at the degree of the draws; returns :class:`Compared`. A job."""
    kinds = [draws.chosen(range(min(len(draws), MOST)))]
    if sample is not None:
        rows = sample.truncated(min(draws.l_max, sample.l_max)).coefficients[:MOST]
        kinds.append(Draws(rows, "radius", "measured", draws.seed, sample.unit))
    total = sum(len(each) for each in kinds)
    yield Started("Comparing distributions", total)
    tables, done = [], 0
    for each in kinds:
        tables.append((yield from _measured(each, done, total)))
        done += len(each)
    drawn, measured = tables[0], tables[1] if len(tables) > 1 else np.empty((0, len(KEYS)))
    return Compared(KEYS, measured, drawn)


def _measured(draws: Draws, done: int, total: int) -> Generator[Progress, None, FloatArray]:
    tables = []
    for first in range(0, len(draws), STEP):
        last = min(first + STEP, len(draws))
        tables.append(descriptors_of(draws.chosen(range(first, last)), KEYS))
        yield Progress(done + last, total)
    table = np.concatenate(tables)
    return table[np.isfinite(table).all(axis=1)]
