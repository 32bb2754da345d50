"""Budget of uncertainty: one bar a step for each descriptor and for the angle, and its files."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.io.json_text import json_bytes
from regolith_studio.io.tables import write_table
from regolith_studio.studies.figures.files import with_subscript, write_figure
from regolith_studio.studies.uncertainty import (
    KEYS,
    OUTPUTS,
    UNITS,
    AngleBudget,
    DescriptorBudget,
    UncertaintyBudget,
    budget_document,
    steps_table,
    values_table,
)

STEM = "uncertainty"
FIRST, TOTAL, DECIDED, OPEN = "#0072b2", "0.8", "#009e73", "0.8"


def write_uncertainty(budget: UncertaintyBudget, folder: Path) -> tuple[Path, ...]:
    """Tables of values and steps (CSV, JSON), all of it with the recipe (JSON), and the figure (PNG, SVG)."""
    document = folder / f"{STEM}.json"
    document.write_bytes(json_bytes(budget_document(budget)))
    tables = (
        *write_table(values_table(budget), folder, f"{STEM}_values"),
        *write_table(steps_table(budget), folder, f"{STEM}_steps"),
    )
    return (document, *tables, *write_figure(uncertainty_figure(budget), folder, STEM))


def uncertainty_figure(budget: UncertaintyBudget) -> Figure:
    """A panel for each descriptor of the simulated polyhedra, and one for the angle where there are heaps."""
    found, angle = budget.descriptors, budget.angle
    n, rows = len(KEYS) + (angle is not None), len(found.steps)
    if angle is not None:
        rows = max(rows, len(angle.effects) + 1)
    figure = Figure(figsize=(2.3 * n + 1.6, 0.3 * rows + 1.5), layout="constrained")
    panels = figure.subplots(1, n, squeeze=False)[0]
    for k, key in enumerate(KEYS):
        _draw_shares(panels[k], found, key)
        if k:
            panels[k].set_yticklabels([])
    if angle is not None:
        _draw_angle(panels[-1], angle)
    return figure


def _draw_shares(axis: Axes, found: DescriptorBudget, key: str) -> None:
    """First-order shares with their intervals, in front of the total ones."""
    k = OUTPUTS.index(("polyhedra", key))
    value, (low, high) = found.nominal[k], found.intervals[k]
    unit = {"um^2": " µm²", "um^3": " µm³"}.get(UNITS.get(key, ""), "")
    symbol = with_subscript(CATALOGUE[key].symbol)
    axis.set_title(f"{symbol} = {value:.3g}{unit}\n{low:.3g} to {high:.3g}", fontsize=9)
    places = np.arange(len(found.steps))
    if (shares := found.shares) is not None:
        first, total = 100 * shares[0][k], 100 * shares[1][k]
        axis.barh(places, np.maximum(total[:, 0], 0), color=TOTAL, label="total")
        spread = np.abs(first[:, 1:] - first[:, :1]).T
        axis.barh(places, np.maximum(first[:, 0], 0), height=0.45, color=FIRST, label="first order")
        axis.errorbar(first[:, 0], places, xerr=spread, fmt="none", ecolor="0.2", elinewidth=0.8)
        longest = max(first[:, 0].max(), total[:, 0].max())
        axis.set_xlim(min(-5.0, first[:, 1].min() - 3.0), max(105.0, longest + 5.0))
        if key == KEYS[0]:
            bars = axis.get_legend_handles_labels()[0]
            axis.figure.legend(handles=bars, loc="outside lower center", ncols=2, frameon=False, fontsize=8)
    axis.set_yticks(places, [step.label for step in found.steps], fontsize=8)
    axis.invert_yaxis()
    axis.set_xlabel("share of the variance (%)", fontsize=8)
    axis.grid(True, axis="x", alpha=0.3)


def _draw_angle(axis: Axes, angle: AngleBudget) -> None:
    """What each step does to the angle, with its interval; grey where it is not decided."""
    axis.set_title(f"angle = {angle.value:.1f}°\n± {angle.half_width:.1f}°", fontsize=9)
    names = ["Filling"]
    filling = angle.filling_variance**0.5
    if np.isfinite(filling):
        axis.barh(0, filling, color=DECIDED)
    for place, effect in enumerate(angle.effects, 1):
        axis.barh(place, effect.change, color=DECIDED if effect.decided else OPEN)
        axis.plot([effect.low, effect.high], [place, place], color="0.2", linewidth=0.8)
        names.append(effect.step.label)
    axis.set_yticks(range(len(names)), names, fontsize=8)
    axis.yaxis.tick_right()
    axis.invert_yaxis()
    axis.axvline(0.0, color="0.5", linewidth=0.8)
    axis.set_xlabel("change (°)", fontsize=8)
    axis.grid(True, axis="x", alpha=0.3)
