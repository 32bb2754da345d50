"""ZEISS TXM: a reconstruction by an Xradia microscope, in a compound file with one stream a slice.

There is no public specification: the names and types of the streams are those that public readers agree on.
The compound file follows [MS-CFB]; olefile reads its allocation table and its folders.
"""

import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import any_fault
from regolith_studio.readers.volume_formats import VolumeFormat
from regolith_studio.readers.voxels.header import VoxelHeader, sizes_or_none, three_dimensions, voxel_type

MAGIC = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
SLICES_A_FOLDER = 100
_TYPES = {3: "<u1", 5: "<u2", 10: "<f4"}
_STREAM = 2
"""The type of an entry that is a stream, not a folder."""
_SECTOR_SIZES = (struct.pack("<HH", 9, 6), struct.pack("<HH", 12, 6))
"""Sectors of 512 or 4,096 bytes and small ones of 64, as powers of two."""
_MAX_NUMBER_BYTES = 1024
_BROKEN = "is a broken TXM: the places of its streams are invalid; copy it again."


class TxmVoxels:
    """Slices that lie in sectors of a compound file.

    - ``file``: the file, or the stream in it that holds small streams.
    - ``offset``, ``sector_bytes``: where its first sector begins, and the size of one.
    - ``sectors``: numbers of the sectors of each slice, shape (nz, sectors a slice).
    - ``header``, ``stored``: shape and type of the voxels in memory, and their type in the file.
    """

    def __init__(
        self,
        file: BinaryIO,
        offset: int,
        sector_bytes: int,
        sectors: NDArray[np.uint32],
        header: VoxelHeader,
        stored: np.dtype[Any],
    ) -> None:
        self.header = header
        self._file, self._offset, self._sector_bytes = file, offset, sector_bytes
        self._sectors, self._stored = sectors, stored

    def read(self, z0: int, z1: int) -> NDArray[Any]:
        """Slices z0 to z1 in the machine's byte order, shape (z1 - z0, ny, nx)."""
        _, ny, nx = self.header.shape
        out = np.empty((z1 - z0, ny, nx), self.header.dtype)
        for place, sectors in enumerate(self._sectors[z0:z1].astype(np.int64)):
            data = b"".join(map(self._run, np.split(sectors, np.flatnonzero(np.diff(sectors) != 1) + 1)))
            if len(data) < ny * nx * self._stored.itemsize:
                raise FileError("is cut short: its voxels end too early; copy it again.")
            out[place] = np.frombuffer(data, self._stored, ny * nx).reshape(ny, nx)
        return out

    def _run(self, sectors: NDArray[np.int64]) -> bytes:
        """The bytes of sectors that follow one another."""
        self._file.seek(self._offset + int(sectors[0]) * self._sector_bytes)
        return self._file.read(len(sectors) * self._sector_bytes)

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def open_txm(path: Path, _options: Mapping[str, Any]) -> TxmVoxels:
    """The slices of a reconstruction."""
    if path.suffix.lower() == ".txrm":
        raise FileError("holds projections, not a volume: reconstruct it and open the TXM file.")
    file = path.open("rb")
    try:
        return _opened(file)
    except BaseException:
        file.close()
        raise


def _opened(file: BinaryIO) -> TxmVoxels:
    compound = _compound_file(file)
    number = _number(compound, "DataType")
    if number not in _TYPES:
        raise FileError(f"holds voxels of type {number}; 8 bits, 16 bits and 32-bit floats are read.")
    stored = np.dtype(_TYPES[int(number)])
    count = "NoOfImages" if _entry(compound, "ImageInfo", "NoOfImages") else "ImagesTaken"
    shape = three_dimensions(
        tuple(int(_number(compound, name)) for name in (count, "ImageHeight", "ImageWidth"))
    )
    known = _entry(compound, "ImageInfo", "PixelSize") is not None
    size = sizes_or_none([_number(compound, "PixelSize", "<f")] * 3) if known else None
    header = VoxelHeader(shape, voxel_type(stored), size, "um" if size else None)
    starts = _first_sectors(compound, header)
    if header.slice_bytes >= compound.minisectorcutoff:
        source, table, sector_bytes = file, compound.fat, compound.sectorsize
        offset = sector_bytes
    else:
        source, table, sector_bytes = compound.ministream, compound.minifat, compound.minisectorsize
        offset = 0
        file.close()
    sectors = _chains(np.asarray(table), starts, header.slice_bytes, sector_bytes)
    return TxmVoxels(source, offset, sector_bytes, sectors, header, stored)


