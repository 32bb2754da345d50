"""What one page leaves for another: values by name."""

from collections.abc import Callable
from typing import Any


class Shelf:
    """Values that belong to no choice and no result, each under a name.

    Parameters
    ----------
    changed
        Told the name whenever something has been put there.
    """

    def __init__(self, changed: Callable[[str], None]) -> None:
        self._values: dict[str, Any] = {}
        self._changed = changed

    def put(self, name: str, value: Any) -> None:
        """Leave a value, instead of what was there under this name."""
        self._values[name] = value
        self._changed(name)

    def get(self, name: str, default: Any = None) -> Any:
        """What is there under this name."""
        return self._values.get(name, default)
