"""Calibration: the runs against each parameter, its posterior density, and its interval after each run."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from regolith_studio.io.json_text import json_bytes
from regolith_studio.io.tables import write_table
from regolith_studio.studies.calibration import CONFIDENCE, density_of
from regolith_studio.studies.figures.files import write_figure
from regolith_studio.studies.repose_calibration import (
    ANGLE,
    ReposeCalibration,
    calibration_document,
    calibration_table,
    probabilities_of,
)

RUNS, POSTERIOR, WANTED = "#0072b2", "#009e73", "#e69f00"
STEM = "calibration"


def write_calibration_files(calibration: ReposeCalibration, folder: Path) -> tuple[Path, ...]:
    """``calibration.json``, the table of the runs (``runs.csv``, ``runs.json``) and the figure (PNG, SVG)."""
    document = folder / f"{STEM}.json"
    document.write_bytes(json_bytes(calibration_document(calibration)))
    table = write_table(calibration_table(calibration), folder, "runs")
    return (document, *table, *write_figure(calibration_figure(calibration), folder, STEM))


def calibration_figure(calibration: ReposeCalibration) -> Figure:
    """A row a parameter, three columns: angles, density, intervals."""
    n = len(calibration.parameters)
    figure = Figure(figsize=(10.5, 3.1 * n), layout="constrained")
    for k, row in enumerate(figure.subplots(n, 3, squeeze=False)):
        _draw_angles(row[0], calibration, k)
        _draw_density(row[1], calibration, k)
        draw = _draw_probabilities if calibration.parameters[k].choices else _draw_intervals
        draw(row[2], calibration, k)
    return figure


def _draw_angles(axis: Axes, calibration: ReposeCalibration, k: int) -> None:
    """Angles of the runs; with a single parameter also the prediction, with its standard deviation."""
    target = next(each for each in calibration.targets if each.name == ANGLE)
    low, high = target.value - target.error, target.value + target.error
    axis.axhspan(low, high, color=WANTED, alpha=0.3, label="wanted")
    posterior = calibration.posterior
    if len(calibration.parameters) == 1:
        order = np.argsort(posterior.points[:, 0])
        where, mean = posterior.points[order, 0], posterior.predicted[order, 0]
        spread = posterior.deviations[order, 0]
        axis.fill_between(where, mean - spread, mean + spread, color=RUNS, alpha=0.2, label="predicted")
        if calibration.runs:
            seen = [run.result(ANGLE) for run in calibration.runs]
            axis.set_ylim(np.nanmin([low, *seen]) - 5.0, np.nanmax([high, *seen]) + 5.0)
    for run in calibration.runs:
        axis.errorbar(run.values[k], run.result(ANGLE), run.error(ANGLE), fmt="o", color=RUNS, capsize=3)
    if choices := calibration.parameters[k].choices:
        _name_choices(axis, choices)
    axis.set_xlabel(_label(calibration, k))
    axis.set_ylabel("angle of repose (°)")
    axis.legend(frameon=False)


def _draw_density(axis: Axes, calibration: ReposeCalibration, k: int) -> None:
    posterior, parameter = calibration.posterior, calibration.parameters[k]
    where, density = density_of(posterior, parameter, k)
    if parameter.choices:
        axis.bar(where, density, color=POSTERIOR, alpha=0.4)
        _name_choices(axis, parameter.choices)
    else:
        axis.fill_between(where, density, step="mid", color=POSTERIOR, alpha=0.4)
        axis.axvline(float(posterior.best[k]), color=POSTERIOR, label="best")
        axis.axvline(calibration.next_values[k], color="0.3", linestyle=":", label="next run")
    axis.axhline(1.0, color="0.5", linewidth=0.8, linestyle="--", label="before the first run")
    axis.set_xlabel(_label(calibration, k))
    axis.set_ylabel("posterior density over prior")
    axis.legend(frameon=False)


def _draw_probabilities(axis: Axes, calibration: ReposeCalibration, k: int) -> None:
    """Of each choice, before the first and after each run."""
    parameter = calibration.parameters[k]
    found = [probabilities_of(each, parameter, k) for each in calibration.posteriors]
    for name in parameter.choices:
        axis.plot(range(len(found)), [each[name] for each in found], "o-", label=name)
    axis.set_ylim(0.0, 1.0)
    axis.set_xlabel("runs")
    axis.xaxis.set_major_locator(MaxNLocator(integer=True))
    axis.set_ylabel(f"probability of the {_label(calibration, k)}")
    axis.legend(frameon=False)


def _draw_intervals(axis: Axes, calibration: ReposeCalibration, k: int) -> None:
    intervals = np.array([each.intervals[k] for each in calibration.posteriors])
    numbers = np.arange(len(intervals))
    axis.fill_between(numbers, *intervals.T, color=POSTERIOR, alpha=0.4)
    best = [float(each.best[k]) for each in calibration.posteriors]
    axis.plot(numbers[1:], best[1:], "o-", color=POSTERIOR)
    axis.set_title(f"best and {100 * CONFIDENCE:g} % interval", fontsize="medium")
    axis.set_xlabel("runs")
    axis.xaxis.set_major_locator(MaxNLocator(integer=True))
    axis.set_ylabel(_label(calibration, k))


def _name_choices(axis: Axes, choices: Sequence[str]) -> None:
    axis.set_xlim(-0.5, len(choices) - 0.5)
    axis.set_xticks(range(len(choices)), choices, rotation=20, ha="right", rotation_mode="anchor")


def _label(calibration: ReposeCalibration, k: int) -> str:
    return calibration.parameters[k].name.replace("_", " ")
