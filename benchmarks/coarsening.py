"""Coarsening against a plain implementation of the paper, side by side in one run.

    python benchmarks/coarsening.py FOLDER_OF_STL [--particles 10] [--faces 20]

The plain one uses scipy and trimesh in the straightforward way: half-space intersection by Qhull, trimesh's
convex hull and oriented box, and for IoU a fixed cloud of 4,000 points in the particle's bounding box.
Errors of both are measured by benchmarks/independent.py, which shares no code with either. Times are
processor times of one thread.
"""

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, HalfspaceIntersection, QhullError

sys.path.insert(0, str(Path(__file__).resolve().parent))
from independent import measured

from regolith_studio.coarsening import warm_up
from regolith_studio.coarsening.coarsen import coarsen
from regolith_studio.coarsening.evaluation import LossFunction
from regolith_studio.coarsening.start import quadric_half_spaces
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.geometry.mesh import Mesh

KEYS = ("volume", "sphericity", "min_diameter", "max_diameter", "aspect_ratio", "convex_hull_volume")
Array = NDArray[np.float64]
T = TypeVar("T")


class PlainLoss:
    """Eq. 9 with all weights 1, as one would write it down from the paper."""

    def __init__(self, target: Target, overlap: bool) -> None:
        mesh = trimesh.Trimesh(target.mesh.vertices, target.mesh.faces)
        self._wanted = self._descriptors(mesh, mesh.convex_hull.volume)
        self._overlap = overlap
        if overlap:
            rng = np.random.default_rng(0)
            low, high = mesh.bounds
            self._cloud = rng.uniform(low, high, (4000, 3))
            self._inside = mesh.contains(self._cloud)

    @staticmethod
    def _descriptors(mesh: trimesh.Trimesh, hull_volume: float) -> dict[str, float]:
        edges = np.sort(mesh.bounding_box_oriented.primitive.extents)
        return {
            "volume": mesh.volume,
            "sphericity": np.pi ** (1 / 3) * (6 * mesh.volume) ** (2 / 3) / mesh.area,
            "min_diameter": edges[0],
            "max_diameter": edges[-1],
            "aspect_ratio": edges[-1] / edges[0],
            "convex_hull_volume": hull_volume,
        }

    def __call__(self, points: Array) -> float:
        offsets = np.linalg.norm(points, axis=1)
        normals = points / offsets[:, None]
        try:
            corners = HalfspaceIntersection(np.c_[normals, -offsets], np.zeros(3)).intersections
            hull = ConvexHull(corners)
        except QhullError:
            return np.inf
        mesh = trimesh.Trimesh(corners, hull.simplices).convex_hull
        found = self._descriptors(mesh, mesh.volume)
        loss = sum(abs(found[key] - self._wanted[key]) / self._wanted[key] for key in KEYS)
        if self._overlap:
            within = (self._cloud @ normals.T <= offsets).all(axis=1)
            either = np.count_nonzero(within | self._inside)
            loss += 1.0 - np.count_nonzero(within & self._inside) / either
        return float(loss)


def plain_annealing(target: Target, n_faces: int, loss: PlainLoss, seed: int) -> HalfSpaces:
    """Section 2.4 as printed."""
    rng = np.random.default_rng(seed)
    points = quadric_half_spaces(target, n_faces).points * (1 + 1e-7 * rng.random((n_faces, 1)))
    now = loss(points)
    for k in range(1, 101):
        proposal = points.copy()
        i = rng.integers(n_faces)
        proposal[i] = rng.normal(points[i], np.linalg.norm(points, axis=1).mean())
        then = loss(proposal)
        if then < now or (np.isfinite(then) and rng.random() < 0.2 * 0.9**k):
            points, now = proposal, then
    return HalfSpaces.from_points(points)


