"""Coarsening against plain programs of the paper, side by side in one run.

    python -m benchmarks.coarsening FOLDER_OF_STL [--particles 10] [--facets 20] [--only methods|evaluation]

The plain programs stand in benchmarks/plain.py. Errors of all methods are measured by
benchmarks/independent.py, which shares no code with any of them. Times are processor times of one thread; of
the evaluations, all sides work in turns and a ratio is taken in each round.
"""

import argparse
import time
import warnings
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TypeVar

import numpy as np
import trimesh
from numpy.typing import NDArray

from benchmarks.independent import measured
from benchmarks.plain import HAS_BOOLEANS, KEYS, PlainLoss, plain_annealing
from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.decimated_hull import decimated_hull
from regolith_studio.coarsening.loss import LossFunction
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.jobs.compile_kernels import TASKS, run_task

Array = NDArray[np.float64]
T = TypeVar("T")
ROUNDS = 5


def timed(function: Callable[[], T]) -> tuple[T, float]:
    """Result and processor time in milliseconds."""
    begun = time.process_time()
    value = function()
    return value, 1e3 * (time.process_time() - begun)


def main() -> None:
    """Measure and print both tables."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.coarsening", description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--particles", type=int, default=10)
    parser.add_argument("--facets", type=int, default=20)
    parser.add_argument("--only", choices=("methods", "evaluation"))
    options = parser.parse_args()
    warnings.simplefilter("ignore")  # the plain programs are full of them
    for task in TASKS:
        run_task(task)
    targets = [*targets_in(options.folder, options.particles)]
    if options.only != "evaluation":
        report_methods([compared(target, i, options.facets) for i, target in enumerate(targets)])
    if options.only != "methods":
        rounds = np.array([evaluation_rounds(target, options.facets) for target in targets])
        report_evaluations(rounds.reshape(-1, rounds.shape[-1]), options.facets)


def targets_in(folder: Path, count: int) -> Iterator[Target]:
    """The first particles of a folder."""
    for path in sorted(folder.glob("*.stl"))[:count]:
        loaded = trimesh.load(path, force="mesh")
        yield Target.of(Mesh(loaded.vertices, loaded.faces))


def plain_loss(target: Target, **how: str | bool) -> PlainLoss:
    """The paper's loss for a particle, as a plain program has it."""
    return PlainLoss(np.array(target.mesh.vertices), np.array(target.mesh.faces), **how)  # type: ignore[arg-type]


def annealed(target: Target, n_facets: int, loss: PlainLoss, seed: int) -> HalfSpaces:
    """The plain annealing, from the start that all methods have."""
    start = np.array(decimated_hull(target, n_facets).half_spaces.points)
    return HalfSpaces.from_points(plain_annealing(loss, start, seed))


def compared(target: Target, index: int, n_facets: int) -> dict[str, list[float]]:
    """Errors, Jaccard distance and milliseconds of every method for one particle."""
    plain, with_overlap = plain_loss(target), plain_loss(target, overlap="points")
    cases: dict[str, Callable[[], HalfSpaces]] = {
        "quadric half-spaces": lambda: decimated_hull(target, n_facets).half_spaces,
        "plain annealing": lambda: annealed(target, n_facets, plain, index),
        "plain annealing with IoU": lambda: annealed(target, n_facets, with_overlap, index),
        "annealing (ours)": lambda: unit(target, "annealing", n_facets),
        "exact, fast": lambda: unit(target, "exact", n_facets, level="fast"),
        "exact, best": lambda: unit(target, "exact", n_facets, level="best"),
    }
    found = {}
    for name, case in cases.items():
        planes, milliseconds = timed(case)
        found[name] = [*errors(target, planes), milliseconds]
    return found


def unit(target: Target, method: str, n_facets: int, **settings: object) -> HalfSpaces:
    """The half-spaces that a method finds, at unit volume."""
    return target.in_unit_frame(coarsen(target, n_facets, method, settings=settings).half_spaces)


