"""A crash-safe store for the results of a long run, one SQLite file, so that the run can be resumed.

Records are added in transactions: after a crash each is there as a whole or not at all. The file is locked
against a second process for as long as it is open. It uses a rollback journal, because the write-ahead log
of SQLite fails on network folders. Content is JSON and bytes; nothing is unpickled.
"""

import contextlib
import hashlib
import json
import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self

from regolith_studio.errors import FileError, check_not_stopped

_APPLICATION_ID = 0x5265676F  # "Rego"; SQLite keeps it in the header of the file
_SCHEMA = """
CREATE TABLE notes (name TEXT PRIMARY KEY, content TEXT NOT NULL);
CREATE TABLE records (position INTEGER PRIMARY KEY, content TEXT NOT NULL, digest BLOB NOT NULL);
CREATE TABLE blobs (position INTEGER, name TEXT, content BLOB NOT NULL, PRIMARY KEY (position, name));
"""
_SUBJECT = "subject"


@dataclass(frozen=True)
class CheckpointRecord:
    """Result of one item of a run.

    - ``index``: position of the item in the run.
    - ``values``: plain values, as JSON has them; floats are kept to the last bit.
    - ``blobs``: byte strings by name, such as the content of a file.
    """

    index: int
    values: Mapping[str, Any]
    blobs: Mapping[str, bytes] = field(default_factory=dict)


class Checkpoint:
    """An open checkpoint file, made by :meth:`create` or :meth:`resume`."""

    def __init__(self, path: Path, connection: sqlite3.Connection) -> None:
        self.path = path
        self._connection = connection

    @classmethod
    def create(cls, path: Path, subject: Mapping[str, Any]) -> Self:
        """An empty checkpoint in place of any old one.

        ``subject``: what the results depend on, as JSON; a run about anything else cannot be resumed from
        this file.

        Raises FileError if the file cannot be written, or another process has it open.
        """
        with _errors_of(path):
            path.parent.mkdir(parents=True, exist_ok=True)
            _check_not_in_use(path)
            _remove(path)
            return cls(path, _new(path, {_SUBJECT: dict(subject)}))

    @classmethod
    def resume(cls, path: Path, subject: Mapping[str, Any], kind: str = "run") -> Self:
        """The checkpoint as it was left; damaged records are dropped, an empty file is a beginning.

        ``subject``: as for :meth:`create`. ``kind``: what was interrupted, for the message: a run or a
        study.

        Raises FileError if the file is damaged or another process has it open; or if the subject differs,
        naming the first key that does.
        """
        with _errors_of(path):
            if not path.stat().st_size:  # a full disk or a kill at the very beginning
                return cls.create(path, subject)
            checkpoint = cls(path, _open(path))
            try:
                checkpoint._check_subject(subject, kind)
                checkpoint._drop_damaged()
            except BaseException:
                checkpoint.close()
                raise
        return checkpoint

    @property
    def indices(self) -> set[int]:
        """Positions of all records."""
        with _errors_of(self.path):
            return {row[0] for row in self._connection.execute("SELECT position FROM records")}

    def add(self, records: Iterable[CheckpointRecord]) -> None:
        """Add records in one transaction; they are on the disk when this returns.

        Raises FileError if they cannot be written, for example to a full disk. Raises ValueError if a value
        is not finite.
        """
        check_not_stopped()
        records = list(records)
        rows = []
        for each in records:
            content = _to_json(each.values)
            rows.append((each.index, content, _digest(content, each.blobs)))
        blobs = [(each.index, name, each.blobs[name]) for each in records for name in sorted(each.blobs)]
        with _errors_of(self.path), self._connection:
            self._connection.executemany("INSERT INTO records VALUES (?, ?, ?)", rows)
            self._connection.executemany("INSERT INTO blobs VALUES (?, ?, ?)", blobs)

    def records(self, blobs: bool = True) -> Iterator[CheckpointRecord]:
        """All records by position, one in memory at a time, with their byte strings or without."""
        with _errors_of(self.path):
            rows = self._connection.execute("SELECT position, content FROM records ORDER BY position")
            for position, content in rows:
                yield CheckpointRecord(position, json.loads(content), self._blobs(position) if blobs else {})

    def records_at(self, positions: Iterable[int]) -> Iterator[CheckpointRecord]:
        """Records that are there, one in memory at a time."""
        with _errors_of(self.path):
            for position in positions:
                row = self._connection.execute("SELECT content FROM records WHERE position = ?", (position,))
                yield CheckpointRecord(position, json.loads(row.fetchone()[0]), self._blobs(position))

    def note(self, name: str) -> Any:
        """The value that :meth:`set_note` kept under a name, or ``None``."""
        with _errors_of(self.path):
            return _note(self._connection, name)

    def set_note(self, name: str, value: Any) -> None:
        """Keep a JSON value under a name; it is on the disk when this returns."""
        with _errors_of(self.path), self._connection:
            self._connection.execute("INSERT OR REPLACE INTO notes VALUES (?, ?)", (name, _to_json(value)))

    def remove_records(self, **notes: Any) -> None:
        """Replace the file in one step by a small one without records, with `notes` added."""
        fresh = self.path.with_name(f".{self.path.name}.new")
        with _errors_of(self.path):
            rows = self._connection.execute("SELECT name, content FROM notes")
            kept = {name: json.loads(content) for name, content in rows}
            _remove(fresh)
            _new(fresh, kept | notes).close()
            self._connection.close()
            fresh.replace(self.path)
            self._connection = _open(self.path)

    def close(self) -> None:
        """Close the file, so that another process can continue."""
        self._connection.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()

    def _blobs(self, position: int) -> dict[str, bytes]:
        query = "SELECT name, content FROM blobs WHERE position = ? ORDER BY name"
        return dict(self._connection.execute(query, (position,)))

    def _check_subject(self, subject: Mapping[str, Any], kind: str) -> None:
        before, now = self.note(_SUBJECT), json.loads(_to_json(subject))
        for key in {**before, **now}:
            if before.get(key) != now.get(key):
                raise FileError(
                    f"The unfinished {kind} in {self.path.parent.parent} was begun with another {key}; "
                    "restore that, or run again without --resume to begin anew."
                )

    def _drop_damaged(self) -> None:
        rows = self._connection.execute("SELECT position, content, digest FROM records")
        damaged = [(at,) for at, content, digest in rows if _digest(content, self._blobs(at)) != digest]
        with self._connection:
            self._connection.executemany("DELETE FROM records WHERE position = ?", damaged)
            self._connection.executemany("DELETE FROM blobs WHERE position = ?", damaged)


