"""VTK's XML files (.vtp, .vtu): points in text, base64 or appended raw, zlib-compressed or not."""

import base64
import binascii
import re
import zlib
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.readers.position_formats import ParsedPositions, PositionFormat

_TYPES = {
    "Int8": "i1", "UInt8": "u1", "Int16": "i2", "UInt16": "u2", "Int32": "i4", "UInt32": "u4",
    "Int64": "i8", "UInt64": "u8", "Float32": "f4", "Float64": "f8",
}  # fmt: skip
_SIZES = {"diameter": 1.0, "size": 1.0, "radius": 2.0, "rad": 2.0}
_APPENDED = re.compile(rb"<AppendedData[^>]*\bencoding=\"(\w+)\"[^>]*>\s*_")
MAX_BLOCKS = 1 << 20
MAX_ARRAY_BYTES = 1 << 31


def parse(data: bytes, _asked: tuple[str, ...]) -> ParsedPositions:
    """Points of all pieces, and their point data that is named diameter or radius."""
    if b"<!DOCTYPE" in data or b"<!ENTITY" in data:
        raise FileError("defines entities of its own, which no VTK file needs.")
    appended = _APPENDED.search(data)
    text = data if appended is None else data[: appended.start()] + b"</VTKFile>"
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError:
        raise FileError("is a broken VTK file: its XML is malformed.") from None
    if root.tag != "VTKFile" or root.get("type") not in ("PolyData", "UnstructuredGrid"):
        raise FileError("is not a VTK file of points: it is neither poly data nor an unstructured grid.")
    tail = (b"", b"") if appended is None else (appended[1], data[appended.end() :])
    source = _Source(_order(root), _header_type(root), root.get("compressor"), tail[0].decode(), tail[1])
    pieces = [_piece(piece, source) for piece in root.iter("Piece")]
    pieces = [piece for piece in pieces if len(piece[0])]
    if not pieces:
        raise FileError("holds no points.")
    sizes = [diameters for _, diameters in pieces if diameters is not None]
    together = np.concatenate(sizes) if len(sizes) == len(pieces) else None
    return ParsedPositions(np.concatenate([points for points, _ in pieces]), together)


