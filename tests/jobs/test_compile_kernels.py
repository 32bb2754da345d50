"""Compiling before the first use: once, in one process, said while it lasts."""

import os
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.imaging.segmentation.segment import SegmentationSettings
from regolith_studio.imaging.volume import sample_volume
from regolith_studio.jobs import compile_kernels
from regolith_studio.jobs.coarsening_jobs import CoarseningRequest, coarsen_one
from regolith_studio.jobs.compile_kernels import TASKS, compile_first, compile_first_for, is_compiled
from regolith_studio.jobs.dataset_jobs import choose_job
from regolith_studio.jobs.events import Partial, Progress, Started
from regolith_studio.jobs.lecture_jobs import trace_degrees
from regolith_studio.jobs.model_jobs import draw_live
from regolith_studio.jobs.scan_jobs import find_grains, scan_of

SLOWLY = "import sys, time, pathlib; time.sleep(0.4); [pathlib.Path(name).touch() for name in sys.argv[1:]]"


class Compiler:
    """Stands in for the process that compiles: it marks the tasks as done after a while."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.script = SLOWLY
        self.processes: list[subprocess.Popen[bytes]] = []

    def start(self, tasks: list[str]) -> "subprocess.Popen[bytes]":
        marks = [str(self.folder / task) for task in tasks]
        self.processes.append(subprocess.Popen([sys.executable, "-S", "-c", self.script, *marks]))
        return self.processes[-1]


@pytest.fixture
def compiler(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Compiler]:
    """A machine where nothing has been compiled."""
    made = Compiler(tmp_path)
    monkeypatch.setattr(compile_kernels, "_mark", lambda task: tmp_path / task)
    monkeypatch.setattr(compile_kernels, "machine_code_folder", lambda part: tmp_path / part)
    monkeypatch.setattr(compile_kernels, "_compile_in_process", made.start)
    yield made
    for process in made.processes:
        process.wait()


def test_that_compiling_is_said_and_done_once(compiler: Compiler) -> None:
    said = list(compile_first("fit", "describe"))
    assert said[0] == Started("First start: compiling", TASKS["fit"] + TASKS["describe"])
    assert all(isinstance(step, Progress) and not step.message for step in said[1:])
    assert is_compiled("fit")
    assert is_compiled("describe")
    assert list(compile_first("fit", "describe")) == []
    assert len(compiler.processes) == 1


def test_that_the_second_who_needs_kernels_waits_for_the_first(compiler: Compiler) -> None:
    waiting = [threading.Thread(target=lambda: list(compile_first("fit"))) for _ in range(3)]
    for thread in waiting:
        thread.start()
    for thread in waiting:
        thread.join()
    assert len(compiler.processes) == 1


def test_that_all_who_wait_announce_the_total_of_what_is_compiled(compiler: Compiler) -> None:
    first = compile_first("read", "fit", "describe")
    total = next(first).total
    next(first)  # the process runs
    assert next(compile_first("read")) == Started("First start: compiling", total)
    list(first)
    compiler.folder.joinpath("read").unlink()
    assert next(compile_first("read")).total == TASKS["read"]


def test_that_what_could_not_be_compiled_ahead_is_left_for_the_first_call(compiler: Compiler) -> None:
    compiler.script = "raise SystemExit(1)"
    list(compile_first("fit"))
    assert not is_compiled("fit")
    assert len(compiler.processes) == 1


def test_that_compounds_are_compiled_last_and_by_no_page_that_has_none(
    compiler: Compiler, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[list[str]] = []
    start = compiler.start
    monkeypatch.setattr(
        compile_kernels, "_compile_in_process", lambda tasks: started.append(tasks) or start(tasks)
    )
    list(compile_first())
    assert started.pop() == [*(task for task in TASKS if task != "compound"), "compound"]
    for task in ("fit", "compound"):
        compiler.folder.joinpath(task).unlink()
    list(compile_first_for("exact"))
    list(compile_first_for("compound"))
    assert started == [["fit"], ["compound"]]


def test_that_a_job_that_is_stopped_stops_the_compiling(compiler: Compiler) -> None:
    compiler.script = "import time; time.sleep(60)"
    steps = compile_first("fit")
    next(steps)
    next(steps)
    assert compiler.processes[0].poll() is None
    steps.close()
    assert compiler.processes[0].poll() is not None
    assert compile_kernels._lock() >= 0


def test_that_quadrics_are_shown_while_the_exact_method_is_compiled(compiler: Compiler) -> None:
    sphere = icosphere(2)
    mesh = Mesh(sphere.vertices * np.array([3.0, 2.0, 1.5]), sphere.faces)
    request = CoarseningRequest(LossWeights.from_preset("all"), 8, target="particle")
    steps = [type(step) for step in coarsen_one(mesh, request)]
    assert len(compiler.processes) == 2
    shown = steps.index(Partial)
    assert steps[:shown].count(Started) == 1
    assert steps[shown:].count(Started) == 2  # the exact method's kernels, then the exact method


@pytest.mark.parametrize(
    ("tasks", "job"),
    [
        ("scan", lambda: find_grains(scan_of(sample_volume("grey")), SegmentationSettings())),
        ("model", lambda: draw_live(None, 0)),
        ("representatives", lambda: choose_job(None, None)),
        ("describe degrees", lambda: trace_degrees(icosphere(1), None)),
    ],
)
@pytest.mark.usefixtures("compiler")
def test_that_jobs_of_pages_compile_what_they_need_in_another_process(tasks, job) -> None:
    steps = job()
    files = sum(TASKS[task] for task in tasks.split())
    assert next(steps) == Started("First start: compiling", files)
    steps.close()


def test_that_a_method_of_another_package_has_nothing_to_compile(compiler: Compiler) -> None:  # noqa: ARG001
    assert is_compiled("spheres")


@pytest.mark.slow
@pytest.mark.timeout(3600)
def test_that_a_first_start_compiles_as_many_kernels_as_are_announced(tmp_path: Path) -> None:
    """The limit of what an installation compiles: a new specialisation has to be written into the table.

    What no task compiles is compiled in the window, which keeps some 2 MB for each kernel from then on.
    """
    count = (
        "from regolith_studio.jobs import compile_kernels as c\n"
        "for task in c.TASKS:\n"
        "    before = c._count_files()\n"
        "    c.run_task(task)\n"
        "    print(task, c._count_files() - before)\n"
    )
    named = (
        "import importlib, pathlib, pkgutil, sys, regolith_studio\n"
        "from numba.core.dispatcher import Dispatcher\n"
        "from regolith_studio.geometry.kernels import _KernelCache\n"
        "for each in pkgutil.walk_packages(regolith_studio.__path__, 'regolith_studio.'):\n"
        "    if each.name.split('.')[1] not in ('ui', 'web', '__main__'):\n"
        "        importlib.import_module(each.name)\n"
        "for name, module in list(sys.modules.items()):\n"
        "    for value in vars(module).values() if name.startswith('regolith_studio') else ():\n"
        "        if isinstance(value, Dispatcher) and isinstance(value._cache, _KernelCache):\n"
        "            function = value.py_func\n"
        "            print(f'{pathlib.Path(function.__code__.co_filename).stem}.{function.__name__}')\n"
    )
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    told = subprocess.check_output([sys.executable, "-c", count], env=environment, text=True)
    assert told.split() == [str(word) for entry in TASKS.items() for word in entry]
    kernels = subprocess.check_output([sys.executable, "-c", named], env=environment, text=True).split()
    compiled = {path.name.split("-")[0] for path in tmp_path.rglob("*.nbc")}
    assert len(kernels) > 150
    assert {*kernels} <= compiled


@pytest.mark.slow
def test_that_the_compiling_process_marks_what_it_has_done_and_ends_with_its_parent(tmp_path: Path) -> None:
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    command = [sys.executable, "-m", "regolith_studio.jobs.compile_kernels", "fit"]
    with subprocess.Popen(command, env=environment, stdin=subprocess.PIPE) as process:
        assert process.wait() == 0
    assert [path.name for path in tmp_path.rglob("*.compiled")] == ["fit.compiled"]
    with subprocess.Popen([*command, "exact"], env=environment, stdin=subprocess.PIPE) as process:
        assert process.stdin
        time.sleep(2.0)
        process.stdin.close()
        assert process.wait() == 1
