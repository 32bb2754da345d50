"""Plain voxels that a text beside them describes: VGStudio's VGI, ESRF's INFO, Nikon's XTEKCT."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import display_name, printable
from regolith_studio.readers.number_rows import float_or_nan
from regolith_studio.readers.voxels.header import VoxelHeader, stated_edges, three_dimensions, voxel_type
from regolith_studio.readers.voxels.stored import PlainVoxels, beside, exact_voxels

VGI, INFO, XTEKCT = ".vgi", ".vol.info", ".xtekct"
MAX_HEADER_BYTES = 1 << 20
_SECTION = re.compile(r"[\[{]\s*([^\]}]*?)\s*[\]}]")
_KINDS = {"unsigned integer": "u", "unsigned": "u", "signed integer": "i", "integer": "i", "float": "f"}
_NIKON_TYPES = {1: "<u1", 2: "<u2", 4: "<f4"}


@dataclass(frozen=True)
class _Description:
    """The file of voxels; voxels and edges along x, y and z; the unit of the edges; and the voxels' type."""

    source: Path
    shape: tuple[int, ...]
    edges: list[float]
    unit: str | None
    stored: np.dtype[Any]


def open_described(path: Path) -> PlainVoxels:
    """The voxels that a header describes, which must lie beside it and be just as many.

    Raises FileError if the header breaks the rules, or the voxels are elsewhere or of another number.
    """
    kind = next(suffix for suffix in READERS if path.name.lower().endswith(suffix))
    described = READERS[kind](path, text_fields(path))
    size, unit = stated_edges(described.edges, [described.unit] * 3)
    shape = three_dimensions(described.shape[::-1])
    header = VoxelHeader(shape, voxel_type(described.stored), size, unit)
    try:
        return exact_voxels(described.source, 0, header, described.stored)
    except FileError as error:
        raise FileError(f"describes {display_name(described.source)}, which {error}") from None


def header_beside(path: Path) -> Path | None:
    """The header of ``scan.vol``: ``scan.vol.info``, ``scan.vgi`` or ``scan.xtekct``."""
    named = (path.with_name(f"{path.name}.info"), path.with_suffix(VGI), path.with_suffix(XTEKCT))
    return next((each for each in named if path.suffix.lower() == ".vol" and each.is_file()), None)


def text_fields(path: Path) -> dict[str, str]:
    """The lines ``name = value`` of a text by ``section/name`` in lower case; the first of a name counts.

    Raises FileError if the file is no text, or longer than 1 MiB.
    """
    with path.open("rb") as file:
        data = file.read(MAX_HEADER_BYTES + 1)
    if len(data) > MAX_HEADER_BYTES or b"\0" in data:
        raise FileError("is not the text of a scanner that describes voxels.")
    fields: dict[str, str] = {}
    section = ""
    for line in data.decode("utf-8", "replace").splitlines():
        if heading := _SECTION.fullmatch(line.strip()):
            section = heading[1].lower()
            fields.setdefault(f"{section}/", "")
        elif "=" in line:
            name, _, value = line.partition("=")
            fields.setdefault(f"{section}/{name.strip().lower()}", value.strip().strip('"'))
    return fields


def _vgi(path: Path, fields: Mapping[str, str]) -> _Description:
    if "file2/" in fields or "volume2/" in fields:
        raise FileError("describes several volumes or files of voxels; export one of them.")

    def stated(name: str) -> str:
        return fields.get(f"file1/{name}") or fields.get(f"representation/{name}", "")

    bits, kind = stated("bitsperelement"), stated("datatype").lower()
    letter = _KINDS.get(kind, "") if kind else "f" if bits == "32" else "u"
    if bits not in ("8", "16", "32", "64") or f"{letter}{bits}" in ("f8", "u64", "i64") or not letter:
        raise FileError(
            f"states voxels of an unknown type: “{printable(kind)[:30]}”, {printable(bits)[:9]} bits."
        )
    source = beside(path, _needed(fields, "file1/name").removeprefix("./").removeprefix(".\\"))
    edges = [float_or_nan(word) for word in fields.get("geometry/resolution", "").split()]
    unit = fields.get("geometry/unit", "mm")
    shape = tuple(_whole(word, "size") for word in stated("size").split())
    return _Description(source, shape, edges, unit, np.dtype(f"<{letter}{int(bits) // 8}"))


def _esrf(path: Path, fields: Mapping[str, str]) -> _Description:
    order = fields.get("/byteorder", "LOWBYTEFIRST").upper()
    if order not in ("LOWBYTEFIRST", "HIGHBYTEFIRST"):
        raise FileError(f"states an unknown byte order: “{printable(order)[:30]}”.")
    shape = tuple(_whole(_needed(fields, f"/num_{axis}"), f"NUM_{axis.upper()}") for axis in "xyz")
    edges = [float_or_nan(fields.get("/voxelsize", ""))] * 3
    stored = np.dtype("<f4" if order == "LOWBYTEFIRST" else ">f4")
    return _Description(beside(path, path.name[: -len(".info")]), shape, edges, "um", stored)


def _nikon(path: Path, fields: Mapping[str, str]) -> _Description:
    shape = tuple(_whole(_needed(fields, f"xtekct/voxels{axis}"), f"Voxels{axis.upper()}") for axis in "xyz")
    edges = [float_or_nan(fields.get(f"xtekct/voxelsize{axis}", "")) for axis in "xyz"]
    source = beside(path, f"{path.stem}.vol")
    item = source.stat().st_size // max(1, math.prod(shape))
    return _Description(source, shape, edges, "mm", np.dtype(_NIKON_TYPES.get(item, "<f4")))


READERS = {VGI: _vgi, INFO: _esrf, XTEKCT: _nikon}
"""What reads a header, by the end of its name."""


def _needed(fields: Mapping[str, str], name: str) -> str:
    if not fields.get(name):
        raise FileError(f"does not describe voxels: it has no field “{name.rpartition('/')[2]}”.")
    return fields[name]


def _whole(word: str, name: str) -> int:
    if not re.fullmatch(r"\d{1,18}", word):
        raise FileError(f"is damaged: its field “{name}” is not whole numbers.")
    return int(word)
