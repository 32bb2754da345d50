"""Descriptors of one particle, and how far those of one shape or sample are from those of another."""

from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from regolith_studio.descriptors.catalogue import CATALOGUE, DEFAULT_KEYS, LOSS_KEYS, ShapeCache
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_compound import ConvexCompound
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.steps import result_of


class Descriptors(Mapping[str, float]):
    """Values of descriptors by key, in the order of `CATALOGUE`; never changes.

    Raises ValueError if a key is not in the catalogue.
    """

    __slots__ = ("_values",)
    _values: dict[str, float]

    def __init__(self, values: Mapping[str, float]) -> None:
        _check_keys(values)
        object.__setattr__(self, "_values", {key: float(values[key]) for key in CATALOGUE if key in values})

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"Descriptors cannot be changed ({name})")

    def __reduce__(self) -> tuple[Callable[..., "Descriptors"], tuple[Any, ...]]:
        return Descriptors, (dict(self._values),)

    def __getitem__(self, key: str) -> float:
        return self._values[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __hash__(self) -> int:
        return hash(tuple(self._values.items()))

    def __repr__(self) -> str:
        return f"Descriptors({self._values})"


def describe(
    solid: Particle | Mesh | ConvexPolyhedron | ConvexCompound,
    keys: Iterable[str] | None = None,
    box_metric: str = "exact",
) -> Descriptors:
    """Descriptors of a closed, outward-oriented solid, in powers of its length unit.

    Parameters
    ----------
    solid
        In micrometres for particles; a compound counts as its union.
    keys
        Keys of `CATALOGUE`; by default all that are quick to work out (`DEFAULT_KEYS`).
    box_metric
        ``exact``, or ``trimesh`` for the heuristic box of the paper's program.

    Raises
    ------
    GeometryError
        If the solid has fewer than four faces, is flat or is inside out.
    ValueError
        If a key or the box metric is unknown.
    """
    return result_of(description_steps(solid, keys, box_metric))


def description_steps(
    solid: Particle | Mesh | ConvexPolyhedron | ConvexCompound,
    keys: Iterable[str] | None = None,
    box_metric: str = "exact",
) -> Generator[str, None, Descriptors]:
    """As :func:`describe`, with the label of each descriptor before it is worked out."""
    wanted = DEFAULT_KEYS if keys is None else tuple(keys)
    _check_keys(wanted)
    facts = ShapeCache(solid.mesh if isinstance(solid, Particle | ConvexCompound) else solid, box_metric)
    values = {}
    for key in wanted:
        yield CATALOGUE[key].label
        values[key] = CATALOGUE[key].compute(facts)
    return Descriptors(values)


def _check_keys(keys: Iterable[str]) -> None:
    unknown = [key for key in keys if key not in CATALOGUE]
    if unknown:
        raise ValueError(f"unknown descriptors {unknown}; the catalogue has {list(CATALOGUE)}")


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
