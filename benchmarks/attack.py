"""Every command that writes, on a full disk, killed, with a second writer, and where nothing can be written.

``python -m benchmarks.attack`` runs each command over an earlier result of the same command with other
options, so that afterwards the place must hold the earlier result or the new one, byte for byte, and nothing
else. It prints one line a command and kind of attack:

runs
    How many.
sentences
    How many failed with one sentence. Unclear ends have more lines or a traceback; a kill needs no sentence.
lost
    How many left neither result, or claimed to have succeeded without the new one.
mixed
    How many left parts of both, or of one.
left
    How many left hidden files or processes behind, after SIGKILL once the next run has ended.

A command runs in a process that is forked from this one, which has loaded the program's modules, so that all
moments fall into its work and none into imports. SIGINT and SIGHUP go to all processes of the command, as a
terminal sends them, SIGTERM and SIGKILL to the first alone. `demo` is shortened (:func:`shorten_demo`).

Linux only. Full and read-only disks are small file systems in memory, which needs root.
Then come inputs that were made to harm (:mod:`benchmarks.attack_inputs`).
``--share 0.1 --seed 1`` runs a sample, ``--only NAME ...`` some of :data:`COMMANDS`.
Ctrl+C ends it with the table of what ran.
"""

import argparse
import hashlib
import io
import math
import multiprocessing
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import uuid
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, nullcontext, redirect_stderr, redirect_stdout, suppress
from dataclasses import astuple, dataclass, replace
from functools import partial
from itertools import takewhile
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

from benchmarks import attack_inputs
from benchmarks.attack_inputs import PROGRESS, write_inputs
from regolith_studio import __main__ as program
from regolith_studio.cli import entry

ROOT = Path(__file__).resolve().parents[1]
DISK_MOMENTS, KILL_MOMENTS = 5, 10
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL)
NOT_COMPARED = {"times.json", "journal"}
"""Durations differ, and a journal is there to be resumed."""
PATIENCE = 900.0
BLOCK = 4096
"""Bytes in which a file system in memory counts."""
GRACE = 2.0
"""Seconds after the end of a command, or after a signal, in which its processes must be gone.

They are multiplied by the number of processes that wait for a core, where it is above 1.
"""

QUICK = (
    "-n 40 --measure min_particles=40 --test mass=0.003 --test lift_speed=0.15 --set time_step=0.04 "
    "--set iterations=15 --set rest_energy=4e-3 --set snapshots=12"
)
"""A heap in about a second, of too few particles for an angle that means anything."""
COMMANDS = {
    "fit": ("fit IN/meshes -o OUT/f.json --l-max 6", "--l-max 4"),
    "fit surfaces": ("fit IN/meshes -o OUT/f.json --surfaces OUT/surfaces --l-max 6 --level 2", "--l-max 4"),
    "generate": ("generate IN/fit.json -o OUT/g -n 6 --level 2", "-n 4"),
    "generate npz": ("generate IN/fit.json -o OUT/g -n 6 --format npz --save-model OUT/m.json", "-n 4"),
    "coarsen": ("coarsen IN/meshes -o OUT/c --method quadric --facets 12 --jobs 2", "--facets 8"),
    "extract": ("extract IN/labels.npy -o OUT/e --kind labels --voxel-size 2", "--voxel-size 3"),
    "gallery": ("gallery IN/meshes/grain-0.stl -o OUT/p --degrees 1 --no-animation", "--degrees 2"),
    "run": ("run IN/recipe.json -o OUT/r --jobs 2", "--seed 5"),
    "demo": ("demo -o OUT/d", "--seed 5"),
    "study lmax": ("study lmax IN/meshes/grain-0.stl -o OUT/s --degrees 1-2", "--degrees 1"),
    "study coarsening": (
        "study coarsening IN/meshes -o OUT/s --method quadric --loss all --facets 12",
        "--facets 8",
    ),
    "study solids": (
        "study solids IN/meshes -o OUT/s --method quadric --loss all --facets 12",
        "--facets 8",
    ),
    "study population": (
        "study population IN/many.json -o OUT/s --models gaussian_field --l-max 3 --splits 1 --repeats 1 "
        "--descriptors equivalent_radius,sphericity",
        "--seed 1",
    ),
    "study facets": ("study facets IN/meshes -o OUT/s --method quadric --facets 8", "--facets 12"),
    "study tradeoff": (
        "study tradeoff IN/meshes/grain-0.stl -o OUT/s --factors 1 --method annealing --set iterations=100",
        "--facets 8",
    ),
    "study sensitivity": (
        "study sensitivity IN/meshes/grain-0.stl -o OUT/s --factors 4 --method annealing "
        "--set iterations=100",
        "--facets 8",
    ),
    "dataset build": (
        "dataset build IN/meshes -o OUT/d --method quadric --facets 12 --overwrite --name d",
        "--facets 8",
    ),
    "dataset sample": ("dataset sample IN/dataset -o OUT/d.csv -n 5000", "-n 4000"),
    "dataset export": ("dataset export IN/dataset -o OUT/x --to rocky,gltf --particles 40", "--particles 30"),
    "repose measure": ("repose measure IN/heap.csv -o OUT/m", "--base 0.0001"),
    "repose run": (
        f"repose run IN/dataset -o OUT/run --overwrite {QUICK}",
        "--seed 1",
    ),
    "repose study": (
        f"repose study IN/dataset -o OUT/t --vary plate_friction=0.8 {QUICK}",
        "--measure confidence=0.8",
    ),
    "repose calibrate": (
        f"repose calibrate IN/dataset -o OUT/c --angle 25 --runs 2 {QUICK}",
        "--angle 26",
    ),
}
"""What is run, and what its earlier run had instead."""
TO_ALL = {signal.SIGINT, signal.SIGHUP}
"""Signals that a terminal sends to all processes of a command."""
_FORK = multiprocessing.get_context("fork")
_MARK = "REGOLITH_ATTACK"

