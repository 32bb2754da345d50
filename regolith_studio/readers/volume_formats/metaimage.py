"""MetaImage (MHA with its voxels, MHD with them in another file), as ITK writes it."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import printable
from regolith_studio.readers.number_rows import float_or_nan
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.header import (
    MIRRORED,
    OpenVolume,
    Sizes,
    VoxelHeader,
    stated_edges,
    three_dimensions,
    voxel_type,
)
from regolith_studio.readers.voxels.stored import DeflatedVoxels, PlainVoxels, beside, start_before_end

MAX_HEADER_BYTES = 1 << 16
_TYPES = {
    "MET_CHAR": "i1",
    "MET_UCHAR": "u1",
    "MET_SHORT": "i2",
    "MET_USHORT": "u2",
    "MET_INT": "i4",
    "MET_UINT": "u4",
    "MET_LONG": "i4",
    "MET_ULONG": "u4",
    "MET_LONG_LONG": "i8",
    "MET_ULONG_LONG": "u8",
    "MET_FLOAT": "f4",
    "MET_DOUBLE": "f8",
}
_TRUE = ("true", "t", "1", "yes")


def open_metaimage(path: Path, _options: Mapping[str, Any]) -> OpenVolume:
    """An image of three dimensions with one channel."""
    with path.open("rb") as file:
        fields, body = _fields(file.read(MAX_HEADER_BYTES))
    stored = _stored_type(fields)
    sizes = _sizes(fields)
    size, unit = _voxel_size(fields, sizes)
    notes = (MIRRORED,) if _is_mirrored(fields) else ()
    header = VoxelHeader(three_dimensions(tuple(sizes[::-1])), voxel_type(stored), size, unit, None, notes)
    source, start = _data_file(path, fields, body)
    if fields.get("compresseddata", "").lower() in _TRUE:
        return DeflatedVoxels(source, start, 0, header, stored)
    return PlainVoxels(source, _start(fields, source, start, header, stored), header, stored)


def _start(
    fields: dict[str, str], source: Path, start: int, header: VoxelHeader, stored: np.dtype[Any]
) -> int:
    """The byte of the first voxel; a header size of -1 counts from the end of the file."""
    text = fields.get("headersize", "0")
    if not re.fullmatch(r"-1|\d{1,15}", text):
        raise FileError(f"is a broken MetaImage: its header cannot have the size “{printable(text)[:20]}”.")
    if text != "-1":
        return start + int(text)
    return start_before_end(source, header, stored)


def _fields(head: bytes) -> tuple[dict[str, str], int]:
    """The fields by lower-case name, and where the header ends: after the line of the data file."""
    fields: dict[str, str] = {}
    place = 0
    for raw in head.splitlines(keepends=True):
        place += len(raw)
        line = raw.decode("utf-8", "replace").strip()
        if not line or line.startswith("#"):
            continue
        name, equals, value = line.partition("=")
        if not equals or not re.fullmatch(r"\s*\w+\s*", name):
            raise FileError("is a broken MetaImage: a line of its header is not a field.")
        name = name.strip().lower()
        if name in fields:
            raise FileError(
                f"is a broken MetaImage: its header has the field “{printable(name)[:30]}” twice."
            )
        fields[name] = value.strip()
        if name == "elementdatafile":
            return fields, place
    raise FileError("is a broken MetaImage: its header does not state where its voxels are.")


def _stored_type(fields: dict[str, str]) -> np.dtype[Any]:
    name = fields.get("elementtype", "").upper()
    if name.endswith("_ARRAY") or fields.get("elementnumberofchannels", "1") != "1":
        raise FileError("holds several channels; save one of them as greys.")
    if not name:
        raise FileError("is a broken MetaImage: its header has no field “ElementType”.")
    if name not in _TYPES:
        raise FileError(f"holds “{printable(name)[:30]}” values; voxels are whole numbers or floats.")
    if fields.get("binarydata", "true").lower() not in _TRUE:
        raise FileError("holds its voxels as text; save it as binary.")
    order = fields.get("binarydatabyteordermsb", fields.get("elementbyteordermsb", "false")).lower()
    return np.dtype(_TYPES[name]).newbyteorder(">" if order in _TRUE else "<")


def _sizes(fields: dict[str, str]) -> list[int]:
    words = fields.get("dimsize", "").split()
    if not words or not all(re.fullmatch(r"\d{1,18}", word) for word in words):
        raise FileError("is a broken MetaImage: its field “DimSize” is not whole numbers.")
    if fields.get("ndims") != str(len(words)):
        raise FileError("is a broken MetaImage: its NDims and its DimSize do not agree.")
    return [int(word) for word in words]


def _voxel_size(fields: dict[str, str], sizes: list[int]) -> tuple[Sizes | None, str | None]:
    """ElementSpacing; MetaImage has no field for the unit that ITK would write."""
    edges = [
        float_or_nan(word) for word in fields.get("elementspacing", fields.get("elementsize", "")).split()
    ]
    kept = [axis for axis, edge in enumerate(sizes) if edge > 1 or len(sizes) == 3]
    if len(edges) != len(sizes) or len(kept) != 3:
        return None, None
    name = fields.get("distanceunits", fields.get("elementspacingunit"))
    return stated_edges([edges[axis] for axis in kept], [name] * 3)


def _is_mirrored(fields: dict[str, str]) -> bool:
    text = next(
        (fields[name] for name in ("transformmatrix", "rotation", "orientation") if name in fields), ""
    )
    numbers = np.array([float_or_nan(word) for word in text.split()])
    return bool(numbers.size == 9 and np.isfinite(numbers).all() and np.linalg.det(numbers.reshape(3, 3)) < 0)


def _data_file(path: Path, fields: dict[str, str], body: int) -> tuple[Path, int]:
    name = fields["elementdatafile"]
    if name.upper() == "LOCAL":
        return path, body
    if name.upper().startswith("LIST") or "%" in name:
        raise FileError("spreads its voxels over several files, which is not read here.")
    return beside(path, name.removeprefix("./")), 0


def _recognises(head: bytes) -> bool:
    return re.match(rb"\s*(ObjectType\s*=\s*Image|NDims\s*=\s*\d)", head) is not None


FORMAT = VolumeFormat("metaimage", "a MetaImage", (".mha", ".mhd"), _recognises, open_metaimage)
