"""How often the intervals of a budget of uncertainty hold the truth, on digitised grains of known shape.

    python -m benchmarks.uncertainty_coverage [SCANS] [TRIALS] [SEED] [RESULT.json]

Polyhedra of 8 to 20 planes, stretched along three axes and log-normal in size, stand apart in scans with blur
and noise. Each scan is taken to grains at all levels of the threshold that the design has. A
trial draws a sample of the grains of all scans with replacement; the truth is the mean over all of them.
The binomial test is two-sided against the stated 95 %.

Then, of the angle: 3, 6 or 10 heaps drawn with replacement from those of one dataset that
benchmarks.shape_heaps has made, whose mean is the truth. With 0 SCANS only this.
"""

import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import ndimage
from scipy.stats import binomtest

from benchmarks.grain_surfaces import polyhedron
from benchmarks.result_files import Rows, add_result, show_row
from regolith_studio.descriptors.describe import Descriptors, describe
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.imaging.grain_surface import coverage
from regolith_studio.imaging.segmentation.segment import SegmentationSettings
from regolith_studio.imaging.settings import CleaningSettings, ExtractionSettings, SplittingSettings
from regolith_studio.imaging.volume import Volume
from regolith_studio.jobs.extraction_settings import GrainSettings
from regolith_studio.jobs.uncertainty_chain import RESCANNED, Chain, GrainSample
from regolith_studio.resources import results_folder
from regolith_studio.studies.uncertainty import (
    CONFIDENCE,
    KEYS,
    STAGES,
    AngleBudget,
    ChainStep,
    DescriptorBudget,
    saltelli_rows,
)
from tools.make_samples.grains import random_rotation

ACROSS, SPREAD, NOISE, BLUR = 18.0, 0.2, 0.1, 0.8
"""Median diameter in voxels, standard deviation of its logarithm, noise over contrast, blur in voxels."""
CELL, CELLS = 36, 3
SAMPLE, BASE = 30, 16
VARIED = ("threshold", "digitisation", "representatives")
SETTINGS = GrainSettings(
    SegmentationSettings(cleaning=CleaningSettings(min_voxels=60), splitting=SplittingSettings(False)),
    ExtractionSettings(min_voxels=100),
)
BALL = Particle("ball", Mesh(icosphere(1).vertices, icosphere(1).faces))
"""In the place of grains of which only the descriptors are needed."""
Grain = tuple[Particle, Descriptors]
Pool = dict[tuple[int, ...], list[Grain | None]]


