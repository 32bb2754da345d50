"""Angle of repose against what was varied: one row a run, repeats joined."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from regolith_studio.io.tables import Cell, Column, Table, write_table
from regolith_studio.studies.figure_files import write_figure

COLUMNS = (
    Column("varied"),
    Column("value"),
    Column("seed"),
    Column("status"),
    Column("angle", "deg"),
    Column("interval_low", "deg"),
    Column("interval_high", "deg"),
    Column("asymmetric_paper", "deg"),
    Column("symmetric_paper", "deg"),
    Column("n_particles"),
    Column("max_overlap", "%"),
    Column("seconds", "s"),
    Column("folder"),
)


@dataclass(frozen=True)
class ReposeStudyRun:
    """One run of a study.

    Parameters
    ----------
    varied, value
        What was varied, and to what; a number or a name.
    seed
        Of the run.
    folder
        Of the run, by name.
    document
        Its ``repose.json``.
    """

    varied: str
    value: float | str
    seed: int
    folder: str
    document: dict[str, Any]

    @property
    def angle(self) -> float | None:
        """In degrees, or ``None`` where there is no pile."""
        found = (self.document.get("measurement") or {}).get("angle_deg")
        return None if found is None else float(found)


@dataclass(frozen=True)
class ReposeStudy:
    """All runs of a study, in their order."""

    runs: tuple[ReposeStudyRun, ...]

    @property
    def values(self) -> tuple[float | str, ...]:
        """The values of what was varied, in order of appearance."""
        return tuple(dict.fromkeys(run.value for run in self.runs))

    def angles(self, value: float | str) -> list[float]:
        """Angles of the runs of one value that became piles."""
        return [run.angle for run in self.runs if run.value == value and run.angle is not None]


def repose_table(study: ReposeStudy) -> Table:
    """One row a run."""
    return Table("Angle of repose", COLUMNS, tuple(_row(run) for run in study.runs))


def _row(run: ReposeStudyRun) -> tuple[Cell, ...]:
    measurement = run.document.get("measurement") or {"status": run.document["state"]}
    low, high = measurement.get("interval_deg", (None, None))
    paper = measurement.get("paper_sections", {})
    checks = run.document.get("checks") or {}
    overlap = checks.get("max_overlap")
    return (
        run.varied,
        run.value,
        run.seed,
        measurement["status"],
        run.angle,
        low,
        high,
        paper.get("asymmetric", {}).get("mean_deg"),
        paper.get("symmetric", {}).get("mean_deg"),
        run.document["case"]["n_particles"],
        None if overlap is None else 100 * overlap,
        run.document["run"]["seconds"],
        run.folder,
    )


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
    """Table (CSV, JSON) and figure (PNG, SVG)."""
    return (
        *write_table(repose_table(study), folder, stem),
        *write_figure(repose_study_figure(study), folder, stem),
    )


def runs_from(documents: Sequence[tuple[str, float | str, str, dict[str, Any]]]) -> ReposeStudy:
    """A study of (varied, value, folder name, document) entries."""
    return ReposeStudy(
        tuple(
            ReposeStudyRun(varied, value, document["case"]["seed"], folder, document)
            for varied, value, folder, document in documents
        )
    )
