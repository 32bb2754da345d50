"""Members of ZIP archives, also of archives in archives; runs in the guarded child process only.

A member is known by where it begins: no reader needs the list of the others, and nothing is written.
"""

import io
import stat
import struct
import zipfile
import zlib
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path, PurePosixPath
from typing import IO, NamedTuple, cast

from regolith_studio.errors import FileError
from regolith_studio.readers.error_messages import printable

SUFFIX = ".zip"
MAX_RATIO = 120
"""Of a member's size to that of its compressed bytes; meshes in text have about 10."""
MAX_SMALL_BYTES = 16 * 1024**2
"""Up to this size a member may be compressed by any ratio."""
MAX_TAIL_BYTES = 128 * 1024**2
"""Of a compressed archive in an archive: its list of members is within its last bytes."""
_BLOCK = 1 << 20
_LOCAL = struct.Struct("<4s22xHH")
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA)
_IGNORED = ("__macosx",)


class Place(NamedTuple):
    """Where a member is in its archive, and how it is compressed."""

    offset: int
    compressed: int
    size: int
    crc: int
    method: int


Chain = Sequence[Sequence[int]]
"""The fields of the :class:`Place` of each archive in an archive, and of the member at the end."""


def listed_members(
    path: Path, chain: Chain, suffixes: Sequence[str]
) -> tuple[list[str], list[Place], list[str]]:
    """Names and places of the meshes and archives in an archive, and sentences about refused ones.

    Raises FileError with the second half of a sentence if it is no archive, or one that is made to do harm.
    """
    file, shift = _with_list(path, chain)
    try:
        with file, zipfile.ZipFile(file) as archive:
            infos = archive.infolist()
    except (zipfile.BadZipFile, struct.error, ValueError, NotImplementedError, EOFError) as error:
        raise FileError("is damaged or no ZIP archive: its list of members cannot be read.") from error
    _check_overlap(infos)
    names, places, refused = [], [], dict[str, list[str]]()
    for info in infos:
        name = info.filename.replace("\\", "/")
        parts = [part for part in name.split("/") if part not in ("", ".")]
        if info.is_dir() or not parts or not _is_wanted(parts, suffixes):
            continue
        if reason := _refusal(info, name, parts):
            refused.setdefault(reason, []).append(name)
            continue
        names.append("/".join(parts))
        place = (info.header_offset + shift, info.compress_size, info.file_size, info.CRC, info.compress_type)
        places.append(Place(*place))
    return names, places, [left_out_sentence(reason, given) for reason, given in refused.items()]


def member_bytes(path: Path, chain: Chain) -> bytes:
    """The bytes of a member.

    Raises FileError with the second half of a sentence if they are damaged.
    """
    place = Place(*chain[-1])
    try:
        with _opened(_container(path, chain[:-1]), place) as member:
            data = member.read(place.size)
    except (zipfile.BadZipFile, zlib.error, EOFError, OSError, ValueError, struct.error) as error:
        raise FileError("is damaged in its archive; download or pack it again.") from error
    if len(data) < place.size or zlib.crc32(data) != place.crc:
        raise FileError("is damaged in its archive; download or pack it again.")
    return data


def _is_wanted(parts: Sequence[str], suffixes: Sequence[str]) -> bool:
    if any((part.startswith(".") and part != "..") or part.lower() in _IGNORED for part in parts):
        return False
    return PurePosixPath(parts[-1]).suffix.lower() in suffixes


def _refusal(info: zipfile.ZipInfo, name: str, parts: Sequence[str]) -> str:
    """Why a member is not read, to be put behind its name; empty for others."""
    if name.startswith("/") or ".." in parts or ":" in parts[0]:
        return "its name leads out of the archive"
    if stat.S_ISLNK(info.external_attr >> 16):
        return "it is a link, and links are not followed"
    if info.flag_bits & 0x1:
        return "it is locked by a password; unpack it with the password first"
    if info.compress_type not in _METHODS:
        return f"it is packed by method {info.compress_type}, which is not read; pack it with deflate"
    if info.file_size > MAX_SMALL_BYTES and info.file_size > MAX_RATIO * info.compress_size:
        return f"it would unpack to more than {MAX_RATIO} times its size, as a zip bomb does"
    return ""


