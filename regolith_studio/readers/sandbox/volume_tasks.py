"""Tasks of the sandbox process for volumes: open one, keep it open, and return its slices."""

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.messages import N_, Message, to_json
from regolith_studio.readers.error_messages import message_about, printable
from regolith_studio.readers.formats import mesh_suffixes
from regolith_studio.readers.sandbox.messages import SandboxMessage
from regolith_studio.readers.units import UNITS
from regolith_studio.readers.volume_formats import VOLUME_FORMATS, WITH_AXES, VolumeFormat
from regolith_studio.readers.voxels.header import OpenVolume, Sizes, VoxelHeader, checked_header
from regolith_studio.readers.voxels.stored import PlainVoxels

MIN_VOXEL_EDGE, MAX_VOXEL_EDGE, MAX_EDGE_RATIO = 1e-5, 1e6, 1e4
"""Range of plausible voxel edges in micrometres, and the largest ratio of two."""
_HEAD = 1024
_PICTURES = (".png", ".bmp", ".jpg", ".jpeg")
_opened: dict[str, tuple[OpenVolume, VolumeFormat]] = {}
"""At most one volume, by the request that opened it."""


def prepare_volume(request: dict[str, Any]) -> SandboxMessage:
    """Import what the format of the file needs; the only step that may take long on a small file."""
    path = Path(request["path"])
    try:
        row, _ = volume_format_of(path)
        row.prepare()
    except FileError as error:
        raise FileError(message_about(path, str(error))) from None
    return SandboxMessage({"format": row.key})


def open_volume(request: dict[str, Any]) -> SandboxMessage:
    """The header of the volume that the request names, which stays open for `read_slices`."""
    path = Path(request["path"])
    try:
        volume, row = _open_one(request)
    except FileError as error:
        raise FileError(message_about(path, str(error))) from None
    return SandboxMessage(_as_json(volume, row, volume_format_of(path)[1]))


def read_slices(request: dict[str, Any]) -> SandboxMessage:
    """Slices ``request["z0"]`` to ``request["z1"]``, shape (z1 - z0, ny, nx)."""
    path = Path(request["path"])
    try:
        volume, _ = _open_one(request)
        z0, z1 = int(request["z0"]), int(request["z1"])
        voxels = read_checked_slices(volume, z0, z1)
    except FileError as error:
        raise FileError(message_about(path, str(error))) from None
    return SandboxMessage({}, (_little(voxels),))


def read_checked_slices(volume: OpenVolume, z0: int, z1: int) -> NDArray[Any]:
    """What the volume gives for the slices, if it is what its header promised.

    Raises
    ------
    FileError
        If the file holds something else.
    """
    with np.errstate(all="ignore"):
        voxels = volume.read(z0, z1)
    header = volume.header
    if voxels.shape != (z1 - z0, *header.shape[1:]) or voxels.dtype != header.dtype:
        raise FileError("is damaged: its slices are not of the size and type that its header states.")
    return voxels


def open_volume_file(path: Path, request: dict[str, Any]) -> tuple[OpenVolume, VolumeFormat]:
    """An opened volume with a checked header, and the format that it came in.

    Raises
    ------
    FileError
        With the second half of a sentence.
    """
    row, _ = volume_format_of(path)
    if request.get("axes") and row.key not in WITH_AXES:
        raise FileError(f"is {row.label}, which states its axes itself; leave the axes out.")
    if request.get("allow_gaps") and row.key != "slices":
        raise FileError(f"is {row.label}, not a folder of slices, of which alone some may be absent.")
    row.prepare()
    with np.errstate(all="ignore"):
        volume = row.open(path, request)
    checked_header(volume.header)
    return volume, row


def volume_format_of(path: Path) -> tuple[VolumeFormat, tuple[str, ...]]:
    """The format of a file by its content where that is unmistakable, else by its suffix; and notes.

    Raises
    ------
    FileError
        If it is not a volume format.
    """
    rows = VOLUME_FORMATS
    if path.is_dir():
        return next((row for row in rows.values() if row.holds(path)), rows["slices"]), ()
    with path.open("rb") as file:
        head = file.read(_HEAD)
    if not head:
        raise FileError("is empty: it has no bytes at all.")
    name = path.name.lower()
    named = next((row for row in rows.values() if name.endswith(row.suffixes)), None)
    shown = next((row for row in rows.values() if row.recognises(head)), None)
    if shown is not None and shown is not named:
        return shown, (
            Message(
                N_("The file is named {suffix} but is {format}."),
                suffix=printable(path.suffix) or "without a suffix",
                format=shown.label,
            ),
        )
    if named is not None:
        return named, ()
    if name.endswith(tuple(mesh_suffixes())):
        raise FileError("is a mesh, not a volume: it is a particle already, open or describe it as it is.")
    if name.endswith(_PICTURES):
        raise FileError("is a single picture; open the folder that holds all slices of the scan.")
    known = ", ".join(sorted(row.suffixes[0] for row in rows.values() if row.suffixes))
    raise FileError(
        f"has an unsupported file type ({printable(path.suffix) or 'no suffix'}); volumes end in {known}."
    )


def _open_one(request: dict[str, Any]) -> tuple[OpenVolume, VolumeFormat]:
    key = repr(
        [request.get(name) for name in ("path", "stamp", "dataset", "raw", "names", "axes", "allow_gaps")]
    )
    if key not in _opened:
        for volume, _ in _opened.values():
            volume.close()
        _opened.clear()
        _opened[key] = open_volume_file(Path(request["path"]), request)
    return _opened[key]


def _as_json(volume: OpenVolume, row: VolumeFormat, notes: tuple[str, ...]) -> dict[str, Any]:
    header = volume.header
    size, doubts = _plausible_size(header)
    return {
        "format": row.key,
        "label": row.label,
        "shape": header.shape,
        "dtype": header.dtype.str,
        "voxel_size": size,
        "unit": header.unit,
        "kind": header.kind,
        "notes": [to_json(note) for note in notes + header.notes + doubts],
        "datasets": [(each.name, each.shape, each.dtype, each.voxel_size) for each in header.datasets],
        "dataset": header.dataset,
        "plain": volume.plain() if isinstance(volume, PlainVoxels) else None,
        "in_order": bool(getattr(volume, "in_order", False)),
        "layer": int(getattr(volume, "layer", 1)),
    }


def _plausible_size(header: VoxelHeader) -> tuple[Sizes | None, tuple[str, ...]]:
    """The stated voxel size, or None and a note where it is implausible."""
    size, unit = header.voxel_size, header.unit
    if size is None:
        return None, ()
    factor = UNITS.get(unit or "", math.nan)
    slim = max(size) > MAX_EDGE_RATIO * min(size)
    if not slim and not any(
        not MIN_VOXEL_EDGE <= edge * factor <= MAX_VOXEL_EDGE for edge in size if factor > 0
    ):
        return size, ()
    shown = " × ".join(f"{edge:.3g}" for edge in size)
    template = N_("The file states a voxel of {size}, which is implausible; give the size of a voxel.")
    return None, (Message(template, size=f"{shown} {unit or ''}".rstrip()),)


def _little(voxels: NDArray[Any]) -> NDArray[Any]:
    return voxels.astype(voxels.dtype.newbyteorder("<"), copy=False)
