"""How far the descriptors of one shape, or of a sample of shapes, are from those of another."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from regolith_studio.descriptors.catalogue import LOSS_KEYS


def relative_errors(
    reference: Mapping[str, float], other: Mapping[str, float], keys: Iterable[str] = LOSS_KEYS
) -> dict[str, float]:
    """|D(M) - D(P)| / D(M) of Eq. 8 for each descriptor key.

    Parameters
    ----------
    reference
        Descriptors of the measured shape M, none of them zero.
    other
        Descriptors of the shape P that stands for it.

    Raises
    ------
    ValueError
        If a reference value is zero.
    """
    return {key: abs(_signed_error(reference[key], other[key], key)) for key in keys}


def rmsre(
    references: Sequence[Mapping[str, float]],
    others: Sequence[Mapping[str, float]],
    keys: Iterable[str] = LOSS_KEYS,
) -> dict[str, float]:
    """Root of the mean squared relative error of Eq. 10 for each descriptor key, over pairs of shapes.

    Raises
    ------
    ValueError
        If there are no pairs, the lengths differ or a reference value is zero.
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
