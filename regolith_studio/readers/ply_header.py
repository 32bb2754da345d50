"""The header of a PLY file: which elements follow, with which properties."""

from dataclasses import dataclass

import numpy as np

from regolith_studio.errors import FileError

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
LONGEST_HEADER = 1 << 16


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

    def least_row(self, ascii_rows: bool) -> int:
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

    Raises
    ------
    FileError
        If it is not a PLY header, or promises more than the file holds.
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
                raise FileError(f"is not a proper PLY: its header says “{' '.join(line)[:60]}”.")
    if encoding is None:
        raise FileError("is not a proper PLY: its header names no format 1.0 (ascii or binary).")
    tables = tuple(Element(name, count, tuple(properties)) for name, count, properties in elements)
    _check_size(tables, len(data) - body, encoding == "")
    return Header(encoding, tables, body)


def _header_lines(data: bytes) -> tuple[list[list[str]], int]:
    lines: list[list[str]] = []
    place = 0
    while place < min(len(data), LONGEST_HEADER):
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
    raise FileError("is not a proper PLY: its header has no line “end_header”.")


def _property(words: list[str]) -> Property:
    match words:
        case ["list", counter, kind, name] if SCALARS.get(counter, "f")[0] in "iu" and kind in SCALARS:
            return Property(name, SCALARS[kind], SCALARS[counter])
        case [kind, name] if kind in SCALARS:
            return Property(name, SCALARS[kind])
    raise FileError(f"is not a proper PLY: its header has the property “{' '.join(words)[:60]}”.")


def _check_size(elements: tuple[Element, ...], held: int, ascii_rows: bool) -> None:
    least = 0
    for element in elements:
        if not element.properties and element.count:
            raise FileError(f"is not a proper PLY: its element “{element.name}” has no properties.")
        least += element.count * element.least_row(ascii_rows)
        if least > held + 2:
            raise FileError(
                f"is cut short: it promises {element.count:,} rows of “{element.name}”, "
                f"at least {least:,} bytes, and has {held:,}; copy or export it again."
            )
