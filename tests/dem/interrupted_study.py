"""Interrupt ``repose study`` at the lines of its code; prints a line for each end that is wrong.

``python -m tests.dem.interrupted_study FOLDER EVERY`` replaces an earlier study in a process of its own for
each interruption, on an engine that needs no time; EVERY takes one line in so many. A second interruption
comes some calls after the first, as a second Ctrl+C would.
"""

import contextlib
import hashlib
import os
import shutil
import sys
from collections import Counter
from collections.abc import Callable, Generator
from dataclasses import replace
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np

import regolith_studio
from regolith_studio.cli.entry import run
from regolith_studio.dataset.folder_io import write_dataset
from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import RunChecks, SimulationResult
from regolith_studio.dem.initial_packing import loose_column
from regolith_studio.dem.run_io import save_snapshot
from regolith_studio.dem.snapshot import Snapshot
from regolith_studio.jobs import repose_jobs
from regolith_studio.studies.figures import repose as figures
from tests.dem.conftest import box_dataset

PACKAGE = Path(regolith_studio.__file__).parent
TRACED = tuple(
    str(PACKAGE / name)
    for name in ("io/", "jobs/repose", "dem/run_io", "studies/repose", "studies/figures/repose", "cli/repose")
)
CALLS_BETWEEN = (1, 30, 300)
"""Calls between the first interruption and a second one."""
SMALL = "-n 40 --measure min_particles=40 --test mass=0.003"
LOCK_FILE = ".study.regolith-lock"
"""An empty file, which may stay where the interruption comes between its making and the lock."""
Place = tuple[str, int]
"""A line of code: file and number."""


def main(folder: Path, every: int) -> None:
    """Interrupt at the first and the last time that each line is reached."""
    repose_jobs.run_engine = instant_engine  # type: ignore[assignment]
    figures.write_figure = write_figure  # type: ignore[assignment]
    dataset, place, earlier = folder / "data" / "boxes", folder / "work" / "study", folder / "earlier"
    write_dataset(dataset, box_dataset())
    words = ["repose", "study", str(dataset), "-o", str(place), *SMALL.split()]
    assert in_child(lambda: run([*words, "--contact", "static_friction=0.3"])) == 0
    shutil.copytree(place, earlier)
    passed: Counter[Place] = Counter()
    old = tree(place)
    with contextlib.redirect_stdout(None):
        assert run(words) == 0  # imports what is counted next
        new = tree(place)
        shutil.rmtree(place)
        shutil.copytree(earlier, place)
        reached(words, passed)
    assert new == tree(place)
    assert set(old) == set(new)
    assert old != new
    for (number, (line, last)), again in (
        (each, again) for each in enumerate(passed.items()) for again in (0, *CALLS_BETWEEN)
    ):
        for time in {1, last} if number % every == 0 else ():
            shutil.rmtree(place.parent)
            shutil.copytree(earlier, place)
            code = in_child(lambda line=line, time=time, again=again: interrupted(words, line, time, again))
            found, left = tree(place), sorted(path.name for path in place.parent.iterdir())
            left.remove("study")
            if code != 130 or found not in (old, new) or not (again or {*left} <= {LOCK_FILE}):
                mixed = sorted(name for name in old if found.get(name) != old[name])
                where = f"{line[0].removeprefix(str(PACKAGE))}:{line[1]} time {time}, again {again}"
                sys.stdout.write(f"{where}: code {code}, {left}, not as earlier: {mixed}\n")


def instant_engine(
    _key: str, prepared: PreparedCase, _settings: Any, folder: Path, _threads: int
) -> Generator[Snapshot | None, None, SimulationResult]:
    """A run whose particles stay where they begin, on one level."""
    column = loose_column(prepared)
    flat = replace(column, points=column.points * [1.0, 1.0, 0.0] + [0.0, 0.0, column.diameters.max() / 2])
    save_snapshot(folder, 0, flat)
    yield Snapshot(flat, 0.5, "half")
    yield None
    n = len(flat.points)
    return SimulationResult(flat, RunChecks(n, n, 0.0, 0.0, 0.0, 0.0, 0.0, True, 0.02, 0.55, 0.0), 1, 1.0)


def write_figure(figure: Any, folder: Path, stem: str) -> tuple[Path, Path]:
    """Files in place of figures, which take long."""
    content = repr(np.array([line.get_xydata() for line in figure.axes[0].lines], dtype=object)).encode()
    paths = folder / f"{stem}.png", folder / f"{stem}.svg"
    for path in paths:
        path.write_bytes(content)
    return paths


def tree(folder: Path) -> dict[str, str]:
    """SHA-256 of the files of a study, but for the journal, durations and lists of hashes with durations."""
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in folder.rglob("*")
        if path.is_file()
        and path.relative_to(folder).parts[0] != "journal"
        and path.name != "times.json"
        and path.suffix != ".sha256"
    }


def in_child(work: Callable[[], int]) -> int:
    """Exit code of `work` in a process of its own."""
    if child := os.fork():
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    nothing = os.open(os.devnull, os.O_RDWR)
    for number in (1, 2):
        os.dup2(nothing, number)
    code = 99
    try:
        code = work()
    finally:
        os._exit(code)


def reached(words: list[str], passed: "Counter[Place]") -> None:
    """Count how often each line is reached by the command."""

    def count(place: Place) -> None:
        passed[place] += 1

    sys.settrace(tracer(count))
    assert run(words) == 0
    sys.settrace(None)


def interrupted(words: list[str], line: Place, time: int, again: int) -> int:
    """Exit code of the command, interrupted when it reaches a line for the n-th time, and once more later."""
    calls = passed = 0

    def interrupt(place: Place) -> None:
        nonlocal passed
        passed += place == line
        if place == line and passed == time:
            if again:
                sys.setprofile(interrupt_again)
            raise KeyboardInterrupt

    def interrupt_again(_frame: FrameType, event: str, _argument: Any) -> None:
        nonlocal calls
        calls += event == "call"
        if calls == again:
            sys.setprofile(None)
            raise KeyboardInterrupt

    sys.settrace(tracer(interrupt))
    try:
        return run(words)
    except KeyboardInterrupt:  # the second one, while the first was being reported: __main__ has this clause
        return 130


def tracer(reach: Callable[[Place], None]) -> Callable[..., Any]:
    """A trace function that reports the lines of the traced files."""

    def trace(frame: FrameType, event: str, _argument: Any) -> Any:
        if not frame.f_code.co_filename.startswith(TRACED):
            return None
        if event == "line":
            reach((frame.f_code.co_filename, frame.f_lineno))
        return trace

    return trace


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]))
