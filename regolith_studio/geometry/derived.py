"""Arrays that follow from others: kept with their owner, but only those that were made last."""

from collections import deque
from collections.abc import Callable
from threading import Lock
from typing import Any, Generic, TypeVar, overload
from weakref import ReferenceType, ref

T = TypeVar("T")

SMALL = 16_384
"""Bytes up to which a value stays for as long as its owner does."""
KEPT = 64_000_000
"""Bytes that all values above :data:`SMALL` together may take, apart from those of the last owner."""


class Derived(Generic[T]):
    """A property that is computed when it is first asked for and then kept, like ``cached_property``.

    What is large is forgotten again when :data:`KEPT` bytes have been made after it, by any owner, and
    computed anew if somebody asks once more: hundreds of open particles do not hold what each was
    measured by.

    Parameters
    ----------
    compute
        A method without arguments whose value is an array, or has arrays as ``vertices`` and ``faces``.
    """

    def __init__(self, compute: Callable[[Any], T]) -> None:
        self._compute, self._name = compute, compute.__name__
        self.__doc__ = compute.__doc__

    @overload
    def __get__(self, owner: None, kind: type) -> "Derived[T]": ...
    @overload
    def __get__(self, owner: object, kind: type) -> T: ...
    def __get__(self, owner: object | None, kind: type) -> "Derived[T] | T":
        if owner is None:
            return self
        value = self._compute(owner)
        owner.__dict__[self._name] = value
        if (size := _bytes(value)) > SMALL:
            _kept.add(owner, self._name, size)
        return value


class _Kept:
    """The large values in the order in which they were made."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._line: deque[tuple[ReferenceType[object], str, int]] = deque()
        self._size = 0

    def add(self, owner: object, name: str, size: int) -> None:
        with self._lock:
            self._line.append((ref(owner), name, size))
            self._size += size
            while self._size > KEPT and self._line[0][0]() is not owner:
                oldest, name, size = self._line.popleft()
                self._size -= size
                if (gone := oldest()) is not None:
                    gone.__dict__.pop(name, None)


_kept = _Kept()


def _bytes(value: Any) -> int:
    parts = (value,) if hasattr(value, "nbytes") else (value.vertices, value.faces)
    return sum(int(part.nbytes) for part in parts)
