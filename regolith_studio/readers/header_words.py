"""Numbers in the headers of volumes, and where the voxels behind a header begin."""

import math
from pathlib import Path

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.readers.volume_format import VoxelHeader


def float_or_nan(word: str | bytes) -> float:
    """The number that a word is, or not a number."""
    try:
        return float(word)
    except ValueError:
        return math.nan


def start_before_end(path: Path, header: VoxelHeader, stored: np.dtype[np.generic]) -> int:
    """The byte at which voxels begin that end with their file.

    Raises
    ------
    FileError
        If the file is shorter than they are.
    """
    start = path.stat().st_size - math.prod(header.shape) * stored.itemsize
    if start < 0:
        raise FileError("is cut short: it holds fewer voxels than its header says.")
    return start
