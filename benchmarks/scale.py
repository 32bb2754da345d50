"""Thousands of virtual particles drawn, measured, coarsened to 20 faces and written as a dataset.

    python -m benchmarks.scale [--particles 300 1000] [--jobs 2] [--json FILE] [--archive]

With ``--archive`` they are read from a ZIP archive of STL of 2,000 triangles, half of them in an archive
in it, as libraries of simulants are downloaded, and become a dataset for each fraction.

Each count is a whole run of the recipe that a user would give, in a process of its own. Printed are wall
time, processor time of all processes (what a quiet machine would need on one core), its parts, memory and
bytes on disk; from two or more counts, what a particle costs and what the run costs before the first one.
Of an archive each step is also timed by itself, in one process. The table of the guide:

    python -m benchmarks.scale --archive --particles 100 400 --json benchmarks/results/library.json

``whole`` in that file was added by hand and is kept: an archive of 10,000 by the command ``run``, killed
once, stopped once, and resumed to its end.
"""

import argparse
import csv
import json
import resource
import subprocess
import sys
import tempfile
import threading
import time
import zipfile
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

STAGES = ("reading", "measuring", "fitting", "coarsening", "writing")
STEPS = ("reading", "repair", "measuring", "coarsening", "writing")
TARGET = (10_000, 3 * 60.0)
"""Particles, and seconds on two quiet cores."""
N_TIMED = 50
"""Meshes whose steps are timed one by one."""
N_TRIANGLES, N_SHAPES = 2000, 200
"""Of the meshes in an archive, and how many of them differ."""


@dataclass(frozen=True)
class Run:
    """What a run took.

    Parameters
    ----------
    wall, processor
        Seconds; processor time is of all processes together.
    assembling
        Processor seconds between the last particle and the end, of one process.
    stages
        Wall seconds of a particle in each stage, mean.
    memory, parent
        Largest sum of resident memory of all processes, and largest of the first, bytes.
    disk
        Bytes of results.
    """

    particles: int
    jobs: int
    wall: float
    processor: float
    assembling: float
    stages: dict[str, float]
    memory: int
    parent: int
    disk: int

    @property
    def row(self) -> dict[str, float]:
        """For a file of results: no times by the clock, which other processes change."""
        sizes = {f"{key}_mb": round(getattr(self, key) / 1e6, 1) for key in ("memory", "parent", "disk")}
        processor = round(self.processor, 2)
        return {"particles": self.particles, "jobs": self.jobs, "processor": processor, **sizes}


def measured(particles: int, jobs: int, archive: bool) -> Run:
    """One run, in a process of its own."""
    command = [sys.executable, "-m", "benchmarks.scale", "--one", str(particles), "--jobs", str(jobs)]
    command += ["--archive"] if archive else []
    printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return Run(**json.loads(printed.splitlines()[-1]))


def one(particles: int, jobs: int, archive: bool) -> Run:
    """In the process: perform the recipe in a temporary folder."""
    from regolith_studio.jobs.events import Started
    from regolith_studio.jobs.executor import Executor
    from regolith_studio.session.run_recipe import run_recipe

    population = None if archive else {"sources": ["ma165"], "n": particles, "l_max": 10}
    recipe = _recipe(["library.zip"] if archive else [], archive, population)
    with tempfile.TemporaryDirectory() as place, _watched() as memory:
        if archive:
            write_archive(Path(place) / "library.zip", particles)
        folder = Path(place) / "out"
        executor, begun, mark = Executor(jobs), time.perf_counter(), 0.0
        for step in run_recipe(recipe, Path(place), folder, executor):
            if isinstance(step, Started) and step.title.startswith("Writing"):
                mark = time.process_time()
        assembling = time.process_time() - mark
        executor.close()
        wall = time.perf_counter() - begun
        stages, disk = _stages(folder), sum(p.stat().st_size for p in folder.rglob("*") if p.is_file())
    return Run(particles, jobs, wall, _processor_time(), assembling, stages, *memory.most, disk)


def _recipe(inputs: list[str], archive: bool, population: dict[str, Any] | None = None) -> Any:
    from regolith_studio.session.recipe import recipe_of

    return recipe_of(
        inputs=inputs,
        population=population,
        target="particle",
        method="exact",
        settings={"level": "fast"},
        n_facets=20,
        outputs={"meshes": False, "dataset_by_group": archive, "summary": not archive},
    )


def write_archive(path: Path, particles: int) -> None:
    """Virtual particles of 2,000 triangles as STL, half of them in a compressed archive in the archive."""
    from regolith_studio.coarsening.decimated_hull import decimated
    from regolith_studio.io.triangles import stl_bytes
    from regolith_studio.shape_models.materials import materials
    from regolith_studio.shape_models.realizations import virtual_mesh

    draws = materials()["ma165"].model(10).draw(min(particles, N_SHAPES), 0)
    stls = [
        stl_bytes(decimated(virtual_mesh(draws, index, 4), N_TRIANGLES).triangles, "of the benchmark")
        for index in range(len(draws))
    ]
    inner, half = path.with_name("75-300.zip"), particles // 2
    with zipfile.ZipFile(inner, "w", zipfile.ZIP_DEFLATED) as fraction:
        for number in range(half):
            fraction.writestr(f"p{number}.stl", stls[number % N_SHAPES])
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(inner, inner.name)
        for number in range(half, particles):
            archive.writestr(f"75m/p{number}.stl", stls[number % N_SHAPES])
    inner.unlink()


