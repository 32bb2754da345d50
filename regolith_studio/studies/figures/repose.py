"""Angle of repose: sections through a pile with the fitted flanks (Fig. 9), and angles against a value."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure

from regolith_studio.dem.angle_of_repose import PAPER_AZIMUTHS, ReposeMeasurement
from regolith_studio.dem.evaluation.profile import project
from regolith_studio.dem.evaluation.section import Section
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.io.tables import write_table
from regolith_studio.studies.figures.files import write_figure
from regolith_studio.studies.repose import ReposeStudy, repose_means, repose_table

MILLIMETRE = 1e3
LEFT, RIGHT, BOTH = "#0072b2", "#e69f00", "#009e73"
"""Colours of the left flank, the right flank and the symmetric model, as in the paper's figure."""


def section_figure(points: FloatArray, diameters: FloatArray, measurement: ReposeMeasurement) -> Figure:
    """The x-z and y-z sections; positions and diameters in metres."""
    figure = Figure(figsize=(10.5, 3.2), layout="constrained")
    axes = figure.subplots(1, 2, sharey=True)
    for axis, plane, azimuth in zip(axes, ("x-z", "y-z"), PAPER_AZIMUTHS, strict=True):
        section = measurement.section_at(azimuth)
        axis.set_xlabel(f"{plane[0]} (mm)")
        if section is None:
            axis.set_title(f"{plane}: no two flanks")
            continue
        _draw_particles(axis, points, diameters, measurement, section)
        _draw_fits(axis, section)
        axis.set_title(
            f"{plane}: {section.asymmetric.left.angle:.1f}° | {section.asymmetric.right.angle:.1f}°"
        )
        reach, top = framed(section)
        axis.set_xlim(-MILLIMETRE * reach, MILLIMETRE * reach)
        axis.set_ylim(0.0, MILLIMETRE * top)
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


def write_section_figure(
    points: FloatArray, diameters: FloatArray, measurement: ReposeMeasurement, folder: Path
) -> tuple[Path, Path]:
    """``sections.png`` and ``sections.svg``."""
    return write_figure(section_figure(points, diameters, measurement), folder, "sections")


def _draw_particles(
    axis: Axes, points: FloatArray, diameters: FloatArray, measurement: ReposeMeasurement, section: Section
) -> None:
    discs = project(points, diameters, measurement.base, np.radians(section.azimuth))
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


def write_repose_study(study: ReposeStudy, folder: Path, stem: str = "repose_study") -> tuple[Path, ...]:
    """Table (CSV, JSON) and figure (PNG, SVG), and a table of means where values were repeated."""
    means = repose_means(study)
    return (
        *write_table(repose_table(study), folder, stem),
        *(() if means is None else write_table(means, folder, f"{stem}_means")),
        *write_figure(repose_study_figure(study), folder, stem),
    )
