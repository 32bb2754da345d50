"""Fig. 8 as a heat map, and error against face count.

Figures and files of parameter sweeps of a coarsening.
"""

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, PowerNorm, TwoSlopeNorm
from matplotlib.figure import Figure

from regolith_studio.coarsening.weights import JACCARD, WEIGHT_KEYS
from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.io.tables import write_table
from regolith_studio.studies.coarsening import (
    COLUMNS,
    MIN_PLOTTED,
    CoarseningStudy,
    particle_table,
    rmsre_table,
)
from regolith_studio.studies.figures import as_written, with_subscript, write_figure
from regolith_studio.studies.sweeps import (
    SWEEPS,
    descriptor_error,
    differences,
    format_difference,
    pareto_front,
    significant,
)

BELOW = 0.02
"""Room below 0, as a share of the axis: the marker of a row without errors is whole."""
MIN_SPAN = 0.01
"""Percentage points: where all changes are smaller, they are drawn as none."""


def tradeoff_figure(study: CoarseningStudy) -> Figure:
    """Mean RMSRE of the descriptors against the mean Jaccard distance; a line through the Pareto front."""
    x, y = 100 * study.rmsre[:, -1], 100 * descriptor_error(study.rmsre)
    x_ends = 100 * study.bands[..., -1]
    y_ends = 100 * study.band_of(descriptor_error(study.resampled))
    figure = Figure(figsize=(7.5, 4.5), layout="constrained")
    axis = figure.subplots()
    best = list(pareto_front(study))
    axis.plot(
        x[best], y[best], color="#888888", linewidth=1, linestyle="--", label="no row is better in both"
    )
    for r, row in enumerate(study.rows):
        axis.errorbar(
            x[r],
            y[r],
            # The band of the resamples need not hold the value, and matplotlib refuses bars below 0.
            xerr=np.maximum(0.0, [[x[r] - x_ends[0, r]], [x_ends[1, r] - x[r]]]),
            yerr=np.maximum(0.0, [[y[r] - y_ends[0, r]], [y_ends[1, r] - y[r]]]),
            fmt="o",
            markersize=5,
            color=f"C{r % 10}",
            elinewidth=0.8,
            capsize=2,
            label=as_written(row.label),
        )
    axis.set_xlabel("mean Jaccard distance (%)")
    axis.set_ylabel("mean RMSRE of the six descriptors (%)")
    axis.set_ylim(bottom=-BELOW * axis.get_ylim()[1])
    axis.grid(True, alpha=0.3)
    figure.legend(loc="outside right upper", frameon=False, fontsize="small")
    return figure


def sensitivity_figure(study: CoarseningStudy) -> Figure:
    """Changes in percentage points, one row a changed weight; numbers in brackets may be chance."""
    values, sure = 100 * differences(study)[0], significant(study)
    n_rows = len(values)
    figure = Figure(figsize=(9.0, 1.6 + 0.34 * n_rows), layout="constrained")
    axis = figure.subplots()
    span = max(MIN_SPAN, float(np.abs(values).max(initial=0.0)))
    norm = TwoSlopeNorm(0.0, -span, span)
    image = axis.imshow(values, aspect="auto", cmap="RdBu_r", norm=norm)
    for (r, k), value in np.ndenumerate(values):
        text = format_difference(value)
        text = text if sure[r, k] or text == "0" else f"({text})"
        colour = "white" if abs(value) > 0.6 * span else "black"
        axis.text(k, r, text, ha="center", va="center", color=colour, fontsize=8)
    _label_cells(axis, [row.label for row in study.rows[1:]])
    figure.colorbar(image, ax=axis).set_label(
        "change of RMSRE (percentage points); in brackets: may be chance"
    )
    return figure


def _label_cells(axis: Axes, rows: list[str]) -> None:
    """Name the rows and, above, the descriptors."""
    axis.set_xticks(range(len(COLUMNS)), [column_symbol(key) for key in COLUMNS])
    axis.set_yticks(range(len(rows)), rows)
    axis.xaxis.tick_top()


ERRORS = LinearSegmentedColormap.from_list("errors", ["#ffffff", "#ecb73f"])
"""White for no error to the colour of polyhedra for the largest, by the root, as the table of the window."""


