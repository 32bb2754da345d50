"""Coefficients as other programs write them, and fits as a JSON document with arrays.

Pure functions of arrays and documents; ``readers`` opens the files.
"""

from collections.abc import Mapping, Sequence
from math import isqrt
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.harmonics.coefficients import CONVENTION, ShCoefficients, degrees, orders
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.fit_options import MAX_TABLE_DEGREE
from regolith_studio.harmonics.radius_function import Ellipsoid

FORMAT = "regolith-studio fit"
_STATED = (
    *("hidden_surface_share", "unrepresentable_volume_share", "radial_error", "largest_radial_error"),
    *("rule", "sampling_degree"),
)
"""Fields of a fit that its document states as they are."""
SYMMETRY_TOLERANCE = 1e-4
"""Largest violation of a_{l,-m} = (-1)^m conj(a_lm), as a share of the largest coefficient."""


def fits_document(names: Sequence[str], fits: Sequence[HarmonicFit]) -> dict[str, Any]:
    """The JSON document of several fits, cut at the lowest degree among them."""
    return {
        "format": FORMAT,
        "version": 1,
        "convention": CONVENTION,
        "unit": "um",
        "l_max": _common_degree(fits),
        "particles": [
            _entry(name, fit.truncated(_common_degree(fits))) for name, fit in zip(names, fits, strict=True)
        ],
    }


def fits_arrays(names: Sequence[str], fits: Sequence[HarmonicFit]) -> dict[str, NDArray[Any]]:
    """The arrays that go with :func:`fits_document`.

    ``names`` of shape (n,), ``coefficients`` (n, (l_max + 1)^2) and ``star_points`` (n, 3).
    """
    l_max = _common_degree(fits)
    rows = [fit.coefficients.truncated(l_max).values for fit in fits]
    return {
        "names": np.array(list(names), dtype=np.str_),
        "coefficients": np.array(rows).reshape(len(fits), (l_max + 1) ** 2),
        "star_points": np.array([fit.star_point for fit in fits]).reshape(len(fits), 3),
    }


