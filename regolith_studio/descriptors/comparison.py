"""How far the descriptors of one shape, or of a sample of shapes, are from those of another.

Of a sample by the RMSRE (Eq. 10), with its bootstrap band over particles.
"""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.geometry.arrays import FloatArray


def relative_errors(
    reference: Mapping[str, float], other: Mapping[str, float], keys: Iterable[str] = LOSS_KEYS
) -> dict[str, float]:
    """|D(M) - D(P)| / D(M) of Eq. 8 for each descriptor key.

    ``reference``: descriptors of the measured shape M, none of them zero. ``other``: descriptors of the
    shape P that stands for it.

    Raises ValueError if a reference value is zero.
    """
    return {key: abs(_signed_error(reference[key], other[key], key)) for key in keys}


def rmsre(
    references: Sequence[Mapping[str, float]],
    others: Sequence[Mapping[str, float]],
    keys: Iterable[str] = LOSS_KEYS,
) -> dict[str, float]:
    """Root of the mean squared relative error of Eq. 10 for each descriptor key, over pairs of shapes.

    Raises ValueError if there are no pairs, the lengths differ or a reference value is zero.
    """
    if len(references) != len(others) or not references:
        raise ValueError(f"need pairs of descriptors, got {len(references)} and {len(others)}")
    return {key: _root_mean_square(references, others, key) for key in keys}


def _root_mean_square(
    references: Sequence[Mapping[str, float]], others: Sequence[Mapping[str, float]], key: str
) -> float:
    errors = [_signed_error(one[key], two[key], key) for one, two in zip(references, others, strict=True)]
    return float(np.sqrt(np.mean(np.square(errors))))


def _signed_error(reference: float, other: float, key: str) -> float:
    if reference == 0.0:
        raise ValueError(f"the reference value of {key} is zero, so no relative error exists")
    return (reference - other) / reference


N_RESAMPLES = 1000


def pooled_rmsre(errors: FloatArray, counts: ArrayLike) -> FloatArray:
    """RMSRE with each particle counted as often as each row of `counts` says; NaN where none has a value.

    ``errors``: shape (particles, rows, columns); NaN is left out. ``counts``: shape (b, particles). The
    result has shape (b, rows, columns).
    """
    weights = np.asarray(counts, dtype=np.float64)
    present = np.isfinite(errors)
    sums = np.tensordot(weights, np.where(present, errors, 0.0) ** 2, axes=1)
    members = np.tensordot(weights, present.astype(np.float64), axes=1)
    return np.asarray(np.sqrt(np.divide(sums, members, out=np.full_like(sums, np.nan), where=members > 0)))


def resampled_counts(n: int, seed: int) -> FloatArray:
    """How often each of `n` particles is drawn in each bootstrap sample, shape (N_RESAMPLES, n)."""
    if not n:  # multinomial refuses an empty list of shares
        return np.zeros((N_RESAMPLES, 0))
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    return np.asarray(rng.multinomial(n, np.full(n, 1.0 / n), N_RESAMPLES), dtype=np.float64)


def band_of(resampled: FloatArray, confidence: float) -> FloatArray:
    """Ends of the central band along the first axis, shape (2, ...); NaN where no sample has a value."""
    if not resampled.size:  # numpy.nanpercentile drops an axis of arrays without values
        return np.full((2, *resampled.shape[1:]), np.nan)
    tail = 50.0 * (1.0 - confidence)
    empty = np.isnan(resampled).all(axis=0)
    # numpy warns of columns that are nothing but NaN, and warnings are errors in our tests
    ends = np.asarray(np.nanpercentile(np.where(empty, 0.0, resampled), [tail, 100.0 - tail], axis=0))
    ends[:, empty] = np.nan
    return ends
