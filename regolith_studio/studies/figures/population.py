"""Figs. 4, 5 and 6: densities of descriptors, measured and virtual."""

from itertools import combinations, cycle
from math import ceil
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, MaxNLocator, NullLocator

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.io.tables import write_table
from regolith_studio.shape_models.models import MODELS
from regolith_studio.studies.figures import as_written, write_figure
from regolith_studio.studies.matching import QUANTILES as MATCHED_QUANTILES
from regolith_studio.studies.matching import Match
from regolith_studio.studies.population import PopulationStudy
from regolith_studio.studies.population_distances import WEIGHTINGS
from regolith_studio.studies.population_tables import (
    CUT,
    MEASURED,
    PopulationCurve,
    common_grid,
    components_panels,
    density_panels,
    distance_table,
    pair_density,
    pair_table,
    quantile_panels,
    ranking_table,
    target_table,
)

COLOURS = ("#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#f0e442")
"""Okabe and Ito's palette; the measured sample is black and grey."""
SAMPLE = "#bbbbbb"
GREYS = ("#e4e4e4", "#c8c8c8", "#a8a8a8", "#888888")
N_COLUMNS = 3


def density_figure(study: PopulationStudy, weighting: str = "number") -> Figure:
    """Fig. 4 (by number) or Fig. 5 (by volume)."""
    figure, axes = _panels(len(study.keys))
    for axis, panel in zip(axes, density_panels(study, weighting), strict=True):
        for curve in panel.curves:
            if curve.source == MEASURED:
                axis.fill_between(curve.x, curve.y, color=SAMPLE, label="measured")
            else:
                colour, label = _style(study, curve)
                axis.plot(curve.x, curve.y, ":" if curve.source == CUT else "-", color=colour, label=label)
        axis.set_ylim(bottom=0.0)
        axis.set_xlabel(_label(study, panel.x))
    _complete(figure, axes, f"density by {weighting}")
    return figure


def quantile_figure(study: PopulationStudy) -> Figure:
    """Quantiles (0.5 to 99.5 %) of each model against those of the sample: equal ones lie on the line."""
    figure, axes = _panels(len(study.keys))
    for axis, panel in zip(axes, quantile_panels(study), strict=True):
        for curve in panel.curves:
            if curve.source == MEASURED:
                axis.plot(curve.x, curve.y, color="black", linewidth=0.8)
            else:
                colour, label = _style(study, curve)
                line = ":" if curve.source == CUT else "."
                axis.plot(curve.x, curve.y, line, color=colour, markersize=3, label=label)
        axis.set_xlabel(f"measured {_label(study, panel.x)}")
    _complete(figure, axes, "drawn")
    return figure


def _style(study: PopulationStudy, curve: PopulationCurve) -> tuple[str, str]:
    """Colour and label of the particles cut at another degree, or of a model."""
    if curve.source == CUT:
        return "black", f"measured, cut at l = {study.cut_degree}"
    number = [model.key for model in study.models].index(curve.source)
    return COLOURS[number % len(COLOURS)], MODELS[curve.source].label


def _complete(figure: Figure, axes: list[Axes], y: str) -> None:
    """Label the vertical axes and explain the curves."""
    for axis in axes[::N_COLUMNS]:
        axis.set_ylabel(y)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3, frameon=False)


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
            axis.set_xlabel(_label(study, study.keys[pair[0]]))
            axis.set_ylabel(_label(study, study.keys[pair[1]]))
    handles = [Line2D([], [], color=SAMPLE, linewidth=6, label="measured")]
    handles += [
        Line2D([], [], color=colour, label=MODELS[model.key].label)
        for model, colour in zip(study.models, cycle(COLOURS), strict=False)
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=3, frameon=False)
    return figure


def components_figure(study: PopulationStudy) -> Figure | None:
    """Bayes' criterion above its lowest value against the number of parts; none without a mixture."""
    panels = components_panels(study)
    if not panels:
        return None
    figure = Figure(figsize=(5, 3.4), layout="constrained")
    axis = figure.subplots()
    for curve in panels[0].curves:
        colour, label = _style(study, curve)
        axis.plot(curve.x, curve.y, "o-", color=colour, label=label)
        axis.plot(curve.x[curve.y.argmin()], 0.0, "o", color=colour, markersize=10, fillstyle="none")
    axis.set_xlabel("number of parts")
    axis.set_ylabel("BIC above its minimum")
    axis.xaxis.set_major_locator(MaxNLocator(integer=True))
    axis.legend(frameon=False)
    return figure


def write_population_study(study: PopulationStudy, folder: Path) -> tuple[Path, ...]:
    """Tables (CSV, JSON) of ranking, targets, distances and pairs, and the figures (PNG, SVG)."""
    files = [
        *write_table(ranking_table(study), folder, "population_ranking"),
        *write_table(target_table(study), folder, "population_targets"),
        *write_table(distance_table(study), folder, "population_distances"),
        *write_table(pair_table(study), folder, "population_pairs"),
    ]
    for weighting in WEIGHTINGS:
        files += write_figure(density_figure(study, weighting), folder, f"population_{weighting}")
    files += write_figure(pair_figure(study), folder, "population_pairs")
    files += write_figure(quantile_figure(study), folder, "population_quantiles")
    if (figure := components_figure(study)) is not None:
        files += write_figure(figure, folder, "population_components")
    return tuple(files)


def _panels(n: int) -> tuple[Figure, list[Axes]]:
    columns = min(N_COLUMNS, n)
    rows = ceil(n / columns)
    figure = Figure(figsize=(1 + 3.2 * columns, 0.8 + 2.6 * rows), layout="constrained")
    axes = list(figure.subplots(rows, columns, squeeze=False).flat)
    for axis in axes[n:]:
        axis.remove()
    return figure, axes[:n]


def _label(study: PopulationStudy, key: str) -> str:
    row = CATALOGUE[key]
    unit = "µm" if study.unit == "um" else study.unit
    power = {1: "", 2: "²", 3: "³", 5: "⁵"}
    suffix = f" ({unit}{power[row.dimension]})" if row.dimension else ""
    return f"{row.label.lower()}{suffix}"


def matching_figure(match: Match) -> Figure:
    """Energy distances over their noise, masses of the mixture, and quantiles of the size by mass."""
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
    near.set_xlabel(f"energy distance to {as_written(match.target)} / noise")
    masses.set_xlabel("mass in the mixture, %")
    for size in match.target_sizes:
        sizes.axvline(size, color="#888888", linestyle=":")
    sizes.set(xscale="log", xlabel=f"{match.keys[0].replace('_', ' ')} (µm) of\n10, 50 and 90 % of the mass")
    sizes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    sizes.xaxis.set_major_formatter("{x:g}")
    sizes.xaxis.set_minor_locator(NullLocator())
    near.set_yticks(rows, names)
    near.set_ylim(len(parts) - 0.5, -0.5)
    return figure
