"""Angle of repose against shape statistics of datasets: a response surface with its tables."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.descriptors.describe import describe
from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.io.tables import Column, Table
from regolith_studio.messages import N_
from regolith_studio.studies.repose import ReposeStudy
from regolith_studio.studies.response_surface import CONFIDENCE, ResponseSurface, fit_response_surface


@dataclass(frozen=True, eq=False)
class ReposeSurface:
    """Runs of several datasets, the mean shape statistics of each, shape (n, k), and the surface."""

    study: ReposeStudy
    statistics: FloatArray
    surface: ResponseSurface


def shape_statistics(datasets: Sequence[Dataset], keys: Sequence[str]) -> FloatArray:
    """Weighted means of dimensionless descriptors over the simulated shapes of each dataset, shape (n, k).

    Raises
    ------
    InputError
        If a key is no dimensionless descriptor.
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

    Parameters
    ----------
    statistics
        Of each value of the study, shape (k,).

    Raises
    ------
    InputError
        If the runs do not suffice.
    """
    angles = {value: study.angles(value) for value in study.values}
    piles = [value for value in study.values if angles[value]]
    values = np.array([statistics[str(value)] for value in piles]).reshape(len(piles), len(keys))
    means = np.array([np.mean(angles[value]) for value in piles])
    rows = np.array([statistics[str(value)] for value in study.values])
    return ReposeSurface(study, rows, fit_response_surface(keys, values, means))


def surface_table(found: ReposeSurface) -> Table:
    """One row a dataset: its statistics, the mean angle of its runs, and that of the surface."""
    mean, half = found.surface.predict(found.statistics)
    angles = [found.study.angles(value) for value in found.study.values]
    columns = (
        Column("dataset"),
        *map(Column, found.surface.factors),
        Column("runs"),
        Column("angle", "deg"),
        Column("surface", "deg"),
        Column("surface_low", "deg"),
        Column("surface_high", "deg"),
    )
    rows = tuple(
        (str(value), *place.tolist(), len(own), float(np.mean(own)) if own else None, m, m - h, m + h)
        for value, place, own, m, h in zip(
            found.study.values, found.statistics, angles, mean.tolist(), half.tolist(), strict=True
        )
    )
    return Table(N_("Angle of repose against shape statistics"), columns, rows)


def surface_document(found: ReposeSurface) -> dict[str, Any]:
    """The terms of the surface and the effect of each statistic as JSON; angles in degrees."""
    surface = found.surface
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
