"""Batches in chunks: what is on disk is not done again, and what is lost is only what was under way."""

import os
from collections.abc import Sequence
from pathlib import Path

import pytest

from regolith_studio.errors import FileError, InputError
from regolith_studio.io.checkpoint import CheckpointRecord
from regolith_studio.jobs.batch import LOST, Batch, chunk_size, chunks_of, run_batch
from regolith_studio.jobs.events import Job, Progress, Started, Steps
from regolith_studio.jobs.executor import open_executor

ABOUT = {"recipe": "squares"}


def squares(indices: Sequence[int]) -> Steps:
    yield Started("Squaring", len(indices))
    return [
        CheckpointRecord(i, {"square": i * i, "pid": os.getpid()}, {"text": f"<{i}>".encode()})
        for i in indices
    ]


def squares_of(indices: Sequence[int]) -> Job:
    return Job(squares, (tuple(indices),))


def deadly(indices: Sequence[int]) -> Steps:
    yield Started("Squaring")
    if 5 in indices:
        os._exit(9)
    return (yield from squares(indices))


def deadly_of(indices: Sequence[int]) -> Job:
    return Job(deadly, (tuple(indices),))


def finish(batch: Batch, workers: int = 1, work=squares_of) -> list[Progress]:
    with open_executor(workers) as executor:
        return [step for step in run_batch(batch, work, executor) if isinstance(step, Progress)]


def found(batch: Batch) -> list[tuple[int, int | None, bytes | None]]:
    return [(r.index, r.values.get("square"), r.blobs.get("text")) for r in batch.checkpoint.records()]


def test_that_chunks_cover_every_item_once() -> None:
    assert [tuple(chunk) for chunk in chunks_of(7, 3)] == [(0, 1, 2), (3, 4, 5), (6,)]
    assert chunks_of(0, 3) == ()


@pytest.mark.parametrize(
    ("items", "size"), [(1, 1), (199, 1), (200, 25), (3_200, 50), (10_000, 156), (10**6, 200)]
)
def test_that_chunks_of_large_batches_have_25_to_200_items(items: int, size: int) -> None:
    assert chunk_size(items) == size


@pytest.mark.parametrize("workers", [1, 2])
def test_that_a_batch_finds_every_record_in_order(tmp_path: Path, workers: int) -> None:
    batch = Batch.create(tmp_path / "b.sqlite", 10, ABOUT, chunk=3)
    steps = finish(batch, workers)
    assert found(batch) == [(i, i * i, f"<{i}>".encode()) for i in range(10)]
    assert (steps[0].done, steps[-1].done, steps[-1].total) == (0, 10, 10)


def test_that_what_is_on_disk_is_not_done_again(tmp_path: Path) -> None:
    batch = Batch.create(tmp_path / "b.sqlite", 10, ABOUT, chunk=3)
    for number in (0, 2):
        chunk = batch.missing[0 if number == 0 else 1]
        batch.store(chunk, [CheckpointRecord(i, {"square": -1}) for i in chunk])
    batch.checkpoint.close()
    again = Batch.resume(tmp_path / "b.sqlite", 10, ABOUT)
    assert again.n_done == 6
    assert finish(again)[0].done == 6
    assert [square for _, square, _ in found(again)] == [-1, -1, -1, 9, 16, 25, -1, -1, -1, 81]


def test_that_a_checkpoint_of_another_recipe_is_refused_by_name(tmp_path: Path) -> None:
    Batch.create(tmp_path / "b.sqlite", 4, ABOUT).checkpoint.close()
    with pytest.raises(FileError, match="begun with another recipe"):
        Batch.resume(tmp_path / "b.sqlite", 4, {"recipe": "cubes"})
    with pytest.raises(FileError, match="number of particles"):
        Batch.resume(tmp_path / "b.sqlite", 5, ABOUT)


def test_that_an_item_that_kills_its_worker_costs_itself_alone(tmp_path: Path) -> None:
    batch = Batch.create(tmp_path / "b.sqlite", 9, ABOUT, chunk=3)
    finish(batch, 2, deadly_of)
    assert [square for _, square, _ in found(batch)] == [0, 1, 4, 9, 16, None, 36, 49, 64]
    lost = next(record for record in batch.checkpoint.records() if record.index == 5)
    assert "died" in lost.values[LOST]


def test_that_an_error_of_the_work_is_no_end_of_the_batch(tmp_path: Path) -> None:
    batch = Batch.create(tmp_path / "b.sqlite", 3, ABOUT, chunk=3)
    finish(batch, 1, refusing_of)
    assert [r.values.get(LOST, "") for r in batch.checkpoint.records()] == ["", "Item 1 is too green.", ""]


def refusing(indices: Sequence[int]) -> Steps:
    yield Started("Refusing")
    if 1 in indices:
        raise InputError("Item 1 is too green.")
    return (yield from squares(indices))


def refusing_of(indices: Sequence[int]) -> Job:
    return Job(refusing, (tuple(indices),))
