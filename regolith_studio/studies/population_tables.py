"""Figs. 4 to 6 as numbers: distances of each model from the sample, which is nearest, and the curves.

Curves are histograms, quantiles, densities of pairs, and the criterion of mixtures.
"""

from collections.abc import Generator, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from skimage.measure import find_contours

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.io.tables import Column, Table
from regolith_studio.messages import N_, Message, Number
from regolith_studio.studies.population import N_FLOOR_SPLITS, ModelEvaluation, PopulationStudy
from regolith_studio.studies.population_distances import (
    CONFIDENCE,
    N_RESAMPLES,
    WEIGHTINGS,
    class_weights,
    distances,
)

MEASURED, CUT = "measured", "cut"
"""Sources of a curve besides the keys of the models."""
N_BINS = 40
QUANTILES = np.linspace(0.5, 99.5, 100)
"""In per cent."""
GRID = 60
CONTAINED = (0.95, 0.75, 0.5, 0.25)
"""Shares of the particles inside the contours of Fig. 6."""
MAX_FOR_DENSITY = 1500
N_PAIRED = 3
"""Descriptors of Fig. 6, the first ones of the study."""


@dataclass(frozen=True, eq=False)
class PopulationCurve:
    """One line of a panel.

    ``source``: :data:`MEASURED`, :data:`CUT`, or a key of ``MODELS``. ``x``, ``y``: shape (n,); NaN between
    separate lines.
    """

    source: str
    x: FloatArray
    y: FloatArray


