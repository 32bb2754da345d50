"""The work of a study of populations in parts that processes can share, and that a user can stop between."""

from collections.abc import Callable, Generator, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from regolith_studio.descriptors.describe import describe
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.shape_models.draws import Draws, virtual_mesh
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.principal_axes import canonical
from regolith_studio.shape_models.sample import Sample
from regolith_studio.studies.progress import StudyProgress

LEVEL = 3
"""Icosphere level of the meshes that are measured: 642 vertices, and the exact volume of the series."""
STEP = 25
"""Particles that one process measures at a time."""
FRAMES_STEP = 100
"""Particles that one process turns into the frame of their axes at a time."""

Mapper = Callable[[Callable[[Any], Any], Iterable[Any]], Iterable[Any]]
"""Anything that maps a picklable function in order: ``map``, or ``imap`` of a process pool. It may yield
``None`` while a result is waited for, so that the study can be stopped."""


@dataclass(frozen=True, eq=False)
class Fitting:
    """A model to be fitted and drawn from, a few times: what :func:`drawings` takes.

    Parameters
    ----------
    key
        Of ``MODELS``.
    options
        Settings of the model.
    sample
        Fitted to.
    n_draws
        Of each drawing.
    seeds
        Of the drawings.
    """

    key: str
    options: Any
    sample: Sample
    n_draws: int
    seeds: tuple[int, ...]


def drawings(order: Fitting) -> tuple[tuple[Draws, ...], tuple[float, ...]]:
    """Drawings from a fitted model, and Bayes' criterion of its parts if it has one."""
    fitted = MODELS[order.key].fit(order.sample, order.options)
    drawn = tuple(fitted.draw(order.n_draws, seed) for seed in order.seeds)
    return drawn, tuple(getattr(fitted, "bic", ()))


class Workshop:
    """Shares out the parts of a study, and remembers how many particles are measured, for its progress."""

    def __init__(self, keys: tuple[str, ...], level: int, mapper: Mapper, total: int) -> None:
        self.keys, self.level, self.mapper, self.total = keys, level, mapper, total
        self.done = 0
        self.size_column = keys.index("equivalent_radius") if "equivalent_radius" in keys else None

    def progress(self, message: str) -> StudyProgress:
        """How far the study is."""
        return StudyProgress(self.done, self.total, message)

    def measured(self, draws: Draws, message: str) -> Generator[StudyProgress, None, FloatArray]:
        """Descriptors of every particle, shape (n, keys); NaN where its series bounds no solid."""
        tables = [np.empty((0, len(self.keys)))]
        measure = partial(descriptors_of, keys=self.keys, level=self.level)
        for table in self.mapper(measure, _parts(draws, STEP)):
            if table is not None:
                tables.append(table)
                self.done += len(table)
            yield self.progress(message)
        return np.concatenate(tables)

    def framed(self, draws: Draws, l_max: int, message: str) -> Generator[StudyProgress, None, FloatArray]:
        """Every particle in the frame of its axes, shape (n, (l_max + 1)^2)."""
        rows = [np.empty((0, (l_max + 1) ** 2))]
        for part in self.mapper(partial(frames_of, l_max=l_max), _parts(draws, FRAMES_STEP)):
            if part is not None:
                rows.append(part)
            yield self.progress(message)
        return np.concatenate(rows)

    def drawn(
        self, order: Fitting, message: str
    ) -> Generator[StudyProgress, None, tuple[tuple[Draws, ...], tuple[float, ...]]]:
        """As :func:`drawings`, by one process."""
        found: tuple[tuple[Draws, ...], tuple[float, ...]] = (), ()
        yield self.progress(message)
        for answer in self.mapper(drawings, (order,)):
            if answer is not None:
                found = answer
            yield self.progress(message)
        return found


def descriptors_of(draws: Draws, keys: tuple[str, ...], level: int = LEVEL) -> FloatArray:
    """Descriptors of each particle, shape (n, keys); NaN where its series bounds no solid."""
    rows = [_described(draws, index, keys, level) for index in range(len(draws))]
    return np.array(rows, dtype=np.float64).reshape(len(draws), len(keys))


def _described(draws: Draws, index: int, keys: tuple[str, ...], level: int) -> tuple[float, ...]:
    try:
        found = describe(virtual_mesh(draws, index, level), keys)
    except RegolithError:
        return (np.nan,) * len(keys)
    return tuple(found[key] for key in keys)


def frames_of(draws: Draws, l_max: int) -> FloatArray:
    """The radius of every particle in the frame of its axes, shape (n, (l_max + 1)^2)."""
    if draws.scale == "radius" and draws.l_max == l_max:
        return canonical(draws.coefficients)
    return canonical(np.stack([draws.particle(index, l_max).values for index in range(len(draws))]))


def _parts(draws: Draws, size: int) -> Iterable[Draws]:
    return (draws.chosen(range(i, min(i + size, len(draws)))) for i in range(0, len(draws), size))