def fits_from(document: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> dict[str, HarmonicFit]:
    """The fits by name, from a document and its arrays: inverse of the two functions above.

    Raises InputError if they do not belong together or a coefficient is not finite.
    """
    entries, rows, points = document["particles"], arrays["coefficients"], arrays["star_points"]
    if not len(entries) == len(rows) == len(points):
        raise InputError(f"The fit names {len(entries)} particles but holds coefficients of {len(rows)}.")
    return {
        entry["name"]: _fit(entry, row, point)
        for entry, row, point in zip(entries, rows, points, strict=True)
    }


def _common_degree(fits: Sequence[HarmonicFit]) -> int:
    return min((fit.l_max for fit in fits), default=0)


def _entry(name: str, fit: HarmonicFit) -> dict[str, Any]:
    ellipsoid = fit.reference
    return {
        "name": name,
        "star_point": fit.star_point.tolist(),
        "mean_radius": fit.coefficients.mean_radius,
        **{field: getattr(fit, field) for field in _STATED},
        "reference": None
        if ellipsoid is None
        else {"axes": ellipsoid.axes.tolist(), "semi_axes": ellipsoid.semi_axes.tolist()},
        "notes": list(fit.notes),
    }


def _fit(entry: Mapping[str, Any], row: NDArray[Any], point: NDArray[Any]) -> HarmonicFit:
    given = entry["reference"]
    return HarmonicFit(
        ShCoefficients(row),
        point,
        reference=None if given is None else Ellipsoid(given["axes"], given["semi_axes"]),
        notes=tuple(entry["notes"]),
        **{field: entry[field] for field in _STATED},
    )


def from_complex_rows(rows: ArrayLike) -> ShCoefficients:
    """From rows ``l m Re Im`` of orthonormal complex harmonics with the Condon-Shortley phase.

    That is the convention of ``scipy.special.sph_harm_y`` and of the particle tables of NIST lineage.
    Rows may come in any order; those of m < 0 may be missing, coefficients that are not given are zero.

    ``rows``: shape (n, 4).

    Raises InputError if a number is missing or not finite, l and m are no degree and order, a row comes
    twice, or the rows of +m and -m contradict each other, so that the radius would not be real.
    """
    table, degree, order = _checked_rows(rows)
    values = table[:, 2] + 1j * table[:, 3]
    l_max = int(degree.max())
    full = np.zeros((l_max + 1) ** 2, dtype=np.complex128)
    full[degree**2 + degree + order] = values
    _check_symmetry(full, degree, order)
    return ShCoefficients(_real_from_complex(full))


def from_shtools_rows(rows: ArrayLike, norm: str = "4pi") -> ShCoefficients:
    """From rows ``l m C S`` (m >= 0) of SHTOOLS: real, without the Condon-Shortley phase.

    ``rows``: shape (n, 4). ``norm``: ``4pi`` (the default of SHTOOLS, where C_00 is the mean radius) or
    ``ortho``.

    Raises InputError if a number is not finite, l and m are no degree and order, a row comes twice, or the
    normalisation is unknown.
    """
    if norm not in ("4pi", "ortho"):
        raise InputError(f"The normalisation must be 4pi or ortho, got {norm!r}.")
    table, degree, order = _checked_rows(rows)
    if (order < 0).any():
        raise InputError("A table of SHTOOLS has no negative orders m.")
    values = np.zeros((int(degree.max()) + 1) ** 2)
    values[degree**2 + degree + order] = table[:, 2]
    wave = order > 0
    values[(degree**2 + degree - order)[wave]] = table[wave, 3]
    # Harmonics normalised to 4 pi are sqrt(4 pi) times the orthonormal ones.
    return ShCoefficients(values * (np.sqrt(4 * np.pi) if norm == "4pi" else 1.0))


def _checked_rows(rows: ArrayLike) -> tuple[FloatArray, IntArray, IntArray]:
    """The rows, their degrees and their orders."""
    table = np.asarray(rows, dtype=np.float64)
    if table.ndim != 2 or table.shape[1] != 4 or not len(table):
        raise InputError(f"A table of coefficients needs 4 numbers a row, got shape {table.shape}.")
    broken = np.flatnonzero(~np.isfinite(table).all(axis=1))
    if len(broken):
        first = "  ".join(f"{number:g}" for number in table[broken[0]])
        raise InputError(
            f"{len(broken)} of {len(table)} rows hold a number that is not finite, the first is row "
            f"{broken[0] + 1}: {first}."
        )
    degree, order = table[:, 0].astype(np.int64), table[:, 1].astype(np.int64)
    wrong = (degree != table[:, 0]) | (order != table[:, 1]) | (np.abs(order) > degree)
    wrong |= degree > MAX_TABLE_DEGREE
    if wrong.any():
        row = int(np.flatnonzero(wrong)[0])
        raise InputError(
            f"Row {row + 1} begins with {table[row, 0]:g} {table[row, 1]:g}: expected a degree l from 0 to "
            f"{MAX_TABLE_DEGREE} and an order m from -l to l."
        )
    index, counts = np.unique(degree**2 + degree + order, return_counts=True)
    if (counts > 1).any():
        k = int(index[counts > 1][0])
        raise InputError(f"The row l = {isqrt(k)}, m = {k - isqrt(k) ** 2 - isqrt(k)} comes more than once.")
    return table, degree, order


def _check_symmetry(full: np.ndarray, degree: IntArray, order: IntArray) -> None:
    """Refuse rows of +m and -m that contradict each other; fill in what only -m gave."""
    given = np.zeros(len(full), dtype=np.bool_)
    given[degree**2 + degree + order] = True
    every_degree, every_order = degrees(len(full)), orders(len(full))
    mirror = every_degree**2 + every_degree - every_order
    expected = np.where(every_order % 2, -1.0, 1.0) * np.conj(full[mirror])
    only_mirror = ~given & given[mirror]
    full[only_mirror] = expected[only_mirror]
    # A row of m = 0 is its own mirror: here the gap is twice its imaginary part, which must vanish, too.
    gap = np.abs(full - expected) * (given & given[mirror])
    if gap.max() > SYMMETRY_TOLERANCE * np.abs(full).max():
        k = int(gap.argmax())
        raise InputError(
            f"The rows l = {every_degree[k]}, m = {abs(every_order[k])} and m = {-abs(every_order[k])} "
            "contradict each other: the radius would not be a real number."
        )


def _real_from_complex(full: np.ndarray) -> FloatArray:
    """Real coefficients (n,) of complex ones (n,): c_cos = (-1)^m sqrt2 Re, c_sin = -(-1)^m sqrt2 Im."""
    degree, order = degrees(len(full)), orders(len(full))
    size = np.abs(order)
    # The rows of -m repeat those of +m, as `_check_symmetry` has made sure.
    half = full[degree**2 + degree + size]
    sign = np.where(size % 2, -1.0, 1.0) * np.sqrt(2)
    values = np.where(order > 0, sign * half.real, -sign * half.imag)
    return np.asarray(np.where(order == 0, half.real, values))