def errors(target: Target, planes: HalfSpaces) -> list[float]:
    """Relative errors of the descriptors, measured independently, and the Jaccard distance."""
    found = measured(planes.normals, planes.offsets, 2.0)
    relative = [abs(found[key] / target.descriptors[key] - 1.0) for key in KEYS]
    return [*relative, target.jaccard_distance(planes)]


ALL_PLAIN: dict[str, dict[str, str | bool]] = {
    "meshes": {},
    "lean": {"lean": True},
    "meshes, boolean": {"overlap": "boolean"},
    "lean, points": {"lean": True, "overlap": "points"},
    "lean, exact box": {"lean": True, "exact": True},
    "meshes, exact box, boolean": {"exact": True, "overlap": "boolean"},
}
PLAIN = {name: how for name, how in ALL_PLAIN.items() if HAS_BOOLEANS or how.get("overlap") != "boolean"}
"""The plain programs by name; see benchmarks/plain.py."""
CASES: tuple[tuple[str, str, tuple[str, ...]], ...] = (
    ("minimum box", "descriptors", ("meshes", "lean", "lean, exact box")),
    ("minimum box, IoU", "all", ("meshes, boolean", "lean, points", "meshes, exact box, boolean")),
)
"""What our evaluation measures: name, preset, and the plain programs that it is held against."""


def evaluation_rounds(target: Target, n_facets: int) -> Array:
    """Microseconds of one evaluation, shape (rounds, plain programs + cases)."""
    planes = unit(target, "exact", n_facets)
    points, normals, offsets = np.array(planes.points), planes.normals, planes.offsets
    work: list[tuple[Callable[[], object], int]] = [
        (partial(plain_loss(target, **how), points), 1 if how.get("exact") else 2) for how in PLAIN.values()
    ]
    for _, preset, _ in CASES:
        loss = LossFunction(target, LossWeights.from_preset(preset))
        work.append((partial(loss.value, normals, offsets), 50))
    for call, _ in work:
        call()
    return np.array(
        [
            [timed(partial(repeated, call, count))[1] * 1e3 / count for call, count in work]
            for _ in range(ROUNDS)
        ]
    )


def repeated(call: Callable[[], object], count: int) -> None:
    """Do something several times."""
    for _ in range(count):
        call()


def report_methods(tables: list[dict[str, list[float]]]) -> None:
    """RMSRE, mean Jaccard distance and median time of each method."""
    print("| method | V | S | Dmin | Dmax | AR | CH | Jaccard | ms median |")
    print("| --- | " + "--- | " * 8)
    for name in tables[0]:
        values = np.array([table[name] for table in tables])
        shown = [*np.sqrt(np.mean(values[:, :6] ** 2, axis=0)), values[:, 6].mean()]
        print(f"| {name} | " + " | ".join(f"{v:.4f}" for v in shown) + f" | {np.median(values[:, 7]):.0f} |")


def report_evaluations(rounds: Array, n_facets: int) -> None:
    """Microseconds of each side, median ratio and the middle 80 % of the ratios."""
    names = list(PLAIN)
    print(
        f"\n| one evaluation of the loss, {n_facets} facets | ours, us | plain program | us | ratio | 80 % |"
    )
    print("| --- | ---: | --- | ---: | ---: | --- |")
    for number, (title, _, against) in enumerate(CASES):
        ours = rounds[:, len(names) + number]
        for name in [each for each in against if each in PLAIN]:
            theirs = rounds[:, names.index(name)]
            low, middle, high = np.quantile(theirs / ours, [0.1, 0.5, 0.9])
            print(
                f"| {title} | {np.median(ours):.1f} | {name} | {np.median(theirs):,.0f} "
                f"| {middle:,.0f} | {low:,.0f} to {high:,.0f} |"
            )


if __name__ == "__main__":
    main()
