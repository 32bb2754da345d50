"""Intervals of what is measured of a digitised grain, from errors on grains of known shape.

The table is ``grain_errors.json`` among the results of the benchmarks, by voxels across, noise and roundness.
"""

import json
import re
from collections.abc import Mapping
from functools import cache
from typing import Literal, get_args

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.particle import Particle, ScanOfGrain
from regolith_studio.resources import results_folder

KEYS = ("volume", "surface_area", "sphericity", "min_diameter", "max_diameter")
"""Descriptors that intervals are stated of; the first of the table's."""
ROUND = 1.25
"""Aspect ratio up to which a grain is nearly round: its box has no direction, so extents err more."""
Shape = Literal["round", "other"]
_CELL = re.compile(r"(\d+) voxels, noise (\d+) %")
_NUMBERS = 3
"""Of each descriptor in a row of the table: mean error and both ends of its interval, in percent."""


def intervals(measured: Mapping[str, float], scan: ScanOfGrain) -> dict[str, tuple[float, float]]:
    """Between which values the true ones lie in 90 % of grains, by key; nothing where too few were found.

    ``measured``: descriptors, those of :data:`KEYS` and the aspect ratio among them.
    """
    shape: Shape = "round" if measured["aspect_ratio"] < ROUND else "other"
    low, high = _errors(shape, scan.across, scan.noise, scan.follows_grey) / 100.0
    if not np.isfinite(low).all():
        return {}
    return {key: (measured[key] / (1 + high[k]), measured[key] / (1 + low[k])) for k, key in enumerate(KEYS)}


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
        sum(np.abs(_errors(shape, across, noise, surface)[:, area]).max() for shape in get_args(Shape))
        for surface in (True, False)
    )
    return bool(not grey > mask)


def _errors(shape: Shape, across: float, noise: float, grey: bool) -> FloatArray:
    """Ends of the relative errors in percent, shape (2, keys), interpolated in the table."""
    sizes, noises, table = _table(f"{shape}, {'grey' if grey else 'mask'}")
    place = np.interp(np.log(max(across, 1.0)), np.log(sizes), np.arange(len(sizes)))
    level = np.interp(noise, noises, np.arange(len(noises)))
    i, j = (min(int(at), n - 2) for at, n in ((place, len(sizes)), (level, len(noises))))
    u, v = place - i, level - j
    corner = table[i : i + 2, j : j + 2]
    rows = (1 - u) * corner[0] + u * corner[1]
    return np.asarray(((1 - v) * rows[0] + v * rows[1]).T)


@cache
def _table(name: str) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Voxels across, noise as a share, and ends of the errors, shape (sizes, noises, keys, 2)."""
    text = (results_folder() / "grain_errors.json").read_text(encoding="utf-8")
    rows = json.loads(text)[name]["rows"]
    cells: dict[tuple[float, float], FloatArray] = {}
    for cell, numbers in rows.items():
        match = _CELL.fullmatch(cell)
        assert match is not None, cell
        ends = np.reshape(numbers, (-1, _NUMBERS))[: len(KEYS), 1:]
        cells[float(match[1]), int(match[2]) / 100] = ends
    lost = np.full((len(KEYS), 2), np.nan)
    sizes, noises = (sorted({cell[axis] for cell in cells}) for axis in (0, 1))
    table = np.array([[cells.get((size, noise), lost) for noise in noises] for size in sizes])
    return np.array(sizes), np.array(noises), table
