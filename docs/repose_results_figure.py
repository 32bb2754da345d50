"""Draws the results of heaps on Rapier from the tables in ``benchmarks/results``: docs/repose_results.md.

Usage: python docs/repose_results_figure.py
"""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy import stats

DOCS = Path(__file__).parent
RESULTS = DOCS.parent / "benchmarks" / "results"
BLUE, ORANGE = "#0072b2", "#e69f00"
CONFIDENCE = 0.95


def results(name: str) -> Any:
    """Content of a file of results."""
    return json.loads((RESULTS / name).read_text("utf-8"))


def draw_friction(axis: Axes) -> None:
    """Means of up to four heaps a friction, from the blind calibrations; one deviation for all heaps."""
    angles: dict[float, list[float]] = {}
    for each in results("blind_calibration.json")["sets"].values():
        for case, heaps in zip(each["calibrations"], each["angles_deg"], strict=True):
            angles[case["friction"]] = [angle for angle in heaps if angle is not None]
    freedom = sum(len(heaps) - 1 for heaps in angles.values())
    deviation = np.sqrt(sum(np.var(heaps) * len(heaps) for heaps in angles.values()) / freedom)
    half = stats.t.ppf((1 + CONFIDENCE) / 2, freedom) * deviation
    for friction, heaps in angles.items():
        axis.plot([friction] * len(heaps), heaps, ".", color=BLUE, alpha=0.35, markersize=4)
        axis.errorbar(
            friction, np.mean(heaps), half / np.sqrt(len(heaps)), fmt="o", color=BLUE, capsize=2, markersize=4
        )
    axis.set_xlabel("friction between particles")
    axis.set_title("20 facets, 1,000 particles")


def draw_facets(axis: Axes) -> None:
    """Means over the number of facets, at two numbers of particles."""
    for name, colour, label in (
        ("repose_shapes.json", BLUE, "1,000 particles"),
        ("repose_shapes_5000.json", ORANGE, "5,000 particles"),
    ):
        angles: dict[int, list[float]] = {}
        for run in results(name)["runs"]:
            if run["angle_deg"] is not None and run["coarsening"].isdigit():
                angles.setdefault(int(run["coarsening"]), []).append(run["angle_deg"])
        facets = sorted(angles)
        means = [np.mean(angles[each]) for each in facets]
        halves = [student(angles[each]) for each in facets]
        axis.errorbar(facets, means, halves, fmt="o-", color=colour, capsize=3, label=label)
    axis.set_xscale("log")
    axis.set_xticks([8, 12, 20, 40, 60], ["8", "12", "20", "40", "60"])
    axis.minorticks_off()
    axis.set_xlabel("facets of a particle")
    axis.set_title("friction 0.8")
    axis.legend(frameon=False)


def draw_populations(axis: Axes) -> None:
    """Means of up to three heaps of seven drawn populations, coloured by aspect ratio."""
    rows = results("population_heaps.json")["response_surface.json"]["rows"]
    x, angles, ratios = ([row[key] for row in rows] for key in ("sphericity", "angle", "aspect_ratio"))
    points = axis.scatter(x, angles, c=ratios, cmap="cividis", s=40, edgecolors="black", linewidths=0.5)
    axis.figure.colorbar(points, ax=axis, label="mean aspect ratio")
    axis.set_xlabel("mean sphericity of a population")
    axis.set_title("friction 0.8, 1,000 particles")


def student(values: Sequence[float]) -> float:
    """Half of Student's interval for a mean."""
    return float(stats.t.ppf((1 + CONFIDENCE) / 2, len(values) - 1) * stats.sem(values))


if __name__ == "__main__":
    figure = Figure(figsize=(12.6, 4.0), layout="constrained")
    axes = figure.subplots(1, 3)
    for axis, draw in zip(axes, (draw_friction, draw_facets, draw_populations), strict=True):
        draw(axis)
        axis.set_ylabel("angle of repose (°)")
        axis.title.set_fontsize("medium")
    figure.savefig(DOCS / "images" / "repose_results.png", dpi=110)
