"""A vertical section through the pile, and the surface of the pile in it (section 3.3)."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import median_filter

from regolith_studio.dem.evaluation import EvaluationSettings
from regolith_studio.geometry.arrays import BoolArray, FloatArray, IntArray

BASE_SHARE = 0.01
"""The base is where this share of the particles would reach below: strays under the plate do not count."""


@dataclass(frozen=True, eq=False)
class Discs:
    """Particles projected on a vertical plane, as discs.

    ``u``, ``z``: centres along the section and above the base, shape (n,). ``radius``: shape (n,).
    """

    u: FloatArray
    z: FloatArray
    radius: FloatArray


@dataclass(frozen=True, eq=False)
class Profile:
    """Surface of the heap on equally spaced vertical lines.

    - ``u``: places of the lines, ascending, shape (m,).
    - ``raw``: top of the connected column above the base on each, 0 where there is none, shape (m,).
    - ``height``: `raw` after the rolling median, shape (m,).
    - ``first``, ``last``: the heap without strays: the lines from `first` to `last` (inclusive) about the
      highest point on which there is any particle.
    """

    u: FloatArray
    raw: FloatArray
    height: FloatArray
    first: int
    last: int

    @property
    def top(self) -> float:
        """Height of the pile."""
        return float(self.height.max())

    @property
    def width(self) -> float:
        """Width of the heap at its base."""
        return float(self.u[self.last] - self.u[self.first])


def base_level(points: FloatArray, diameters: FloatArray) -> float:
    """Height of the plate: 0, unless the lowest particles reach to more than a mean diameter from it.

    Centres of polyhedra that lie flat are less than half a diameter above the plate, so that the estimate
    from the lowest particles is up to a quarter of a diameter too low.
    """
    lowest = float(np.quantile(points[:, 2] - diameters / 2, BASE_SHARE))
    return 0.0 if abs(lowest) <= diameters.mean() else lowest


def project(
    points: FloatArray, diameters: FloatArray, base: float, azimuth: float, slab: float = 0.0
) -> Discs:
    """Discs of the particles on the vertical plane at `azimuth` (radians; 0 is x-z, pi/2 is y-z).

    The plane goes through the median of x and y. With a `slab`, only particles whose centre is at most
    half of it from the plane are projected; 0 projects all.
    """
    plan = points[:, :2] - np.median(points[:, :2], axis=0)
    along = np.array([np.cos(azimuth), np.sin(azimuth)])
    across = np.array([-along[1], along[0]])
    near = np.abs(plan @ across) <= slab / 2 if slab > 0 else np.ones(len(points), dtype=bool)
    return Discs(plan[near] @ along, points[near, 2] - base, diameters[near] / 2)


def surface_profile(discs: Discs, mean_diameter: float, settings: EvaluationSettings) -> Profile:
    """The surface: the top of the column that is connected to the base, then a rolling median."""
    width = settings.bin_width * mean_diameter
    start = float((discs.u - discs.radius).min())
    n_lines = int(np.ceil(((discs.u + discs.radius).max() - start) / width)) + 1
    places: FloatArray = (start + width * np.arange(n_lines)).astype(np.float64)
    raw = connected_tops(discs, places, width, settings.gap * mean_diameter)
    height = np.asarray(median_filter(raw, size=settings.median_window, mode="constant", cval=0.0))
    # A heap narrower than half of the window has a median of 0 everywhere.
    if not height.any():
        height = raw
    first, last = _heap(height)
    return Profile(places, raw, height, first, last)


def connected_tops(discs: Discs, places: FloatArray, width: float, gap: float) -> FloatArray:
    """Top of the connected column on each vertical line, shape (m,); 0 where nothing stands on the base.

    A line crosses a disc on a chord. Climbing from the base, the column ends below the first chord whose
    lower end is more than `gap` above everything before it.
    """
    line, disc = _crossings(discs, places, width)
    half = np.sqrt(np.maximum(discs.radius[disc] ** 2 - (discs.u[disc] - places[line]) ** 2, 0.0))
    bottom, top = discs.z[disc] - half, discs.z[disc] + half
    order = np.lexsort((bottom, line))
    line, bottom, top = line[order], bottom[order], np.maximum(top[order], 0.0)
    reached = _highest_before(line, top)
    loose = _after_first(line, bottom - reached > gap)
    tops = np.zeros(len(places))
    np.maximum.at(tops, line[~loose], top[~loose])
    return tops


def _crossings(discs: Discs, places: FloatArray, width: float) -> tuple[IntArray, IntArray]:
    """Lines and discs that cross: two arrays of indices."""
    low = np.ceil((discs.u - discs.radius - places[0]) / width).astype(np.int64)
    high = np.floor((discs.u + discs.radius - places[0]) / width).astype(np.int64)
    # A small disc may lie between two lines.
    counts = np.maximum(high - low + 1, 0)
    disc = np.repeat(np.arange(len(discs.u)), counts)
    step = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    line = np.clip(low[disc] + step, 0, len(places) - 1)
    return line.astype(np.int64), disc.astype(np.int64)


def _highest_before(line: IntArray, top: FloatArray) -> FloatArray:
    """Highest top among the earlier entries of the same line, at least 0; `line` is sorted."""
    # Each line is lifted above all lines before it, so that one running maximum begins anew with each.
    lift = (top.max(initial=0.0) + 1.0) * line
    running = np.maximum.accumulate(np.maximum(top + lift, lift))
    before = np.concatenate([[0.0], running[:-1]])
    return np.asarray(np.maximum(before - lift, 0.0))


def _after_first(line: IntArray, event: BoolArray) -> BoolArray:
    """Whether an entry is at or after the first event of its line; `line` is sorted."""
    total = np.cumsum(event)
    starts = np.searchsorted(line, line, side="left")
    before = np.where(starts > 0, total[starts - 1], 0)
    return np.asarray(total - before > 0)


def _heap(height: FloatArray) -> tuple[int, int]:
    """First and last of the lines about the highest one that hold anything."""
    peak = int(height.argmax())
    empty = np.flatnonzero(height <= 0.0)
    left, right = empty[empty < peak], empty[empty > peak]
    return (int(left[-1]) + 1 if len(left) else 0), (int(right[0]) - 1 if len(right) else len(height) - 1)