def scan_of_known(seed: int, cells: int = CELLS, across: float = ACROSS) -> tuple[Volume, list[Descriptors]]:
    """A scan of one grain a cell, and what is true of each."""
    rng = np.random.default_rng((seed, 77))
    share, known = np.zeros((cells * CELL,) * 3, dtype=np.float32), []
    for place in np.ndindex((cells,) * 3):
        mesh = polyhedron(int(rng.integers(8, 21)), rng)
        mesh = Mesh(mesh.vertices * rng.uniform((1.0, 0.9, 0.6), (1.6, 1.1, 1.0)), mesh.faces)
        size = np.clip(across * np.exp(SPREAD * rng.standard_normal()), 10.0, 26.0)
        scale = size / 2 / (3 * mesh.volume / (4 * np.pi)) ** (1 / 3)
        grain = mesh.moved(shift=-mesh.centroid, rotation=random_rotation(rng), scale=float(scale))
        known.append(describe(grain))
        inside = coverage(grain.moved(shift=CELL // 2 + rng.uniform(-0.5, 0.5, 3)), (CELL,) * 3, 6)
        share[tuple(slice(CELL * k, CELL * (k + 1)) for k in place)] = inside
    seen = ndimage.gaussian_filter(share, BLUR) + NOISE * rng.standard_normal(share.shape)
    return Volume(np.round(8000 + 6000 * seen).astype(np.uint16), np.ones(3), "grey", "known"), known


def digitised(
    volume: Volume, n_cells: int, levels: Sequence[dict[str, int]], seed: int
) -> tuple[Chain, Pool]:
    """The grain in each cell at each of the levels, none where it is not found; all have one small mesh."""
    chain, pool = Chain.of(volume, grains=SETTINGS, seed=seed), {}
    for each in levels:
        sample = chain.sample(each)
        found: list[Grain | None] = [None] * n_cells
        edge = round(n_cells ** (1 / 3))
        for particle, described in zip(sample.particles, sample.descriptors, strict=True):
            cell = np.floor(particle.mesh.centroid / CELL).astype(int).clip(0, edge - 1)
            grain = replace(BALL, scan=particle.scan), described
            found[int(np.ravel_multi_index(tuple(cell), (edge,) * 3))] = grain
        pool[tuple(each.values())] = found
    return chain, pool


@dataclass(frozen=True, eq=False)
class Digitised:
    """Grains of several scans at all levels of a design.

    ``rows``: levels of the steps; ``truth``: mean of :data:`KEYS` over all grains.
    """

    steps: tuple[ChainStep, ...]
    rows: IntArray
    pool: Pool
    truth: FloatArray
    chain: Chain

    @property
    def n_grains(self) -> int:
        return len(next(iter(self.pool.values())))


def digitised_scans(n_scans: int, seed: int, cells: int = CELLS, across: float = ACROSS) -> Digitised:
    """The grains that are found at all levels."""
    steps = Chain(Volume(np.zeros((2, 2, 2)), np.ones(3), "grey", ""), SETTINGS, kind="grey").steps
    steps = tuple(each for each in steps if each.key in VARIED)
    rows = saltelli_rows(steps, BASE, seed)[:2].reshape(-1, len(steps))
    scanned = [k for k, each in enumerate(steps) if each.key in RESCANNED]
    combinations = sorted({tuple(row) for row in rows[:, scanned].tolist()} | {(0,) * len(scanned)})
    levels = [{steps[k].key: level for k, level in zip(scanned, each, strict=True)} for each in combinations]
    truths: list[Descriptors] = []
    pool: Pool = {each: [] for each in combinations}
    for number in range(n_scans):
        volume, known = scan_of_known(seed + number, cells, across)
        chain, tables = digitised(volume, len(known), levels, seed)
        common = [k for k in range(len(known)) if all(table[k] for table in tables.values())]
        truths += [known[k] for k in common]
        for each, table in tables.items():
            pool[each] += [table[k] for k in common]
    truth = np.array([[each[key] for key in KEYS] for each in truths]).mean(axis=0)
    return Digitised(steps, rows, pool, truth, chain)


def intervals_of_trials(scans: Digitised, n_trials: int, seed: int) -> FloatArray:
    """Ends of the intervals of samples of the grains, shape (trials, keys, 2)."""
    names, ends = [each.key for each in scans.steps], []
    for trial in range(n_trials):
        picks = np.random.default_rng((seed, trial, 5)).integers(0, scans.n_grains, SAMPLE)
        chain, samples = replace(scans.chain, seed=trial), {}
        for each, grains in scans.pool.items():
            particles, described = zip(*(grains[at] for at in picks), strict=True)
            samples[each] = GrainSample(chain, particles, np.ones(SAMPLE), described)
        means = []
        for row in scans.rows.tolist():
            levels = dict(zip(names, row, strict=True))
            sample = samples[tuple(level for key, level in levels.items() if key in RESCANNED)]
            means.append(sample.grain_means(levels))
        results = np.tile(means, (1, len(STAGES))).reshape(2, BASE, -1)
        budget = DescriptorBudget(scans.steps, results[0, 0], results, SAMPLE)
        ends.append(budget.intervals[: len(KEYS)])
    return np.array(ends)


def covered(ends: FloatArray, truth: FloatArray) -> list[int]:
    """Number of intervals that hold the true mean, by descriptor."""
    return ((ends[:, :, 0] <= truth) & (truth <= ends[:, :, 1])).sum(axis=0).tolist()


def heaps_covered(n_trials: int, seed: int, dataset: str = "20") -> tuple[Rows, int]:
    """By number of heaps: intervals that hold the mean angle of all heaps, of how many, the p-value and the
    mean half width in degrees; and the number of all heaps."""
    heaps = json.loads((results_folder() / "repose_shapes.json").read_text("utf-8"))["runs"]
    angles = np.array([heap["angle_deg"] for heap in heaps if heap["coarsening"] == dataset], dtype=float)
    angles, rows = angles[np.isfinite(angles)], {}
    for size in (3, 6, 10):
        rng = np.random.default_rng((seed, size))
        found = [AngleBudget((), rng.choice(angles, size), {}) for _ in range(n_trials)]
        count = sum(abs(each.value - angles.mean()) <= each.half_width for each in found)
        p = binomtest(int(count), n_trials, CONFIDENCE).pvalue
        show_row(rows, f"{size}", [count, n_trials, p, np.mean([each.half_width for each in found])])
    return rows, len(angles)


def main(n_scans: int, n_trials: int, seed: int, result: str) -> None:
    """Print and write coverage, p-value of the binomial test, and width."""
    angles, n_heaps = heaps_covered(n_trials, seed)
    add_result(result, "heaps", angles, all_heaps=n_heaps, seed=seed)
    if n_scans == 0:
        return
    scans = digitised_scans(n_scans, seed)
    ends, rows = intervals_of_trials(scans, n_trials, seed), {}
    for k, (key, count) in enumerate(zip(KEYS, covered(ends, scans.truth), strict=True)):
        p = float(binomtest(count, n_trials, CONFIDENCE).pvalue)
        width = 50 * float((np.diff(ends[:, k], axis=1)[:, 0] / scans.truth[k]).mean())
        rows[key] = [count, n_trials, round(p, 3), round(width, 2)]
        print(key, rows[key])
    add_result(result, "coverage", rows, scans=n_scans, grains=scans.n_grains, sample=SAMPLE, seed=seed)


if __name__ == "__main__":
    words = [*sys.argv[1:], *("6", "400", "1", "")[len(sys.argv) - 1 :]]
    main(int(words[0]), int(words[1]), int(words[2]), words[3])
