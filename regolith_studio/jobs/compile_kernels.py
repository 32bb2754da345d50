"""Compile kernels before their first use, in a process of its own; the machine code is kept on the disk.

A job begins with ``yield from compile_first("fit")``. Whoever comes first starts the process, others wait for
it, so that no two processes compile the same; while the interpreter of the window stays free.
"""

import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np

from regolith_studio.geometry.kernels import machine_code_folder
from regolith_studio.io.output_lock import lock_file
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.jobs.progress_rate import ProgressRate, format_duration
from regolith_studio.messages import N_, Message

TASKS = {"read": 9, "fit": 27, "describe": 31, "quadric": 18, "annealing": 12, "exact": 75, "compound": 12}
"""What can be compiled, in the order in which the window needs it, and the files of machine code that each
adds to those of the tasks before it. Annealing has no kernel that the exact method does not need too."""

_PARTS = {"read": "geometry", "fit": "harmonics", "describe": "geometry"}
"""Part of the program in whose folder of machine code a task is marked as done; else ``coarsening``."""

_POLL_SECONDS = 0.1


def is_compiled(task: str) -> bool:
    """Whether nothing of a task is left to be compiled; what is not of :data:`TASKS` has nothing."""
    mark = _mark(task)
    return task not in TASKS or mark is None or mark.exists()


def compile_first_for(*methods: str) -> Steps:
    """:func:`compile_first` for reading, fitting, measuring and coarsening methods."""
    names = list(TASKS)
    last = max(names.index(method) if method in TASKS else names.index("describe") for method in methods)
    yield from compile_first(*names[: last + 1])


def compile_first(*tasks: str) -> Steps:
    """Wait until the kernels of these :data:`TASKS` are compiled; no step where they are already.

    Where that fails, or nothing can be kept on the disk, they are compiled when they are first called.
    """
    missing = [task for task in tasks if not is_compiled(task)]
    if not missing:
        return
    before, total = _count_files(), sum(TASKS[task] for task in missing)
    rate = ProgressRate(total)
    yield Started(N_("Compiling, once after an installation"), total)
    process: subprocess.Popen[bytes] | None = None
    lock = -1
    try:
        while not all(map(is_compiled, missing)):
            if process is None:
                lock = _lock()
                process = _compile_in_process(missing) if lock >= 0 else None
            elif process.poll() is not None:
                break
            rate.advance(min(_count_files() - before, total) - rate.done)
            left = rate.seconds_left
            text = "" if left is None else Message(N_("{duration} left"), duration=format_duration(left))
            yield Progress(rate.done, total, text)
            time.sleep(_POLL_SECONDS)
    finally:
        if process is not None:
            process.kill()
            process.wait()
        if lock >= 0:
            os.close(lock)


def run_task(name: str) -> None:
    """Call every kernel of one of :data:`TASKS` in this process."""
    from regolith_studio.coarsening.coarsen import coarsen
    from regolith_studio.descriptors.describe import describe
    from regolith_studio.geometry.mesh import Mesh
    from regolith_studio.geometry.mesh_health import inspect
    from regolith_studio.geometry.sphere_points import icosphere
    from regolith_studio.harmonics.fit import fit_harmonics
    from regolith_studio.harmonics.surface import reconstruct
    from regolith_studio.harmonics.visibility import star_point_visibility
    from regolith_studio.readers.particles import sample_particles

    sphere = icosphere(2)
    mesh = Mesh(sphere.vertices * [3.0, 2.0, 1.5], sphere.faces)
    along = 0.5 + sphere.vertices[:, 0] ** 2
    if name == "read":
        list(sample_particles())
    elif name == "fit":
        reconstruct(fit_harmonics(mesh, 4, sampling_degree=8), 2, level=1)
    elif name == "describe":
        inspect(mesh)
        describe(mesh)
        star_point_visibility(mesh)
    elif name == "compound":
        waist = Mesh(mesh.vertices * np.column_stack([np.ones(len(along)), along, along]), mesh.faces)
        coarsen(waist, 12, name, settings={"parts": 2})
    else:
        coarsen(mesh, 12, name)


def _mark(task: str) -> Path | None:
    folder = machine_code_folder(_PARTS.get(task, "coarsening"))
    return folder and folder / f"{task}.compiled"


def _count_files() -> int:
    folders = {machine_code_folder(part) for part in ("harmonics", "geometry", "coarsening")}
    return sum(1 for folder in folders if folder for _ in folder.rglob("*.nbc"))


def _lock() -> int:
    """Handle of the lock of whoever compiles; -1 where that is somebody else."""
    folder = machine_code_folder("geometry")
    assert folder is not None, "a task is missing only where there is a folder for it"
    try:
        return lock_file(folder.parent / "compiling.lock")
    except BlockingIOError:
        return -1


def _compile_in_process(tasks: list[str]) -> "subprocess.Popen[bytes]":
    """A process that compiles these tasks and marks them; it ends when this one does."""
    return subprocess.Popen(
        [sys.executable, "-m", __name__, *tasks],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,  # Ctrl+C is for this process, which then ends that one
    )


def _compile_and_mark(tasks: list[str]) -> None:
    threading.Thread(target=_exit_with_parent, daemon=True).start()
    for task in tasks:
        run_task(task)
        if mark := _mark(task):
            mark.touch()


def _exit_with_parent() -> None:
    sys.stdin.read()  # ends when the other end of the pipe is closed
    os._exit(1)


if __name__ == "__main__":
    _compile_and_mark(sys.argv[1:])
