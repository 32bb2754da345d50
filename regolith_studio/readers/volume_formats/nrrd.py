"""NRRD: attached and detached headers; raw and gzip encodings (teem's format, versions 1 to 5)."""

import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import printable
from regolith_studio.readers.number_rows import float_or_nan
from regolith_studio.readers.settings import in_one_unit
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.header import (
    MIRRORED,
    SKEWED,
    OpenVolume,
    Sizes,
    VoxelHeader,
    hand_note,
    stated_edges,
    three_dimensions,
    voxel_type,
)
from regolith_studio.readers.voxels.stored import DeflatedVoxels, PlainVoxels, beside, start_before_end

MAX_HEADER_BYTES = 1 << 16
_TYPES = {
    "i1": ("signed char", "int8", "int8_t"),
    "u1": ("uchar", "unsigned char", "uint8", "uint8_t"),
    "i2": ("short", "short int", "signed short", "signed short int", "int16", "int16_t"),
    "u2": ("ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"),
    "i4": ("int", "signed int", "int32", "int32_t"),
    "u4": ("uint", "unsigned int", "uint32", "uint32_t"),
    "i8": (
        "longlong",
        "long long",
        "long long int",
        "signed long long",
        "signed long long int",
        "int64",
        "int64_t",
    ),
    "u8": ("ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"),
    "f4": ("float",),
    "f8": ("double",),
}
_TYPE = {name: kind for kind, names in _TYPES.items() for name in names}
_VECTOR = re.compile(r"\(([^()]*)\)|none", re.IGNORECASE)
_LEFT_HANDED = ("left-anterior-superior", "las", "3d-left-handed")
"""Spaces whose own axes are left-handed, without their forms with a time."""


def open_nrrd(path: Path, _options: Mapping[str, Any]) -> OpenVolume:
    """A three-dimensional array of plain numbers."""
    with path.open("rb") as file:
        head = file.read(MAX_HEADER_BYTES)
    fields, body = _fields(head)
    _check_encoding(fields)
    stored = _stored_type(fields)
    sizes = _whole_numbers(fields, "sizes")
    if len(sizes) != _whole_numbers(fields, "dimension", 1)[0]:
        raise FileError("is a broken NRRD: its dimension and its sizes do not agree.")
    size, unit, notes = _voxel_size(fields, sizes)
    header = VoxelHeader(three_dimensions(tuple(sizes[::-1])), voxel_type(stored), size, unit, None, notes)
    source, start = _data_file(path, fields, body)
    return _opened(source, start, fields, header, stored)


def _opened(
    source: Path, start: int, fields: dict[str, str], header: VoxelHeader, stored: np.dtype[Any]
) -> OpenVolume:
    encoding = fields.get("encoding", "").lower()
    skip = (
        int(fields.get("byte skip", "0")) if re.fullmatch(r"-?\d{1,15}", fields.get("byte skip", "0")) else -2
    )
    if _lines_to_skip(fields) or skip < -1:
        raise FileError("skips lines or bytes before its voxels in a way that is not read here.")
    if encoding == "raw":
        if skip == -1:
            start, skip = start_before_end(source, header, stored), 0
        return PlainVoxels(source, start + skip, header, stored)
    if skip == -1:
        raise FileError("counts its bytes from the end of a compressed stream, which cannot be.")
    return DeflatedVoxels(source, start, skip, header, stored)


def _check_encoding(fields: dict[str, str]) -> None:
    encoding = fields.get("encoding", "").lower()
    if not encoding:
        raise FileError("is a broken NRRD: it states no encoding (raw or gzip).")
    if encoding not in ("raw", "gz", "gzip"):
        raise FileError(f"is an NRRD in the encoding “{printable(encoding)[:20]}”; raw and gzip are read.")


def _fields(head: bytes) -> tuple[dict[str, str], int | None]:
    """The fields by name, and where the voxels begin (None for a header without them)."""
    end = re.search(rb"\r?\n\r?\n", head)
    if end is None and len(head) == MAX_HEADER_BYTES:
        raise FileError("is a broken NRRD: its header does not end.")
    lines = head[: end.start() if end else len(head)].decode("utf-8", "replace").splitlines()
    if not lines or not re.fullmatch(r"NRRD000[1-5]", lines[0]):
        raise FileError("is not an NRRD of versions 1 to 5.")
    fields: dict[str, str] = {}
    for number, line in enumerate(lines[1:], start=2):
        if line.startswith("#") or ":=" in line or not line.strip():
            continue
        name, colon, value = line.partition(":")
        if not colon:
            raise FileError(f"is a broken NRRD: line {number} of its header is not a field.")
        name = {
            "centers": "centerings",
            "datafile": "data file",
            "byteskip": "byte skip",
            "lineskip": "line skip",
        }.get(name.strip().lower(), name.strip().lower())
        if name in fields:
            raise FileError(f"is a broken NRRD: its header has the field “{printable(name)[:30]}” twice.")
        fields[name] = value.strip()
    return fields, end.end() if end else None


