"""Avizo and Amira: scalar fields on uniform lattices; raw, as text, deflated and as run lengths of bytes."""

import re
import warnings
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import printable
from regolith_studio.readers.number_rows import float_or_nan
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.header import (
    OpenVolume,
    VoxelHeader,
    hand_note,
    stated_edges,
    three_dimensions,
    voxel_type,
)
from regolith_studio.readers.voxels.stored import DeflatedVoxels, InflatedStream, PlainVoxels

MAX_HEADER_BYTES = 1 << 20
_TYPES = {"byte": "u1", "short": "i2", "ushort": "u2", "int": "i4", "float": "f4", "double": "f8"}
_FIRST_LINE = re.compile(r"#\s*(?:AmiraMesh|Avizo)\b[^\n]*?\b(BINARY-LITTLE-ENDIAN|BINARY|ASCII)\b")
_FIELD = re.compile(
    r"^\s*Lattice\s*\{\s*(\w+)(\[\d+\])?\s+\w+\s*\}\s*=?\s*@(\d{1,4})(?:\((\w+)(?:,\s*(\d{1,18}))?\))?",
    re.MULTILINE,
)
_DAMAGED = "is damaged: its packed voxels are invalid; save it again."
_CUT = "is cut short: its voxels end too early; copy it again."
_RUN_BYTES = 1 << 16
_WORD_BYTES = 64


class RunLengthStream(InflatedStream):
    """Bytes as HxByteRLE: 1 to 127 and a byte to repeat, or 128 and more and so many bytes as they are."""

    _decoded = b""

    def _piece(self, most: int, may_end: bool = False) -> bytes:
        while not self._decoded:
            more = self._file.read(_RUN_BYTES)
            if not more:
                if may_end:
                    return b""
                raise FileError(_CUT)
            self._decode(self._waiting + more)
        piece, self._decoded = self._decoded[:most], self._decoded[most:]
        self.place += len(piece)
        return piece

    def _decode(self, data: bytes) -> None:
        place, parts = 0, []
        while place + 1 < len(data):
            count = data[place]
            end = place + 2 if count < 128 else place + 1 + count - 128
            if count in (0, 128):
                raise FileError(_DAMAGED)
            if end > len(data):
                break
            parts.append(data[place + 1 : end] * count if count < 128 else data[place + 1 : end])
            place = end
        self._decoded, self._waiting = b"".join(parts), data[place:]

    def check_end(self) -> None:
        """Do nothing: run lengths have no checksum."""


class TextStream(InflatedStream):
    """The bytes of voxels that are written as text."""

    _decoded = b""

    def __init__(self, path: Path, offset: int, stored: np.dtype[Any]) -> None:
        super().__init__(path, offset)
        self._stored = stored

    def _piece(self, most: int, may_end: bool = False) -> bytes:
        while not self._decoded:
            more = self._file.read(_RUN_BYTES)
            if not more and (may_end or not self._waiting.strip()):
                if may_end:
                    return b""
                raise FileError(_CUT)
            text = self._waiting + more
            end = max(text.rfind(b" "), text.rfind(b"\n")) + 1 if more else len(text)
            text, self._waiting = text[:end], text[end:]
            if len(self._waiting) > _WORD_BYTES:
                raise FileError("is damaged: its voxels are not numbers.")
            self._decoded = self._numbers(text.partition(b"\n@")[0]).tobytes()
        piece, self._decoded = self._decoded[:most], self._decoded[most:]
        self.place += len(piece)
        return piece

    def _numbers(self, text: bytes) -> np.ndarray:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")  # older numpy warns where newer raises
                numbers = np.fromstring(text.decode("latin-1"), sep=" ")
        except (ValueError, DeprecationWarning):
            raise FileError("is damaged: its voxels are not numbers.") from None
        voxels = numbers.astype(self._stored)
        if self._stored.kind != "f" and (voxels != numbers).any():
            raise FileError(f"is damaged: some of its voxels are no {self._stored.name}.")
        return voxels

    def check_end(self) -> None:
        """Do nothing: text has no checksum."""


