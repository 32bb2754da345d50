"""Answers of a study that go to disk as they come, so that a study that was stopped or killed can go on.

A study asks its mapper for one answer a particle (or a few particles), always in the same order. Each answer
becomes a line of a journal; taken up again, the study gets those from there and the rest by work. Numbers
are kept to the bit, so what a study comes to does not depend on how often it was stopped.
"""

import base64
import contextlib
import hashlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Self

import numpy as np

from regolith_studio.dataset.build import software_versions
from regolith_studio.errors import FileError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.journal import Journal

LARGEST = 4096
"""Numbers of an answer that is kept; larger ones, and those of other kinds, are worked out again."""

Mapper = Callable[[Callable[[Any], Any], Iterable[Any]], Iterable[Any]]


class Answers:
    """The answers of one study, in the order in which it asks.

    As a context it removes the journal when all went well, or where nothing is in it, and keeps it otherwise.

    Parameters
    ----------
    path
        Of the journal, in a folder of its own below that of the results.
    resume
        Whether to go on with what is there, if anything is.
    """

    def __init__(self, path: Path, resume: bool = False) -> None:
        self._path, self._resume = path, resume
        self._journal: Journal | None = None
        self._known: dict[int, Any] = {}
        self._asked = 0

    @property
    def n_known(self) -> int:
        """Answers that are known from before and have not been asked for."""
        return len(self._known)

    def about(self, study: str, options: object, inputs: str) -> None:
        """Say what is asked, before anything is.

        Parameters
        ----------
        options
            Their ``repr`` must tell all that the answers depend on.
        inputs
            Changes when an input does, as :func:`fingerprint`.

        Raises
        ------
        FileError
            If what is there is of another study, of other options or inputs or versions of programs; or if
            the journal cannot be written.
        """
        subject = {
            "study": study,
            "set of options": _digest(repr(options).encode("utf-8")),
            "set of particles": inputs,
            "set of program versions": software_versions(),
        }
        if not self._resume or not self._path.exists():
            self._journal = Journal.begin(self._path, {"subject": subject})
            return
        journal = Journal.reopen(self._path)
        before = journal.header.get("subject", {})
        if changed := [key for key in subject if before.get(key) != subject[key]]:
            journal.close()
            raise FileError(
                f"The unfinished study in {self._path.parent.parent} was begun with another {changed[0]};"
                " restore that, or run again without --resume to begin anew."
            )
        self._journal = journal
        self._known = {entry["at"]: _decoded(entry) for entry in journal.entries}

    def through(self, mapper: Mapper) -> Mapper:
        """The mapper, which is asked only for what is not known, and whose answers are kept."""

        def mapped(function: Callable[[Any], Any], items: Iterable[Any]) -> Iterator[Any]:
            listed = list(items)
            numbers = range(self._asked, self._asked + len(listed))
            self._asked += len(listed)
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
        if self._journal is not None and (encoded := _encoded(answer)) is not None:
            self._journal.append({"at": at} | encoded)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: object, *_error: object) -> None:
        if self._journal is None:
            return
        self._journal.close()
        if kind is None or not self._journal.entries:
            self._path.unlink(missing_ok=True)
            for folder in (self._path.parent, self._path.parent.parent):
                with contextlib.suppress(OSError):  # what else is there stays
                    folder.rmdir()


def fingerprint(particles: Sequence[Particle]) -> str:
    """Changes when a name, a group or a coordinate does."""
    whole = hashlib.sha256()
    for each in particles:
        parts = (each.name.encode("utf-8", "surrogateescape"), each.group.encode("utf-8", "surrogateescape"))
        for part in (*parts, each.mesh.vertices.tobytes(), each.mesh.faces.tobytes()):
            whole.update(len(part).to_bytes(8, "little") + part)
    return whole.hexdigest()


def fingerprint_of_rows(rows: np.ndarray[Any, Any], names: Sequence[str] = ()) -> str:
    """Of a table of numbers and the names of its rows."""
    return _digest(repr((rows.shape, rows.dtype.str, tuple(names))).encode("utf-8") + rows.tobytes())


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _encoded(answer: Any) -> dict[str, Any] | None:
    """A sentence, a table of numbers, one with a flag for each row, or a document; ``None`` for other kinds.

    A document is a dictionary of what JSON takes: its numbers come back to the bit.
    """
    match answer:
        case str():
            return {"text": answer}
        case dict():
            return {"document": answer}
        case np.ndarray() if answer.dtype == np.float64 and answer.size <= LARGEST:
            numbers = base64.b64encode(np.ascontiguousarray(answer).astype("<f8").tobytes())
            return {"shape": list(answer.shape), "numbers": numbers.decode("ascii")}
        case (np.ndarray() as table, tuple(flags)) if all(isinstance(flag, bool) for flag in flags):
            encoded = _encoded(table)
            return None if encoded is None else encoded | {"flags": list(flags)}
    return None


def _decoded(entry: Mapping[str, Any]) -> Any:
    if "text" in entry:
        return entry["text"]
    if "document" in entry:
        return entry["document"]
    numbers = np.frombuffer(base64.b64decode(entry["numbers"]), dtype="<f8")
    table = numbers.astype(np.float64).reshape(entry["shape"])
    return (table, tuple(entry["flags"])) if "flags" in entry else table