def left_out_sentence(reason: str, names: Sequence[str]) -> str:
    """The second half of a sentence about all members that are not read for one reason."""
    shown = f"“{printable(names[0])[-60:]}”"
    more = f" and {len(names) - 1:,} more: the first is refused because" if names[1:] else ":"
    return f"left out {shown}{more} {reason}."


def _check_overlap(infos: Sequence[zipfile.ZipInfo]) -> None:
    """Refuse members that share compressed bytes: a few bytes would unpack to any number of them."""
    spans = sorted((info.header_offset, info.compress_size) for info in infos)
    for (first, size), (second, _) in pairwise(spans):
        if first + _LOCAL.size + size > second:
            raise FileError("has members that overlap, as those of a zip bomb do.")


_STREAMS: dict[tuple[object, ...], IO[bytes]] = {}
"""The archive that was last read from: members that follow each other are unpacked in one go."""


def _container(path: Path, chain: Chain) -> IO[bytes]:
    """The archive that a member is in, to be read from any place on; forward is fast."""
    state = path.stat()
    key = (str(path), state.st_size, state.st_mtime_ns, tuple(map(tuple, chain)))
    if key not in _STREAMS:
        for stream in _STREAMS.values():
            stream.close()
        _STREAMS.clear()
        file: IO[bytes] = path.open("rb")
        for place in chain:
            file = _opened(file, Place(*place))
        _STREAMS[key] = file
    return _STREAMS[key]


def _opened(file: IO[bytes], place: Place) -> IO[bytes]:
    """A member of an opened archive as a file."""
    file.seek(place.offset)
    signature, name, extra = _LOCAL.unpack(file.read(_LOCAL.size))
    if signature != b"PK\3\4":
        raise zipfile.BadZipFile("no member begins here")
    start = place.offset + _LOCAL.size + name + extra
    if place.method == zipfile.ZIP_STORED:
        return io.BufferedReader(_Part(file, start, place.size), _BLOCK)
    file.seek(start)
    info = zipfile.ZipInfo()
    info.compress_type, info.compress_size, info.file_size, info.CRC = (
        place.method, place.compressed, place.size, place.crc,
    )  # fmt: skip
    return cast("IO[bytes]", zipfile.ZipExtFile(file, "r", info))


class _Part(io.RawIOBase):
    """A stored member: a part of its archive."""

    def __init__(self, file: IO[bytes], start: int, size: int) -> None:
        super().__init__()
        self._file, self._start, self._size, self._at = file, start, size, 0

    def readable(self) -> bool:
        """Always."""
        return True

    def seekable(self) -> bool:
        """Always."""
        return True

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        """As of a file."""
        self._at = max(0, offset + (0, self._at, self._size)[whence])
        return self._at

    def readinto(self, buffer: memoryview) -> int:  # type: ignore[override]
        """As of a file."""
        self._file.seek(self._start + self._at)
        data = self._file.read(max(0, min(len(buffer), self._size - self._at)))
        buffer[: len(data)] = data
        self._at += len(data)
        return len(data)


def _with_list(path: Path, chain: Chain) -> tuple[IO[bytes], int]:
    """A file that ends as an archive does, with its list of members, and what to add to their offsets."""
    if not chain:
        return path.open("rb"), 0
    file = _container(path, chain)
    if not isinstance(file, zipfile.ZipExtFile):
        return _Detached(file), 0
    size, tail = Place(*chain[-1]).size, bytearray()
    try:
        while block := file.read(_BLOCK):
            tail += block
            del tail[: max(0, len(tail) - MAX_TAIL_BYTES)]
    except (zipfile.BadZipFile, zlib.error, EOFError) as error:
        raise FileError("is damaged in its archive; download or pack it again.") from error
    return io.BytesIO(tail), size - len(tail)


class _Detached(io.BufferedReader):
    """A stored archive, whose own file stays open when this is closed."""

    def __init__(self, file: IO[bytes]) -> None:
        size = file.seek(0, io.SEEK_END)
        super().__init__(_Part(file, 0, size), _BLOCK)
