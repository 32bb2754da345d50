"""Angle of repose against a varied value: one row a run, and the mean of the runs of each value."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import t as student_t

from regolith_studio.io.tables import Cell, Column, Table
from regolith_studio.messages import N_

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
    Column("filled_bulk_density", "kg/m^3"),
    Column("heap_bulk_density", "kg/m^3"),
    Column("coordination_number"),
    Column("max_overlap", "%"),
    Column("folder"),
)

MEAN_COLUMNS = (
    Column("varied"),
    Column("value"),
    Column("piles"),
    Column("angle", "deg"),
    Column("interval_low", "deg"),
    Column("interval_high", "deg"),
    Column("standard_deviation", "deg"),
    Column("filled_bulk_density", "kg/m^3"),
    Column("heap_bulk_density", "kg/m^3"),
    Column("coordination_number"),
)
CONFIDENCE = 0.95
"""Of the intervals of means."""


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
    return Table(N_("Angle of repose"), COLUMNS, tuple(_row(run) for run in study.runs))


def repose_means(study: ReposeStudy) -> Table | None:
    """One row a value: the mean angle over its runs with Student's interval of :data:`CONFIDENCE`, and the
    means of densities and contacts; ``None`` if no value was run more than once."""
    if all(len([run for run in study.runs if run.value == value]) < 2 for value in study.values):
        return None
    return Table(
        N_("Mean angle of repose"), MEAN_COLUMNS, tuple(_mean_row(study, value) for value in study.values)
    )


def _mean_row(study: ReposeStudy, value: float | str) -> tuple[Cell, ...]:
    """Of the runs of a value that became piles; no interval for a single one."""
    runs = [run for run in study.runs if run.value == value]
    piles = [run for run in runs if run.angle is not None]
    angles, n = study.angles(value), len(piles)
    mean = float(np.mean(angles)) if n else None
    low = high = deviation = None
    if mean is not None and n > 1:
        deviation = float(np.std(angles, ddof=1))
        half = float(student_t.ppf((1 + CONFIDENCE) / 2, n - 1)) * deviation / n**0.5
        low, high = mean - half, mean + half
    packings = [run.document.get("packing") or {} for run in piles]
    heaps = [each.get("heap") or {} for each in packings]
    means = (
        _mean([each.get("filled_bulk_density") for each in packings]),
        _mean([each.get("bulk_density") for each in heaps]),
        _mean([each.get("coordination_number") for each in heaps]),
    )
    return (runs[0].varied, value, n, mean, low, high, deviation, *means)


def _mean(values: Sequence[float | None]) -> float | None:
    """Of the values that are known."""
    known = [value for value in values if value is not None]
    return float(np.mean(known)) if known else None


def _row(run: ReposeStudyRun) -> tuple[Cell, ...]:
    measurement = run.document.get("measurement") or {"status": run.document["state"]}
    low, high = measurement.get("interval_deg", (None, None))
    paper = measurement.get("paper_sections", {})
    checks = run.document.get("checks") or {}
    overlap = checks.get("max_overlap")
    packing = run.document.get("packing") or {}
    heap = packing.get("heap") or {}
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
        packing.get("filled_bulk_density"),
        heap.get("bulk_density"),
        heap.get("coordination_number"),
        None if overlap is None else 100 * overlap,
        run.folder,
    )


def runs_from(documents: Sequence[tuple[str, float | str, str, dict[str, Any]]]) -> ReposeStudy:
    """A study of (varied, value, folder name, document) entries."""
    return ReposeStudy(
        tuple(
            ReposeStudyRun(varied, value, document["case"]["seed"], folder, document)
            for varied, value, folder, document in documents
        )
    )
