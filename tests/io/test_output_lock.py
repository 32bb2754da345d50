"""Two processes do not write to one place."""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from regolith_studio.errors import FileError
from regolith_studio.io.output_lock import output_lock

HOLDER = """
import sys; from pathlib import Path; from regolith_studio.io.output_lock import output_lock
with output_lock(Path(sys.argv[1])): print("locked", flush=True); input()
"""


@contextmanager
def held_by_another(place: Path) -> Iterator[subprocess.Popen[str]]:
    with subprocess.Popen(
        [sys.executable, "-c", HOLDER, str(place)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == "locked\n"
        yield other
        other.kill()


def lock(place: Path) -> None:
    with output_lock(place):
        pass


def test_that_the_second_writer_gets_a_sentence_and_a_third_place_is_free(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "out")
    with held_by_another(tmp_path / "out"):
        for name in ("out", "link"):
            with pytest.raises(FileError, match="Another process is writing to"):
                lock(tmp_path / name)
        lock(tmp_path / "out.npz")


def test_that_the_place_is_free_after_a_kill_and_clean_after_the_next_writer(tmp_path: Path) -> None:
    with held_by_another(tmp_path / "out"):
        pass
    (tmp_path / f".out.{'a' * 12}.regolith-new").mkdir()
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / f".table.csv.{'b' * 12}.regolith-new").write_text("half")
    lock(tmp_path / "out")
    assert [path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*")] == ["out"]


def test_that_one_process_may_lock_twice_and_leaves_no_folders_that_it_made(tmp_path: Path) -> None:
    place = tmp_path / "new" / ("ä" * 127)
    with output_lock(place), output_lock(place):
        assert place.parent.is_dir()
    assert list(tmp_path.iterdir()) == []
