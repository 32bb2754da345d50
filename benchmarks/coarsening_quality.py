"""How well the exact method keeps its promise: ``python -m benchmarks.coarsening_quality FOLDER...``.

Every closed particle of each folder (or of the shipped sample, where none is named) is coarsened with all
weights 1, for each number of facets and each level. Printed for each: particles met to 1e-6; others that came
with a reason; those with all facets; the largest error of V, S, Dmin, Dmax and AR among particles without a
reason; the median Jaccard distance; median and longest processor time of one thread, with the target measured
before. ``--independent`` measures errors by benchmarks/independent.py, which shares no code with the method;
else by the public descriptors.
"""

import argparse
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.independent import measured
from benchmarks.result_files import add_result
from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.reasons import EXACT
from regolith_studio.coarsening.result import CoarseningResult
from regolith_studio.coarsening.target import Target
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.particle import Particle
from regolith_studio.jobs.compile_kernels import TASKS, run_task
from regolith_studio.readers.particles import read_mesh, sample_particles

KEPT = ("volume", "sphericity", "min_diameter", "max_diameter", "aspect_ratio")
MESH_ENDINGS = (".stl", ".ply", ".obj", ".off")
STEP = 2.0
"""Degrees between the axes that the independent measurement tries before it refines."""


@dataclass(frozen=True)
class Quality:
    """One line of the table.

    Parameters
    ----------
    largest
        Largest error of each of :data:`KEPT` among particles without a reason.
    met, explained
        Particles with all errors below 1e-6; others with a sentence that says why not.
    whole
        Particles with as many facets as asked for.
    jaccard, milliseconds, target_milliseconds
        Medians; the last of measuring the target and its rays, which is done once a particle.
    """

    name: str
    level: str
    n_facets: int
    particles: int
    met: int
    explained: int
    whole: int
    largest: dict[str, float]
    jaccard: float
    milliseconds: float
    slowest: float
    target_milliseconds: float


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.coarsening_quality", description=__doc__)
    parser.add_argument("folders", type=Path, nargs="*")
    parser.add_argument("--facets", type=int, nargs="+", default=[12, 20, 50, 100])
    parser.add_argument("--levels", nargs="+", default=["fast", "best"], choices=["fast", "best"])
    parser.add_argument("--particles", type=int, default=1000, help="at most so many of each set")
    parser.add_argument("--unit", default="um")
    parser.add_argument("--independent", action="store_true")
    parser.add_argument("--json", default="", metavar="FILE")
    options = parser.parse_args()
    for task in TASKS:
        run_task(task)
    found: list[Quality] = []
    print(HEADER)
    for name, particles in sets(options.folders, options.unit):
        targets, milliseconds = prepared(particles[: options.particles])
        for level in options.levels:
            for n_facets in options.facets:
                errors = independent_errors if options.independent else public_errors
                found.append(quality(name, targets, milliseconds, level, n_facets, errors))
                print(line(found[-1]), flush=True)
    add_result(options.json, "quality", result_rows(found))


def result_rows(found: Sequence[Quality]) -> dict[str, list[float]]:
    """Met particles, of how many, and the median Jaccard distance of each level, by set and facets."""
    rows: dict[str, list[float]] = {}
    for each in found:
        row = rows.setdefault(f"{each.name}, {each.n_facets}", [each.met, each.particles])
        row.append(round(each.jaccard, 3))
    return rows


def sets(folders: Sequence[Path], unit: str) -> list[tuple[str, list[Particle]]]:
    """Names and particles; the shipped sample without folders."""
    if not folders:
        return [("sample", list(sample_particles()))]
    return [(folder.name, [read_mesh(path, unit) for path in mesh_files(folder)]) for folder in folders]


def mesh_files(folder: Path) -> list[Path]:
    """Those of a folder that the program reads, by name."""
    return sorted(path for path in folder.iterdir() if path.suffix.lower() in MESH_ENDINGS)


def prepared(particles: Sequence[Particle]) -> tuple[list[Target], float]:
    """Targets of the closed ones, and the median milliseconds that one takes."""
    targets, times = [], []
    for particle in particles:
        begun = time.process_time()
        try:
            targets.append(Target.of(particle.mesh))
        except RegolithError as error:
            print(f"{particle.name} is left out: {error}")
            continue
        times.append(1e3 * (time.process_time() - begun))
    return targets, float(np.median(times))


def quality(
    name: str,
    targets: Sequence[Target],
    target_milliseconds: float,
    level: str,
    n_facets: int,
    errors: Callable[[Target, CoarseningResult], NDArray[np.float64]],
) -> Quality:
    """One line: each target coarsened once."""
    table, results, times = [], [], []
    for place, target in enumerate(targets):
        begun = time.process_time()
        try:
            result = coarsen(target, n_facets, "exact", settings={"level": level})
        except RegolithError as error:  # such as a hull with fewer triangles than asked for
            print(f"particle {place} is left out: {error}")
            continue
        times.append(1e3 * (time.process_time() - begun))
        results.append(result)
        table.append(errors(target, result))
    values = np.array(table)
    free = np.array([result.reason is None for result in results])
    met = (values <= EXACT).all(axis=1)
    largest = values[free].max(axis=0) if free.any() else np.full(len(KEPT), np.nan)
    return Quality(
        name,
        level,
        n_facets,
        len(results),
        int(met.sum()),
        int((~met & ~free).sum()),
        sum(result.n_facets == n_facets for result in results),
        dict(zip(KEPT, largest.tolist(), strict=True)),
        float(np.median([result.jaccard_distance for result in results])),
        float(np.median(times)),
        float(np.max(times)),
        target_milliseconds,
    )


def public_errors(_target: Target, result: CoarseningResult) -> NDArray[np.float64]:
    """Relative errors of the public descriptors."""
    return np.array([result.errors[key] for key in KEPT])


def independent_errors(target: Target, result: CoarseningResult) -> NDArray[np.float64]:
    """Relative errors of descriptors measured by scipy and brute force."""
    planes = target.in_unit_frame(result.half_spaces)
    found = measured(planes.normals, planes.offsets, STEP)
    return np.array([abs(found[key] / target.descriptors[key] - 1.0) for key in KEPT])


HEADER = (
    "| set | level | n | met | explained | all facets | V | S | Dmin | Dmax | AR | Jaccard | ms | slowest |\n"
    "| --- | --- | ---: | --- | ---: | --- | " + "---: | " * 8
).rstrip()


def line(found: Quality) -> str:
    """A row of the table."""
    worst = " | ".join(f"{value:.0e}" for value in found.largest.values())
    of = f"/{found.particles}"
    return (
        f"| {found.name} | {found.level} | {found.n_facets} | {found.met}{of} | {found.explained} "
        f"| {found.whole}{of} | {worst} | {found.jaccard:.3f} "
        f"| {found.milliseconds:.0f} | {found.slowest:.0f} |"
    )


if __name__ == "__main__":
    main()
