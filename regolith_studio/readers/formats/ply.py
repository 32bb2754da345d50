"""PLY: ASCII and binary of both byte orders, polygons and triangle strips."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.readers.formats import MeshFormat, ParsedMesh
from regolith_studio.readers.ply_elements import (
    Columns,
    Header,
    ascii_columns,
    binary_columns,
    read_header,
    trimmed_rows,
)
from regolith_studio.readers.polygons import triangulated

_CORNERS = ("vertex_indices", "vertex_index", "vertex_indexes")


def parse(data: bytes, _path: Path) -> ParsedMesh:
    """Vertices and triangulated faces; colours, normals and texture coordinates are ignored.

    Raises
    ------
    FileError
        If the header or a row is broken, or an index points nowhere.
    """
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
