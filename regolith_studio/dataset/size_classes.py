"""Any size distribution as a short list of diameters, without moving its number or its mass."""

from dataclasses import dataclass

import numpy as np

from regolith_studio.dataset.size_distribution import DiscreteSizes, SizeDistribution
from regolith_studio.geometry.arrays import FloatArray

QUANTILES = 20_000
"""How finely a continuous distribution is taken apart, evenly by number and as finely again by volume."""


@dataclass(frozen=True, eq=False)
class SizeClasses:
    """A few diameters that stand for a distribution.

    Parameters
    ----------
    diameters
        Ascending, in micrometres, shape (k,).
    number, mass
        Share of each by number and by mass (at one density), shape (k,); each adds up to 1.
    """

    diameters: FloatArray
    number: FloatArray
    mass: FloatArray


def size_classes(sizes: SizeDistribution, count: int = 16) -> SizeClasses:
    """At most `count` diameters with their shares by number and by mass.

    Discrete sizes that are few enough stay as they are. Others are gathered between evenly spaced
    logarithms; a class has the diameter whose volume is the mean of its particles', so that number
    and mass are both what they were.
    """
    diameters, number = _points(sizes)
    if len(diameters) > count:
        edges = np.geomspace(diameters[0], diameters[-1], count + 1)[1:-1]
        place = np.searchsorted(edges, diameters, side="right")
        shares = np.bincount(place, weights=number, minlength=count).astype(np.float64)
        cubes = np.bincount(place, weights=number * diameters**3, minlength=count).astype(np.float64)
        held = shares > 0.0
        diameters, number = np.cbrt(cubes[held] / shares[held]), shares[held]
    mass = number * (diameters / diameters[-1]) ** 3
    return SizeClasses(diameters, number / number.sum(), mass / mass.sum())


def _points(sizes: SizeDistribution) -> tuple[FloatArray, FloatArray]:
    """Diameters and number shares that stand for a distribution closely."""
    by_number = sizes.weighted("number")
    if isinstance(by_number, DiscreteSizes):
        shares = np.array(by_number.shares)
        return np.array(by_number.diameters_um)[shares > 0], shares[shares > 0]
    edges = np.linspace(0.0, 1.0, QUANTILES + 1)
    middle = (edges[1:] + edges[:-1]) / 2
    limits = np.unique(
        np.concatenate([by_number.quantile(middle), sizes.weighted("volume").quantile(middle)])
    )
    rising = np.concatenate([[0.0], by_number.cdf(limits[1:-1]), [1.0]])
    return np.asarray(np.sqrt(limits[1:] * limits[:-1])), np.diff(rising)
