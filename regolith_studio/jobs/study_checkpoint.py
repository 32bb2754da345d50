"""Keeps the answers of a study on the disk as they come, so that an interrupted study can be resumed.

A study asks its mapper for one answer a particle (or a few particles), always in the same order. Each answer
is written to a checkpoint; after a resume the study gets those from there and computes the rest. Numbers are
kept to the bit, so that the results do not depend on interruptions.
"""

import contextlib
import hashlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, Self

import numpy as np

from regolith_studio.dataset.build import software_versions
from regolith_studio.geometry.particle import Particle
from regolith_studio.io.checkpoint import Checkpoint, CheckpointRecord

MAX_NUMBERS = 4096
"""Largest array that is kept; larger ones, and answers of other kinds, are computed again."""

Mapper = Callable[[Callable[[Any], Any], Iterable[Any]], Iterable[Any]]


class StudyCheckpoint:
    """The answers of one study, in the order in which it asks.

    As a context it removes its file when all went well or nothing is in it, and keeps it otherwise.

    Parameters
    ----------
    path
        Of the file, in a folder of its own below that of the results.
    resume
        Whether to continue with what is there, if anything is.
    """

    def __init__(self, path: Path, resume: bool = False) -> None:
        self._path, self._resume = path, resume
        self._checkpoint: Checkpoint | None = None
        self._known: dict[int, Any] = {}
        self._n_asked = 0

    def open(self, study: str, options: object, inputs: str) -> None:
        """Open the file, before the study asks for anything.

        Parameters
        ----------
        options
            Their ``repr`` must name all that the answers depend on.
        inputs
            Changes when an input does, as :func:`hash_of_particles`.

        Raises
        ------
        FileError
            If the file belongs to another study, other options, inputs or versions of programs; or if it
            cannot be written.
        """
        subject = {
            "study": study,
            "set of options": _sha256(repr(options).encode("utf-8")),
            "set of particles": inputs,
            "set of program versions": software_versions(),
        }
        if not self._resume or not self._path.exists():
            self._checkpoint = Checkpoint.create(self._path, subject)
            return
        self._checkpoint = Checkpoint.resume(self._path, subject, "study")
        self._known = {record.index: _decode(record) for record in self._checkpoint.records()}

    def wrap(self, mapper: Mapper) -> Mapper:
        """The mapper, called only for answers that are not known, and with its answers kept."""

        def mapped(function: Callable[[Any], Any], items: Iterable[Any]) -> Iterator[Any]:
            listed = list(items)
            numbers = range(self._n_asked, self._n_asked + len(listed))
            self._n_asked += len(listed)
            missing = [item for at, item in zip(numbers, listed, strict=True) if at not in self._known]
            answers = iter(mapper(function, missing)) if missing else iter(())
            for at in numbers:
                if at in self._known:
                    yield self._known.pop(at)
                    continue
                while (answer := next(answers)) is None:
                    yield None
                self._keep(at, answer)
                yield answer

        return mapped

    def _keep(self, at: int, answer: Any) -> None:
        if self._checkpoint is not None and (record := _encode(at, answer)) is not None:
            self._checkpoint.add([record])

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: object, *_error: object) -> None:
        if self._checkpoint is None:
            return
        empty = not self._checkpoint.indices
        self._checkpoint.close()
        if kind is None or empty:
            self._path.unlink(missing_ok=True)
            for folder in (self._path.parent, self._path.parent.parent):
                with contextlib.suppress(OSError):  # not empty: other files stay
                    folder.rmdir()


def hash_of_particles(particles: Sequence[Particle]) -> str:
    """Changes when a name, a group or a coordinate does."""
    whole = hashlib.sha256()
    for each in particles:
        parts = (each.name.encode("utf-8", "surrogateescape"), each.group.encode("utf-8", "surrogateescape"))
        for part in (*parts, each.mesh.vertices.tobytes(), each.mesh.faces.tobytes()):
            whole.update(len(part).to_bytes(8, "little") + part)
    return whole.hexdigest()


def hash_of_rows(rows: np.ndarray[Any, Any], names: Sequence[str] = ()) -> str:
    """Of a table of numbers and the names of its rows."""
    return _sha256(repr((rows.shape, rows.dtype.str, tuple(names))).encode("utf-8") + rows.tobytes())


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _encode(at: int, answer: Any) -> CheckpointRecord | None:
    """A message, an array of numbers, one with a flag for each row, or a document; ``None`` for other kinds.

    A document is a dictionary that JSON can hold: its numbers come back to the bit.
    """
    match answer:
        case str():
            return CheckpointRecord(at, {"text": answer})
        case dict():
            return CheckpointRecord(at, {"document": answer})
        case np.ndarray() if answer.dtype == np.float64 and answer.size <= MAX_NUMBERS:
            numbers = np.ascontiguousarray(answer).astype("<f8").tobytes()
            return CheckpointRecord(at, {"shape": list(answer.shape)}, {"numbers": numbers})
        case (np.ndarray() as table, tuple(flags)) if all(isinstance(flag, bool) for flag in flags):
            encoded = _encode(at, table)
            if encoded is not None:
                return CheckpointRecord(at, {**encoded.values, "flags": list(flags)}, encoded.blobs)
    return None


def _decode(record: CheckpointRecord) -> Any:
    values = record.values
    if "text" in values:
        return values["text"]
    if "document" in values:
        return values["document"]
    numbers = np.frombuffer(record.blobs["numbers"], dtype="<f8")
    table = numbers.astype(np.float64).reshape(values["shape"])
    return (table, tuple(values["flags"])) if "flags" in values else table
