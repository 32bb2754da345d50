"""A journal on disk: lines that are only ever appended, each of them whole or not there at all.

The first line says what the journal is about, every further one what has been done. A line counts once
it ends in a newline; what a dying process left behind it is cut off when the journal is opened again.
"""

import contextlib
import json
import os
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Self

from regolith_studio.errors import FileError
from regolith_studio.io.atomic import sync_folder

FORMAT = "regolith-studio journal"


class Journal:
    """An open journal, locked against a second process.

    Attributes
    ----------
    header
        What the first line says.
    entries
        The further lines, oldest first.
    """

    def __init__(self, path: Path, header: Mapping[str, Any], entries: list[dict[str, Any]]) -> None:
        self.path, self.header, self.entries = path, header, entries
        self._stream = path.open("ab")
        try:
            _lock(self._stream.fileno(), path)
        except FileError:
            self._stream.close()
            raise

    @classmethod
    def begin(cls, path: Path, header: Mapping[str, Any]) -> Self:
        """A new journal in place of any old one.

        Raises
        ------
        FileError
            If it cannot be written, or another process is writing it.
        """
        with _sentences(path):
            path.parent.mkdir(parents=True, exist_ok=True)
            journal = cls(path, dict(header), [])
            journal._stream.truncate(0)
            journal._write({"format": FORMAT, "version": 1} | dict(header))
            sync_folder(path.parent)
        return journal

    @classmethod
    def reopen(cls, path: Path) -> Self:
        """A journal as it was left, to be continued.

        Raises
        ------
        FileError
            If it is none, cannot be read, or another process is writing it.
        """
        with _sentences(path):
            content = path.read_bytes()
            whole = content[: content.rfind(b"\n") + 1]
            header, *entries = _lines(whole, path)
            journal = cls(path, header, entries)
            journal._stream.truncate(len(whole))
        return journal

    def append(self, entry: Mapping[str, Any]) -> None:
        """Add a line; it is on the disk when this returns.

        Raises
        ------
        FileError
            If it cannot be written.
        """
        with _sentences(self.path):
            self._write(entry)
        self.entries.append(dict(entry))

    def close(self) -> None:
        """Let go of the file and its lock."""
        self._stream.close()

    def _write(self, entry: Mapping[str, Any]) -> None:
        line = json.dumps(entry, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
        self._stream.write(line.encode("utf-8") + b"\n")
        self._stream.flush()
        os.fsync(self._stream.fileno())


def _lines(content: bytes, path: Path) -> list[dict[str, Any]]:
    try:
        lines = [json.loads(line) for line in content.splitlines()]
    except ValueError as error:
        raise FileError(f"{path} is damaged; run again without --resume.") from error
    if not lines or not all(isinstance(line, dict) for line in lines) or lines[0].get("format") != FORMAT:
        raise FileError(f"{path} is no journal of this program.")
    return lines


def _lock(handle: int, path: Path) -> None:
    if sys.platform == "win32":
        return  # two runs into one folder are the user's to avoid
    import fcntl

    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        raise FileError(f"Another run is writing to {path.parent.parent}.") from error


class _sentences(contextlib.AbstractContextManager[None]):  # noqa: N801  a context, read like a sentence
    """What the system says about the file becomes a sentence."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        if isinstance(error, OSError):
            raise FileError(f"The journal {self._path} cannot be used ({error.strerror}).") from error
