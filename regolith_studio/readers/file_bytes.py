"""Bytes of files: read within limits, and their SHA-256."""

import hashlib
from pathlib import Path

from regolith_studio.errors import FileError, os_error_reason
from regolith_studio.readers.error_messages import message_about
from regolith_studio.readers.sandbox.parent import checked_size


def read_bytes(path: Path, largest: int | None = None) -> bytes:
    """The bytes of a regular file.

    Raises FileError if there is no such file, it cannot be read, or it is larger than `largest` bytes.
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


def sha256_of(path: Path) -> str:
    """SHA-256 of the file's bytes, hexadecimal."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
