"""Processor time that numba takes to compile each kernel: ``python -m benchmarks.compile_times``.

Every task of :mod:`regolith_studio.jobs.compile_kernels` runs in a process of its own with an empty
cache, as after an installation, so that what two of them share counts in both. A kernel's own time leaves out
the kernels that are compiled on its behalf.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from typing import Any

from numba.core import event

from regolith_studio.jobs.compile_kernels import TASKS, run_task


class CompileTimes(event.Listener):
    """Own time of each compiled specialisation, in seconds of processor time."""

    def __init__(self) -> None:
        self.own: dict[str, list[float]] = {}
        self._started: list[tuple[float, float]] = []

    def on_start(self, _event: event.Event) -> None:
        """Begin to count; what runs inside is not this kernel's own."""
        self._started.append((time.process_time(), 0.0))

    def on_end(self, ended: event.Event) -> None:
        """Note the time since the matching start."""
        began, of_others = self._started.pop()
        total = time.process_time() - began
        if self._started:
            outer_began, outer_others = self._started[-1]
            self._started[-1] = outer_began, outer_others + total
        function = ended.data["dispatcher"].py_func
        name = f"{function.__module__.removeprefix('regolith_studio.')}.{function.__qualname__}"
        self.own.setdefault(name, []).append(total - of_others)


def measure(task: str) -> dict[str, list[float]]:
    """Own times of the kernels that one task compiles, in this process, by name."""
    listener = CompileTimes()
    with event.install_listener("numba:compile", listener):
        run_task(task)
    return listener.own


def measure_cold(task: str) -> dict[str, list[float]]:
    """:func:`measure` in a new process with an empty cache."""
    with tempfile.TemporaryDirectory() as cache:
        command = [sys.executable, "-m", "benchmarks.compile_times", task]
        environment = os.environ | {"NUMBA_CACHE_DIR": cache}
        done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, text=True, check=True)
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def report() -> None:
    """Print a table: total of each task, then own time and specialisations of each kernel."""
    times = {task: measure_cold(task) for task in TASKS}
    for task, own in times.items():
        print(f"{task:44s} {sum(map(sum, own.values())):6.1f} s {sum(map(len, own.values())):4d} kernels")
    merged = {name: seconds for own in times.values() for name, seconds in own.items()}
    print(f"{'each kernel once':44s} {sum(map(sum, merged.values())):6.1f} s\n")
    for name, seconds in sorted(merged.items(), key=lambda item: -sum(item[1])):
        print(f"{name:70s} {sum(seconds):6.2f} s {len(seconds):2d}")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print(json.dumps(measure(sys.argv[1])))
    else:
        report()
