"""Batches in chunks: what is on disk is not done again, and what is lost is only what was under way."""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from regolith_studio.errors import FileError, InputError
from regolith_studio.jobs.chunked import LOST, Batch, chunk_size, chunks_of, work_through
from regolith_studio.jobs.events import Job, Progress, Started, Steps
from regolith_studio.jobs.executor import open_executor
from regolith_studio.jobs.journal import Journal
from regolith_studio.jobs.progress_rate import ProgressRate, format_duration
from regolith_studio.jobs.shards import Record, read_shard, write_shard

ABOUT = {"recipe": "squares"}


def squares(indices: Sequence[int]) -> Steps:
    yield Started("Squaring", len(indices))
    return [Record(i, {"square": i * i, "pid": os.getpid()}, {"text": f"<{i}>".encode()}) for i in indices]


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
        return [step for step in work_through(batch, work, executor) if isinstance(step, Progress)]


def found(batch: Batch) -> list[tuple[int, int | None, bytes | None]]:
    batch.close()
    return [(r.index, r.values.get("square"), r.blobs.get("text")) for r in batch.records()]


def test_that_chunks_cover_every_item_once() -> None:
    assert [tuple(c.indices) for c in chunks_of(7, 3)] == [(0, 1, 2), (3, 4, 5), (6,)]
    assert chunks_of(0, 3) == ()


@pytest.mark.parametrize(
    ("items", "size"), [(1, 1), (199, 1), (200, 25), (3_200, 50), (10_000, 156), (10**6, 200)]
)
def test_that_chunks_of_large_batches_have_25_to_200_items(items: int, size: int) -> None:
    assert chunk_size(items) == size


@pytest.mark.parametrize("workers", [1, 2])
def test_that_a_batch_finds_every_record_in_order(tmp_path: Path, workers: int) -> None:
    batch = Batch.begin(tmp_path / "b", 10, ABOUT, chunk=3)
    steps = finish(batch, workers)
    assert found(batch) == [(i, i * i, f"<{i}>".encode()) for i in range(10)]
    assert (steps[0].done, steps[-1].done, steps[-1].total) == (0, 10, 10)


def test_that_what_is_on_disk_is_not_done_again(tmp_path: Path) -> None:
    batch = Batch.begin(tmp_path, 10, ABOUT, chunk=3)
    for number in (0, 2):
        chunk = batch.chunks[number]
        batch.store(chunk, [Record(i, {"square": -1}) for i in chunk.indices])
    batch.close()
    again = Batch.resume(tmp_path, 10, ABOUT)
    assert again.n_done == 6
    assert finish(again)[0].done == 6
    assert [square for _, square, _ in found(again)] == [-1, -1, -1, 9, 16, 25, -1, -1, -1, 81]


def test_that_a_damaged_shard_is_done_again(tmp_path: Path) -> None:
    batch = Batch.begin(tmp_path, 4, ABOUT, chunk=2)
    finish(batch)
    batch.close()
    shard = tmp_path / "shards" / "000001.zip"
    shard.write_bytes(shard.read_bytes()[:-20])
    again = Batch.resume(tmp_path, 4, ABOUT)
    assert [chunk.number for chunk in again.missing] == [1]
    finish(again)
    assert len(found(again)) == 4


def test_that_a_line_cut_off_by_death_does_not_count(tmp_path: Path) -> None:
    batch = Batch.begin(tmp_path, 4, ABOUT, chunk=2)
    finish(batch)
    batch.close()
    journal = tmp_path / "journal.jsonl"
    journal.write_bytes(journal.read_bytes()[:-30])
    again = Batch.resume(tmp_path, 4, ABOUT)
    assert again.n_done == 2
    finish(again)
    again.close()
    assert [json.loads(line)["chunk"] for line in journal.read_text().splitlines()[1:]] == [0, 1]


