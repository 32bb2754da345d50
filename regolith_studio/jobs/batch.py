"""A large batch in chunks: each is written to a checkpoint as soon as it is done, and none is done twice."""

from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from regolith_studio.errors import JobCancelled, MissingRequirement
from regolith_studio.io.checkpoint import Checkpoint, CheckpointRecord
from regolith_studio.jobs.events import (
    Failed,
    Finished,
    Job,
    JobResult,
    Progress,
    ProgressRate,
    Step,
    Stopped,
)
from regolith_studio.jobs.executor import Executor

SMALL_BATCH = 200
"""Below so many items each is a chunk of its own: their items tend to be those that take long."""
CHUNK_LIMITS = (25, 200)
CHUNKS = 64
"""A large batch is cut into about so many chunks, within the limits."""
LOST = "lost"
"""Key in the values of an item that ended the process that worked on it: the message."""
_N_ITEMS, _CHUNK_SIZE = "number of particles", "chunk size"

MakeJob = Callable[[Sequence[int]], Job]
"""Makes the job of a chunk from the indices of its items; the job returns a `CheckpointRecord` for each."""


def chunks_of(n_items: int, size: int) -> tuple[range, ...]:
    """The indices of the items in chunks of `size`, the last one perhaps smaller."""
    return tuple(range(first, min(first + size, n_items)) for first in range(0, n_items, size))


def chunk_size(n_items: int) -> int:
    """Number of items in a chunk; does not depend on the number of workers."""
    if n_items < SMALL_BATCH:
        return 1
    low, high = CHUNK_LIMITS
    return min(max(n_items // CHUNKS, low), high)


class Batch:
    """The items of a batch in chunks, with the results of those that are done in a checkpoint.

    ``checkpoint``: holds a record for each item that is done; to be closed by the caller. ``n_items``: of
    the whole batch.
    """

    def __init__(self, checkpoint: Checkpoint, n_items: int) -> None:
        self.checkpoint, self.n_items = checkpoint, n_items
        self._chunks = chunks_of(n_items, checkpoint.note(_CHUNK_SIZE) or chunk_size(n_items))
        self._done = checkpoint.indices

    @classmethod
    def create(
        cls, path: Path, n_items: int, subject: Mapping[str, Any], chunk: int | None = None
    ) -> "Batch":
        """A batch of which nothing is done yet."""
        checkpoint = Checkpoint.create(path, {**subject, _N_ITEMS: n_items})
        checkpoint.set_note(_CHUNK_SIZE, chunk or chunk_size(n_items))
        return cls(checkpoint, n_items)

    @classmethod
    def resume(cls, path: Path, n_items: int, subject: Mapping[str, Any]) -> "Batch":
        """The batch that was begun here, with what is done of it."""
        return cls(Checkpoint.resume(path, {**subject, _N_ITEMS: n_items}), n_items)

    @property
    def n_done(self) -> int:
        """Number of items whose results are on the disk."""
        return len(self._done)

    @property
    def missing(self) -> tuple[range, ...]:
        """Chunks that are still to be done."""
        return tuple(chunk for chunk in self._chunks if not self._done.issuperset(chunk))

    def store(self, chunk: range, records: Sequence[CheckpointRecord]) -> None:
        """Write the results of the items of a chunk that are not there yet."""
        self.checkpoint.add(each for each in records if each.index not in self._done)
        self._done.update(chunk)


def run_batch(
    batch: Batch,
    make_job: MakeJob,
    executor: Executor,
    count_failures: Callable[[CheckpointRecord], int] = lambda _: 0,
) -> Generator[Step, None, None]:
    """Do what is missing of a batch, with rate and time left after each chunk.

    An item that ends the process that works on it is found by doing the items of its chunk one by one;
    its record holds the message under :data:`LOST`.

    ``count_failures``: number of failures in a record, for the progress message.
    """
    rate = ProgressRate(batch.n_items, batch.n_done)
    missing = batch.missing
    yield Progress(rate.done, rate.total, "")
    answers = executor.as_completed(make_job(chunk) for chunk in missing)
    for answer in answers:
        if answer is not None:
            number, result = answer
            chunk = missing[number]
            records = yield from _records_of(chunk, result, make_job, executor)
            batch.store(chunk, records)
            rate.advance(batch.n_done - rate.done, sum(map(count_failures, records)))
        yield Progress(rate.done, rate.total, str(rate))


def _records_of(
    chunk: range, result: JobResult, make_job: MakeJob, executor: Executor
) -> Generator[Step, None, Sequence[CheckpointRecord]]:
    """The records of a chunk, however its job ended."""
    match result:
        case Finished(value):
            return list(value)
        case Failed(sentence) if len(chunk) == 1:
            return [CheckpointRecord(chunk.start, {LOST: sentence})]
        case Failed():
            return (yield from _one_by_one(chunk, make_job, executor))
        case Stopped(reason) if reason:
            raise MissingRequirement(reason)
        case _:
            raise JobCancelled("The work was stopped.")


def _one_by_one(
    chunk: range, make_job: MakeJob, executor: Executor
) -> Generator[Step, None, Sequence[CheckpointRecord]]:
    records: list[CheckpointRecord] = []
    results = _results(executor, [make_job([index]) for index in chunk])
    for index, result in zip(chunk, results, strict=True):
        records += yield from _records_of(range(index, index + 1), result, make_job, executor)
    return records


def _results(executor: Executor, jobs: Sequence[Job]) -> Iterator[JobResult]:
    return (result for result in executor.results(jobs) if result is not None)
