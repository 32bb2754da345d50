"""Compile kernels before their first use, in a process of its own; the machine code is kept on the disk.

A job begins with ``yield from compile_first("fit")``. Whoever comes first starts the process, others wait for
it, so that no two processes compile the same; while the interpreter of the window stays free.
"""

import os
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from regolith_studio.geometry.kernels import machine_code_folder
from regolith_studio.io.child_process import end_with_parent, start_module
from regolith_studio.io.output_lock import lock_file
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.messages import N_

TASKS = {"read": 16, "fit": 30, "describe": 46, "quadric": 4, "annealing": 11, "exact": 110}
_METHODS = (*TASKS, "compound")
"""Reading to measuring, then the methods of coarsening: each needs what is before it."""
TASKS |= {"degrees": 2, "model": 7, "scan": 10, "representatives": 3, "compound": 59}
"""What can be compiled, in the order in which it is needed, and the files of machine code that each adds to
those of the tasks before it. Annealing has no kernel that the exact method does not need too. The second line
is for single pages; compounds are last, as they take minutes and few users need them at once. What is
compiled in the window instead keeps 2 MB a kernel there."""

_PARTS = {"read": "geometry", "fit": "harmonics", "describe": "geometry", "degrees": "harmonics"}
_PARTS |= {"model": "shape_models", "scan": "imaging", "representatives": "dataset"}
"""Part of the program in whose folder of machine code a task is marked as done; else ``coarsening``."""

_POLL_SECONDS = 0.1


def is_compiled(task: str) -> bool:
    """Whether nothing of a task is left to be compiled; what is not of :data:`TASKS` has nothing."""
    mark = _mark(task)
    return task not in TASKS or mark is None or mark.exists()


def compile_first_for(*methods: str) -> Steps:
    """:func:`compile_first` for reading, fitting, measuring and coarsening methods."""
    last = max(_METHODS.index(method if method in TASKS else "describe") for method in methods)
    yield from compile_first(*_METHODS[: last + 1])


_announced: list[tuple[int, int]] = []
"""Files before, and all that there will be, of what a thread of this process is compiling: one total for all
that wait, which would else grow with each of them."""


def compile_first(*tasks: str) -> Steps:
    """Wait until the kernels of these tasks, or of all :data:`TASKS`, are compiled; no step where they are.

    Where that fails, or nothing can be kept on the disk, they are compiled when they are first called.
    """
    missing = [task for task in tasks or TASKS if not is_compiled(task)]
    if not missing:
        return
    ours = _count_files(), sum(TASKS[task] for task in missing)
    before, total = next(iter(_announced), ours)
    done = 0
    yield Started(N_("First start: compiling"), total)
    process: subprocess.Popen[bytes] | None = None
    lock = -1
    try:
        while not all(map(is_compiled, missing)):
            if process is None:
                lock = _lock()
                if lock >= 0:
                    _announced.append(ours)
                    process = _compile_in_process(missing)
            elif process.poll() is not None:
                break
            done = max(done, min(_count_files() - before, total))
            yield Progress(done, total)  # no time left: kernels differ too much in theirs
            time.sleep(_POLL_SECONDS)
    finally:
        if process is not None:
            process.kill()
            process.wait()
        if lock >= 0:
            _announced.clear()
            os.close(lock)