@dataclass(frozen=True, eq=False)
class PopulationPanel:
    """Curves over common axes.

    ``x``, ``y``: keys of descriptors; empty for an axis of another quantity.
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
    from scipy.stats import gaussian_kde  # .6 s, which each worker of a batch would wait for

    few = table[:: max(1, len(table) // MAX_FOR_DENSITY)].T
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


PERCENTAGES = (
    "wasserstein",
    "wasserstein_low",
    "wasserstein_high",
    "floor",
    "floor_p5",
    "floor_p95",
    "cut_sample",
    "kolmogorov_smirnov",
    "kolmogorov_smirnov_low",
    "kolmogorov_smirnov_high",
    "kolmogorov_smirnov_floor",
)

PAPERS_MODEL = "gaussian_field"
AT_NOISE = ("equivalent_radius", "surface_area", "aspect_ratio", "sphericity")
PAPERS_PAIRS = AT_NOISE[:3]
MIN_GAIN, MAX_FLOORS, MAX_ENERGY, MIN_NOVELTY = 8.0, 2.0, 0.3, 0.9


def size_column(study: PopulationStudy) -> int | None:
    """Column of the equivalent radius, if it was measured."""
    return study.keys.index("equivalent_radius") if "equivalent_radius" in study.keys else None


def distance_table(study: PopulationStudy) -> Table:
    """Figs. 4 and 5 as numbers: a row for each model, weighting and descriptor."""
    rows = []
    low, high = (np.percentile(study.floor.wasserstein, p, axis=0) for p in (5, 95))
    (cut,) = distances([(study.measured, study.cut)], study.seed, size_column(study)).wasserstein
    floor, gap = study.floor.wasserstein.mean(axis=0), study.floor.kolmogorov.mean(axis=0)
    for model in study.models:
        far, ks = model.distances.wasserstein, model.distances.kolmogorov
        for w, weighting in enumerate(WEIGHTINGS):
            for k, key in enumerate(study.keys):
                mean, spread = far[:, w, k].mean(), model.intervals.wasserstein[:, w, k]
                noise = (floor[w, k], low[w, k], high[w, k], cut[w, k])
                shares = [100 * value for value in (mean, *spread, *noise)]
                ends = 100 * model.intervals.kolmogorov[:, w, k]
                gaps = (100 * ks[:, w, k].mean(), *ends, 100 * gap[w, k])
                floors = (mean / floor[w, k], ks[:, w, k].mean() / gap[w, k])
                rows.append((model.key, weighting, key, *shares, *gaps, *floors))
    columns = (
        *map(Column, ("model", "weighting", "descriptor")),
        *(Column(name, "%") for name in PERCENTAGES),
        Column("wasserstein_in_floors"),
        Column("kolmogorov_smirnov_in_floors"),
    )
    return Table("Distances of drawn from measured particles", columns, tuple(rows), _notes(study))


def pair_table(study: PopulationStudy) -> Table:
    """Fig. 6 as numbers: energy distance of each pair of descriptors."""
    rows = [
        (model.key, *pair, 100 * model.distances.energy[:, p].mean(), 100 * study.floor.energy[:, p].mean())
        for model in study.models
        for p, pair in enumerate(study.pairs)
    ]
    columns = (
        *map(Column, ("model", "first", "second")),
        Column("energy_distance", "%"),
        Column("floor", "%"),
    )
    return Table("Energy distances of pairs of descriptors", columns, tuple(rows), _notes(study))


def ranking_table(study: PopulationStudy) -> Table:
    """The models, the nearest to the sample first: by their mean Wasserstein distance in floors."""
    floor = study.floor.wasserstein.mean(axis=0)
    rows = [
        (
            model.key,
            (model.distances.wasserstein.mean(axis=0) / floor).mean(),
            (model.distances.kolmogorov.mean(axis=0) / study.floor.kolmogorov.mean(axis=0)).mean(),
            100 * model.distances.energy.mean(),
            model.distances.accuracy.mean(),
            model.novelty.mean(),
            100 * model.rejected.mean(),
            100 * model.near_parents.mean(),
        )
        for model in study.models
    ]
    columns = (
        Column("model"),
        Column("wasserstein_in_floors"),
        Column("kolmogorov_smirnov_in_floors"),
        Column("energy_distance", "%"),
        Column("classifier_accuracy"),
        Column("novelty"),
        Column("rejected", "%"),
        Column("nearest_to_parent", "%"),
    )
    ranked = tuple(sorted(rows, key=lambda row: row[1]))
    return Table("Models by their distance to held-out particles", columns, ranked, _notes(study))


AT_LEAST, AT_MOST = N_("at least {limit}"), N_("at most {limit}")
UNDECIDED = N_("not decidable with so few")
_DECIDABLE = 0.9
"""Share of random halves of the sample that must reach a target for a model to miss it."""


def target_table(study: PopulationStudy) -> Table:
    """What a model of a real sample should reach, what each model does, and what other real particles do.

    The floor is the median of what random halves of the sample reach. Where more than a tenth of the halves
    miss a target as well, a model that misses it is not told from particles of the same source.
    """
    rows = []
    for model in study.models:
        for name, value, sign, limit, halves in _targets(study, model):
            reached = _met(np.array([value]), sign, limit) == 1.0
            decidable = halves is None or _met(halves, sign, limit) >= _DECIDABLE
            answer = N_("yes") if reached else N_("no") if decidable else UNDECIDED
            floor = float("nan") if halves is None else float(np.median(halves))
            rows.append((model.key, name, value, floor, Message(sign, limit=Number(limit, "g")), answer))
    columns = tuple(map(Column, ("model", "target", "value", "floor", "wanted", "reached")))
    return Table("What a model should reach on held-out particles", columns, tuple(rows), _notes(study))


def _met(values: FloatArray, sign: str, limit: float) -> float:
    """Share of the values that meet a target."""
    return float(np.mean(values >= limit if sign == AT_LEAST else values <= limit))


_Target = tuple[str, float, str, float, FloatArray | None]


def _targets(study: PopulationStudy, model: ModelEvaluation) -> Iterator[_Target]:
    """Name, value, sense and limit of what can be told from what was measured; the same of random halves."""
    far, noise = model.distances.wasserstein.mean(axis=0), study.floor.wasserstein
    paper = next((each for each in study.models if each.key == PAPERS_MODEL), None)
    if paper is not None and paper is not model and "aspect_ratio" in study.keys:
        column = study.keys.index("aspect_ratio")
        papers = paper.distances.wasserstein.mean(axis=0)[0, column]
        name = N_("aspect ratio: distance of the Gaussian field over that of the model")
        yield name, papers / far[0, column], AT_LEAST, MIN_GAIN, papers / noise[:, 0, column]
    if columns := [study.keys.index(key) for key in AT_NOISE if key in study.keys]:
        highest = np.percentile(noise, 95, axis=0)
        worst, halves = ((each / highest)[..., columns].max(axis=(-2, -1)) for each in (far, noise))
        name = N_("r_eq, A, AR, S: the worst, over the 95th percentile of noise")
        yield name, float(worst), AT_MOST, 1.0, halves
    if "convexity" in study.keys:
        column = study.keys.index("convexity")
        gaps = study.floor.kolmogorov[:, 0, column]
        gap = model.distances.kolmogorov[:, 0, column].mean() / gaps.mean()
        name = N_("V/CH: Kolmogorov-Smirnov distance over the sampling noise")
        yield name, gap, AT_MOST, MAX_FLOORS, gaps / gaps.mean()
    if pairs := [i for i, pair in enumerate(study.pairs) if set(pair) <= set(PAPERS_PAIRS)]:
        energy = 100 * model.distances.energy.mean(axis=0)[pairs].max()
        name = N_("pairs of r_eq, A, AR: the largest energy distance [%]")
        yield name, energy, AT_MOST, MAX_ENERGY, 100 * study.floor.energy[:, pairs].max(axis=1)
    yield N_("rejected draws [%]"), 100 * model.rejected.mean(), AT_MOST, 0.0, None
    yield N_("median novelty"), model.novelty.mean(), AT_LEAST, MIN_NOVELTY, None


def _notes(study: PopulationStudy) -> tuple[str, ...]:
    splits = len(study.models[0].novelty) if study.models else 0
    once = N_(
        "{count} measured particles with degrees up to {degree}, {left} left out; fitted to one half, "
        "evaluated on the other; {splits} {split}, {draws} draws once from each fit, seed {seed}."
    )
    often = N_(
        "{count} measured particles with degrees up to {degree}, {left} left out; fitted to one half, "
        "evaluated on the other; {splits} {split}, {draws} draws {repeats} times from each fit, seed {seed}."
    )
    return (
        Message(
            once if study.n_repeats == 1 else often,
            count=len(study.measured),
            degree=study.l_max,
            left=study.left_out,
            splits=splits,
            split=Message(N_("split") if splits == 1 else N_("splits")),
            draws=study.n_draws,
            repeats=study.n_repeats,
            seed=study.seed,
        ),
        "Wasserstein distances are shares of the measured mean; the floor is the distance between random "
        f"halves, {N_FLOOR_SPLITS} of them; by volume means weighted with the cube of the equivalent radius.",
        Message(N_("The cut sample is the measured one cut at l_max = {degree}."), degree=study.cut_degree),
        "Degrees of the draws: " + ", ".join(f"{model.key} {model.l_max}" for model in study.models) + ".",
        f"Low and high hold the distance of one round in {CONFIDENCE:.0%} of {N_RESAMPLES} resamples of "
        "measured and drawn particles, shifted back by what resampling adds.",
        "Energy distances are unbiased, of standardised columns; a classifier at 0.5 cannot tell measured "
        "from drawn; novelty is the distance to the nearest measured particle over all rotations, 1 for the "
        "same source.",
    )
