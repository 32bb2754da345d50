"""Bytes of files: read within limits, SHA-256, and NPZ archives, checked before they are unpacked."""

import hashlib
import io
import zipfile
import zlib
from math import prod
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError, os_error_reason
from regolith_studio.readers.error_messages import message_about
from regolith_studio.readers.sandbox.parent import checked_size

MAX_ARRAYS = 64
MAX_UNPACKED_BYTES = 2 * 1024**3
"""Bytes of all arrays together."""
KINDS = "biufU"
"""Kinds of arrays: booleans, integers, floats and text; no objects, structures or dates."""

_BROKEN = (zipfile.BadZipFile, zlib.error, ValueError, EOFError, OSError, NotImplementedError, RuntimeError)


def read_bytes(path: Path, largest: int | None = None) -> bytes:
    """The bytes of a regular file.

    Raises
    ------
    FileError
        If there is no such file, it cannot be read, or it is larger than `largest` bytes.
    """
    size = checked_size(path)
    if largest is not None and size > largest:
        raise FileError(
            message_about(path, f"has {size / 1e6:.0f} MB; at most {largest / 1e6:.0f} are read.")
        )
    try:
        return path.read_bytes()
    except OSError as error:
        raise FileError(message_about(path, f"cannot be read: {os_error_reason(error)}.")) from None


def read_npz(path: Path) -> tuple[dict[str, NDArray[Any]], str]:
    """The arrays of an NPZ file by name, and the SHA-256 of its bytes.

    Raises
    ------
    FileError
        With one sentence if the file is no archive of plain arrays, or larger unpacked than it may be.
    """
    packed = read_bytes(path)
    try:
        with zipfile.ZipFile(io.BytesIO(packed)) as archive:
            arrays = _arrays(archive)
    except FileError as error:
        raise FileError(message_about(path, str(error))) from None
    except MemoryError:
        raise FileError(message_about(path, "needs more memory than there is.")) from None
    except _BROKEN:
        raise FileError(
            message_about(path, "is not an NPZ archive of arrays, or is damaged; save it again.")
        ) from None
    return arrays, hashlib.sha256(packed).hexdigest()


def _arrays(archive: zipfile.ZipFile) -> dict[str, NDArray[Any]]:
    entries = archive.infolist()
    names = [entry.filename for entry in entries]
    total = sum(entry.file_size for entry in entries)
    if len(entries) > MAX_ARRAYS or len(set(names)) < len(names):
        raise FileError(f"holds {len(entries)} entries, some maybe twice; an NPZ of this program has few.")
    if not all(name.endswith(".npy") for name in names):
        raise FileError("holds something else than arrays.")
    if total > MAX_UNPACKED_BYTES:
        raise FileError(f"unpacks to {total / 1024**3:.1f} GiB; at most 2 are read.")
    found = {}
    for entry in entries:
        with archive.open(entry) as stream:
            found[entry.filename.removesuffix(".npy")] = _array(stream, entry.file_size)
    return found


def _array(stream: IO[bytes], size: int) -> NDArray[Any]:
    """One array whose header declares exactly as many bytes as there are."""
    version = np.lib.format.read_magic(stream)
    if version not in ((1, 0), (2, 0)):
        raise FileError(f"holds an array of format {version[0]}.{version[1]}; 1.0 and 2.0 are read.")
    read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, fortran, dtype = read(stream)
    if dtype.kind not in KINDS or dtype.hasobject:
        raise FileError(f"holds an array of {dtype}, not of plain numbers or text.")
    promised = prod(shape) * dtype.itemsize
    if promised > size or min(shape, default=0) < 0:
        raise FileError(f"declares an array of {promised} bytes and holds {size}.")
    data = stream.read(promised)
    if len(data) != promised:
        raise FileError(f"ends in the middle of an array of {promised} bytes.")
    return np.frombuffer(data, dtype).reshape(shape, order="F" if fortran else "C").copy()


def sha256_of(path: Path) -> str:
    """SHA-256 of the file's bytes, hexadecimal."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