@dataclass(frozen=True)
class _Source:
    """How the arrays of one file are packed, and its appended bytes."""

    order: str
    header: np.dtype[np.unsignedinteger]
    compressor: str | None
    encoding: str
    appended: bytes

    def values(self, array: ElementTree.Element) -> np.ndarray:
        """The numbers of a DataArray."""
        kind = _TYPES.get(array.get("type", ""))
        if kind is None:
            raise FileError("is a broken VTK file: an array has no type that is known.")
        dtype = np.dtype(kind).newbyteorder(self.order)  # type: ignore[arg-type]
        form = array.get("format", "ascii")
        if form == "ascii":
            return _numbers(array.text or "")
        if form == "binary":
            packed = "".join((array.text or "").split()).encode()
            data = self._unpacked(packed, encoded=True)
        elif form == "appended":
            place = array.get("offset", "")
            if not re.fullmatch(r"\d{1,15}", place) or int(place) >= len(self.appended):
                raise FileError("is cut short: an array lies beyond the end of the file.")
            data = self._unpacked(self.appended[int(place) :], encoded=self.encoding == "base64")
        else:
            raise FileError("is a broken VTK file: an array is in a form that is not known.")
        whole = len(data) // dtype.itemsize
        return np.frombuffer(data, dtype, whole).astype(np.float64)

    def _unpacked(self, data: bytes, encoded: bool) -> bytes:
        if self.compressor is None:
            size = int(self._header(data, 1, encoded)[0])
            return self._bytes(data, self.header.itemsize, size, encoded)
        if self.compressor != "vtkZLibDataCompressor":
            raise FileError("is packed by a compressor that is not read here; save it with zlib or none.")
        blocks, block_size, last = (int(number) for number in self._header(data, 3, encoded))
        if blocks > MAX_BLOCKS or blocks * block_size > MAX_ARRAY_BYTES:
            raise FileError("is a broken VTK file: an array has more blocks than can be.")
        sizes = self._header(data, 3 + blocks, encoded)[3:]
        place = (3 + blocks) * self.header.itemsize
        packed = self._compressed(data, place, int(sizes.sum()), encoded)
        ends = np.cumsum(sizes.astype(np.int64))
        parts = [
            packed[int(end - size) : int(end)] for end, size in zip(ends, sizes.astype(np.int64), strict=True)
        ]
        return b"".join(_inflated(part, max(block_size, last)) for part in parts)

    def _header(self, data: bytes, count: int, encoded: bool) -> np.ndarray:
        size = count * self.header.itemsize
        raw = _decoded(data[: -(-size // 3) * 4])[:size] if encoded else data[:size]
        if len(raw) < size:
            raise FileError("is cut short: an array ends in its header.")
        return np.frombuffer(raw, self.header, count)

    def _bytes(self, data: bytes, skip: int, size: int, encoded: bool) -> bytes:
        """Bytes of an uncompressed array, which is encoded together with its header."""
        end = skip + size
        raw = _decoded(data[: -(-end // 3) * 4]) if encoded else data[:end]
        if len(raw) < end:
            raise FileError("is cut short: an array ends too early.")
        return raw[skip:end]

    def _compressed(self, data: bytes, skip: int, size: int, encoded: bool) -> bytes:
        """Bytes of the compressed blocks, which are encoded apart from their header."""
        if encoded:
            start = -(-skip // 3) * 4
            raw = _decoded(data[start : start + -(-size // 3) * 4])
        else:
            raw = data[skip : skip + size]
        if len(raw) < size:
            raise FileError("is cut short: an array ends too early.")
        return raw[:size]


def _piece(piece: ElementTree.Element, source: _Source) -> tuple[np.ndarray, np.ndarray | None]:
    array = piece.find("Points/DataArray")
    if array is None:
        return np.empty((0, 3)), None
    values = source.values(array)
    if len(values) % 3:
        raise FileError("is a broken VTK file: its points are not three numbers each.")
    points = values.reshape(-1, 3)
    count = piece.get("NumberOfPoints", "")
    if count.isdigit() and int(count) != len(points):
        raise FileError(f"is cut short: it declares {int(count):,} points and has {len(points):,}.")
    for each in piece.findall("PointData/DataArray"):
        factor = _SIZES.get(each.get("Name", "").lower())
        if factor is not None and each.get("NumberOfComponents", "1") == "1":
            sizes = source.values(each) * factor
            if len(sizes) == len(points):
                return points, sizes
    return points, None


def _numbers(text: str) -> np.ndarray:
    try:
        return np.array([float(word) for word in text.split()])
    except ValueError:
        raise FileError("is a broken VTK file: a word stands where a number belongs.") from None


def _decoded(data: bytes) -> bytes:
    try:
        return base64.b64decode(data, validate=False)
    except (binascii.Error, ValueError):
        raise FileError("is a broken VTK file: its base64 cannot be decoded.") from None


def _inflated(part: bytes, most: int) -> bytes:
    try:
        return zlib.decompressobj().decompress(part, most)
    except zlib.error:
        raise FileError("is damaged: its compressed points cannot be unpacked.") from None


def _order(root: ElementTree.Element) -> str:
    return ">" if root.get("byte_order") == "BigEndian" else "<"


def _header_type(root: ElementTree.Element) -> np.dtype[np.unsignedinteger]:
    kind = "u8" if root.get("header_type") == "UInt64" else "u4"
    return np.dtype(kind).newbyteorder(_order(root))  # type: ignore[arg-type]


FORMAT = PositionFormat("vtk_xml", "a VTK file", (".vtp", ".vtu"), lambda head: b"<VTKFile" in head, parse)