def coarsening_figure(study: CoarseningStudy) -> Figure:
    """Rows of weights against descriptors; the number in a cell is the RMSRE in percent."""
    values = 100 * study.rmsre
    n_rows = len(study.rows)
    figure = Figure(figsize=(9.0, 1.9 + 0.55 * n_rows), layout="constrained")
    figure.suptitle(_made_with(study), fontsize="medium")
    axis = figure.subplots()
    norm = PowerNorm(0.5, 0.0, max(float(np.nanmax(values, initial=0.0)), MIN_PLOTTED))
    image = axis.imshow(values, aspect="auto", cmap=ERRORS, norm=norm)
    for (r, k), value in np.ndenumerate(values):
        axis.text(k, r, _printed(value), ha="center", va="center")
    _label_cells(axis, [_described(study, r) for r in range(n_rows)])
    figure.colorbar(image, ax=axis).set_label("RMSRE (%); J: mean Jaccard distance (%)")
    return figure


def _made_with(study: CoarseningStudy) -> str:
    """What all rows have in common: particles, and method and facets where they are the same."""
    methods = {row.method_run for row in study.rows if not row.is_baseline}
    facets = {row.n_facets for row in study.rows}
    words = [f"{len(study.names)} particles"]
    words += [f"method {key}" for key in methods if len(methods) == 1]
    words += [f"{count} facets" for count in facets if len(facets) == 1]
    return ", ".join(words)


def facet_count_figure(study: CoarseningStudy) -> Figure:
    """Errors against the number of facets, with bootstrap bands."""
    counts = [row.n_facets for row in study.rows]
    values, (low, high) = 100 * study.rmsre, 100 * study.bands
    figure = Figure(figsize=(6.0, 4.0), layout="constrained")
    axis = figure.subplots()
    for k, key in enumerate(COLUMNS):
        ends = np.maximum(low[:, k], MIN_PLOTTED), np.maximum(high[:, k], MIN_PLOTTED)
        axis.fill_between(counts, *ends, alpha=0.15, linewidth=0)
        shown = np.maximum(values[:, k], MIN_PLOTTED)
        axis.plot(counts, shown, marker="o", markersize=3.5, label=column_symbol(key))
    axis.set_yscale("log")
    axis.set_xlabel("facets")
    axis.set_ylabel(f"RMSRE (%), at least {MIN_PLOTTED:g}; J: mean (%)")
    axis.grid(True, which="major", alpha=0.3)
    figure.legend(loc="outside right upper", frameon=False)
    return figure


FIGURES: Mapping[str, Callable[[CoarseningStudy], Figure]] = {
    "facets": facet_count_figure,
    "tradeoff": tradeoff_figure,
    "sensitivity": sensitivity_figure,
}
"""By key of :data:`~regolith_studio.studies.sweeps.SWEEPS`."""


def write_sweep(key: str, study: CoarseningStudy, folder: Path) -> tuple[Path, ...]:
    """Tables (CSV, JSON) of rows and of particles, and the figure (PNG, SVG)."""
    return (
        *write_table(SWEEPS[key].table(study), folder, key),
        *write_table(particle_table(study), folder, f"{key}_particles"),
        *write_figure(FIGURES[key](study), folder, key),
    )


def write_coarsening_study(study: CoarseningStudy, folder: Path) -> tuple[Path, ...]:
    """Tables (CSV, JSON) of rows and of particles, and the figures (PNG, SVG)."""
    paths: tuple[Path, ...] = (
        *write_table(rmsre_table(study), folder, "coarsening_rmsre"),
        *write_table(particle_table(study), folder, "coarsening_particles"),
        *write_figure(coarsening_figure(study), folder, "coarsening_rmsre"),
    )
    if len({row.n_facets for row in study.rows}) == len(study.rows) > 1:
        paths += write_figure(facet_count_figure(study), folder, "coarsening_faces")
    return paths


def column_symbol(key: str) -> str:
    """Of a descriptor, or J of the Jaccard distance (the paper's IoU), as matplotlib sets it."""
    return "J" if key == JACCARD else with_subscript(CATALOGUE[key].symbol)


def _described(study: CoarseningStudy, r: int) -> str:
    row = study.rows[r]
    weights = " ".join(f"{row.weights[key]:g}" for key in WEIGHT_KEYS)
    return f"{as_written(row.label)}\n({weights})"


def _printed(value: float) -> str:
    return "0" if value < 5e-3 else f"{value:.2f}" if value < 1.0 else f"{value:.1f}"