def read_note(path: Path, name: str) -> Any:
    """A note of a checkpoint that is not open, or ``None``; an empty file has none.

    Raises FileError if the file is damaged or another process has it open.
    """
    with _errors_of(path):
        if not path.stat().st_size:
            return None
        with contextlib.closing(_open(path)) as connection:
            return _note(connection, name)


def _new(path: Path, notes: Mapping[str, Any]) -> sqlite3.Connection:
    connection = _locked(path)
    try:
        connection.executescript(f"BEGIN;PRAGMA application_id = {_APPLICATION_ID};{_SCHEMA}")
        rows = [(name, _to_json(value)) for name, value in notes.items()]
        connection.executemany("INSERT INTO notes VALUES (?, ?)", rows)
        connection.commit()
    except BaseException:
        connection.close()
        raise
    return connection


def _open(path: Path) -> sqlite3.Connection:
    """A connection to an existing file that holds its lock."""
    connection = _locked(path)
    try:
        if connection.execute("PRAGMA application_id").fetchone() != (_APPLICATION_ID,):
            raise sqlite3.DatabaseError("not written by this program")
    except BaseException:
        connection.close()
        raise
    return connection


def _locked(path: Path) -> sqlite3.Connection:
    """A connection that keeps all others out, in whichever thread it is used (one at a time)."""
    # No waiting: who has the file open keeps it for hours, and the user shall read that at once.
    connection = sqlite3.connect(path, timeout=0.0, check_same_thread=False)
    try:
        connection.execute("PRAGMA trusted_schema = OFF")
        connection.execute("PRAGMA locking_mode = EXCLUSIVE")
        # SQLite takes the lock with the first transaction, and in this mode keeps it until the file is
        # closed.
        connection.execute("BEGIN EXCLUSIVE")
        connection.execute("COMMIT")
    except BaseException:
        connection.close()
        raise
    return connection


def _check_not_in_use(path: Path) -> None:
    try:
        _locked(path).close()
    except sqlite3.OperationalError:
        raise
    except sqlite3.DatabaseError:  # no database: nobody is writing to it
        pass


def _remove(path: Path) -> None:
    for each in (path, path.with_name(f"{path.name}-journal")):
        each.unlink(missing_ok=True)


def _note(connection: sqlite3.Connection, name: str) -> Any:
    row = connection.execute("SELECT content FROM notes WHERE name = ?", (name,)).fetchone()
    return None if row is None else json.loads(row[0])


def _to_json(value: Any) -> str:
    return json.dumps(dict(value) if isinstance(value, Mapping) else value, allow_nan=False)


def _digest(content: str, blobs: Mapping[str, bytes]) -> bytes:
    """SHA-256 of a record: the disk may lose bits that SQLite does not miss."""
    digest = hashlib.sha256(content.encode())
    for name in sorted(blobs):
        digest.update(b"\0%s\0%d\0" % (name.encode(), len(blobs[name])) + blobs[name])
    return digest.digest()


@contextlib.contextmanager
def _errors_of(path: Path) -> Iterator[None]:
    """Turns errors of SQLite and of the system into a :class:`FileError`."""
    try:
        yield
    except sqlite3.ProgrammingError:  # wrong use, such as of a closed file
        raise
    except sqlite3.Error as error:
        if getattr(error, "sqlite_errorcode", None) in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
            raise FileError(f"Another run is writing to {path.parent.parent}.") from error
        if isinstance(error, sqlite3.OperationalError):
            raise FileError(f"The checkpoint {path} cannot be used ({error}).") from error
        raise FileError(
            f"{path} is damaged or no checkpoint of this program; run again without --resume."
        ) from error
    except OSError as error:
        raise FileError(f"The checkpoint {path} cannot be used ({error.strerror}).") from error