Tree = dict[str, str]


@dataclass(frozen=True)
class Prepared:
    """A command with both of its results, and how long it takes."""

    name: str
    words: tuple[str, ...]
    earlier: Path
    old: Tree
    new: Tree
    seconds: float
    n_bytes: int
    notes_on: tuple[str, ...] = ()
    """Lines on stderr of an undisturbed run."""


@dataclass
class Row:
    """What came of the runs of one kind of attack."""

    runs: int = 0
    sentences: int = 0
    unclear: int = 0
    lost: int = 0
    mixed: int = 0
    left: int = 0


Rows = dict[tuple[str, str], Row]
"""By command and kind of attack."""


@dataclass(frozen=True)
class Ended:
    """How a command ended."""

    code: int
    stderr: str
    processes: int


class Arena:
    """A place for results that is emptied between runs, beside the inputs."""

    def __init__(self, folder: Path) -> None:
        self.inputs, self.place, self.temporary = folder / "in", folder / "out", folder / "tmp"
        self.kept = folder / "kept"
        for each in (self.inputs, self.place, self.temporary, self.kept):
            each.mkdir()

    def words(self, line: str) -> tuple[str, ...]:
        """The arguments of a command."""
        return tuple(
            word.replace("IN/", f"{self.inputs}/").replace("OUT/", f"{self.place}/") for word in line.split()
        )

    def start(self, words: tuple[str, ...]) -> "Running":
        """Start a command of the program."""
        return Running(partial(run_program, words), self.temporary)

    def reset(self, content: Path | None) -> None:
        """Let the place hold a copy of `content`, or nothing."""
        for folder in (self.place, self.temporary):
            for each in folder.iterdir():
                shutil.rmtree(each) if each.is_dir() and not each.is_symlink() else each.unlink()
        if content is not None:
            shutil.copytree(content, self.place, dirs_exist_ok=True)

    def hidden(self) -> list[str]:
        """What no result contains."""
        found = [path for path in self.place.rglob(".*") if "journal" not in path.parts]
        return [path.name for path in (*found, *self.temporary.iterdir())]


