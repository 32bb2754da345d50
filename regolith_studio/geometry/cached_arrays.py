"""Cached properties that hold arrays, within a limit on the memory that all of them take."""

from collections import deque
from collections.abc import Callable
from threading import Lock
from typing import Any, Generic, TypeVar, overload
from weakref import ReferenceType, ref

T = TypeVar("T")

ALWAYS_CACHED_BYTES = 16_384
"""Bytes up to which a value stays for as long as its owner does."""
MAX_CACHED_BYTES = 64_000_000
"""Bytes that all larger values together may take, apart from those of the last owner."""


class CachedArray(Generic[T]):
    """A property that is computed at its first access and then cached, like ``cached_property``.

    Large values are dropped again, oldest first, when all of them together take more than
    :data:`MAX_CACHED_BYTES`, and recomputed at the next access: hundreds of open particles do not each hold
    the arrays that they were measured by.

    Parameters
    ----------
    compute
        A method without arguments whose value is an array, or has arrays as ``vertices`` and ``faces``.
    """

    def __init__(self, compute: Callable[[Any], T]) -> None:
        self._compute, self._name = compute, compute.__name__
        self.__doc__ = compute.__doc__

    @overload
    def __get__(self, owner: None, kind: type) -> "CachedArray[T]": ...
    @overload
    def __get__(self, owner: object, kind: type) -> T: ...
    def __get__(self, owner: object | None, kind: type) -> "CachedArray[T] | T":
        if owner is None:
            return self
        value = self._compute(owner)
        owner.__dict__[self._name] = value
        if (size := _bytes(value)) > ALWAYS_CACHED_BYTES:
            _ledger.add(owner, self._name, size)
        return value


class _CacheLedger:
    """The large cached values, oldest first."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._entries: deque[tuple[ReferenceType[object], str, int]] = deque()
        self._size = 0

    def add(self, owner: object, name: str, size: int) -> None:
        with self._lock:
            self._entries.append((ref(owner), name, size))
            self._size += size
            while self._size > MAX_CACHED_BYTES and self._entries[0][0]() is not owner:
                oldest, name, size = self._entries.popleft()
                self._size -= size
                if (gone := oldest()) is not None:
                    gone.__dict__.pop(name, None)


_ledger = _CacheLedger()


def _bytes(value: Any) -> int:
    parts = (value,) if hasattr(value, "nbytes") else (value.vertices, value.faces)
    return sum(int(part.nbytes) for part in parts)
