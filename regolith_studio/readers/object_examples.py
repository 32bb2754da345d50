"""Examples for the classifier of objects: a table of voxels and classes."""

import csv
from pathlib import Path

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import display_name
from regolith_studio.readers.file_bytes import read_bytes

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
