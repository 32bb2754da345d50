"""STL: binary, ASCII, several solids, and binary files whose header lies."""

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.io.triangles import RECORD
from regolith_studio.readers.error_messages import plural
from regolith_studio.readers.formats import MeshFormat, ParsedMesh

HEADER = 84
_FACET = (b"facet", b"normal", None, None, None, b"outer", b"loop") + (
    (b"vertex", None, None, None) * 3 + (b"endloop", b"endfacet")
)
_SOLID_LINE = re.compile(rb"^[ \t]*(?:end[ \t]*)?solid\b[^\r\n]*", re.IGNORECASE | re.MULTILINE)


def parse(data: bytes, _path: Path) -> ParsedMesh:
    """Triangles of an STL file: three new vertices a facet.

    The stated normals are ignored: the order of the corners is more reliable.
    """
    if not data:
        raise FileError("is empty: it has no bytes at all.")
    if _looks_like_text(data):
        return _parse_ascii(data)
    return _parse_binary(data)


def _looks_like_text(data: bytes) -> bool:
    """Whether the file is ASCII; many binary files begin with ``solid`` too."""
    if len(data) >= HEADER and len(data) == HEADER + RECORD.itemsize * _declared(data):
        return False
    head = data[:1024].lstrip().lower()
    if b"\0" in data[:4096]:
        return False
    return head.startswith((b"solid", b"facet")) or b"facet" in head


def _declared(data: bytes) -> int:
    return int.from_bytes(data[80:84], "little")


def _parse_binary(data: bytes) -> ParsedMesh:
    if len(data) < HEADER:
        raise FileError(
            f"is too short for an STL: it has {plural(len(data), 'byte')}, and its header alone has {HEADER}."
        )
    declared, held = _declared(data), (len(data) - HEADER) // RECORD.itemsize
    if declared > held:
        raise FileError(
            f"is cut short or not an STL: it declares {declared:,} triangles and has room for {held:,}; "
            "copy or export it again."
        )
    if declared == 0:
        counts = f": its header counts 0, its length is that of {held:,}" if held else ""
        raise FileError(f"is an STL without a single triangle{counts}.")
    records = np.frombuffer(data, dtype=RECORD, count=declared, offset=HEADER)
    surplus = len(data) - HEADER - declared * RECORD.itemsize
    notes = (_surplus_note(declared, held, surplus),) if surplus else ()
    return _soup(records["corners"].reshape(-1, 3).astype(np.float64), notes)


def _surplus_note(declared: int, held: int, surplus: int) -> str:
    if held > declared:
        return (
            f"The header counts {plural(declared, 'triangle')}, and the file's length is that of {held:,}; "
            "what is not counted was left out."
        )
    return f"The file goes on for {surplus:,} bytes after its last triangle."


def _parse_ascii(data: bytes) -> ParsedMesh:
    data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    words = _SOLID_LINE.sub(b"", data).lower().split()
    whole, rest = divmod(len(words), len(_FACET))
    if not words:
        raise FileError("is an ASCII STL without a single triangle.")
    if rest or any(
        want is not None and words[place :: len(_FACET)].count(want) != whole
        for place, want in enumerate(_FACET)
    ):
        raise FileError(_first_fault(data))
    corners = [words[place + axis :: len(_FACET)] for place in (8, 12, 16) for axis in range(3)]
    try:
        numbers = np.array([[float(word) for word in column] for column in corners])
    except ValueError:
        raise FileError(_first_fault(data)) from None
    return _soup(numbers.T.reshape(-1, 3))


def _soup(corners: NDArray[np.float64], notes: tuple[str, ...] = ()) -> ParsedMesh:
    return ParsedMesh(corners, np.arange(len(corners), dtype=np.int64).reshape(-1, 3), notes)


def _first_fault(data: bytes) -> str:
    """The first syntax error of an ASCII STL, as the end of an error message."""
    place = 0
    for number, line in enumerate(data.splitlines(), start=1):
        if _SOLID_LINE.match(line):
            if place:
                return f"is a broken ASCII STL: a solid begins or ends inside a facet in line {number:,}."
            continue
        for word in line.lower().split():
            fault = _fault(word, _FACET[place])
            if fault:
                return f"is a broken ASCII STL: line {number:,} {fault}."
            place = (place + 1) % len(_FACET)
    return "is a broken ASCII STL: it ends in the middle of a facet; copy or export it again."


def _fault(word: bytes, want: bytes | None) -> str:
    shown = word[:24].decode("ascii", "replace")
    if want is not None:
        return "" if word == want else f"has “{shown}” where “{want.decode()}” belongs"
    try:
        float(word)
    except ValueError:
        comma = " (write decimal points, not commas)" if b"," in word else ""
        return f"has “{shown}” where a number belongs{comma}"
    return ""


def _recognises(head: bytes) -> bool:
    start = head.lstrip().lower()
    return start.startswith(b"solid") and b"facet" in start and b"\0" not in head


FORMAT = MeshFormat("stl", "STL", (".stl", ".stla", ".stlb"), _recognises, parse, shares_vertices=False)
