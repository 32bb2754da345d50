"""Weights of grains that ``extract`` wrote beside their meshes, into ``particles.csv``."""

import csv
import math
from pathlib import Path

WEIGHTS_FILE = "particles.csv"
LARGEST_TABLE = 256 * 1024**2


def weights_in(folder: Path) -> dict[str, float]:
    """Weight of each particle by its name; empty where the folder has no such table.

    A table that somebody else wrote, with no columns ``name`` and ``weight``, or without a positive
    number in the second, gives no weights: they are an addition to the meshes, not a part of them.
    """
    path = folder / WEIGHTS_FILE
    found: dict[str, float] = {}
    try:
        if not path.is_file() or path.stat().st_size > LARGEST_TABLE:
            return found
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = csv.DictReader(file)
            if not {"name", "weight"} <= set(rows.fieldnames or ()):
                return found
            for row in rows:
                weight = float(row["weight"] or 1.0)
                if row["name"] and 0.0 < weight < math.inf:
                    found[row["name"]] = weight
    except (OSError, ValueError, csv.Error):
        return {}
    return found
