"""Angle of repose: sections through a heap with the fitted flanks (Fig. 9), and angles against a value.

Calibration: the runs against each parameter, its posterior density, and its interval after each run.

Response surface of the angle of repose over shape statistics: one panel a statistic, and its files.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from regolith_studio.dem.angle_of_repose import PAPER_AZIMUTHS, ReposeMeasurement
from regolith_studio.dem.evaluation.profile import Profile, project, surface_profile
from regolith_studio.dem.evaluation.section import Section
from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.io.own_files import json_bytes
from regolith_studio.io.tables import write_table
from regolith_studio.studies.calibration import CONFIDENCE, density_of
from regolith_studio.studies.figures import with_subscript, write_figure
from regolith_studio.studies.repose import (
    ReposeStudy,
    ReposeSurface,
    repose_means,
    repose_table,
    surface_document,
    surface_table,
)
from regolith_studio.studies.repose_calibration import (
    ANGLE,
    ReposeCalibration,
    calibration_document,
    calibration_table,
    probabilities_of,
)
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

SURFACE_STEM = "response_surface"


def write_surface(surface: ReposeSurface, folder: Path) -> tuple[Path, ...]:
    """Table (CSV, JSON), terms and effects (JSON) and figure (PNG, SVG)."""
    terms = folder / f"{SURFACE_STEM}_terms.json"
    terms.write_bytes(json_bytes(surface_document(surface)))
    table = write_table(surface_table(surface), folder, SURFACE_STEM)
    return (*table, terms, *write_figure(surface_figure(surface), folder, SURFACE_STEM))


def surface_figure(fitted: ReposeSurface) -> Figure:
    """The surface along each statistic, all others at their means, with its interval; the runs as dots."""
    surface, n = fitted.surface, len(fitted.surface.factors)
    figure = Figure(figsize=(3.6 * n + 0.6, 3.4), layout="constrained")
    statistics = dict(zip(fitted.study.values, fitted.statistics, strict=True))
    for k, axis in enumerate(figure.subplots(1, n, squeeze=False, sharey=True)[0]):
        places = np.tile(surface.centre, (60, 1))
        places[:, k] = np.linspace(fitted.statistics[:, k].min(), fitted.statistics[:, k].max(), 60)
        mean, half = surface.predict(places)
        axis.plot(places[:, k], mean, color="0.3")
        axis.fill_between(places[:, k], mean - half, mean + half, color="0.3", alpha=0.2)
        for run in fitted.study.runs:
            if run.angle is not None:
                axis.plot(statistics[run.value][k], run.angle, "o", color="#0072b2", markersize=4)
        axis.set_xlabel(with_subscript(CATALOGUE[surface.factors[k]].symbol))
        axis.grid(True, alpha=0.3)
        if k == 0:
            axis.set_ylabel("angle of repose (°)")
    return figure


RUNS, POSTERIOR, WANTED = "#0072b2", "#009e73", "#e69f00"
CALIBRATION_STEM = "calibration"


def write_calibration_files(calibration: ReposeCalibration, folder: Path) -> tuple[Path, ...]:
    """``calibration.json``, the table of the runs (``runs.csv``, ``runs.json``) and the figure (PNG, SVG)."""
    document = folder / f"{CALIBRATION_STEM}.json"
    document.write_bytes(json_bytes(calibration_document(calibration)))
    table = write_table(calibration_table(calibration), folder, "runs")
    return (document, *table, *write_figure(calibration_figure(calibration), folder, CALIBRATION_STEM))


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
        _name_choices(axis, parameter.choices)
    if not calibration.is_informed(k):
        axis.set_title("not narrowed by the runs", fontsize="medium")
    elif parameter.choices:
        axis.bar(where, density, color=POSTERIOR, alpha=0.4)
    else:
        axis.fill_between(where, density, step="mid", color=POSTERIOR, alpha=0.4)
        axis.axvline(float(posterior.best[k]), color=POSTERIOR, label="best")
    if not parameter.choices:
        axis.axvline(calibration.next_values[k], color="0.3", linestyle=":", label="next run")
    axis.axhline(1.0, color="0.5", linewidth=0.8, linestyle="--", label="before the first run")
    axis.set_xlabel(_label(calibration, k))
    axis.set_ylabel("posterior density over prior")
    axis.legend(frameon=False)


def _draw_probabilities(axis: Axes, calibration: ReposeCalibration, k: int) -> None:
    """Of each choice, before the first and after each run."""
    parameter = calibration.parameters[k]
    probabilities = [probabilities_of(each, parameter, k) for each in calibration.posteriors]
    for name in parameter.choices:
        axis.plot(range(len(probabilities)), [each[name] for each in probabilities], "o-", label=name)
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
    if calibration.is_informed(k):
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


MILLIMETRE = 1e3
LEFT, RIGHT, BOTH = "#0072b2", "#e69f00", "#009e73"
"""Colours of the left flank, the right flank and the symmetric model, as in the paper's figure."""