def timed(function: Callable[[], T]) -> tuple[T, float]:
    begun = time.process_time()
    value = function()
    return value, 1e3 * (time.process_time() - begun)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--particles", type=int, default=10)
    parser.add_argument("--faces", type=int, default=20)
    options = parser.parse_args()
    warm_up()
    rows: dict[str, list[list[float]]] = {}
    evaluations: list[list[float]] = []
    for index, path in enumerate(sorted(options.folder.glob("*.stl"))[: options.particles]):
        loaded = trimesh.load(path, force="mesh")
        target = Target.of(Mesh(loaded.vertices, loaded.faces))
        for name, values in compared(target, index, options.faces).items():
            rows.setdefault(name, []).append(values)
        evaluations.append(evaluation_times(target, options.faces))
    report(rows, evaluations, options.faces)


def compared(target: Target, index: int, n_faces: int) -> dict[str, list[float]]:
    """Errors, Jaccard distance and milliseconds of every method for one particle."""
    plain, with_overlap = PlainLoss(target, False), PlainLoss(target, True)
    cases: dict[str, Callable[[], HalfSpaces]] = {
        "quadric half-spaces": lambda: quadric_half_spaces(target, n_faces),
        "plain annealing": lambda: plain_annealing(target, n_faces, plain, index),
        "plain annealing with IoU": lambda: plain_annealing(target, n_faces, with_overlap, index),
        "annealing (ours)": lambda: unit(target, "annealing", n_faces),
        "exact, fast": lambda: unit(target, "exact", n_faces, level="fast"),
        "exact, best": lambda: unit(target, "exact", n_faces, level="best"),
    }
    found = {}
    for name, case in cases.items():
        planes, milliseconds = timed(case)
        found[name] = [*errors(target, planes), milliseconds]
    return found


def unit(target: Target, method: str, n_faces: int, **settings: object) -> HalfSpaces:
    return target.in_unit_frame(coarsen(target, n_faces, method, settings=settings).half_spaces)


def errors(target: Target, planes: HalfSpaces) -> list[float]:
    found = measured(planes.normals, planes.offsets, 2.0)
    relative = [abs(found[key] / target.descriptors[key] - 1.0) for key in KEYS]
    return [*relative, target.jaccard_distance(planes)]


CASES = (
    ("box on a facet", "descriptors", True),
    ("box on a facet, IoU", "all", True),
    ("exact box", "descriptors", False),
    ("exact box, IoU", "all", False),
)
"""What our evaluation measures: the box, the preset of weights, whether the box must lie on a facet."""


def evaluation_times(target: Target, n_faces: int) -> list[float]:
    """Microseconds of one evaluation of the loss: plain, plain with IoU, ours in all `CASES`."""
    planes = unit(target, "exact", n_faces)
    points, normals, offsets = planes.points, planes.normals, planes.offsets
    plain = [PlainLoss(target, overlap) for overlap in (False, True)]
    ours = [
        LossFunction(target, LossWeights.from_preset(preset), on_facets=on_facets)
        for _, preset, on_facets in CASES
    ]
    for each in ours:
        each.value(normals, offsets)
    return [
        *(timed(lambda p=p: [p(points) for _ in range(3)])[1] * 1e3 / 3 for p in plain),
        *(timed(lambda f=f: [f.value(normals, offsets) for _ in range(100)])[1] * 10 for f in ours),
    ]


def report(rows: dict[str, list[list[float]]], evaluations: list[list[float]], n_faces: int) -> None:
    print("| method | V | S | Dmin | Dmax | AR | CH | Jaccard | ms median |")
    print("| --- | " + "--- | " * 8)
    for name, values in rows.items():
        table = np.array(values)
        shown = [*np.sqrt(np.mean(table[:, :6] ** 2, axis=0)), table[:, 6].mean()]
        print(f"| {name} | " + " | ".join(f"{v:.4f}" for v in shown) + f" | {np.median(table[:, 7]):.0f} |")
    plain, overlap, *ours = np.median(np.array(evaluations), axis=0)
    print(f"\n| one evaluation of the loss, {n_faces} faces | plain, us | ours, us | ratio |")
    print("| --- | ---: | ---: | ---: |")
    for (name, preset, _), microseconds in zip(CASES, ours, strict=True):
        theirs = overlap if preset == "all" else plain
        print(f"| {name} | {theirs:.0f} | {microseconds:.1f} | {theirs / microseconds:.0f} |")


if __name__ == "__main__":
    main()
