"""Intervals of what is measured of a digitised grain, from errors on grains of known shape.

The table is ``grain_errors.json`` among the results of the benchmarks, by voxels across, noise and roundness:
of each descriptor the mean error and both ends of its interval, in percent.
"""

import json
import re
from collections import defaultdict
from collections.abc import Iterable, Mapping
from functools import cache
from typing import Any

import numpy as np
from scipy.special import stdtrit

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.particle import Particle, ScanOfGrain
from regolith_studio.resources import results_folder

KEYS = ("volume", "surface_area", "sphericity", "min_diameter", "max_diameter")
"""Descriptors that intervals are stated of; the first of the table's."""
MEAN_KEYS = (*KEYS, "aspect_ratio")
"""Descriptors that mean errors are stated of."""
_ROUND_ASPECT, _ROUND_SPHERICITY = 1.25, 0.93
"""Aspect ratio below and sphericity from which on a grain is nearly round: its box has no direction, so
extents err more. Edged grains, which err like others, differ from rough balls by their sphericity."""
SHAPES = ("round", "other")
_CELL = re.compile(r"(\d+) voxels, noise (\d+) %")


def intervals(measured: Mapping[str, float], scan: ScanOfGrain) -> dict[str, tuple[float, float]]:
    """Between which values the true ones lie in 90 % of grains, by key; nothing where too few were found.

    ``measured``: descriptors, those of :data:`MEAN_KEYS` among them.
    """
    name = _name(measured, scan.follows_grey)
    low, high = _errors(name, scan.across, scan.noise)[1:, : len(KEYS)]
    if not np.isfinite(low).all():
        return {}
    # Errors are relative to the truth, measured = (1 + error) truth: the largest error belongs to the lowest
    # value.
    return {key: (measured[key] / (1 + high[k]), measured[key] / (1 + low[k])) for k, key in enumerate(KEYS)}


def mean_errors(
    described: Iterable[Mapping[str, float]], scans: Iterable[ScanOfGrain | None]
) -> tuple[FloatArray, FloatArray]:
    """Mean relative errors of grains like these, and how well the mean over all of them is known.

    Errors have the shape (n, :data:`MEAN_KEYS`), NaN for grains without a scan or where too few were found.
    The standard deviations, by key, are those of the means in the cells of the table, which are independent.
    """
    errors: list[FloatArray] = []
    weights: defaultdict[tuple[str, int, int], float] = defaultdict(float)
    for measured, scan in zip(described, scans, strict=True):
        errors.append(np.full(len(MEAN_KEYS), np.nan))
        if scan is None:
            continue
        name = _name(measured, scan.follows_grey)
        errors[-1] = _errors(name, scan.across, scan.noise)[0]
        if np.isfinite(errors[-1]).all():
            for i, j, share in _corners(name, scan.across, scan.noise):
                weights[name, i, j] += share
    variance = np.zeros(len(MEAN_KEYS))
    for (name, i, j), weight in weights.items():
        _, low, high = _table(name)[2][i, j].T / 100.0
        n = _n_grains(name)
        # Cells hold prediction intervals, mean +- t s sqrt(1 + 1/n), solved here for s. The variance of
        # Student's t with n - 1 degrees of freedom, (n - 1) / (n - 3), is that of a mean whose s is an
        # estimate, too.
        deviation = 0.5 * (high - low) / (stdtrit(n - 1, 0.95) * np.sqrt(1 + 1 / n))
        variance += (weight / sum(weights.values()) * deviation) ** 2 * (n - 1) / (n - 3) / n
    return np.array(errors), np.sqrt(variance)


def stated_intervals(
    particle: Particle, measured: Mapping[str, float] | None
) -> dict[str, tuple[float, float]]:
    """:func:`intervals` of a grain by its key; nothing where its surface is not of grey values."""
    return {} if particle.scan is None or measured is None else intervals(measured, particle.scan)


def follows_grey(across: float, noise: float) -> bool:
    """Whether a surface that follows the grey values has an area nearer to the truth than that of the mask.

    Nearer is the surface whose interval of the area reaches less far from zero error, in the mean over round
    and other grains.
    """
    area = KEYS.index("surface_area")
    grey, mask = (
        sum(np.abs(_errors(f"{shape}, {surface}", across, noise)[1:, area]).max() for shape in SHAPES)
        for surface in ("grey", "mask")
    )
    # Not `grey <= mask`: where the table has no numbers both are NaN, and the grey values are followed.
    return bool(not grey > mask)


def _name(measured: Mapping[str, float], grey: bool) -> str:
    """Of the table of grains of this shape and surface."""
    is_round = measured["aspect_ratio"] < _ROUND_ASPECT and measured["sphericity"] >= _ROUND_SPHERICITY
    return f"{'round' if is_round else 'other'}, {'grey' if grey else 'mask'}"


def _errors(name: str, across: float, noise: float) -> FloatArray:
    """Mean relative error and ends of its interval, shape (3, keys), interpolated in the table."""
    table = _table(name)[2]
    rows = [weight * table[i, j] for i, j, weight in _corners(name, across, noise)]
    return np.asarray(np.sum(rows, axis=0).T / 100.0)


def _corners(name: str, across: float, noise: float) -> list[tuple[int, int, float]]:
    """Cells of the table around a grain, with the weights of the interpolation."""
    sizes, noises, _ = _table(name)
    place = np.interp(np.log(max(across, 1.0)), np.log(sizes), np.arange(len(sizes)))
    level = np.interp(noise, noises, np.arange(len(noises)))
    i, j = (min(int(at), n - 2) for at, n in ((place, len(sizes)), (level, len(noises))))
    u, v = float(place - i), float(level - j)
    return [(i + a, j + b, (u if a else 1 - u) * (v if b else 1 - v)) for a in (0, 1) for b in (0, 1)]


@cache
def _results() -> Any:
    return json.loads((results_folder() / "grain_errors.json").read_text(encoding="utf-8"))


def _n_grains(name: str) -> int:
    """In each cell of a table."""
    return int(_results()[name]["repeats"] * _results()[name]["shapes"])


@cache
def _table(name: str) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Voxels across, noise as a share, and mean and ends of the errors, shape (sizes, noises, keys, 3)."""
    rows = _results()[name]["rows"]
    cells: dict[tuple[float, float], FloatArray] = {}
    for cell, numbers in rows.items():
        match = _CELL.fullmatch(cell)
        assert match is not None, cell
        cells[float(match[1]), int(match[2]) / 100] = np.reshape(numbers, (-1, 3))[: len(MEAN_KEYS)]
    lost = np.full((len(MEAN_KEYS), 3), np.nan)
    sizes, noises = (sorted({cell[axis] for cell in cells}) for axis in (0, 1))
    table = np.array([[cells.get((size, noise), lost) for noise in noises] for size in sizes])
    return np.array(sizes), np.array(noises), table
