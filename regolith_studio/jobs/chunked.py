"""A long batch in chunks: each goes to disk as soon as it is done, and none is done twice.

A journal lists the shards that are whole. Whatever ends the program, the chunks under way are lost and
nothing else; run again, the batch goes on with the chunks that are missing.
"""

from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from regolith_studio.errors import Cancelled, EnvironmentProblem, FileError
from regolith_studio.jobs.events import Failed, Finished, Job, JobResult, Progress, Step, Stopped
from regolith_studio.jobs.executor import Executor
from regolith_studio.jobs.journal import Journal
from regolith_studio.jobs.progress_rate import ProgressRate
from regolith_studio.jobs.shards import Record, read_shard, sha256, write_shard

SMALL_BATCH = 200
"""Below so many items each is a chunk of its own: they tend to be those that take long."""
CHUNK_LIMITS = (25, 200)
CHUNKS = 64
"""A large batch is cut into about so many chunks, within the limits."""
JOURNAL, SHARDS = "journal.jsonl", "shards"
LOST = "lost"
"""Key in the values of an item that ended the process that worked on it: the sentence."""

Work = Callable[[Sequence[int]], Job]
"""Makes the job of a chunk from the indices of its items; the job returns a sequence of `Record`."""


@dataclass(frozen=True)
class Chunk:
    """Items `first` to `first + count - 1`."""

    number: int
    first: int
    count: int

    @property
    def indices(self) -> range:
        """Of its items."""
        return range(self.first, self.first + self.count)


def chunks_of(n_items: int, size: int) -> tuple[Chunk, ...]:
    """The items in chunks of `size`, the last one perhaps smaller."""
    firsts = range(0, n_items, size)
    return tuple(Chunk(number, first, min(size, n_items - first)) for number, first in enumerate(firsts))


