"""Gives mapped particles back the power that the cut at l_max has taken from the highest degrees.

A linear map moves power between neighbouring degrees. From a sample that ends at l_max nothing comes down
from above, so that the highest degrees of mapped particles are too weak, the particles too smooth, and their
shares of the convex hull, which a linear map does not change, too large.
"""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray

LOWEST_DEGREE = 3
"""Degrees below belong to the ellipsoid and are left alone."""
LIMITS = (0.8, 1.3)


def roughness_gain(mapped: FloatArray, measured: FloatArray) -> FloatArray:
    """A factor for each degree with which mapped particles have the mean power of the measured ones.

    Parameters
    ----------
    mapped, measured
        Coefficients of the radii of the same particles, shapes (n, (l_max + 1)^2).

    Returns
    -------
    Shape (l_max + 1,); ones for the lowest degrees.
    """
    ratio = np.sqrt(_power(measured) / np.maximum(_power(mapped), 1e-300))
    ratio[:LOWEST_DEGREE] = 1.0
    return np.asarray(np.clip(ratio, *LIMITS))


def _power(rows: FloatArray) -> FloatArray:
    """Mean over the particles of the sum of squares at each degree, sizes divided out."""
    starts = np.arange(round(rows.shape[1] ** 0.5)) ** 2
    return np.asarray(np.add.reduceat(((rows / rows[:, :1]) ** 2).mean(axis=0), starts))
