"""Writing is all or nothing: every call of the system may fail, or the process die at it."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from regolith_studio.dataset.folder_io import read_dataset, write_dataset
from regolith_studio.dataset.validation import validate_dataset
from regolith_studio.errors import DatasetError
from regolith_studio.io import atomic
from regolith_studio.io.atomic import recover_folder
from regolith_studio.io.output_lock import leftovers

CALLS = ((os, "mkdir"), (os, "open"), (os, "rename"), (Path, "open"), (atomic, "swap_folders"))
"""Every call that writing a folder goes through."""

PATH_OPEN = Path.open


class Failing:
    """Lets the n-th call of the system fail, and counts calls."""

    def __init__(self, monkeypatch, at: int | None) -> None:
        self.count, self.at = 0, at
        for owner, name in CALLS:
            monkeypatch.setattr(owner, name, self._wrapped(getattr(owner, name)))

    def _wrapped(self, call):
        def counted(*arguments, **options):
            if call is PATH_OPEN and "xb" not in arguments:  # to read what is there
                return call(*arguments, **options)
            self.count += 1
            if self.count == self.at:
                raise OSError(28, "No space left on device")
            return call(*arguments, **options)

        return counted


def names(folder: Path) -> list[str]:
    return [representative.name for representative in read_dataset(folder).representatives]


def calls_of(monkeypatch, action) -> int:
    with monkeypatch.context() as patch:
        counter = Failing(patch, None)
        action()
    return counter.count


def test_that_a_failing_call_leaves_the_old_dataset_or_the_new_one(
    tmp_path, monkeypatch, make_dataset
) -> None:
    folder, old, new = tmp_path / "set", make_dataset(1), make_dataset(1, first=10)
    write_dataset(folder, old)
    steps = calls_of(monkeypatch, lambda: write_dataset(folder, new))
    assert steps > 10
    refused = 0
    for step in range(1, steps + 1):
        write_dataset(folder, old)
        with monkeypatch.context() as patch:
            Failing(patch, step)
            try:
                write_dataset(folder, new)
            except DatasetError as error:
                refused += 1
                assert "the disk is full" in str(error)  # noqa: PT017
                assert names(folder) == ["grain-0"]
                assert leftovers(folder) == []
            else:
                assert names(folder) == ["grain-10"]
                assert len(leftovers(folder)) <= 1
        assert validate_dataset(folder) == []
        for rest in leftovers(folder):
            atomic.remove_quietly(rest)
    assert refused >= 6


DRIVER = """
import json, os, signal, sys
from pathlib import Path
from regolith_studio.io import atomic
from regolith_studio.io.atomic import replace_folder
from regolith_studio.io.output_lock import leftovers
from regolith_studio.dataset.folder_io import dataset_files, read_dataset
from regolith_studio.dataset.validation import validate_dataset

folder, runs, mode, swaps = Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3], sys.argv[4] == "swap"
def contents(root):
    return {p.relative_to(root).as_posix(): p.read_bytes() for p in Path(root).rglob("*") if p.is_file()}

files = [contents(folder) for folder in sys.argv[5:]]
if not swaps:
    atomic.swap_folders = lambda first, second: False
count = 0

def deadly(call, at, after):
    def counted(*arguments, **options):
        global count
        count += 1
        if count == at and not after:
            os.kill(os.getpid(), signal.SIGKILL)
        mine = count == at and after
        try:
            return call(*arguments, **options)
        finally:
            if mine:
                os.kill(os.getpid(), signal.SIGKILL)
    return counted

def child(run):
    calls = (os, "mkdir"), (os, "open"), (os, "rename"), (Path, "open"), (Path, "mkdir")
    for owner, name in (*calls, (atomic, "swap_folders"), (atomic.shutil, "rmtree")):
        setattr(owner, name, deadly(getattr(owner, name), run + 1, mode == "after"))
    replace_folder(folder, files[1])
    os._exit(0)

found, killed = [0, 0], 0
for run in range(runs):
    atomic.recover_folder(folder)
    replace_folder(folder, files[0])
    pid = os.fork()
    if pid == 0:
        child(run)
    status = os.waitpid(pid, 0)[1]
    killed += os.WIFSIGNALED(status)
    names = [r.name for r in read_dataset(folder).representatives]
    problems = validate_dataset(folder)
    assert not problems, problems
    found[names[0] != "grain-0"] += 1
    for rest in leftovers(folder):
        atomic.remove_quietly(rest)
    if not os.WIFSIGNALED(status):
        break
print(json.dumps({"found": found, "killed": killed, "runs": run + 1}))
"""


def drive(tmp_path: Path, make_dataset, runs: int, mode: str, swap: str) -> dict:
    """Kill writers of the folder and look at it after each, in a process that can fork cheaply."""
    for name, first in (("old", 0), ("new", 10), ("set", 0)):
        write_dataset(tmp_path / name, make_dataset(1, first=first))
    sources = (str(tmp_path / "old"), str(tmp_path / "new"))
    run = subprocess.run(
        [
            sys.executable,
            "-W",
            "ignore",
            "-c",
            DRIVER,
            str(tmp_path / "set"),
            str(runs),
            mode,
            swap,
            *sources,
        ],
        capture_output=True,
        text=True,
        check=False,
        cwd=Path(__file__).parents[2],
    )
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout)


needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system cannot fork")


@needs_fork
@pytest.mark.parametrize(
    ("mode", "swap"),
    [
        ("before", "swap"),
        pytest.param("after", "swap", marks=pytest.mark.slow),
        pytest.param("before", "no swap", marks=pytest.mark.slow),
        pytest.param("after", "no swap", marks=pytest.mark.slow),
    ],
)
def test_that_a_kill_at_every_step_leaves_the_old_dataset_or_the_new_one(
    tmp_path, make_dataset, mode, swap
) -> None:
    report = drive(tmp_path, make_dataset, 400, mode, swap)
    assert report["runs"] == report["killed"] + 1 < 400
    assert report["found"][0] > 10
    assert report["found"][1] >= 2


def test_that_a_folder_moved_aside_by_a_writer_that_died_is_put_back(tmp_path: Path, make_dataset) -> None:
    folder = write_dataset(tmp_path / "set", make_dataset(1))
    folder.rename(tmp_path / ".set.regolith-old")
    assert names(folder) == ["grain-0"]
    assert recover_folder(folder).is_dir()


def test_that_leftovers_of_dead_writers_are_cleared_by_the_next_one(tmp_path: Path, make_dataset) -> None:
    (tmp_path / f".set.{'a' * 12}.regolith-new").mkdir()
    other = tmp_path / f".set.b.{'b' * 12}.regolith-new"
    other.mkdir()
    write_dataset(tmp_path / "set", make_dataset(1))
    assert sorted(path.name for path in tmp_path.iterdir()) == [other.name, "set"]
