"""The curves of Figs. 4 to 6 as numbers: histograms, quantiles, densities of pairs, criterion of mixtures."""

from collections.abc import Generator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.stats import gaussian_kde
from skimage.measure import find_contours

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.studies.population import PopulationStudy
from regolith_studio.studies.population_distances import class_weights
from regolith_studio.studies.population_tables import size_column

MEASURED, CUT = "measured", "cut"
"""Sources of a curve besides the keys of the models."""
N_BINS = 40
QUANTILES = np.linspace(0.5, 99.5, 100)
"""In per cent."""
GRID = 60
CONTAINED = (0.95, 0.75, 0.5, 0.25)
"""Shares of the particles inside the contours of Fig. 6."""
MOST_FOR_DENSITY = 1500
N_PAIRED = 3
"""Descriptors of Fig. 6, the first ones of the study."""


@dataclass(frozen=True, eq=False)
class PopulationCurve:
    """One line of a panel.

    Parameters
    ----------
    source
        :data:`MEASURED`, :data:`CUT`, or a key of ``MODELS``.
    x, y
        Shape (n,); NaN between separate lines.
    """

    source: str
    x: FloatArray
    y: FloatArray


@dataclass(frozen=True, eq=False)
class PopulationPanel:
    """Curves over common axes.

    Parameters
    ----------
    x, y
        Keys of descriptors; empty for an axis of another quantity.
    """

    x: str
    y: str
    curves: tuple[PopulationCurve, ...]


def tables_of(study: PopulationStudy) -> list[tuple[str, FloatArray]]:
    """Descriptors by source, each (n, keys): measured, cut where it is another degree, and each model."""
    cut = [(CUT, study.cut)] if study.cut_degree < study.l_max else []
    return [(MEASURED, study.measured), *cut, *((model.key, model.table) for model in study.models)]


def histogram_edges(tables: Sequence[FloatArray], column: int) -> FloatArray:
    """Edges of the bins that all tables share, shape (N_BINS + 1,); the outer 0.2 % are cut off."""
    low, high = np.percentile(np.concatenate([table[:, column] for table in tables]), [0.1, 99.9])
    return np.linspace(low, max(high, low + 1e-12), N_BINS + 1)


def density_panels(study: PopulationStudy, weighting: str = "number") -> tuple[PopulationPanel, ...]:
    """Fig. 4 (by number) or Fig. 5 (by volume): a panel a descriptor, histograms as steps of area 1."""
    named = tables_of(study)
    weights = [class_weights(table, weighting, size_column(study)) for _, table in named]
    panels = []
    for column, key in enumerate(study.keys):
        edges = histogram_edges([table for _, table in named], column)
        curves = []
        for (source, table), weight in zip(named, weights, strict=True):
            height, _ = np.histogram(table[:, column], edges, weights=weight, density=True)
            outline = np.concatenate([[0.0], np.repeat(height, 2), [0.0]])
            curves.append(PopulationCurve(source, np.repeat(edges, 2), outline))
        panels.append(PopulationPanel(key, "", tuple(curves)))
    return tuple(panels)


def quantile_panels(study: PopulationStudy) -> tuple[PopulationPanel, ...]:
    """Quantiles (0.5 to 99.5 %) against those of the sample: equal ones lie on the line ``measured``."""
    panels = []
    for column, key in enumerate(study.keys):
        measured = np.percentile(study.measured[:, column], QUANTILES)
        curves = [
            PopulationCurve(source, measured, np.percentile(table[:, column], QUANTILES))
            for source, table in tables_of(study)
        ]
        panels.append(PopulationPanel(key, key, tuple(curves)))
    return tuple(panels)


def pair_panels(study: PopulationStudy) -> Generator[None, None, tuple[PopulationPanel, ...]]:
    """Fig. 6: contours that hold 25, 50, 75 and 95 % of the particles, a panel a pair of descriptors.

    Yields after each density, which takes some tenths of a second.
    """
    named = [(source, table) for source, table in tables_of(study) if source != CUT]
    panels = []
    for i, j in combinations(range(min(N_PAIRED, len(study.keys))), 2):
        x, y = common_grid([table[:, [i, j]] for _, table in named])
        curves = []
        for source, table in named:
            values, levels = pair_density(table[:, [i, j]], x, y)
            curves.append(PopulationCurve(source, *contours(values, levels, x, y)))
            yield
        panels.append(PopulationPanel(study.keys[i], study.keys[j], tuple(curves)))
    return tuple(panels)


def components_panels(study: PopulationStudy) -> tuple[PopulationPanel, ...]:
    """Bayes' criterion above its lowest value against the number of parts; none without a mixture."""
    curves = []
    for model in study.models:
        if len(model.criterion) > 1:
            curve = np.array(model.criterion)
            numbers = np.arange(1.0, len(curve) + 1)
            curves.append(PopulationCurve(model.key, numbers, curve - curve.min()))
    return (PopulationPanel("", "", tuple(curves)),) if curves else ()


def common_grid(tables: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Places along both axes that hold nearly all particles of all tables (n, 2), with a margin."""
    ends = np.array([np.percentile(table, [0.5, 99.5], axis=0) for table in tables])
    low, high = ends[:, 0].min(axis=0), ends[:, 1].max(axis=0)
    margin = 0.15 * (high - low)
    x, y = (np.linspace(low[i] - margin[i], high[i] + margin[i], GRID) for i in range(2))
    return x, y


def pair_density(table: FloatArray, x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Kernel density at the places, shape (GRID, GRID), and the levels whose contours hold the shares.

    Scott's bandwidth n^(-1/6) times the covariance.
    """
    few = table[:: max(1, len(table) // MOST_FOR_DENSITY)].T
    density = gaussian_kde(few)
    values = density(np.stack(np.meshgrid(x, y)).reshape(2, -1)).reshape(GRID, GRID)
    return values, np.unique(np.quantile(density(few), [1 - share for share in CONTAINED]))


def contours(
    values: FloatArray, levels: FloatArray, x: FloatArray, y: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Contours of a density with values[row of y, column of x], with NaN between them."""
    lines = [np.full((1, 2), np.nan)]
    for level in levels:
        for line in find_contours(values, level):  # type: ignore[no-untyped-call]
            lines += [line, np.full((1, 2), np.nan)]
    rows, columns = np.concatenate(lines).T
    places = np.arange(GRID)
    return np.interp(columns, places, x), np.interp(rows, places, y)
