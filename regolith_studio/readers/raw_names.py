"""What the name of a raw file tells about its voxels: ``scan_512x512x300_uint16.raw``."""

import math
import re
from pathlib import Path

import numpy as np

from regolith_studio.readers.guard import checked_size
from regolith_studio.readers.volume_header import RawLayout

_EDGES = re.compile(r"(?<!\d)(\d{1,6})([x×_])(\d{1,6})\2(\d{1,6})(?!\d)", re.IGNORECASE)
_TYPE = re.compile(
    r"u?int(?:8|16|32|64)|float(?:32|64)|(?<!\d)(?:8|16|32)[-_ ]?bit|[ui](?:8|16|32)|f(?:32|64)",
    re.IGNORECASE,
)
_BIG = re.compile(r"(?<![a-z])(?:be|big(?:[-_ ]?endian)?|msb)(?![a-z])", re.IGNORECASE)
_BY_SIZE = {1: "uint8", 2: "uint16", 4: "float32", 8: "float64"}
_LONGEST_HEADER = 1 << 16


def layout_from_name(path: Path) -> RawLayout | None:
    """The layout that the file's name states and its size confirms, or None.

    The name must hold the voxels along x, y and z; the type may stand there too, and follows from the
    size otherwise. What the file has more than the voxels, up to 64 KiB, is a header before them.

    Raises
    ------
    FileError
        If there is no such file.
    """
    size = checked_size(path, largest=None)
    found = _EDGES.search(path.stem)
    if found is None:
        return None
    shape = (int(found[1]), int(found[3]), int(found[4]))
    voxels = math.prod(shape)
    if not voxels:
        return None
    dtype = _type_in(path.stem[: found.start()] + " " + path.stem[found.end() :])
    if dtype is None:
        dtype = _BY_SIZE.get(size // voxels)
    if dtype is None:
        return None
    offset = size - voxels * np.dtype(dtype).itemsize
    if not 0 <= offset <= _LONGEST_HEADER:
        return None
    return RawLayout(shape, dtype, "big" if _BIG.search(path.stem) else "little", offset)


def _type_in(text: str) -> str | None:
    """The voxel type that a name holds, as numpy calls it."""
    found = _TYPE.search(text)
    if found is None:
        return None
    word = found[0].lower()
    if word.startswith(("uint", "int", "float")):
        return word
    number = re.sub(r"\D", "", word)
    return {"u": "uint", "i": "int", "f": "float"}.get(word[0], "uint") + number