def run_task(name: str) -> None:
    """Call every kernel of one of :data:`TASKS` in this process."""
    from regolith_studio.coarsening.coarsen import coarsen
    from regolith_studio.coarsening.optimiser.starts import round_start
    from regolith_studio.coarsening.target import Target
    from regolith_studio.descriptors.catalogue import CATALOGUE
    from regolith_studio.descriptors.describe import describe
    from regolith_studio.geometry.hole_filling import fill_holes
    from regolith_studio.geometry.mesh import Mesh
    from regolith_studio.geometry.mesh_health import inspect
    from regolith_studio.geometry.sphere_points import icosphere
    from regolith_studio.harmonics.fit import fit_harmonics
    from regolith_studio.harmonics.star_point import star_point_visibility
    from regolith_studio.harmonics.synthesis import gallery, reconstruct
    from regolith_studio.readers.particles import sample_particles

    sphere = icosphere(2)
    mesh = Mesh(sphere.vertices * [3.0, 2.0, 1.5], sphere.faces)
    along = 0.5 + sphere.vertices[:, 0] ** 2
    if name == "read":
        list(sample_particles())
        fill_holes(mesh.vertices, mesh.faces[9:])
    elif name == "fit":
        reconstruct(fit_harmonics(mesh, 4, sampling_degree=8), 2, level=1)
    elif name == "describe":
        inspect(mesh)
        describe(mesh, tuple(CATALOGUE))
        star_point_visibility(mesh)
    elif name == "degrees":
        list(gallery(fit_harmonics(mesh, 4, sampling_degree=8), (2, 3), level=1))
        reconstruct(fit_harmonics(mesh, 4, sampling_degree=8, reference="ellipsoid"), 2, level=1)
    elif name in _PAGES:
        _PAGES[name]()
    elif name == "compound":
        waist = Mesh(mesh.vertices * np.column_stack([np.ones(len(along)), along, along]), mesh.faces)
        coarsen(waist, 12, name, settings={"parts": 2})
    else:
        result = coarsen(mesh, 12, name)
        if name == "exact":
            coarsen(mesh, 14, name, fewer=result.half_spaces)
            round_start(Target.of(mesh), 12, np.random.default_rng(0))


def _draw_particles() -> None:
    """Fit the models of measured surfaces to the shipped particles, and draw from each."""
    from regolith_studio.harmonics.fit import fit_harmonics
    from regolith_studio.readers.particles import sample_particles
    from regolith_studio.readers.shape_files import radius_of
    from regolith_studio.shape_models.models import MODELS, model_settings
    from regolith_studio.shape_models.sample import Sample

    sample = Sample.of([radius_of(fit_harmonics(particle.mesh, 8)) for particle in sample_particles()])
    for key in ("recombined", "sample_matched"):
        MODELS[key].fit(sample, replace(model_settings(key), l_max=4)).draw(2, 0)


def _extract_two_balls() -> None:
    """Segment two touching balls, and extract them from their labels and from their grey values."""
    from regolith_studio.imaging.extraction import extract_particles
    from regolith_studio.imaging.segmentation.segment import segment
    from regolith_studio.imaging.settings import ExtractionSettings
    from regolith_studio.imaging.volume import Volume

    places = np.indices((68, 44, 44)) - 21.5
    places[0] = np.minimum(np.abs(places[0]), np.abs(places[0] - 25.0))
    depth = 13.0 - np.linalg.norm(places, axis=0)
    grey = Volume(np.clip(200 + 80 * depth, 40, 200).astype(np.uint8), np.ones(3), "grey", "balls")
    labels = segment(grey).labels
    for values in (None, grey):
        extract_particles(labels, ExtractionSettings(), grey=values)


def _choose_medoids() -> None:
    from regolith_studio.dataset.representatives import medoid_series

    next(medoid_series(np.arange(12.0).reshape(6, 2) ** 2, (2,)))


_PAGES = {"model": _draw_particles, "scan": _extract_two_balls, "representatives": _choose_medoids}


def _mark(task: str) -> Path | None:
    folder = machine_code_folder(_PARTS.get(task, "coarsening"))
    return folder and folder / f"{task}.compiled"


def _count_files() -> int:
    folders = {machine_code_folder(part) for part in {*_PARTS.values(), "coarsening"}}
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
    # a session of its own: Ctrl+C is for this process, which then ends that one
    return start_module(__name__, *tasks, stdout=subprocess.DEVNULL, start_new_session=True)


def _compile_and_mark(tasks: list[str]) -> None:
    end_with_parent(sys.stdin.buffer)
    for task in tasks:
        run_task(task)
        if mark := _mark(task):
            mark.touch()


if __name__ == "__main__":
    _compile_and_mark(sys.argv[1:])
