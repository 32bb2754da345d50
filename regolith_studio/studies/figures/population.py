"""Figs. 4, 5 and 6: densities of descriptors, measured and virtual."""

from itertools import combinations, cycle
from math import ceil
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.io.tables import write_table
from regolith_studio.shape_models.models import MODELS
from regolith_studio.studies.figures import as_written, write_figure
from regolith_studio.studies.matching import QUANTILES as MATCHED_QUANTILES
from regolith_studio.studies.matching import Match
from regolith_studio.studies.population import PopulationStudy
from regolith_studio.studies.population_distances import WEIGHTINGS, class_weights
from regolith_studio.studies.population_tables import (
    QUANTILES,
    common_grid,
    distance_table,
    histogram_edges,
    pair_density,
    pair_table,
    ranking_table,
    size_column,
    target_table,
)

COLOURS = ("#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#f0e442")
"""Okabe and Ito's palette; the measured sample is black and grey."""
MEASURED = "#bbbbbb"
GREYS = ("#e4e4e4", "#c8c8c8", "#a8a8a8", "#888888")
N_COLUMNS = 3


def density_figure(study: PopulationStudy, weighting: str = "number") -> Figure:
    """Fig. 4 (by number) or Fig. 5 (by volume): histograms with bins shared by all, outer 0.2 % cut off."""
    figure, axes = _panels(len(study.keys))
    for axis, column in zip(axes, range(len(study.keys)), strict=False):
        tables = [study.measured, study.cut, *(model.table for model in study.models)]
        bins = histogram_edges(tables, column).tolist()
        weights = [class_weights(table, weighting, size_column(study)) for table in tables]
        measured = study.measured[:, column]
        axis.hist(measured, bins, weights=weights[0], density=True, color=MEASURED, label="measured")
        if study.cut_degree < study.l_max:
            axis.hist(
                study.cut[:, column],
                bins,
                weights=weights[1],
                density=True,
                histtype="step",
                color="black",
                linestyle=":",
                label=cut_label(study),
            )
        for table, weight, model, colour in zip(
            tables[2:], weights[2:], study.models, cycle(COLOURS), strict=False
        ):
            axis.hist(
                table[:, column],
                bins,
                weights=weight,
                density=True,
                histtype="step",
                color=colour,
                label=MODELS[model.key].label,
            )
        axis.set_xlabel(_label(study, column))
    for axis in axes[::N_COLUMNS]:
        axis.set_ylabel(f"density by {weighting}")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3, frameon=False)
    return figure


def quantile_figure(study: PopulationStudy) -> Figure:
    """Quantiles (0.5 to 99.5 %) of each model against those of the sample: equal ones lie on the line."""
    figure, axes = _panels(len(study.keys))
    for column, axis in enumerate(axes):
        measured = np.percentile(study.measured[:, column], QUANTILES)
        axis.plot(measured[[0, -1]], measured[[0, -1]], color="black", linewidth=0.8)
        if study.cut_degree < study.l_max:
            cut = np.percentile(study.cut[:, column], QUANTILES)
            axis.plot(measured, cut, ":", color="black", label=cut_label(study))
        for model, colour in zip(study.models, cycle(COLOURS), strict=False):
            quantiles = np.percentile(model.table[:, column], QUANTILES)
            axis.plot(measured, quantiles, ".", color=colour, markersize=3, label=MODELS[model.key].label)
        axis.set_xlabel(f"measured {_label(study, column)}")
    for axis in axes[::N_COLUMNS]:
        axis.set_ylabel("drawn")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3, frameon=False)
    return figure


def pair_figure(study: PopulationStudy) -> Figure:
    """Fig. 6: contours that hold 25, 50, 75 and 95 % of the particles, a row a model.

    Kernel densities with Scott's bandwidth n^(-1/6) times the covariance; the measured sample is filled.
    """
    pairs = [list(pair) for pair in combinations(range(min(3, len(study.keys))), 2)]
    rows = max(1, len(study.models))
    figure = Figure(figsize=(1 + 3.2 * len(pairs), 0.8 + 2.7 * rows), layout="constrained")
    axes = figure.subplots(rows, len(pairs), squeeze=False)
    for column, pair in enumerate(pairs):
        tables = [study.measured[:, pair], *(model.table[:, pair] for model in study.models)]
        x, y = common_grid(tables)
        measured = pair_density(tables[0], x, y)
        for row, drawn in enumerate(tables[1:]):
            axis = axes[row, column]
            values, levels = measured
            ends = [*levels, max(values.max(), levels[-1]) * 1.01]
            axis.contourf(x, y, values, levels=ends, colors=GREYS[: len(levels)])
            values, levels = pair_density(drawn, x, y)
            axis.contour(x, y, values, levels=levels, colors=COLOURS[row % len(COLOURS)], linewidths=1)
            axis.set_xlabel(_label(study, pair[0]))
            axis.set_ylabel(_label(study, pair[1]))
    handles = [Line2D([], [], color=MEASURED, linewidth=6, label="measured")]
    handles += [
        Line2D([], [], color=colour, label=MODELS[model.key].label)
        for model, colour in zip(study.models, cycle(COLOURS), strict=False)
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=3, frameon=False)
    return figure


