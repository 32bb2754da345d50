"""Undo and redo of a value."""

from collections.abc import Hashable
from typing import Generic, TypeVar

T = TypeVar("T")


class History(Generic[T]):
    """A line of values with a position on it.

    ``value``: where it begins. ``limit``: number of steps kept; older ones are forgotten.
    """

    def __init__(self, value: T, limit: int = 500) -> None:
        self._limit = limit
        self.restart(value)

    def restart(self, value: T) -> None:
        """Forget every step and begin again at `value`."""
        self._past: list[T] = []
        self._value = value
        self._future: list[T] = []
        self._key: Hashable = None

    @property
    def value(self) -> T:
        """The present value."""
        return self._value

    @property
    def depth(self) -> int:
        """Number of steps that can be taken back."""
        return len(self._past)

    @property
    def can_undo(self) -> bool:
        """Whether there is a step to take back."""
        return bool(self._past)

    @property
    def can_redo(self) -> bool:
        """Whether there is a step to take again."""
        return bool(self._future)

    def push(self, value: T, key: Hashable = None) -> None:
        """Go on to `value`; pushes in a row with the same `key` (not ``None``) are one step."""
        if value == self._value:
            return
        if key is None or key != self._key:
            self._past = [*self._past, self._value][-self._limit :]
        self._key, self._value = key, value
        self._future.clear()

    def end_step(self) -> None:
        """Let the next push be a step of its own, whatever its key."""
        self._key = None

    def undo(self) -> T:
        """One step back, if there is one."""
        if self._past:
            self._future.append(self._value)
            self._value = self._past.pop()
        self._key = None
        return self._value

    def redo(self) -> T:
        """One step forth, if there is one."""
        if self._future:
            self._past.append(self._value)
            self._value = self._future.pop()
        self._key = None
        return self._value
