"""PLY: ASCII and binary of both byte orders, polygons and triangle strips."""

from array import array
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.readers.formats import MeshFormat, ParsedMesh
from regolith_studio.readers.polygons import triangulated

SCALARS = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("int64", "long"), "i8"),
    **dict.fromkeys(("uint64", "ulong"), "u8"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
ENCODINGS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
MAX_HEADER_BYTES = 1 << 16


@dataclass(frozen=True)
class Property:
    """A value of each row: a number, or where `counted_by` is given a list with its length before it."""

    name: str
    kind: str
    counted_by: str = ""


@dataclass(frozen=True)
class Element:
    """A table of the file: `count` rows of the same properties."""

    name: str
    count: int
    properties: tuple[Property, ...]

    def min_row_bytes(self, ascii_rows: bool) -> int:
        """Bytes that a row takes at least."""
        if ascii_rows:
            return 2 * max(len(self.properties), 1)
        return sum(np.dtype(p.counted_by or p.kind).itemsize for p in self.properties)


@dataclass(frozen=True)
class Header:
    """Encoding (``""`` for ASCII, ``"<"`` or ``">"``), elements, and where the rows begin."""

    encoding: str
    elements: tuple[Element, ...]
    body: int


def read_header(data: bytes) -> Header:
    """The header, checked against the size of the file.

    Raises FileError if it is not a PLY header, or declares more than the file holds.
    """
    if not data[:3] == b"ply" or data[3:4] not in (b"\n", b"\r", b" "):
        raise FileError("is not a PLY: it does not begin with the word “ply”.")
    words, body = _header_lines(data)
    encoding: str | None = None
    elements: list[tuple[str, int, list[Property]]] = []
    for line in words:
        match line:
            case ["format", name, "1.0"] if name in ENCODINGS:
                encoding = ENCODINGS[name]
            case ["element", name, count] if count.isascii() and count.isdigit() and len(count) < 16:
                elements.append((name, int(count), []))
            case ["property", *rest] if elements:
                elements[-1][2].append(_property(rest))
            case ["ply" | "comment" | "obj_info", *_] | []:
                pass
            case _:
                raise FileError(f"is not a valid PLY: its header has “{' '.join(line)[:60]}”.")
    if encoding is None:
        raise FileError("is not a valid PLY: its header names no format 1.0 (ascii or binary).")
    tables = tuple(Element(name, count, tuple(properties)) for name, count, properties in elements)
    _check_size(tables, len(data) - body, encoding == "")
    return Header(encoding, tables, body)


def _header_lines(data: bytes) -> tuple[list[list[str]], int]:
    lines: list[list[str]] = []
    place = 0
    while place < min(len(data), MAX_HEADER_BYTES):
        ends = [
            end
            for end in (data.find(b"\n", place, place + 4096), data.find(b"\r", place, place + 4096))
            if end >= 0
        ]
        if not ends:
            break
        end = min(ends)
        line = data[place:end].decode("latin-1").split()
        place = end + (2 if data[end : end + 2] == b"\r\n" else 1)
        if line == ["end_header"]:
            return lines, place
        lines.append(line)
    raise FileError("is not a valid PLY: its header has no line “end_header”.")


def _property(words: list[str]) -> Property:
    match words:
        case ["list", counter, kind, name] if SCALARS.get(counter, "f")[0] in "iu" and kind in SCALARS:
            return Property(name, SCALARS[kind], SCALARS[counter])
        case [kind, name] if kind in SCALARS:
            return Property(name, SCALARS[kind])
    raise FileError(f"is not a valid PLY: its header has the property “{' '.join(words)[:60]}”.")


def _check_size(elements: tuple[Element, ...], held: int, ascii_rows: bool) -> None:
    least = 0
    for element in elements:
        if not element.properties and element.count:
            raise FileError(f"is not a valid PLY: its element “{element.name}” has no properties.")
        least += element.count * element.min_row_bytes(ascii_rows)
        if least > held + 2:
            raise FileError(
                f"is cut short: it declares {element.count:,} rows of “{element.name}”, "
                f"at least {least:,} bytes, and has {held:,}; copy or export it again."
            )


@dataclass
class Columns:
    """The columns of one element: numbers, shape (count,), and lists as flat values with their sizes."""

    numbers: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    lists: dict[str, tuple[NDArray[np.float64], NDArray[np.int64]]] = field(default_factory=dict)


def binary_columns(data: bytes, place: int, element: Element, order: str) -> tuple[Columns, int]:
    """The element's columns and the place after it; `order` is ``"<"`` or ``">"``.

    Raises FileError if the rows go beyond the end of the file.
    """
    if element.count == 0:
        return _empty(element), place
    regular = _regular_dtype(data, place, element, order)
    end = place + element.count * regular.itemsize
    if end <= len(data):
        table = np.frombuffer(data, dtype=regular, count=element.count, offset=place)
        if all(
            (table[f"n{i}"] == table[f"n{i}"][0]).all()
            for i, p in enumerate(element.properties)
            if p.counted_by
        ):
            return _from_table(table, element), end
    if not any(p.counted_by for p in element.properties):
        raise _cut_short(element)
    return _walk_binary(data, place, element, order)


def ascii_columns(words: list[bytes], place: int, element: Element) -> tuple[Columns, int]:
    """The element's columns and the index of the word after it.

    Raises FileError if words are missing or are no numbers.
    """
    if element.count == 0:
        return _empty(element), place
    try:
        if not any(p.counted_by for p in element.properties):
            width = len(element.properties)
            end = place + element.count * width
            if end > len(words):
                raise _cut_short(element)
            table = np.array([float(word) for word in words[place:end]]).reshape(element.count, width)
            return Columns({p.name: table[:, i] for i, p in enumerate(element.properties)}), end
        return _walk_words(words, place, element)
    except ValueError:
        raise FileError(
            f"is not a valid PLY: a row of “{element.name}” holds something else than numbers."
        ) from None


def trimmed_rows(lines: list[list[bytes]], elements: tuple[Element, ...]) -> list[bytes] | None:
    """The words that the header declares, one row per line; ``None`` if a line has fewer."""
    words: list[bytes] = []
    if sum(element.count for element in elements) > len(lines):
        return None
    rows = iter(lines)
    for element in elements:
        for _ in range(element.count):
            row, needed = next(rows), 0
            for p in element.properties:
                if needed >= len(row) or (p.counted_by and not row[needed].isdigit()):
                    return None
                needed += 1 + int(row[needed]) if p.counted_by else 1
            if needed > len(row):
                return None
            words += row[:needed]
    return words


def _empty(element: Element) -> Columns:
    columns = Columns()
    for p in element.properties:
        if p.counted_by:
            columns.lists[p.name] = (np.zeros(0), np.zeros(0, dtype=np.int64))
        else:
            columns.numbers[p.name] = np.zeros(0)
    return columns


def _cut_short(element: Element) -> FileError:
    return FileError(
        f"is cut short: it ends before the {element.count:,} rows of “{element.name}” that it declares; "
        "copy or export it again."
    )


def _regular_dtype(data: bytes, place: int, element: Element, order: str) -> np.dtype[np.void]:
    """The record of a row if all rows' lists are as long as those of the first."""
    fields: list[tuple[str, str, tuple[int, ...]]] = []
    for i, p in enumerate(element.properties):
        if p.counted_by:
            size = _count_at(data, place, order + p.counted_by, element)
            fields.append((f"n{i}", order + p.counted_by, ()))
            place += np.dtype(p.counted_by).itemsize + size * np.dtype(p.kind).itemsize
            fields.append((f"v{i}", order + p.kind, (size,)))
        else:
            place += np.dtype(p.kind).itemsize
            fields.append((f"v{i}", order + p.kind, ()))
    return np.dtype(fields)


def _count_at(data: bytes, place: int, kind: str, element: Element) -> int:
    width = np.dtype(kind).itemsize
    if place + width > len(data):
        raise _cut_short(element)
    count = int.from_bytes(
        data[place : place + width], "little" if kind[0] == "<" else "big", signed=kind[1] == "i"
    )
    if place + width + count > len(data):
        raise _cut_short(element)
    if count < 0:
        raise FileError(f"is not a valid PLY: a row of “{element.name}” has a list of {count:,} values.")
    return count


def _from_table(table: NDArray[np.void], element: Element) -> Columns:
    columns = Columns()
    for i, p in enumerate(element.properties):
        values = table[f"v{i}"]
        if p.counted_by:
            sizes = np.full(len(table), values.shape[1], dtype=np.int64)
            columns.lists[p.name] = (values.astype(np.float64).ravel(), sizes)
        else:
            columns.numbers[p.name] = values.astype(np.float64)
    return columns


def _walk_binary(data: bytes, place: int, element: Element, order: str) -> tuple[Columns, int]:
    """Row by row, where lists differ in length."""

    def take_count(p: Property, _row: int) -> int:
        nonlocal place
        count = _count_at(data, place, order + p.counted_by, element)
        place += np.dtype(p.counted_by).itemsize
        return count

    def take(p: Property, count: int) -> Sequence[float]:
        nonlocal place
        start, place = place, place + count * np.dtype(p.kind).itemsize
        if place > len(data):
            raise _cut_short(element)
        values: list[float] = np.frombuffer(data, order + p.kind, count, start).tolist()
        return values

    return _walk(element, take_count, take), place


def _walk_words(words: list[bytes], place: int, element: Element) -> tuple[Columns, int]:
    def take_count(p: Property, row: int) -> int:
        nonlocal place
        if place >= len(words):
            raise _cut_short(element)
        count = int(words[place])
        place += 1
        if count < 0 or place + count > len(words):
            raise FileError(
                f"is not a valid PLY: row {row:,} of “{element.name}” declares “{p.name[:30]}” with "
                f"{count:,} values, and the file ends before."
            )
        return count

    def take(_p: Property, count: int) -> Sequence[float]:
        nonlocal place
        start, place = place, place + count
        if place > len(words):
            raise _cut_short(element)
        return [float(word) for word in words[start:place]]

    return _walk(element, take_count, take), place


def _walk(
    element: Element,
    take_count: Callable[[Property, int], int],
    take: Callable[[Property, int], Sequence[float]],
) -> Columns:
    """The columns of an element whose rows are taken one after the other."""
    values = {p.name: array("d") for p in element.properties}
    sizes: dict[str, list[int]] = {p.name: [] for p in element.properties if p.counted_by}
    for row in range(element.count):
        for p in element.properties:
            count = take_count(p, row) if p.counted_by else 1
            values[p.name].extend(take(p, count))
            if p.counted_by:
                sizes[p.name].append(count)
    flat = {name: np.frombuffer(column, dtype=np.float64) for name, column in values.items()}
    return Columns(
        {name: column for name, column in flat.items() if name not in sizes},
        {name: (flat[name], np.array(counts, dtype=np.int64)) for name, counts in sizes.items()},
    )


_CORNERS = ("vertex_indices", "vertex_index", "vertex_indexes")


def parse(data: bytes, _path: Path) -> ParsedMesh:
    """Vertices and triangulated faces; colours, normals and texture coordinates are ignored."""
    header = read_header(data)
    tables, notes = _binary_tables(data, header) if header.encoding else _ascii_tables(data, header)
    vertices = _vertices(tables)
    return ParsedMesh(vertices, _faces(tables, vertices), notes)


def _binary_tables(data: bytes, header: Header) -> tuple[dict[str, Columns], tuple[str, ...]]:
    place = header.body
    tables: dict[str, Columns] = {}
    for element in header.elements:
        tables[element.name], place = binary_columns(data, place, element, header.encoding)
    surplus = len(data) - place
    return tables, (f"The file goes on for {surplus:,} bytes after its last row.",) if surplus > 2 else ()


def _ascii_tables(data: bytes, header: Header) -> tuple[dict[str, Columns], tuple[str, ...]]:
    """The rows as one stream of words; where that does not come out even, a row a line."""
    body = data[header.body :]
    try:
        tables, surplus = _from_words(body.split(), header)
    except FileError:
        lines = [line.split() for line in body.splitlines() if line.strip()]
        trimmed = trimmed_rows(lines, header.elements)
        if trimmed is None:
            raise
        tables, _ = _from_words(trimmed, header)
        return tables, ("The file's lines hold more numbers than its header states; the rest was ignored.",)
    return tables, (f"The file goes on for {surplus:,} numbers after its last row.",) if surplus else ()


def _from_words(words: list[bytes], header: Header) -> tuple[dict[str, Columns], int]:
    tables: dict[str, Columns] = {}
    place = 0
    for element in header.elements:
        tables[element.name], place = ascii_columns(words, place, element)
    return tables, len(words) - place


def _vertices(tables: dict[str, Columns]) -> NDArray[np.float64]:
    columns = tables.get("vertex", Columns()).numbers
    if not {"x", "y", "z"} <= columns.keys():
        raise FileError("is not a mesh: it has no element “vertex” with the properties x, y and z.")
    return np.column_stack([columns["x"], columns["y"], columns["z"]])


def _faces(tables: dict[str, Columns], vertices: NDArray[np.float64]) -> NDArray[np.int64]:
    parts = [np.zeros((0, 3), dtype=np.int64)]
    for name, table in tables.items():
        for key, (values, sizes) in table.lists.items():
            if name == "face" and key in _CORNERS:
                corners = _indices(values, len(vertices), allow_stop=False)
                parts.append(triangulated(vertices, corners, sizes))
            elif name == "tristrips" and key in _CORNERS:
                parts.append(_strips(_indices(values, len(vertices), allow_stop=True), sizes))
    return np.concatenate(parts)


def _indices(values: NDArray[np.float64], n_vertices: int, allow_stop: bool) -> NDArray[np.int64]:
    good = (values >= (-1 if allow_stop else 0)) & (values < n_vertices) & (values == np.floor(values))
    if not good.all():
        index = float(values[~good][0])
        shown = f"{index:,.0f}" if index.is_integer() else f"{index:g}"
        raise FileError(
            f"is not a valid PLY: a face points to vertex {shown} of {n_vertices:,} (counted from 0)."
        )
    return values.astype(np.int64)


def _strips(corners: NDArray[np.int64], sizes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Triangles of strips that end at -1 or with their list; every second one is turned round."""
    triangles = [np.zeros((0, 3), dtype=np.int64)]
    for row in np.split(corners, np.cumsum(sizes)[:-1]):
        for strip in np.split(row, np.flatnonzero(row < 0)):
            used = strip[strip >= 0]
            if len(used) >= 3:
                part = np.column_stack([used[:-2], used[1:-1], used[2:]])
                part[1::2] = part[1::2, ::-1]
                triangles.append(part)
    return np.concatenate(triangles)


def _recognises(head: bytes) -> bool:
    return head[:3] == b"ply" and head[3:4] in (b"\n", b"\r")


FORMAT = MeshFormat("ply", "PLY", (".ply",), _recognises, parse)
