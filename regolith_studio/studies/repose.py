"""Angle of repose against a varied value, or against shape statistics of datasets.

Of a value: one row a run, and the mean of the runs of each. Of statistics: a response surface, a polynomial
of one or more factors through scattered results, with intervals, by least squares (Box and Wilson, *J. R.
Stat. Soc. B* 13 (1951) 1): linear, or with all squares and products where there are twice as many different
points as terms.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement
from typing import Any

import numpy as np
from scipy.stats import t as student_t

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.descriptors.describe import describe
from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray
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

    - ``varied``, ``value``: what was varied, and to what; a number or a name.
    - ``seed``: of the run.
    - ``folder``: of the run, by name.
    - ``document``: its ``repose.json``.
    """

    varied: str
    value: float | str
    seed: int
    folder: str
    document: dict[str, Any]

    @property
    def angle(self) -> float | None:
        """In degrees, or ``None`` where there is no pile."""
        degrees = (self.document.get("measurement") or {}).get("angle_deg")
        return None if degrees is None else float(degrees)


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


INDEPENDENT = 0.02
"""Smallest singular value of the terms of a surface, for factors of range 1."""


@dataclass(frozen=True, eq=False)
class ResponseSurface:
    """A fitted polynomial in factors that are centred and divided by their ranges.

    - ``factors``: names.
    - ``centre``, ``width``: mean and range of each factor, shape (k,).
    - ``powers``: indices of the factors that each term multiplies; none for the constant.
    - ``coefficients``, ``covariance``: of the terms, shapes (p,) and (p, p).
    - ``degrees_of_freedom``: results less terms.
    - ``residual_deviation``: standard deviation of the results about the surface.
    """

    factors: tuple[str, ...]
    centre: FloatArray
    width: FloatArray
    powers: tuple[tuple[int, ...], ...]
    coefficients: FloatArray
    covariance: FloatArray
    degrees_of_freedom: int
    residual_deviation: float

    @property
    def is_quadratic(self) -> bool:
        return max(map(len, self.powers)) > 1

    def predict(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Mean results at `values`, shape (m, k), and half widths of their intervals of 95 %, shape (m,)."""
        terms = _terms((values - self.centre) / self.width, self.powers)
        variance = np.einsum("ij,jk,ik->i", terms, self.covariance, terms)
        return terms @ self.coefficients, self._quantile * np.sqrt(variance)

    def effects(self) -> tuple[FloatArray, FloatArray]:
        """Change of the result over the range of each factor at the centre, and half widths, shape (k,)."""
        own = [self.powers.index((k,)) for k in range(len(self.factors))]
        return self.coefficients[own], self._quantile * np.sqrt(np.diag(self.covariance)[own])

    @property
    def _quantile(self) -> float:
        return float(student_t.ppf((1.0 + CONFIDENCE) / 2, self.degrees_of_freedom))


def fit_response_surface(factors: Sequence[str], values: FloatArray, results: FloatArray) -> ResponseSurface:
    """Fit a surface.

    ``values``, ``results``: of the factors, shape (n, k), and what they gave, shape (n,).

    Raises InputError if there are too few different points, or the factors do not vary independently of each
    other.
    """
    n_points, n_linear = len(np.unique(values, axis=0)), len(factors) + 1
    if n_points <= n_linear:
        raise InputError(
            f"A response surface of {', '.join(factors)} needs results at {n_linear + 1} different points "
            f"or more, got {n_points}."
        )
    centre, width = values.mean(axis=0), np.ptp(values, axis=0)
    scaled = (values - centre) / np.where(width > 0.0, width, 1.0)
    linear: list[tuple[int, ...]] = [(), *((k,) for k in range(len(factors)))]
    quadratic = [*linear, *combinations_with_replacement(range(len(factors)), 2)]
    powers = quadratic if n_points >= 2 * len(quadratic) and _independent(scaled, quadratic) else linear
    if not _independent(scaled, powers):
        raise InputError(f"{', '.join(factors)} do not vary independently of each other; leave one out.")
    terms = _terms(scaled, powers)
    coefficients = np.asarray(np.linalg.lstsq(terms, results, rcond=None)[0], dtype=np.float64)
    freedom = len(results) - len(powers)
    variance = float(((results - terms @ coefficients) ** 2).sum() / freedom)
    covariance = np.asarray(variance * np.linalg.inv(terms.T @ terms), dtype=np.float64)
    return ResponseSurface(
        tuple(factors), centre, width, tuple(powers), coefficients, covariance, freedom, variance**0.5
    )


def _independent(scaled: FloatArray, powers: Sequence[tuple[int, ...]]) -> bool:
    return bool(np.linalg.matrix_rank(_terms(scaled, powers), tol=INDEPENDENT) == len(powers))


def _terms(scaled: FloatArray, powers: Sequence[tuple[int, ...]]) -> FloatArray:
    """Products of the factors, shape (n, p)."""
    return np.column_stack([scaled[:, list(each)].prod(axis=1) for each in powers])


@dataclass(frozen=True, eq=False)
class ReposeSurface:
    """Runs of several datasets, the mean shape statistics of each, shape (n, k), and the surface."""

    study: ReposeStudy
    statistics: FloatArray
    surface: ResponseSurface


def shape_statistics(datasets: Sequence[Dataset], keys: Sequence[str]) -> FloatArray:
    """Weighted means of dimensionless descriptors over the simulated shapes of each dataset, shape (n, k).

    Raises InputError if a key is no dimensionless descriptor.
    """
    known = [each.key for each in CATALOGUE.values() if each.dimension == 0]
    for key in keys:
        if key not in known:
            raise InputError(f"There is no shape statistic {key!r}; there are {', '.join(known)}.")
    values = [
        [[describe(each.shape, keys)[key] for key in keys] for each in dataset.representatives]
        for dataset in datasets
    ]
    return np.array(
        [dataset.weights @ np.array(rows) for dataset, rows in zip(datasets, values, strict=True)]
    )


def fit_repose_surface(
    study: ReposeStudy, statistics: Mapping[str, FloatArray], keys: Sequence[str]
) -> ReposeSurface:
    """The surface through the mean angle of each dataset, over its runs that became piles.

    Heaps of one dataset share its shapes, so that datasets, not heaps, are the independent results.

    ``statistics``: of each value of the study, shape (k,).

    Raises InputError if the runs do not suffice.
    """
    angles = {value: study.angles(value) for value in study.values}
    piles = [value for value in study.values if angles[value]]
    values = np.array([statistics[str(value)] for value in piles]).reshape(len(piles), len(keys))
    means = np.array([np.mean(angles[value]) for value in piles])
    rows = np.array([statistics[str(value)] for value in study.values])
    return ReposeSurface(study, rows, fit_response_surface(keys, values, means))


def surface_table(surface: ReposeSurface) -> Table:
    """One row a dataset: its statistics, the mean angle of its runs, and that of the surface."""
    mean, half = surface.surface.predict(surface.statistics)
    angles = [surface.study.angles(value) for value in surface.study.values]
    columns = (
        Column("dataset"),
        *map(Column, surface.surface.factors),
        Column("runs"),
        Column("angle", "deg"),
        Column("surface", "deg"),
        Column("surface_low", "deg"),
        Column("surface_high", "deg"),
    )
    rows = tuple(
        (str(value), *place.tolist(), len(own), float(np.mean(own)) if own else None, m, m - h, m + h)
        for value, place, own, m, h in zip(
            surface.study.values, surface.statistics, angles, mean.tolist(), half.tolist(), strict=True
        )
    )
    return Table(N_("Angle of repose against shape statistics"), columns, rows)


def surface_document(fitted: ReposeSurface) -> dict[str, Any]:
    """The terms of the surface and the effect of each statistic as JSON; angles in degrees."""
    surface = fitted.surface
    change, half = surface.effects()
    return {
        "kind": "quadratic" if surface.is_quadratic else "linear",
        "confidence": CONFIDENCE,
        "residual_standard_deviation_deg": surface.residual_deviation,
        "degrees_of_freedom": surface.degrees_of_freedom,
        "effects": [
            {
                "statistic": name,
                "mean": float(centre),
                "range": float(width),
                "change_over_range_deg": float(c),
                "interval_deg": [float(c - h), float(c + h)],
            }
            for name, centre, width, c, h in zip(
                surface.factors, surface.centre, surface.width, change, half, strict=True
            )
        ],
        "terms": [
            {"factors": [surface.factors[k] for k in powers], "coefficient_deg": float(value)}
            for powers, value in zip(surface.powers, surface.coefficients, strict=True)
        ],
    }
