"""Tables of particles: length, width and thickness, or descriptors of this program, by names of columns."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.readers.sandbox.parent import shared_sandbox
from regolith_studio.readers.units import FILE_UNITS, unit_factor

LENGTH, WIDTH, THICKNESS = "max_feret_diameter", "width", "thickness"
_POWERS = {"volume": 3, "sphericity": 0, "aspect_ratio": 0, "convexity": 0}
"""Of length; 1 for all others."""
SUFFIXES = (".csv", ".tsv")


@dataclass(frozen=True)
class ShapeTable:
    """Descriptors of particles.

    - ``name``: of the file without its ending.
    - ``columns``: values by keys of the catalogue, in micrometres, each of shape (n,).
    - ``notes``: sentences about rows that were left out.
    """

    name: str
    columns: Mapping[str, FloatArray]
    notes: tuple[str, ...] = ()


def read_shape_table(path: str | Path, unit: str = "um") -> ShapeTable:
    """The descriptors in a table, whose columns are found by their names, in any order and among others.

    Length, width and thickness give also the ratios of Zingg, and the volume of the ellipsoid with these axes
    where the table has no volume.

    ``path``: CSV, tab-separated or with semicolons; a row of names comes first. ``unit``: unit of lengths
    whose column names none, such as ``Length (mm)`` does.

    Raises FileError with one sentence if it cannot be read or has no such column.
    """
    path, factor = Path(path), unit_factor(unit)
    answer = shared_sandbox().request("named-columns", path)
    columns: dict[str, FloatArray] = {}
    for key, stated, values in zip(answer.header["keys"], answer.header["units"], answer.arrays, strict=True):
        scale = FILE_UNITS[stated] if stated else factor
        columns[key] = values * scale ** _POWERS.get(key, 1)
    if {LENGTH, WIDTH, THICKNESS} <= set(columns):
        length, width, thickness = (columns[key] for key in (LENGTH, WIDTH, THICKNESS))
        ratios = {"width_over_length": width / length, "thickness_over_width": thickness / width}
        columns = {"volume": np.pi / 6 * length * width * thickness, **columns, **ratios}
    return ShapeTable(
        path.stem,
        columns,
        tuple(answer.header["notes"]),
    )