def _stored_type(fields: dict[str, str]) -> np.dtype[Any]:
    name = _needed(fields, "type").lower()
    if name not in _TYPE:
        raise FileError(f"holds “{printable(name)[:30]}” values; voxels are whole numbers or floats.")
    stored = np.dtype(_TYPE[name])
    endian = fields.get("endian", "").lower()
    if stored.itemsize > 1 and endian not in ("little", "big"):
        raise FileError("is a broken NRRD: it states no byte order.")
    return stored.newbyteorder(">" if endian == "big" else "<")


def _data_file(path: Path, fields: dict[str, str], body: int | None) -> tuple[Path, int]:
    if "data file" not in fields:
        if body is None:
            raise FileError("is cut short: it has a header and no voxels.")
        return path, body
    name = fields["data file"]
    if name.upper().startswith("LIST") or "%" in name:
        raise FileError("spreads its voxels over several files, which is not read here.")
    return beside(path, name.removeprefix("./")), 0


def _voxel_size(fields: dict[str, str], sizes: list[int]) -> tuple[Sizes | None, str | None, tuple[str, ...]]:
    """Edges of those axes that have more than one voxel, unless all of three have a direction."""
    kept = [axis for axis, edge in enumerate(sizes) if edge > 1 or len(sizes) == 3]
    names: Sequence[str | None] = _quoted(fields, "units")
    notes: tuple[str, ...] = ()
    if "space directions" in fields:
        vectors = [_vector(match) for match in _VECTOR.finditer(fields["space directions"])]
        vectors, unit = _in_space_unit(vectors, _quoted(fields, "space units"))
        names = [unit] * len(sizes) if unit else names
        edges = [math.hypot(*vector) if vector else math.nan for vector in vectors]
        notes = _about(np.array([v for v in vectors if len(v) == 3]), fields.get("space", ""))
    else:
        edges = [float_or_nan(word) for word in fields.get("spacings", "").split()]
        notes = hand_note(edges)
        names = names or list(dict.fromkeys(_quoted(fields, "space units")))[:1] * len(sizes)
    if len(edges) != len(sizes) or len(kept) != 3:
        return None, None, ()
    names = names if len(names) == len(sizes) else [None] * len(sizes)
    size, key = stated_edges([edges[axis] for axis in kept], [names[axis] for axis in kept])
    return size, key, notes if size else ()


def _in_space_unit(vectors: list[list[float]], names: list[str]) -> tuple[list[list[float]], str | None]:
    """Directions in one unit, from those in the units of the axes of space, and its key."""
    in_unit = in_one_unit([1.0] * len(names), names)
    if in_unit is None:
        return vectors, None
    factors, key = in_unit
    return [[x * factor for x, factor in zip(vector, factors, strict=False)] for vector in vectors], key


def _quoted(fields: dict[str, str], name: str) -> list[str]:
    return re.findall(r'"([^"]*)"', fields.get(name, ""))


def _about(vectors: np.ndarray, space: str) -> tuple[str, ...]:
    """Notes about axes that are skewed, or left-handed in their space."""
    if vectors.shape != (3, 3) or not np.isfinite(vectors).all():
        return ()
    lengths = np.linalg.norm(vectors, axis=1)
    if not lengths.all():
        return ()
    unit = vectors / lengths[:, None]
    skewed = np.abs(unit @ unit.T - np.eye(3)).max() > 1e-3
    hand = -1.0 if space.strip().lower().removesuffix("-time").removesuffix("t") in _LEFT_HANDED else 1.0
    return (*((SKEWED,) if skewed else ()), *((MIRRORED,) if hand * np.linalg.det(unit) < 0 else ()))


def _vector(match: re.Match[str]) -> list[float]:
    return [float_or_nan(word) for word in match[1].split(",")] if match[1] is not None else []


def _whole_numbers(fields: dict[str, str], name: str, count: int | None = None) -> list[int]:
    words = _needed(fields, name).split()
    if (
        not words
        or (count and len(words) != count)
        or not all(re.fullmatch(r"\d{1,18}", word) for word in words)
    ):
        raise FileError(
            f"is a broken NRRD: its field “{name}” is not {'a whole number' if count else 'whole numbers'}."
        )
    return [int(word) for word in words]


def _lines_to_skip(fields: dict[str, str]) -> bool:
    return fields.get("line skip", "0") != "0"


def _needed(fields: dict[str, str], name: str) -> str:
    if not fields.get(name):
        raise FileError(f"is a broken NRRD: its header has no field “{name}”.")
    return fields[name]


FORMAT = VolumeFormat(
    "nrrd", "an NRRD", (".nrrd", ".nhdr"), lambda head: head.startswith(b"NRRD000"), open_nrrd
)