def open_amira(path: Path, _options: Mapping[str, Any]) -> OpenVolume:
    """The first field of a uniform lattice."""
    with path.open("rb") as file:
        head = file.read(MAX_HEADER_BYTES)
    text = head.decode("latin-1")
    first = _FIRST_LINE.match(text)
    field = _FIELD.search(text)
    if first is None or field is None:
        raise FileError("is no Avizo or Amira file with a field of voxels on a lattice.")
    kind, vector, number, encoding, packed = field.groups()
    begin = re.compile(rf"^@{number}[ \t]*\r?\n", re.MULTILINE).search(text, field.end())
    if begin is None:
        raise FileError(f"is cut short: its header is not followed by the voxels @{number}.")
    header, stored = _header(text[: begin.start()], kind, vector, first[1])
    start = begin.end()
    if packed and start + int(packed) > path.stat().st_size:
        raise FileError(_CUT)
    if first[1] == "ASCII" and encoding is None:
        return DeflatedVoxels(path, start, 0, header, stored, partial(TextStream, stored=stored))
    if encoding is None:
        return PlainVoxels(path, start, header, stored)
    if encoding == "HxZip":
        return DeflatedVoxels(path, start, 0, header, stored)
    if encoding == "HxByteRLE" and stored.itemsize == 1:
        return DeflatedVoxels(path, start, 0, header, stored, RunLengthStream)
    raise FileError(
        f"has its voxels packed as “{printable(encoding)[:30]}”, which is not read; save it unpacked."
    )


def _header(text: str, kind: str, vector: str | None, form: str) -> tuple[VoxelHeader, np.dtype[Any]]:
    if vector is not None:
        raise FileError("holds several numbers a voxel; save one of them as greys.")
    if kind not in _TYPES:
        raise FileError(f"holds “{printable(kind)[:30]}” values; voxels are whole numbers or floats.")
    lattice = re.search(r"^\s*define\s+Lattice\s+([\d \t]{1,60}?)\s*$", text, re.MULTILINE)
    if lattice is None:
        raise FileError("is a broken Amira file: the size of its lattice is not stated in whole numbers.")
    coordinates = re.search(r'CoordType\s+"([^"\n]*)"', text)
    if coordinates is not None and coordinates[1] != "uniform":
        raise FileError(
            f"has a lattice of {printable(coordinates[1])[:30]} coordinates; resample it to a uniform one."
        )
    shape = three_dimensions(tuple(map(int, reversed(lattice[1].split()))))
    stored = np.dtype(_TYPES[kind]).newbyteorder(">" if form == "BINARY" else "<")
    edges = _signed_edges(text, shape)
    named = re.search(r'Coordinates\s+"([^"\n]*)"', text)
    name = named[1].encode("latin-1").decode("utf-8", "replace") if named else None
    size, unit = stated_edges(edges, [name] * 3) if edges else (None, None)
    return VoxelHeader(shape, voxel_type(stored), size, unit, None, hand_note(edges)), stored


def _signed_edges(text: str, shape: tuple[int, int, int]) -> list[float]:
    """Along x, y and z, or none; the bounding box reaches from the first voxel's centre to the last's."""
    box = re.search(r"BoundingBox\s+([^,\n}]*)", text)
    words = box[1].split() if box else []
    if len(words) != 6 or min(shape) < 2:
        return []
    low, high = words[::2], words[1::2]
    return [
        (float_or_nan(b) - float_or_nan(a)) / (n - 1) for a, b, n in zip(low, high, shape[::-1], strict=True)
    ]


def _recognises(head: bytes) -> bool:
    return _FIRST_LINE.match(head.decode("latin-1")) is not None


FORMAT = VolumeFormat("amira", "an Avizo or Amira field", (".am",), _recognises, open_amira)