def chunk_size(n_items: int) -> int:
    """How many items make a chunk; does not depend on who works on them."""
    if n_items < SMALL_BATCH:
        return 1
    low, high = CHUNK_LIMITS
    return min(max(n_items // CHUNKS, low), high)


class Batch:
    """The chunks of a batch, and those of them that are on disk.

    Parameters
    ----------
    folder
        Of the journal and the shards.
    subject
        What the batch is about; a journal of anything else is refused.
    """

    def __init__(self, folder: Path, journal: Journal) -> None:
        self.folder = folder
        self._journal = journal
        self.chunks = chunks_of(journal.header["items"], journal.header["chunk"])
        self._done = {entry["chunk"] for entry in journal.entries if self._is_whole(entry)}

    @classmethod
    def begin(
        cls, folder: Path, n_items: int, subject: Mapping[str, Any], chunk: int | None = None
    ) -> "Batch":
        """A batch of which nothing is done yet.

        Raises
        ------
        FileError
            If the folder cannot be written or another process works in it.
        """
        header = {"subject": dict(subject), "items": n_items, "chunk": chunk or chunk_size(n_items)}
        batch = cls(folder, Journal.begin(folder / JOURNAL, header))
        for path in [*(folder / SHARDS).glob("*.zip"), *(folder / SHARDS).glob(".*.part")]:
            path.unlink()
        return batch

    @classmethod
    def resume(cls, folder: Path, n_items: int, subject: Mapping[str, Any]) -> "Batch":
        """The batch that was begun here, with what is done of it.

        Raises
        ------
        FileError
            If the journal is of another batch, naming the first thing that differs.
        """
        journal = Journal.reopen(folder / JOURNAL)
        before = journal.header.get("subject", {})
        changed = [key for key in {**before, **subject} if before.get(key) != subject.get(key)]
        if changed or journal.header.get("items") != n_items:
            journal.close()
            what = changed[0] if changed else "number of particles"
            raise FileError(
                f"The unfinished run in {folder.parent} was begun with another {what}; restore that, or run "
                "again without --resume to begin anew."
            )
        return cls(folder, journal)

    @property
    def n_items(self) -> int:
        """Of the whole batch."""
        return int(self._journal.header["items"])

    @property
    def n_done(self) -> int:
        """Items whose results are on disk."""
        return sum(chunk.count for chunk in self.chunks if chunk.number in self._done)

    @property
    def missing(self) -> tuple[Chunk, ...]:
        """Chunks that are still to be done."""
        return tuple(chunk for chunk in self.chunks if chunk.number not in self._done)

    def store(self, chunk: Chunk, records: Sequence[Record], **notes: Any) -> None:
        """Write the results of a chunk and enter it in the journal."""
        path = self._shard(chunk.number)
        digest = write_shard(path, records)
        self._journal.append({"chunk": chunk.number, "sha256": digest, **notes})
        self._done.add(chunk.number)

    def records(self, blobs: bool = True) -> Iterator[Record]:
        """What is known of each item, in order, one at a time."""
        for chunk in self.chunks:
            yield from read_shard(self._shard(chunk.number), blobs)

    @property
    def notes(self) -> tuple[Mapping[str, Any], ...]:
        """Lines of the journal that are not about a chunk."""
        return tuple(entry for entry in self._journal.entries if "chunk" not in entry)

    def note(self, entry: Mapping[str, Any]) -> None:
        """A line in the journal that is not about a chunk."""
        self._journal.append(entry)

    def clear(self) -> None:
        """Remove the shards; the journal stays."""
        for chunk in self.chunks:
            self._shard(chunk.number).unlink(missing_ok=True)
        if (shards := self.folder / SHARDS).is_dir():
            shards.rmdir()

    def close(self) -> None:
        """Let another process go on."""
        self._journal.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()

    def _shard(self, number: int) -> Path:
        return self.folder / SHARDS / f"{number:06d}.zip"

    def _is_whole(self, entry: Mapping[str, Any]) -> bool:
        return "chunk" in entry and sha256(self._shard(entry["chunk"])) == entry["sha256"]


def work_through(
    batch: Batch, work: Work, executor: Executor, failures: Callable[[Record], int] = lambda _: 0
) -> Generator[Step, None, None]:
    """Do what is missing of a batch, telling rate and time left after each chunk.

    An item that ends the process that works on it is found by doing the items of its chunk one by one;
    it gets a record of its own that says so, under :data:`LOST`.

    Parameters
    ----------
    failures
        How often the item of a record has failed, for the story.
    """
    rate = ProgressRate(batch.n_items, batch.n_done)
    missing = batch.missing
    yield Progress(rate.done, rate.total, "")
    answers = executor.as_completed(work(chunk.indices) for chunk in missing)
    for answer in answers:
        if answer is not None:
            number, result = answer
            chunk = missing[number]
            records = yield from _records(chunk, result, work, executor)
            batch.store(chunk, records)
            rate.advance(chunk.count, sum(map(failures, records)))
        yield Progress(rate.done, rate.total, str(rate))


def _records(
    chunk: Chunk, result: JobResult, work: Work, executor: Executor
) -> Generator[Step, None, Sequence[Record]]:
    """The records of a chunk, whatever became of its job."""
    match result:
        case Finished(value):
            return list(value)
        case Failed(sentence) if chunk.count == 1:
            return [Record(chunk.first, {LOST: sentence})]
        case Failed():
            return (yield from _one_by_one(chunk, work, executor))
        case Stopped(reason) if reason:
            raise EnvironmentProblem(reason)
        case _:
            raise Cancelled("The work was stopped.")


def _one_by_one(chunk: Chunk, work: Work, executor: Executor) -> Generator[Step, None, Sequence[Record]]:
    found: list[Record] = []
    for index, result in zip(chunk.indices, _said(executor, [work([i]) for i in chunk.indices]), strict=True):
        found += yield from _records(Chunk(chunk.number, index, 1), result, work, executor)
    return found


def _said(executor: Executor, jobs: Sequence[Job]) -> Iterator[JobResult]:
    return (result for result in executor.results(jobs) if result is not None)
