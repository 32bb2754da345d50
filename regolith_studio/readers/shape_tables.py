"""Tables by names of columns: of particles, and of examples for the classifier of objects."""

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.readers.error_messages import display_name, plural
from regolith_studio.readers.sandbox.parent import read_bytes, shared_sandbox
from regolith_studio.readers.settings import FILE_UNITS, unit_factor

LENGTH, WIDTH, THICKNESS = "max_feret_diameter", "width", "thickness"
_POWERS = {"volume": 3, "sphericity": 0, "aspect_ratio": 0, "convexity": 0}
"""Of length; 1 for all others."""
SUFFIXES = (".csv", ".tsv")


@dataclass(frozen=True)
class ShapeTable:
    """Descriptors of particles.

    - ``name``: of the file without its ending.
    - ``columns``: values by keys of the catalogue, in micrometres, each of shape (n,).
    - ``notes``: sentences about rows and columns that were left out or seem to be something else.
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
    notes: list[str] = list(answer.header["notes"])
    for key, stated, values in zip(answer.header["keys"], answer.header["units"], answer.arrays, strict=True):
        scale = FILE_UNITS[stated] if stated else factor
        columns[key] = values * scale ** _POWERS.get(key, 1)
    if {LENGTH, WIDTH, THICKNESS} <= set(columns):
        length, width, thickness = (columns[key] for key in (LENGTH, WIDTH, THICKNESS))
        unordered = int(((width > 1.001 * length) | (thickness > 1.001 * width)).sum())
        if unordered:
            notes.append(
                f"In {plural(unordered, 'row')} the width exceeds the length, or the thickness the width: "
                "the columns may mean other lengths."
            )
        ratios = {"width_over_length": width / length, "thickness_over_width": thickness / width}
        columns = {"volume": np.pi / 6 * length * width * thickness, **columns, **ratios}
    return ShapeTable(path.stem, columns, tuple(notes))


_LARGEST = 16 * 2**20
_COLUMNS = ("x", "y", "z", "class")


def read_object_examples(
    path: Path, classes: tuple[str, ...]
) -> tuple[tuple[tuple[int, int, int], int], ...]:
    """Voxels along x, y, z with the index of their class in `classes`, from a CSV file.

    Raises FileError if it cannot be read, has other columns than x, y, z and class, or a row that is no
    voxel and class.
    """
    try:
        lines = read_bytes(path, _LARGEST).decode("utf-8-sig").splitlines()
    except UnicodeDecodeError:
        raise FileError(f"{display_name(path)} is no table of examples: it is not text in UTF-8.") from None
    rows = csv.DictReader(lines, skipinitialspace=True)
    names = [name.strip() for name in rows.fieldnames or ()]
    if not set(_COLUMNS) <= set(names):
        raise FileError(
            f"{display_name(path)} is no table of examples: its first line names the columns x, y, z and "
            "class, separated by commas."
        )
    rows.fieldnames = names
    examples = []
    for row in rows:
        kind = (row["class"] or "").strip()
        try:
            x, y, z = (int(row[axis]) for axis in "xyz")
        except (TypeError, ValueError):
            kind, x, y, z = "", 0, 0, 0
        if kind not in classes:
            raise FileError(
                f"{display_name(path)}: line {rows.line_num} is no example; give three whole numbers and one "
                f"of {', '.join(classes)}."
            )
        examples.append(((x, y, z), classes.index(kind)))
    return tuple(examples)
