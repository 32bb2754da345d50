"""How well a pile's angle is known: a bootstrap over the directions of its flanks."""

import numpy as np

from regolith_studio.geometry.arrays import FloatArray

RESAMPLES = 2000
NEIGHBOURHOOD = 45.0
"""Degrees over which neighbouring directions see largely the same grains, and are drawn together."""


def bootstrap_interval(flanks: FloatArray, confidence: float, seed: int) -> tuple[float, float]:
    """Interval of the mean angle by a circular block bootstrap.

    Parameters
    ----------
    flanks
        Angle of the flank in each of equally spaced directions around the full circle, shape (k,);
        neighbours are correlated, hence the blocks.
    confidence
        Such as 0.95.

    Returns
    -------
    tuple
        Lower and upper end.
    """
    n = len(flanks)
    block = max(1, min(n, round(NEIGHBOURHOOD / 360.0 * n)))
    generator = np.random.default_rng(np.random.SeedSequence(seed))
    starts = generator.integers(n, size=(RESAMPLES, -(-n // block)))
    picks = ((starts[:, :, None] + np.arange(block)) % n).reshape(RESAMPLES, -1)[:, :n]
    tail = (1.0 - confidence) / 2
    low, high = np.quantile(flanks[picks].mean(axis=1), [tail, 1.0 - tail])
    return float(low), float(high)