def components_figure(study: PopulationStudy) -> Figure | None:
    """Bayes' criterion above its lowest value against the number of parts; none without a mixture."""
    curves = [(model, np.array(model.criterion)) for model in study.models if len(model.criterion) > 1]
    if not curves:
        return None
    figure = Figure(figsize=(5, 3.4), layout="constrained")
    axis = figure.subplots()
    for (model, curve), colour in zip(curves, cycle(COLOURS), strict=False):
        numbers, best = np.arange(1, len(curve) + 1), int(curve.argmin())
        axis.plot(numbers, curve - curve.min(), "o-", color=colour, label=MODELS[model.key].label)
        axis.plot(numbers[best], 0.0, "o", color=colour, markersize=10, fillstyle="none")
    axis.set_xlabel("number of parts")
    axis.set_ylabel("BIC above its minimum")
    axis.xaxis.set_major_locator(MaxNLocator(integer=True))
    axis.legend(frameon=False)
    return figure


def write_population_study(
    study: PopulationStudy, folder: Path, stem: str = "population"
) -> tuple[Path, ...]:
    """Tables (CSV, JSON) of ranking, targets, distances and pairs, and the figures (PNG, SVG)."""
    files = [
        *write_table(ranking_table(study), folder, f"{stem}_ranking"),
        *write_table(target_table(study), folder, f"{stem}_targets"),
        *write_table(distance_table(study), folder, f"{stem}_distances"),
        *write_table(pair_table(study), folder, f"{stem}_pairs"),
    ]
    for weighting in WEIGHTINGS:
        files += write_figure(density_figure(study, weighting), folder, f"{stem}_{weighting}")
    files += write_figure(pair_figure(study), folder, f"{stem}_pairs")
    files += write_figure(quantile_figure(study), folder, f"{stem}_quantiles")
    if (figure := components_figure(study)) is not None:
        files += write_figure(figure, folder, f"{stem}_components")
    return tuple(files)


def cut_label(study: PopulationStudy) -> str:
    """Name of the second measured line."""
    return f"measured, cut at l = {study.cut_degree}"


def _panels(n: int) -> tuple[Figure, list[Axes]]:
    columns = min(N_COLUMNS, n)
    rows = ceil(n / columns)
    figure = Figure(figsize=(1 + 3.2 * columns, 0.8 + 2.6 * rows), layout="constrained")
    axes = list(figure.subplots(rows, columns, squeeze=False).flat)
    for axis in axes[n:]:
        axis.remove()
    return figure, axes[:n]


def _label(study: PopulationStudy, column: int) -> str:
    row = CATALOGUE[study.keys[column]]
    unit = "µm" if study.unit == "um" else study.unit
    power = {1: "", 2: "²", 3: "³", 5: "⁵"}
    suffix = f" ({unit}{power[row.dimension]})" if row.dimension else ""
    return f"{row.label.lower()}{suffix}"


def matching_figure(match: Match) -> Figure:
    """Energy distances in floors, masses of the mixture, and quantiles of the size by mass."""
    parts = (*match.parts, match.mixture)
    rows, names = np.arange(len(parts)), [as_written(part.name) for part in parts]
    figure = Figure(figsize=(11, 1.8 + 0.35 * len(parts)), layout="constrained")
    near, masses, sizes = figure.subplots(1, 3, sharey=True)
    for row, part in zip(rows, parts, strict=True):
        low, high = (end / part.energy_floor for end in part.energy_interval)
        near.plot([low, high], [row, row], color="#0072b2")
        near.plot(part.energy / part.energy_floor, row, "o", color="#0072b2")
        sizes.plot(part.sizes, [row] * len(MATCHED_QUANTILES), "o-", color="#009e73")
        if part is not match.mixture:
            masses.barh(row, 100 * part.mass_share, color="#e69f00")
            masses.plot([100 * end for end in part.mass_interval], [row, row], color="black")
    near.axvspan(-1, 1, color="#e4e4e4")
    near.set_xlabel(f"energy distance to {as_written(match.target)}, in floors")
    masses.set_xlabel("mass in the mixture, %")
    for size in match.target_sizes:
        sizes.axvline(size, color="#888888", linestyle=":")
    sizes.set(xscale="log", xlabel=f"{match.keys[0].replace('_', ' ')} (µm) of\n10, 50 and 90 % of the mass")
    near.set_yticks(rows, names)
    near.set_ylim(len(parts) - 0.5, -0.5)
    return figure