class Running:
    """A function in a process of its own, whose descendants are known by a variable of their environment."""

    def __init__(self, function: Callable[[], Any], temporary: Path) -> None:
        self._mark = uuid.uuid4().hex
        self._stderr = temporary.parent / f"{self._mark}.txt"  # a pipe would stay open until the last ends
        ready, told = _FORK.Pipe(duplex=False)
        self.process = _FORK.Process(target=self._run, args=(function, temporary, told))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of threads, which the child does not use
            self.process.start()
        ready.recv()

    def _run(self, function: Callable[[], Any], temporary: Path, told: Any) -> None:
        os.setsid()
        os.chdir(temporary.parent)
        os.environ.update({_MARK: self._mark, "TMPDIR": str(temporary), "PYTHONPATH": str(ROOT)})
        tempfile.tempdir = None
        warnings.resetwarnings()  # as Python starts, whatever a test has turned into an error
        for category in (DeprecationWarning, PendingDeprecationWarning, ImportWarning, ResourceWarning):
            warnings.simplefilter("ignore", category)
        for number, path in ((1, os.devnull), (2, self._stderr)):
            os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT, 0o600), number)
        sys.stdout, sys.stderr = (os.fdopen(number, "w", 1, closefd=False) for number in (1, 2))
        told.send(None)
        function()

    def send(self, number: signal.Signals) -> None:
        """Send a signal as a terminal, a queue or somebody else does."""
        with suppress(ProcessLookupError):
            (os.killpg if number in TO_ALL else os.kill)(self.process.pid, number)

    def end(self, signalled: bool = False) -> Ended:
        """Wait for its end, unless it was signalled, then for that of its processes; kill those that stay."""
        self.process.join(0.0 if signalled else PATIENCE)
        limit = time.monotonic() + GRACE * max(1.0, os.getloadavg()[0])
        while (alive := self._alive()) and time.monotonic() < limit:
            time.sleep(0.05)
        for number in alive:
            with suppress(ProcessLookupError):
                os.kill(number, signal.SIGKILL)
        self.process.join()
        stderr = self._stderr.read_text("utf-8", "backslashreplace")
        self._stderr.unlink()
        return Ended(self.process.exitcode, stderr, len(alive))

    def _alive(self) -> list[int]:
        found = [self.process.pid] if self.process.is_alive() else []
        mark = f"{_MARK}={self._mark}".encode()
        for process in Path("/proc").glob("[0-9]*"):
            with suppress(OSError):
                if mark in (process / "environ").read_bytes():
                    found.append(int(process.name))
        return found


def run_program(words: Sequence[str]) -> None:
    """The program as it is started by its name."""
    sys.argv = ["regolith-studio", *words]
    sys.modules["__main__"] = program  # what its own processes import
    program.main()


@contextmanager
def shorten_demo() -> Iterator[None]:
    """One particle, three representatives, polyhedra by quadrics and a heap of 40 particles in ``demo``."""
    from regolith_studio.cli import recipe
    from regolith_studio.dataset.parameters import LiftingCylinderTest
    from regolith_studio.dem.evaluation import EvaluationSettings
    from regolith_studio.jobs import repose_jobs
    from regolith_studio.readers.particles import sample_particles
    from regolith_studio.session.batch import inputs

    first = list(sample_particles())[:1]
    few = {"N_REPRESENTATIVES": 3, "N_DRAWN": 4, "N_HEAP": 40}
    complete = repose_jobs.ReposeRequest

    def quick_heap(heap: Any, settings: Any) -> Any:
        test = LiftingCylinderTest(mass=0.003, lift_speed=0.15)
        settings = replace(settings, rest_energy=4e-3, snapshots=12)
        measure = EvaluationSettings(min_particles=40)
        return complete(replace(heap, test=test), settings=settings, evaluation=measure)

    with ExitStack() as stack:
        for name, value in few.items():
            stack.enter_context(patch.object(recipe, name, value))
        quick = partial(recipe._run_recipe, method="quadric", n_facets=12)
        stack.enter_context(patch.object(recipe, "_run_recipe", quick))
        stack.enter_context(patch.object(inputs, "sample_particles", lambda: first))
        stack.enter_context(patch.object(repose_jobs, "ReposeRequest", quick_heap))
        yield


@contextmanager
def empty_folder() -> Iterator[Path]:
    """A folder for this process; each forked one would remove a `TemporaryDirectory` at its own exit too."""
    folder = Path(tempfile.mkdtemp())
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def tree(folder: Path) -> Tree:
    """SHA-256 of the files below a folder, but for hidden ones and those that are not compared."""
    found = {}
    for path in sorted(folder.rglob("*")):
        inside = path.relative_to(folder).parts
        if path.is_file() and not NOT_COMPARED & {*inside} and not any(part[0] == "." for part in inside):
            found["/".join(inside)] = hashlib.sha256(path.read_bytes()).hexdigest()
    return {name: digest for name, digest in found.items() if not name.endswith(".sha256")}