def test_that_a_journal_of_another_recipe_is_refused_by_name(tmp_path: Path) -> None:
    Batch.begin(tmp_path / "b", 4, ABOUT).close()
    with pytest.raises(FileError, match="begun with another recipe"):
        Batch.resume(tmp_path / "b", 4, {"recipe": "cubes"})
    with pytest.raises(FileError, match="number of particles"):
        Batch.resume(tmp_path / "b", 5, ABOUT)


def test_that_a_file_that_is_no_journal_is_refused(tmp_path: Path) -> None:
    (tmp_path / "j").write_text('{"a": 1}\n')
    with pytest.raises(FileError, match="no journal"):
        Journal.reopen(tmp_path / "j")
    (tmp_path / "j").write_text("{]\n")
    with pytest.raises(FileError, match="damaged"):
        Journal.reopen(tmp_path / "j")


@pytest.mark.skipif(os.name == "nt", reason="locks are a matter of POSIX")
def test_that_two_processes_cannot_write_one_journal(tmp_path: Path) -> None:
    batch = Batch.begin(tmp_path / "b", 4, ABOUT)
    code = (
        "import sys, pathlib; from regolith_studio.jobs.journal import Journal\n"
        "try: Journal.reopen(pathlib.Path(sys.argv[1]))\n"
        "except Exception as error: print(error)"
    )
    path = str(tmp_path / "b" / "journal.jsonl")
    said = subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True, check=True)
    assert "Another run is writing" in said.stdout
    batch.close()
    again = subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True, check=True)
    assert again.stdout == ""


def test_that_an_item_that_kills_its_worker_costs_itself_alone(tmp_path: Path) -> None:
    batch = Batch.begin(tmp_path, 9, ABOUT, chunk=3)
    finish(batch, 2, deadly_of)
    assert [square for _, square, _ in found(batch)] == [0, 1, 4, 9, 16, None, 36, 49, 64]
    lost = next(record for record in batch.records() if record.index == 5)
    assert "died" in lost.values[LOST]


def test_that_a_shard_keeps_numbers_to_the_last_bit(tmp_path: Path) -> None:
    values = {"x": [0.1, 1 / 3, 5e-324, 1.7976931348623157e308], "name": "Körnchen\n"}
    write_shard(tmp_path / "s.zip", [Record(7, values, {"b": b"\0\xff"})])
    (record,) = read_shard(tmp_path / "s.zip")
    assert (record.index, dict(record.values), record.blobs["b"]) == (7, values, b"\0\xff")
    (bare,) = read_shard(tmp_path / "s.zip", blobs=False)
    assert bare.blobs == {}


def test_that_a_value_that_is_no_number_never_reaches_the_disk(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="not JSON compliant"):
        write_shard(tmp_path / "s.zip", [Record(0, {"x": float("nan")})])
    assert not (tmp_path / "s.zip").exists()


def test_that_the_pace_is_items_by_seconds_and_forgets_what_was_done_before() -> None:
    now = [0.0]
    rate = ProgressRate(1000, 400, clock=lambda: now[0])
    assert str(rate) == ""
    now[0] = 10.0
    rate.advance(50, failed=2)
    assert rate.rate == 5.0
    assert rate.seconds_left == 110.0
    assert str(rate) == "5 a second, 1 min 50 s left, 2 failed"


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(8.4, "8 s"), (99, "99 s"), (200, "3 min 20 s"), (1500, "25 min"), (7500, "2 h 5 min")],
)
def test_that_a_time_is_said_as_people_say_it(seconds: float, words: str) -> None:
    assert format_duration(seconds) == words


def test_that_an_error_of_the_work_is_no_end_of_the_batch(tmp_path: Path) -> None:
    batch = Batch.begin(tmp_path, 3, ABOUT, chunk=3)
    finish(batch, 1, refusing_of)
    batch.close()
    assert [r.values.get(LOST, "") for r in batch.records()] == ["", "Item 1 is too green.", ""]


def refusing(indices: Sequence[int]) -> Steps:
    yield Started("Refusing")
    if 1 in indices:
        raise InputError("Item 1 is too green.")
    return (yield from squares(indices))


def refusing_of(indices: Sequence[int]) -> Job:
    return Job(refusing, (tuple(indices),))