def section_figure(points: FloatArray, diameters: FloatArray, measurement: ReposeMeasurement) -> Figure:
    """The x-z and y-z sections, of one without two flanks its surface; positions and diameters in metres."""
    figure = Figure(figsize=(10.5, 3.2), layout="constrained")
    axes, tops = figure.subplots(1, 2, sharey=True), []
    for axis, plane, azimuth in zip(axes, ("x-z", "y-z"), PAPER_AZIMUTHS, strict=True):
        section = measurement.section_at(azimuth)
        axis.set_xlabel(f"{plane[0]} (mm)")
        _draw_particles(axis, points, diameters, measurement.base, azimuth)
        if section is None:
            profile = _profile(points, diameters, measurement, azimuth)
            u, z = MILLIMETRE * profile.u, MILLIMETRE * profile.height
            axis.plot(u[z > 0.0], z[z > 0.0], "o", color="0.15", markersize=3)
            axis.set_title(f"{plane}: no two straight flanks, so no angle")
            reach, top = framed_profile(profile)
        else:
            _draw_fits(axis, section)
            axis.set_title(
                f"{plane}: {section.asymmetric.left.angle:.1f}° | {section.asymmetric.right.angle:.1f}°"
            )
            reach, top = framed(section)
        axis.set_xlim(-MILLIMETRE * reach, MILLIMETRE * reach)
        tops.append(MILLIMETRE * top)
    axes[0].set_ylim(0.0, max(tops))
    axes[0].set_ylabel("z (mm)")
    handles, labels = max((axis.get_legend_handles_labels() for axis in axes), key=lambda each: len(each[1]))
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False)
    low, high = measurement.interval
    figure.suptitle(
        f"Angle of repose {measurement.angle:.1f}° ({low:.1f}° to {high:.1f}°), "
        f"{measurement.n_particles:,} particles"
    )
    return figure


STEEP_REACH = 1.3
"""Half width of a picture in half widths of the heap, at most: nearly flat flanks meet the plate far away."""


def framed(section: Section) -> tuple[float, float]:
    """Half width and height of what a picture of a section should show, in metres: no far strays."""
    two, one, profile = section.asymmetric, section.symmetric, section.profile
    toes = [abs(line.intercept / line.slope) for line in (two.left, two.right)]
    reach = max(*toes, abs(one.apex[0]) + one.apex[1] / one.slope)
    heap = max(abs(profile.u[profile.first]), abs(profile.u[profile.last]))
    return min(1.15 * reach, STEEP_REACH * heap), 1.1 * max(two.apex[1], one.apex[1])


def framed_profile(profile: Profile) -> tuple[float, float]:
    """The same of a surface to which nothing could be fitted."""
    ends = profile.u[[profile.first, profile.last]]
    return 1.15 * float(np.abs(ends).max()), 1.1 * profile.top


def write_section_figure(
    points: FloatArray, diameters: FloatArray, measurement: ReposeMeasurement, folder: Path
) -> tuple[Path, Path]:
    """``sections.png`` and ``sections.svg``."""
    return write_figure(section_figure(points, diameters, measurement), folder, "sections")


def _profile(
    points: FloatArray, diameters: FloatArray, measurement: ReposeMeasurement, azimuth: float
) -> Profile:
    mean, settings = measurement.mean_diameter, measurement.settings
    discs = project(points, diameters, measurement.base, np.radians(azimuth), settings.slab * mean)
    return surface_profile(discs, mean, settings)


def _draw_particles(
    axis: Axes, points: FloatArray, diameters: FloatArray, base: float, azimuth: float
) -> None:
    discs = project(points, diameters, base, np.radians(azimuth))
    widths = 2 * MILLIMETRE * discs.radius
    grains = EllipseCollection(
        widths,
        widths,
        np.zeros_like(widths),
        units="xy",
        offsets=MILLIMETRE * np.column_stack([discs.u, discs.z]),
        offset_transform=axis.transData,
        facecolors="0.82",
        edgecolors="0.6",
        linewidths=0.2,
        rasterized=True,
    )
    axis.add_collection(grains)
    axis.set_aspect("equal")


def _draw_fits(axis: Axes, section: Section) -> None:
    u, z = MILLIMETRE * section.profile.u, MILLIMETRE * section.profile.height
    axis.plot(u[section.used], z[section.used], "o", color="0.15", markersize=3, label="surface in range")
    for cut in (section.low, section.high):
        axis.axhline(MILLIMETRE * cut, color="0.5", linewidth=0.6, linestyle=":")
    two, one = section.asymmetric, section.symmetric
    flanks = (("left flank", two.left, LEFT), ("right flank", two.right, RIGHT))
    for name, line, colour in flanks:
        ends = np.array([two.apex[0], -line.intercept / line.slope])
        axis.plot(
            MILLIMETRE * ends, MILLIMETRE * (line.slope * ends + line.intercept), color=colour, label=name
        )
    reach = one.apex[1] / one.slope
    roof = MILLIMETRE * np.array([one.apex[0] - reach, one.apex[0], one.apex[0] + reach])
    axis.plot(roof, [0.0, MILLIMETRE * one.apex[1], 0.0], "--", color=BOTH, label="symmetric")