def _compound_file(file: BinaryIO) -> Any:
    import olefile

    class CompoundFile(olefile.OleFileIO):  # type: ignore[misc]
        """A compound file whose table is read in linear time; olefile copies it for each of its sectors."""

        def loadfat_sect(self, sect: Any) -> int | None:
            numbers = sect if not isinstance(sect, bytes) else self.sect2array(sect)
            number = None
            if len(self.fat) > 2 * self.nb_sect + self.sectorsize:
                raise ValueError("the table is longer than the file")
            for number in numbers:
                if number in (olefile.ENDOFCHAIN, olefile.FREESECT):
                    break
                self.fat.extend(self.sect2array(self.getsect(number)))
            return number

    sizes = file.read(34)[30:]
    file.seek(0)
    with any_fault("is a broken TXM: its table or folders are invalid, or it is cut short; copy it again."):
        if sizes not in _SECTOR_SIZES:
            raise ValueError("sectors of a size that no file has")
        compound = CompoundFile(file)
        if compound.num_mini_fat_sectors > compound.nb_sect or compound.root.size > compound.nb_sect << 12:
            raise ValueError("more small streams than the file can hold")
        return compound


def _entry(compound: Any, folder: str, name: str) -> Any:
    """The entry of a stream, whose name may be in any case; None where there is none."""
    parent = compound.root.kids_dict.get(folder.lower())
    entry = parent and parent.kids_dict.get(name.lower())
    return entry if entry and entry.entry_type == _STREAM else None


def _number(compound: Any, name: str, kind: str = "<I") -> float:
    """The number that a stream about the images begins with."""
    entry = _entry(compound, "ImageInfo", name)
    if entry is None:
        raise FileError(f"is no TXM, or a broken one: it has no stream “ImageInfo/{name}”.")
    data = b"" if entry.size > _MAX_NUMBER_BYTES else compound.openstream(["ImageInfo", name]).read(4)
    if len(data) != 4:
        raise FileError(f"is a broken TXM: its stream “ImageInfo/{name}” is not a number.")
    return struct.unpack(kind, data)[0]  # type: ignore[no-any-return]


def _first_sectors(compound: Any, header: VoxelHeader) -> NDArray[np.int64]:
    """The sector that each slice begins in."""
    starts = []
    for number in range(1, header.shape[0] + 1):
        entry = _entry(compound, f"ImageData{-(-number // SLICES_A_FOLDER)}", f"Image{number}")
        if entry is None:
            raise FileError(
                f"is cut short or damaged: it states {header.shape[0]:,} slices and has no slice {number:,}."
            )
        if entry.size != header.slice_bytes:
            raise FileError(
                f"is damaged: its slice {number:,} has {entry.size:,} bytes and needs {header.slice_bytes:,}."
            )
        starts.append(entry.isectStart)
    return np.array(starts, np.int64)


def _chains(
    table: NDArray[np.uint32], starts: NDArray[np.int64], slice_bytes: int, sector_bytes: int
) -> NDArray[np.uint32]:
    """The sectors of all slices, followed through the table side by side; shape (nz, sectors a slice)."""
    count = -(-slice_bytes // sector_bytes)
    if count * len(starts) > len(table):
        raise FileError("is damaged or cut short: its voxels need more sectors than the file has.")
    sectors = np.empty((count, len(starts)), np.uint32)
    at: NDArray[Any] = starts
    for row in sectors:
        if at.max() >= len(table):
            raise FileError(_BROKEN)
        row[:] = at
        at = table[at]
    if np.bincount(sectors.ravel()).max() > 1:
        raise FileError(_BROKEN)
    return sectors.T


def _prepare() -> None:
    import olefile  # noqa: F401


FORMAT = VolumeFormat(
    "txm", "a ZEISS TXM", (".txm",), lambda head: head.startswith(MAGIC), open_txm, _prepare
)
