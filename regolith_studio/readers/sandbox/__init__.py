"""The sandbox process that parses untrusted files: its parent, its child and what runs in it."""

import json
import struct
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

_LENGTH = struct.Struct("<Q")
MAX_HEADER_BYTES = 1 << 24
KINDS = frozenset(("|b1", "|u1", "|i1", "<u2", "<i2", "<u4", "<i4", "<u8", "<i8", "<f2", "<f4", "<f8"))


class Readable(Protocol):
    """What a message is read from."""

    def readinto(self, buffer: memoryview, /) -> int | None:
        """Fill the buffer as far as bytes are there; 0 at the end."""


class Writable(Protocol):
    """What a message is written to."""

    def write(self, data: bytes | memoryview, /) -> int | None:
        """Write bytes; returns how many."""


@dataclass(frozen=True)
class SandboxMessage:
    """A JSON-able header and numpy arrays."""

    header: dict[str, Any]
    arrays: tuple[NDArray[Any], ...] = ()


def send(stream: Writable, message: SandboxMessage) -> None:
    """Write a whole message.

    Raises OSError if the other side has gone.
    """
    arrays = [np.ascontiguousarray(array) for array in message.arrays]
    listed = [(array.dtype.str, array.shape) for array in arrays]
    header = json.dumps({**message.header, "arrays": listed}).encode()
    _write_all(stream, _LENGTH.pack(len(header)) + header)
    for array in arrays:
        if array.size:
            _write_all(stream, array.data.cast("B"))


def receive(stream: Readable) -> SandboxMessage:
    """Read a whole message.

    Raises EOFError if the other side has gone, or what came is no message.
    """
    length = _LENGTH.unpack(_read_all(stream, _LENGTH.size))[0]
    if length > MAX_HEADER_BYTES:
        raise EOFError("a header of impossible length")
    header = json.loads(bytes(_read_all(stream, length)))
    arrays = []
    for kind, shape in header.pop("arrays"):
        if kind not in KINDS:
            raise EOFError(f"an array of type {kind}")
        array = np.empty(shape, dtype=kind)
        if array.size:
            _fill(stream, array.data.cast("B"))
        arrays.append(array)
    return SandboxMessage(header, tuple(arrays))


def _write_all(stream: Writable, data: bytes | memoryview) -> None:
    view = memoryview(data)
    while view:
        view = view[stream.write(view) or 0 :]


def _read_all(stream: Readable, length: int) -> bytearray:
    data = bytearray(length)
    _fill(stream, memoryview(data))
    return data


def _fill(stream: Readable, view: memoryview) -> None:
    while view:
        got = stream.readinto(view)
        if not got:
            raise EOFError("the other side has gone")
        view = view[got:]