class _watched:  # noqa: N801  a context, read like a sentence
    """Adds up the memory of this process and its children, twice a second, in a thread of its own."""

    def __enter__(self) -> "_watched":
        self.most, self._stop = (0, 0), threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)
        self._thread.start()
        return self

    def __exit__(self, *_error: object) -> None:
        self._stop.set()
        self._thread.join()

    def _watch(self) -> None:
        import psutil

        here = psutil.Process()
        while not self._stop.wait(0.5):
            parent = total = here.memory_info().rss
            for process in here.children(recursive=True):
                with suppress(psutil.NoSuchProcess):
                    total += process.memory_info().rss
            self.most = max(self.most[0], total), max(self.most[1], parent)


def _processor_time() -> float:
    """Of this thread and of all processes that have ended; the thread that watches does not count."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.thread_time() + children.ru_utime + children.ru_stime


def _stages(folder: Path) -> dict[str, float]:
    with (folder / "journal" / "times.csv").open() as table:
        rows = list(csv.DictReader(table))
    return {stage: float(np.mean([float(row[f"{stage} [s]"] or 0.0) for row in rows])) for stage in STAGES}


def timed_steps(archive: Path) -> dict[str, float]:
    """Milliseconds of processor time of a mesh in each step, with those of the process that parses.

    A mesh is inspected where it is read.
    """
    import psutil

    from regolith_studio.dataset.folder_io import stored_shape
    from regolith_studio.jobs.coarsening_jobs import coarsen_particle
    from regolith_studio.jobs.particle_jobs import measure_particle
    from regolith_studio.readers.particles import find_files, read_file
    from regolith_studio.readers.settings import ReadingSettings
    from regolith_studio.steps import result_of

    files, request = (
        find_files([archive], [])[: N_TIMED + 1],
        _recipe([archive.name], True).choices().coarsening_request,
    )
    process, times = psutil.Process(), dict.fromkeys(STEPS, 0.0)

    def clock() -> float:
        return time.process_time() + sum(sum(child.cpu_times()[:2]) for child in process.children())

    def timed(step: str, function: Callable[..., Any], *arguments: Any) -> Any:
        begun = clock()
        result = function(*arguments)
        times[step] += 1e3 * (clock() - begun) / N_TIMED
        return result

    for index, file in enumerate(files):
        if index == 1:  # the first one loads machine code
            times = dict.fromkeys(times, 0.0)
        timed("reading", read_file, file, ReadingSettings(repair=False))
        particle = timed("repair", read_file, file)
        timed("measuring", measure_particle, particle)
        coarse = timed("coarsening", result_of, coarsen_particle(particle, request, index))
        timed("writing", stored_shape, particle, coarse.coarsened)
    times["repair"] -= times["reading"]
    return times


def report(runs: Sequence[Run], steps: Mapping[str, float]) -> dict[str, Any]:
    """Print the table and what follows from it; returns the content of the file of results."""
    print(
        f"{'particles':>10}{'wall s':>9}{'cpu s':>9}{'assembling':>12}{'GiB':>7}{'parent MB':>11}"
        f"{'MB disk':>9}   ms of a particle"
    )
    for run in runs:
        parts = ", ".join(f"{stage} {1e3 * run.stages[stage]:.1f}" for stage in STAGES if run.stages[stage])
        print(
            f"{run.particles:>10,}{run.wall:>9.1f}{run.processor:>9.1f}{run.assembling:>12.2f}"
            f"{run.memory / 2**30:>7.2f}{run.parent / 1e6:>11.1f}{run.disk / 1e6:>9.1f}   {parts}"
        )
    content: dict[str, Any] = {
        "runs": [run.row for run in runs],
        "steps": {key: round(ms, 2) for key, ms in steps.items()},
    }
    print(", ".join(f"{step} {ms:.1f}" for step, ms in steps.items()))
    if len({run.particles for run in runs}) > 1:
        counts, costs = np.array([(run.particles, run.processor) for run in runs]).T
        each, before = np.polyfit(counts, costs, 1)
        if each <= 0:
            print("The machine was too uneven for a line through these runs: nothing is extrapolated.")
            return content
        memory, _ = np.polyfit(counts, [run.parent for run in runs], 1)
        minutes = {f"{count:,}": (before + each * count) / 2 / 60 for count in (10_000, 100_000)}
        content |= {
            "minutes": minutes,
            "each_ms": 1e3 * each,
            "before_s": before,
            "parent_each_bytes": memory,
        }
        for count, wall in minutes.items():
            print(f"{count} by extrapolation: {wall:.1f} min on two quiet cores")
        print(f"{1e3 * each:.1f} ms of a core for a particle, {before:.1f} s before the first, ", end="")
        print(f"{memory / 1e3:.1f} kB of the first process a particle")
    aim, seconds = TARGET
    print(f"aim: {aim:,} in {seconds / 60:.0f} min on two quiet cores")
    return content


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--particles", type=int, nargs="+", default=[300, 1000])
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--json", type=Path, help="write all numbers")
    parser.add_argument("--archive", action="store_true", help="read the particles from an archive")
    parser.add_argument("--one", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        print(json.dumps(asdict(one(options.one, options.jobs, options.archive))))
        return
    measured(4, 1, options.archive)  # compiles kernels, if any have changed
    steps: dict[str, float] = {}
    if options.archive:
        with tempfile.TemporaryDirectory() as place:
            write_archive(Path(place) / "library.zip", 2 * N_TIMED + 2)
            steps = timed_steps(Path(place) / "library.zip")
    runs = []
    for particles in options.particles:
        runs.append(measured(particles, options.jobs, options.archive))
        print(f"{particles:,} particles: {runs[-1].wall:.0f} s", file=sys.stderr)
    content = report(runs, steps)
    if options.json:
        before = json.loads(options.json.read_text()) if options.json.exists() else {}
        options.json.write_text(json.dumps({**before, **content}, indent=1) + "\n")


if __name__ == "__main__":
    main()
