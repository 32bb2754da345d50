"""JSON that is written item by item."""

import json
from collections.abc import Mapping
from typing import IO, Any


class JsonList:
    """A JSON list that grows item by item; the bytes are those of ``staging.json_bytes``.

    Parameters
    ----------
    head
        What an object around the list says before it; with none the list is the whole document.
    key
        Of the list in that object.
    """

    def __init__(self, stream: IO[bytes], head: Mapping[str, Any] | None = None, key: str = "") -> None:
        self._stream = stream
        self._depth = 0 if head is None else 1
        self._count = 0
        if head is None:
            self._write("[")
        else:
            self._write(f'{_text(head, 0)[:-2]},\n "{key}": [')

    def add(self, value: Any) -> None:
        """Write one more item."""
        comma, margin = "," if self._count else "", " " * (self._depth + 1)
        self._write(f"{comma}\n{margin}{_text(value, self._depth + 1)}")
        self._count += 1

    def close(self, tail: Mapping[str, Any] | None = None) -> None:
        """Write the end of the list, and what the object around it says behind it."""
        self._write(f"\n{' ' * self._depth}]" if self._count else "]")
        for key, value in (tail or {}).items():
            self._write(f',\n "{key}": {_text(value, 1)}')
        self._write("\n}\n" if self._depth else "\n")

    def _write(self, text: str) -> None:
        self._stream.write(text.encode("utf-8"))


def _text(value: Any, depth: int) -> str:
    text = json.dumps(value, indent=1, ensure_ascii=False, allow_nan=False)
    return text.replace("\n", "\n" + " " * depth)
