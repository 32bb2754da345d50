"""The two files of a fitted sample: JSON says what the numbers are, NPZ holds them."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import InputError
from regolith_studio.harmonics.coefficients import CONVENTION, ShCoefficients
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.reference import Ellipsoid

FORMAT = "regolith-studio fit"


def write_fits(
    stem: Path, names: Sequence[str], fits: Sequence[HarmonicFit], unit: str = "um"
) -> tuple[Path, Path]:
    """Write ``stem.json`` and ``stem.npz``, all fits at the lowest degree among them."""
    stem.parent.mkdir(parents=True, exist_ok=True)
    text, numbers = Path(f"{stem}.json"), Path(f"{stem}.npz")
    document = fits_document(names, fits, unit) | {"arrays": numbers.name}
    text.write_text(json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n", "utf-8")
    arrays = fits_arrays(names, fits)
    with numbers.open("wb") as stream:
        np.savez_compressed(stream, **arrays)  # type: ignore[arg-type]
    return text, numbers


def fits_document(names: Sequence[str], fits: Sequence[HarmonicFit], unit: str = "um") -> dict[str, Any]:
    """What the JSON file holds."""
    return {
        "format": FORMAT,
        "version": 1,
        "convention": CONVENTION,
        "unit": unit,
        "l_max": _common_degree(fits),
        "particles": [
            _entry(name, fit.truncated(_common_degree(fits))) for name, fit in zip(names, fits, strict=True)
        ],
    }


def fits_arrays(names: Sequence[str], fits: Sequence[HarmonicFit]) -> dict[str, NDArray[Any]]:
    """What the NPZ file holds: names (n,), coefficients (n, (l_max + 1)^2), star_points (n, 3)."""
    l_max = _common_degree(fits)
    rows = [fit.coefficients.truncated(l_max).values for fit in fits]
    return {
        "names": np.array(list(names), dtype=np.str_),
        "coefficients": np.array(rows).reshape(len(fits), (l_max + 1) ** 2),
        "star_points": np.array([fit.star_point for fit in fits]).reshape(len(fits), 3),
    }


def fits_from(document: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> dict[str, HarmonicFit]:
    """The fits by name, from what the two files held.

    Raises
    ------
    InputError
        If they do not belong together or a coefficient is not finite.
    """
    entries, rows, points = document["particles"], arrays["coefficients"], arrays["star_points"]
    if not len(entries) == len(rows) == len(points):
        raise InputError(
            f"The fit names {len(entries)} particles but holds coefficients of {len(rows)}: its two files do "
            "not belong together."
        )
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
        "hidden_surface_share": fit.hidden_surface_share,
        "unrepresentable_volume_share": fit.unrepresentable_volume_share,
        "radial_error": fit.radial_error,
        "largest_radial_error": fit.largest_radial_error,
        "rule": fit.rule,
        "sampling_degree": fit.sampling_degree,
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
        hidden_surface_share=entry["hidden_surface_share"],
        unrepresentable_volume_share=entry["unrepresentable_volume_share"],
        radial_error=entry["radial_error"],
        largest_radial_error=entry["largest_radial_error"],
        reference=None if given is None else Ellipsoid(given["axes"], given["semi_axes"]),
        rule=entry["rule"],
        sampling_degree=entry["sampling_degree"],
        notes=tuple(entry["notes"]),
    )