def repose_study_figure(study: ReposeStudy) -> Figure:
    """Every run as a dot with its interval, the mean of the repeats as a line."""
    figure = Figure(figsize=(5.6, 3.8), layout="constrained")
    axis = figure.subplots()
    numeric = all(isinstance(value, int | float) for value in study.values)
    places = {value: float(value) if numeric else float(k) for k, value in enumerate(study.values)}
    for run in study.runs:
        if run.angle is not None:
            low, high = run.document["measurement"]["interval_deg"]
            reach = [[run.angle - low], [high - run.angle]]
            axis.errorbar(places[run.value], run.angle, yerr=reach, fmt="o", color="#0072b2", capsize=3)
    means = [
        (places[value], float(np.mean(study.angles(value)))) for value in study.values if study.angles(value)
    ]
    if means:
        axis.plot(*np.array(means).T, color="0.4", linewidth=1.0, linestyle="-" if numeric else "none")
    if not numeric:
        axis.set_xticks(list(places.values()), [str(value) for value in places])
        axis.margins(x=0.2)
    axis.set_xlabel(study.runs[0].varied.replace("_", " ") if study.runs else "")
    axis.set_ylabel("angle of repose (°)")
    axis.grid(True, alpha=0.3)
    return figure


def write_repose_study(study: ReposeStudy, folder: Path) -> tuple[Path, ...]:
    """Table (CSV, JSON) and figure (PNG, SVG), and a table of means where values were repeated."""
    means = repose_means(study)
    return (
        *write_table(repose_table(study), folder, "repose_study"),
        *(() if means is None else write_table(means, folder, "repose_study_means")),
        *write_figure(repose_study_figure(study), folder, "repose_study"),
    )


BUDGET_STEM = "uncertainty"
FIRST, TOTAL, DECIDED, OPEN = "#0072b2", "0.8", "#009e73", "0.8"


def write_uncertainty(budget: UncertaintyBudget, folder: Path) -> tuple[Path, ...]:
    """Tables of values and steps (CSV, JSON), all of it with the recipe (JSON), and the figure (PNG, SVG)."""
    document = folder / f"{BUDGET_STEM}.json"
    document.write_bytes(json_bytes(budget_document(budget)))
    tables = (
        *write_table(values_table(budget), folder, f"{BUDGET_STEM}_values"),
        *write_table(steps_table(budget), folder, f"{BUDGET_STEM}_steps"),
    )
    return (document, *tables, *write_figure(uncertainty_figure(budget), folder, BUDGET_STEM))


def uncertainty_figure(budget: UncertaintyBudget) -> Figure:
    """A panel for each descriptor of the simulated polyhedra, and one for the angle where there are heaps."""
    descriptors, angle = budget.descriptors, budget.angle
    n, rows = len(KEYS) + (angle is not None), len(descriptors.steps)
    if angle is not None:
        rows = max(rows, len(angle.effects) + 1)
    figure = Figure(figsize=(2.3 * n + 1.6, 0.3 * rows + 1.5), layout="constrained")
    panels = figure.subplots(1, n, squeeze=False)[0]
    for k, key in enumerate(KEYS):
        _draw_shares(panels[k], descriptors, key)
        if k:
            panels[k].set_yticklabels([])
    if angle is not None:
        _draw_angle(panels[-1], angle)
    return figure


def _draw_shares(axis: Axes, descriptors: DescriptorBudget, key: str) -> None:
    """First-order shares with their intervals, in front of the total ones."""
    k = OUTPUTS.index(("polyhedra", key))
    value, (low, high) = descriptors.nominal[k], descriptors.intervals[k]
    unit = {"um^2": " µm²", "um^3": " µm³"}.get(UNITS.get(key, ""), "")
    symbol = with_subscript(CATALOGUE[key].symbol)
    numbers = [f"{float(f'{each:.3g}'):,.9g}" for each in (value, low, high)]  # 129,000 in place of 1.29e+05
    axis.set_title(f"{symbol} = {numbers[0]}{unit}\n{numbers[1]} to {numbers[2]}", fontsize=9)
    places = np.arange(len(descriptors.steps))
    if (shares := descriptors.shares) is not None:
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
    axis.set_yticks(places, [step.label for step in descriptors.steps], fontsize=8)
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
        several = len(effect.step.levels) > 2
        names.append(f"{effect.step.label}: {effect.level}" if several else effect.step.label)
    axis.set_yticks(range(len(names)), names, fontsize=8)
    axis.yaxis.tick_right()
    axis.invert_yaxis()
    axis.axvline(0.0, color="0.5", linewidth=0.8)
    axis.set_xlabel("change (°)", fontsize=8)
    axis.grid(True, axis="x", alpha=0.3)
