"""Files that are written piece by piece and still appear whole or not at all."""

import json
import os
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

from regolith_studio.errors import FileError
from regolith_studio.session.outputs.staging import give_usual_rights


@contextmanager
def staged_file(path: Path) -> Iterator[IO[bytes]]:
    """A stream to a hidden file beside `path`, which gets its name if all went well.

    Raises
    ------
    FileError
        If the place cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}-")
        try:
            with os.fdopen(handle, "wb") as stream:
                yield stream
            give_usual_rights(Path(name))
            Path(name).replace(path)
        except BaseException:
            Path(name).unlink(missing_ok=True)
            raise
    except OSError as error:
        raise FileError(f"The file {path} cannot be written ({error.strerror}).") from error


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
