"""Checkpoints: records are there whole or not at all, for one process at a time and one subject."""

import os
import signal
import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import pytest

from regolith_studio.errors import FileError
from regolith_studio.io.checkpoint import Checkpoint, CheckpointRecord, read_note

ABOUT = {"recipe": "squares", "versions": {"numpy": "2"}}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "out" / "journal" / "checkpoint.sqlite"


def test_that_numbers_and_bytes_are_kept_to_the_last_bit(path: Path) -> None:
    values = {"x": [0.1, 1 / 3, 5e-324, 1.7976931348623157e308], "name": "Körnchen\n"}
    with Checkpoint.create(path, ABOUT) as checkpoint:
        checkpoint.add([CheckpointRecord(7, values, {"b": b"\0\xff"}), CheckpointRecord(2, {})])
    with Checkpoint.resume(path, ABOUT) as checkpoint:
        assert checkpoint.indices == {2, 7}
        bare, record = checkpoint.records()
        assert (record.index, dict(record.values), record.blobs["b"]) == (7, values, b"\0\xff")
        assert (bare.index, bare.values, bare.blobs) == (2, {}, {})


def test_that_a_value_that_is_not_finite_never_reaches_the_disk(path: Path) -> None:
    with Checkpoint.create(path, ABOUT) as checkpoint:
        with pytest.raises(ValueError, match="not JSON compliant"):
            checkpoint.add([CheckpointRecord(0, {}), CheckpointRecord(1, {"x": float("nan")})])
        assert checkpoint.indices == set()


def test_that_another_subject_is_refused_by_the_name_of_what_differs(path: Path) -> None:
    Checkpoint.create(path, ABOUT).close()
    with pytest.raises(FileError, match=r"unfinished run in .*out was begun with another recipe"):
        Checkpoint.resume(path, ABOUT | {"recipe": "cubes"})
    with pytest.raises(FileError, match=r"unfinished study in .* another versions"):
        Checkpoint.resume(path, ABOUT | {"versions": {"numpy": "3"}}, "study")
    Checkpoint.resume(path, ABOUT).close()  # the refusals have released the file


@pytest.mark.parametrize("content", [b"{}\n", b"SQLite format 3\0 and then nothing"])
def test_that_a_file_that_is_no_checkpoint_is_refused_and_may_be_replaced(path: Path, content: bytes) -> None:
    path.parent.mkdir(parents=True)
    path.write_bytes(content)
    with pytest.raises(FileError, match="damaged or no checkpoint"):
        Checkpoint.resume(path, ABOUT)
    Checkpoint.create(path, ABOUT).close()
    Checkpoint.resume(path, ABOUT).close()


def test_that_an_empty_file_is_a_beginning(path: Path) -> None:
    """As a full disk leaves it: SQLite makes the file and then cannot write to it."""
    path.parent.mkdir(parents=True)
    path.touch()
    assert read_note(path, "ended") is None
    with Checkpoint.resume(path, ABOUT) as checkpoint:
        checkpoint.add([CheckpointRecord(0, {})])
    with Checkpoint.resume(path, ABOUT) as checkpoint:
        assert checkpoint.indices == {0}


def test_that_the_database_of_another_program_is_refused(path: Path) -> None:
    path.parent.mkdir(parents=True)
    with closing(sqlite3.connect(path)) as database, database:
        database.execute("CREATE TABLE records (position, content)")
    with pytest.raises(FileError, match="no checkpoint of this program"):
        Checkpoint.resume(path, ABOUT)


def test_that_a_damaged_record_is_dropped(path: Path) -> None:
    with Checkpoint.create(path, ABOUT) as checkpoint:
        checkpoint.add(CheckpointRecord(i, {}, {"b": bytes([i]) * 9}) for i in range(3))
    with closing(sqlite3.connect(path)) as database, database:
        database.execute("UPDATE blobs SET content = x'00' WHERE position = 1")
    with Checkpoint.resume(path, ABOUT) as checkpoint:
        assert checkpoint.indices == {0, 2}
        checkpoint.add([CheckpointRecord(1, {}, {"b": b"1"})])
        assert [record.index for record in checkpoint.records()] == [0, 1, 2]


def test_that_a_second_process_is_kept_out(path: Path) -> None:
    code = (
        "import sys, pathlib; from regolith_studio.io.checkpoint import Checkpoint\n"
        f"for do in (Checkpoint.create, Checkpoint.resume):\n"
        f"    try: do(pathlib.Path(sys.argv[1]), {ABOUT!r}).close()\n"
        "    except Exception as error: print(error)"
    )
    command = [sys.executable, "-c", code, str(path)]
    with Checkpoint.create(path, ABOUT) as checkpoint:
        checkpoint.add([CheckpointRecord(0, {})])
        output = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        assert output.count("Another run is writing to") == 2
        assert checkpoint.indices == {0}
    assert subprocess.run(command, capture_output=True, text=True, check=True).stdout == ""


@pytest.mark.skipif(os.name == "nt", reason="signals are a matter of POSIX")
def test_that_a_killed_process_leaves_whole_records(path: Path) -> None:
    code = (
        "import sys, pathlib\n"
        "from regolith_studio.io.checkpoint import Checkpoint, CheckpointRecord as R\n"
        f"checkpoint = Checkpoint.create(pathlib.Path(sys.argv[1]), {ABOUT!r})\n"
        "for i in range(10**6):\n"
        "    checkpoint.add(R(3 * i + k, {'i': i}, {'b': bytes(9000)}) for k in range(3))\n"
        "    if i == 5: print('ready', flush=True)\n"
    )
    with subprocess.Popen([sys.executable, "-c", code, str(path)], stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        process.stdout.readline()
        process.send_signal(signal.SIGKILL)
    with Checkpoint.resume(path, ABOUT) as checkpoint:
        n = len(checkpoint.indices)
        assert n >= 18
        assert n % 3 == 0
        assert all(len(record.blobs["b"]) == 9000 for record in checkpoint.records())


def test_that_a_full_disk_is_one_sentence_and_keeps_what_was_there(path: Path) -> None:
    with Checkpoint.create(path, ABOUT) as checkpoint:
        checkpoint.add([CheckpointRecord(0, {})])
        checkpoint._connection.execute("PRAGMA max_page_count = 20")
        with pytest.raises(FileError, match="disk is full"):
            checkpoint.add([CheckpointRecord(1, {}, {"b": bytes(10**6)})])
    with Checkpoint.resume(path, ABOUT) as checkpoint:
        assert checkpoint.indices == {0}


def test_that_records_make_way_for_a_note_that_can_be_read_later(path: Path) -> None:
    with Checkpoint.create(path, ABOUT) as checkpoint:
        assert checkpoint.note("ended") is None
        checkpoint.add([CheckpointRecord(0, {}, {"b": bytes(10**6)})])
        checkpoint.remove_records(ended=["a problem"])
        assert checkpoint.indices == set()
    assert read_note(path, "ended") == ["a problem"]
    assert path.stat().st_size < 100_000
    assert [each.name for each in path.parent.iterdir()] == [path.name]
    Checkpoint.resume(path, ABOUT).close()
