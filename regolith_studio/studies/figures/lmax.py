"""Fig. 3: RMSRE of every descriptor against l_max, one panel a group."""

from math import ceil
from pathlib import Path
from textwrap import fill

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.io.tables import write_table
from regolith_studio.studies.figures.files import with_subscript, write_figure
from regolith_studio.studies.lmax import BOX_NOTE, LmaxStudy, particle_table, rmsre_table

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
"""Okabe and Ito's palette, which most colour-blind people can tell apart."""
MARKERS = "osD^vPX"
N_COLUMNS = 3


def lmax_figure(study: LmaxStudy) -> Figure:
    """Lines are RMSRE in percent, shades the bootstrap bands; the scale is logarithmic."""
    groups = study.group_names
    columns = min(N_COLUMNS, len(groups))
    rows = ceil(len(groups) / columns)
    figure = Figure(figsize=(1.2 + 4.0 * columns, 0.6 + 3.2 * rows), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    for axis, group in zip(axes.flat, groups, strict=False):
        _draw_group(axis, study, group)
    for axis in axes.flat[len(groups) :]:
        axis.remove()
    for axis in axes[:, 0]:
        axis.set_ylabel("RMSRE (%)")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right upper", frameon=False)
    if "min_diameter" in study.keys:
        figure.supxlabel(fill(BOX_NOTE, 22 + 50 * columns), fontsize="x-small", x=0.02, ha="left")
    return figure


def write_lmax_study(study: LmaxStudy, folder: Path, stem: str = "lmax") -> tuple[Path, ...]:
    """Tables (CSV, JSON) of groups and of particles, and the figure (PNG, SVG)."""
    return (
        *write_table(rmsre_table(study), folder, f"{stem}_rmsre"),
        *write_table(particle_table(study), folder, f"{stem}_particles"),
        *write_figure(lmax_figure(study), folder, f"{stem}_rmsre"),
    )


def _draw_group(axis: Axes, study: LmaxStudy, group: str) -> None:
    values, (low, high) = 100 * study.rmsre(group), 100 * study.bands(group)
    for k, key in enumerate(study.keys):
        colour = COLOURS[k % len(COLOURS)]
        axis.fill_between(study.degrees, low[:, k], high[:, k], color=colour, alpha=0.15, linewidth=0)
        axis.plot(
            study.degrees,
            values[:, k],
            label=with_subscript(CATALOGUE[key].symbol),
            color=colour,
            marker=MARKERS[k % len(MARKERS)],
            markersize=3.5,
            linewidth=1.2,
        )
    axis.set_yscale("log")
    axis.set_title(f"{group or 'all particles'} (n = {len(study.of_group(group))})", fontsize="medium")
    axis.set_xlabel("$l_{max}$")
    axis.grid(True, which="major", alpha=0.3)