def prepared(arena: Arena, name: str) -> Prepared:
    """Run a command undisturbed, with both sets of options."""
    line, other = COMMANDS[name]
    words = arena.words(line)
    arena.reset(None)
    said = io.StringIO()
    with Path(os.devnull).open("w") as nowhere, redirect_stdout(nowhere), redirect_stderr(said):
        code = entry.run([*words, *other.split()])  # in this process, which loads the modules that it needs
    if code:
        raise SystemExit(f"{name} fails undisturbed: {said.getvalue()}")
    earlier = arena.kept / name.replace(" ", "-")
    shutil.copytree(arena.place, earlier)
    begun = time.monotonic()
    ended = arena.start(words).end()
    if ended.code:
        raise SystemExit(f"{' '.join(words)}: {ended.stderr}")
    new = tree(arena.place)
    size = sum(-(-path.stat().st_size // BLOCK) * BLOCK for path in arena.place.rglob("*") if path.is_file())
    seconds, notes_on = time.monotonic() - begun, tuple(ended.stderr.splitlines())
    return Prepared(name, words, earlier, tree(earlier), new, seconds, size, notes_on)


def evaluate(arena: Arena, case: Prepared, ended: Ended, row: Row, signalled: bool = False) -> None:
    """Count what a run has left."""
    row.runs += 1
    found = tree(arena.place)
    if ended.code:
        lines = ended.stderr.strip().splitlines()
        said = [line for line in lines if line not in case.notes_on and not PROGRESS.match(line)]
        is_sentence = len(said) == 1 and "made a mistake" not in ended.stderr
        row.sentences += is_sentence
        if not is_sentence and not (signalled and not said):
            row.unclear += 1
            print(f"  {case.name}: code {ended.code}, {ended.stderr.strip()[-300:]!r}", file=sys.stderr)
    if found not in (case.old, case.new):
        row.lost += not found
        row.mixed += bool(found)
        other = {
            name for name, digest in found.items() if digest not in (case.old.get(name), case.new.get(name))
        }
        print(
            f"  {case.name}: code {ended.code}, mixed; missing or too many: "
            f"{sorted(set(found) ^ set(case.new))[:4]}, other content: {sorted(other)[:4]}",
            file=sys.stderr,
        )
    elif not ended.code and found != case.new:
        row.lost += 1
    if hidden := arena.hidden() + ["process"] * ended.processes:
        row.left += 1
        print(f"  {case.name}: code {ended.code}, left behind: {hidden[:4]}", file=sys.stderr)


def kill(arena: Arena, case: Prepared, row: Row, number: signal.Signals, moment: int) -> None:
    """A signal to the command at a share of its duration."""
    arena.reset(case.earlier)
    running = arena.start(case.words)
    time.sleep(case.seconds * (moment + 0.5) / KILL_MOMENTS)
    running.send(number)
    ended = running.end(signalled=True)
    if number is signal.SIGKILL:
        killed = Row()
        found = tree(arena.place)
        if found not in (case.old, case.new):
            killed.mixed += 1
            print(f"  {case.name}: SIGKILL, mixed: {sorted(found)[:4]}", file=sys.stderr)
        if ended.processes:
            killed.left += 1
            print(f"  {case.name}: SIGKILL, {ended.processes} processes", file=sys.stderr)
        for each in arena.temporary.iterdir():  # the system's to clean
            shutil.rmtree(each) if each.is_dir() else each.unlink()
        evaluate(arena, case, arena.start(case.words).end(), row)
        row.mixed += killed.mixed
        row.left += killed.left
    else:
        evaluate(arena, case, ended, row, signalled=True)


@contextmanager
def small_disk(folder: Path) -> Iterator[None]:
    """A file system of its own at `folder`."""
    subprocess.run(["mount", "-t", "tmpfs", "-o", "size=256m", "tmpfs", str(folder)], check=True)
    try:
        yield
    finally:
        subprocess.run(["umount", "--lazy", str(folder)], check=True)


def remount(folder: Path, option: str) -> None:
    """Change an option of the file system at `folder`."""
    subprocess.run(["mount", "-o", f"remount,{option}", str(folder)], check=True)


def fill_disk(arena: Arena, case: Prepared, row: Row, moment: int) -> None:
    """The disk is full after a share of what the command writes, at the first moment after nothing."""
    arena.reset(None)
    with small_disk(arena.place):
        arena.reset(case.earlier)
        found = os.statvfs(arena.place)
        used = (found.f_blocks - found.f_bfree) * found.f_frsize
        remount(arena.place, f"size={used + case.n_bytes * moment // DISK_MOMENTS // BLOCK * BLOCK}")
        evaluate(arena, case, arena.start(case.words).end(), row)


def forbid(arena: Arena, case: Prepared, row: Row) -> None:
    """Nothing can be written."""
    arena.reset(None)
    with small_disk(arena.place):
        arena.reset(case.earlier)
        remount(arena.place, "ro")
        evaluate(arena, case, arena.start(case.words).end(), row)


def race(arena: Arena, case: Prepared, row: Row) -> None:
    """The command twice at a time, with both sets of options."""
    arena.reset(case.earlier)
    other = (*case.words, *COMMANDS[case.name][1].split())
    running = [arena.start(words) for words in (case.words, other)]
    first, second = (each.end() for each in running)
    if not second.code and (first.code or tree(arena.place) == case.old):  # the other one won
        first, second, case = second, first, replace(case, old=case.new, new=case.old)
    evaluate(arena, case, first, row)
    row.sentences += bool(second.code) and len(second.stderr.strip().splitlines()) == 1


def main() -> None:
    """Run the attacks and print the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.attack")
    parser.add_argument("--share", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", nargs="+", default=[], choices=COMMANDS, metavar="NAME")
    options = parser.parse_args()
    signal.signal(signal.SIGINT, signal.default_int_handler)  # the background of a shell ignores it, nohup
    signal.signal(signal.SIGHUP, signal.SIG_DFL)  # this, and so would what is started here
    rows: Rows = {}
    printed: set[str] = set()
    print(HEAD, flush=True)
    with empty_folder() as folder, suppress(KeyboardInterrupt):
        for name in attack(folder, options.only, options.share, options.seed, rows):
            print("\n".join(lines(rows, name)), flush=True)
            printed.add(name)
    for name in dict.fromkeys(name for name, _ in rows if name not in printed):
        print("\n".join(lines(rows, name)))
    print(total(rows))
    inputs: dict[str, list[int]] = {}
    if not options.only:
        with empty_folder() as folder:
            inputs = attack_inputs.attack_inputs(folder, options.share, options.seed)
        print("\n".join(attack_inputs.lines(inputs)))
    if any(each.lost or each.mixed or each.left or each.unclear for each in rows.values()) or any(
        unclear or outside for *_, unclear, outside in inputs.values()
    ):
        raise SystemExit(1)


def attack(
    folder: Path, only: Sequence[str], share: float, seed: int, rows: Rows, seconds: float = math.inf
) -> Iterator[str]:
    """All attacks on the commands `only`, all if there is none, or a seeded share of them.

    Yields the name of each command once its rows are complete. After so many seconds no attack begins.
    """
    end = time.monotonic() + seconds
    arena, rng = Arena(folder), random.Random(seed)
    write_inputs(arena.inputs)
    is_root = os.geteuid() == 0
    for name in only or COMMANDS:
        attacks = [("killed", kill, (number, k)) for number in SIGNALS for k in range(KILL_MOMENTS)]
        attacks += [("full disk", fill_disk, (k,)) for k in range(DISK_MOMENTS)] if is_root else []
        attacks += [("read-only", forbid, ())] if is_root else []
        attacks += [("two writers", race, ())]
        chosen = [each for each in attacks if rng.random() < share]
        if chosen and time.monotonic() < end:
            with shorten_demo() if name == "demo" else nullcontext():
                case = prepared(arena, name)
                for kind, act, arguments in takewhile(lambda _: time.monotonic() < end, chosen):
                    act(arena, case, rows.setdefault((name, kind), Row()), *arguments)
            yield name


HEAD = """\
| command | attack | runs | sentences | unclear ends | lost | mixed | left behind |
| --- | --- | --- | --- | --- | --- | --- | --- |"""


def lines(rows: Rows, name: str) -> list[str]:
    """The rows of a command in Markdown."""
    found = ((kind, row) for (command, kind), row in rows.items() if command == name)
    return [f"| {name} | {kind} | {' | '.join(map(str, astuple(row)))} |" for kind, row in found]


def total(rows: Rows) -> str:
    """The sums of all rows in Markdown."""
    sums = np.sum([astuple(row) for row in rows.values()] or [astuple(Row())], axis=0)
    return f"| all | | {' | '.join(map(str, sums))} |"


if __name__ == "__main__":
    main()
