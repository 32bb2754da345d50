"""Band-limited random fields on the sphere, made without any grid."""

from collections.abc import Mapping

import numpy as np

from regolith_studio.geometry.arrays import FloatArray

CEMENT_LIKE = {
    1: 0.021,
    2: 0.090,
    3: 0.034,
    4: 0.024,
    5: 0.0145,
    6: 0.0103,
    8: 0.0055,
    10: 0.0034,
    20: 0.0011,
}
"""sqrt(A_l)/mu of mineral grains after division by their size: the order of magnitude of real roughness."""


def power_law(lowest: int, highest: int, at_lowest: float, exponent: float) -> dict[int, float]:
    """Standard deviations a_l = at_lowest (l / lowest)^-exponent for l = lowest..highest."""
    return {degree: at_lowest * (degree / lowest) ** -exponent for degree in range(lowest, highest + 1)}


class SphereField:
    """An isotropic random field of which each degree l has variance (2 l + 1) a_l^2 / (4 pi) at a point.

    Each degree is a sum of zonal harmonics P_l(<u, v_j>) about random axes v_j with normal weights:
    every such sum is an exact spherical harmonic of degree l, and isotropic in distribution.

    Parameters
    ----------
    amplitudes
        Standard deviation a_l of one coefficient (orthonormal harmonics) for each degree l.
    generator
        Source of the axes and weights.
    """

    def __init__(self, amplitudes: Mapping[int, float], generator: np.random.Generator) -> None:
        self._terms = [
            (degree, *_axes(degree, amplitude, generator)) for degree, amplitude in sorted(amplitudes.items())
        ]

    def __call__(self, directions: FloatArray) -> FloatArray:
        """Values at unit `directions` of shape (n, 3); shape (n,)."""
        total = np.zeros(len(directions))
        for degree, axes, weights in self._terms:
            total += _legendre(degree, np.clip(directions @ axes.T, -1.0, 1.0)) @ weights
        return total


def _axes(degree: int, amplitude: float, generator: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Random axes (k, 3) and weights (k,): sum of w_j^2 <P_l^2> has the expectation that is asked."""
    count = 2 * (2 * degree + 1)
    axes = generator.standard_normal((count, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    scale = amplitude * (2 * degree + 1) / np.sqrt(4 * np.pi * count)
    return axes, scale * generator.standard_normal(count)


def _legendre(degree: int, cosine: FloatArray) -> FloatArray:
    """P_degree by its three-term recurrence."""
    before, now = np.ones_like(cosine), cosine
    if degree == 0:
        return before
    for step in range(2, degree + 1):
        before, now = now, ((2 * step - 1) * cosine * now - (step - 1) * before) / step
    return now
