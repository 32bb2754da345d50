"""Scans of agglutinates: how many come out whole for each h, and how many pieces of cut ones are kept.

    python -m benchmarks.agglutinate_scans [SEED] [SCANS] [RESULT.json]

Eight agglutinates with vesicles (``tools/make_samples``), turned at random, 24 to 34 voxels in equivalent
diameter, at random places in 128^3 voxels, some of them cut by the border; partial volumes, a blur of 0.8
voxels, noise of 5 %. A whole one is matched where a particle shares more than half of the union with it. A
particle most of whose voxels are of a cut grain is a piece that should have been left out. Then random
packings of balls of 18 voxels: how many whole ones are left out as such pieces.
"""

import sys
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from benchmarks.heaps import tile
from benchmarks.result_files import Rows, add_result, show_row
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.imaging.bounding_boxes import touches
from regolith_studio.imaging.extraction import ExtractionSettings, extract_particles
from regolith_studio.imaging.label_table import label_table
from regolith_studio.imaging.segmentation.segment import SegmentationSettings, segment
from regolith_studio.imaging.volume import Volume
from regolith_studio.imaging.voxelize import coverage
from tools.make_samples.grains import AgglutinateRecipe, random_rotation

EDGE, TRIALS, MARGIN = 128, 250, 30
N_SHAPES = 8
DIAMETERS = (24.0, 34.0)
BLUR, NOISE = 0.8, 0.05
HEIGHTS = (0.8, 2.0, 4.0, 8.0)
SPREADS, BALL = (0.0, 0.3), 18.0
"""Standard deviations of ln of the diameters of balls, and their mean diameter in voxels."""
Labels = NDArray[np.uint16]


def packed(shapes: Sequence[Mesh], rng: np.random.Generator) -> tuple[Labels, FloatArray]:
    """Labels of the true grains, cut at the border, and the share of each voxel that is grain."""
    size = EDGE + 2 * MARGIN
    labels, share = np.zeros((size,) * 3, np.uint16), np.zeros((size,) * 3)
    for number in range(1, TRIALS + 1):
        mesh = shapes[number % len(shapes)].moved(
            rotation=random_rotation(rng), scale=rng.uniform(*DIAMETERS) / DIAMETERS[1]
        )
        place = rng.integers(MARGIN, size - MARGIN, 3)
        low = np.floor(mesh.bounds[0]).astype(int) - 2
        nx, ny, nz = (np.ceil(mesh.bounds[1]).astype(int) + 3 - low).tolist()
        first = place + low
        if (first < 0).any() or (first + np.array([nx, ny, nz]) > size).any():
            continue
        box = tuple(slice(a, a + n) for a, n in zip(first, (nx, ny, nz), strict=True))
        own = coverage(mesh.moved(shift=-low), (nx, ny, nz), 3)
        if share[box][ndimage.binary_dilation(own > 0, iterations=1)].any():
            continue
        share[box] += own
        labels[box][own > 0.5] = number
    inner = (slice(MARGIN, -MARGIN),) * 3
    return labels[inner], share[inner]


def outcome(labels: Labels, found: Labels, kept: set[int]) -> FloatArray:
    """Whole grains, those matched, sum of the errors of their volumes in percent, particles, and those that
    are pieces of cut grains."""
    faces = [labels.take(end, axis) for axis in range(3) for end in (0, -1)]
    cut = set(np.unique(np.concatenate([face.ravel() for face in faces])).tolist())
    sizes, pieces = np.bincount(labels.ravel()), np.bincount(found.ravel())
    shared = np.zeros((len(sizes), len(pieces)))
    np.add.at(shared, (labels.ravel(), found.ravel()), 1)
    whole = [k for k in np.flatnonzero(sizes) if k and k not in cut]
    errors = []
    for k in whole:
        best = int(shared[k, 1:].argmax()) + 1
        if shared[k, best] > 0.5 * (sizes[k] + pieces[best] - shared[k, best]):
            errors.append(100 * (pieces[best] / sizes[k] - 1))
    owner = shared[1:].argmax(axis=0) + 1
    wrong = sum(int(owner[k]) in cut for k in kept)
    return np.array([len(whole), len(errors), np.sum(errors), len(kept), wrong])


def scanned(share: FloatArray, rng: np.random.Generator) -> Volume:
    """Grey values with blur and noise."""
    seen = ndimage.gaussian_filter(share, BLUR) + NOISE * rng.standard_normal(share.shape)
    return Volume(np.clip(60 + 120 * seen, 0, 255).astype(np.uint8), np.ones(3), "grey", "scan")


def packed_balls(size_spread: float, rng: np.random.Generator) -> tuple[Labels, FloatArray]:
    """Labels and shares of a part of a random packing of balls that touch."""
    centres, diameters, side = tile(size_spread, 7)
    labels, share = np.zeros((EDGE,) * 3, np.uint16), np.zeros((EDGE,) * 3)
    places = (centres + rng.uniform(0, side, 3)) % side * BALL
    for number, (place, radius) in enumerate(zip(places, 0.5 * BALL * diameters, strict=True), start=1):
        low, high = np.floor(place - radius - 1).astype(int), np.ceil(place + radius + 2).astype(int)
        low, high = np.clip(low, 0, EDGE), np.clip(high, 0, EDGE)
        axes = [np.arange(a, b) - x for a, b, x in zip(low, high, place, strict=True)]
        box = tuple(slice(a, b) for a, b in zip(low, high, strict=True))
        away = np.linalg.norm(np.stack(np.meshgrid(*axes, indexing="ij")), axis=0)
        share[box] = np.minimum(share[box] + np.clip(0.5 + radius - away, 0, 1), 1)
        labels[box][away < radius] = number
    return labels, share


def lost_balls(size_spread: float, rng: np.random.Generator) -> tuple[int, int]:
    """Whole balls, and those that are left out as pieces of cut ones."""
    labels, share = packed_balls(size_spread, rng)
    grey = scanned(share, rng)
    found = segment(grey).labels
    taken = extract_particles(found, ExtractionSettings(min_voxels=64), grey=grey)
    whole, _, _, _, _ = outcome(labels, np.asarray(found.array), set(taken.labels))
    at_border = {k for k, box in label_table(found).boxes().items() if touches(box, found.shape)}
    return int(whole), len(set(taken.border) - at_border)


def main(seed: int, scans: int, result: str) -> None:
    """Print a row for each h."""
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    shapes = [AgglutinateRecipe(DIAMETERS[1], n_faces=3000).make(rng) for _ in range(N_SHAPES)]
    totals = {h: np.zeros(5) for h in HEIGHTS}
    for _ in range(scans):
        labels, share = packed(shapes, rng)
        grey = scanned(share, rng)
        for h in HEIGHTS:
            base = SegmentationSettings()
            found = segment(grey, replace(base, splitting=replace(base.splitting, h_maxima=h))).labels
            kept = {each.label for each in extract_particles(found, grey=grey).found}
            totals[h] += outcome(labels, np.asarray(found.array), kept)
    rows: Rows = {}
    for h, (whole, matched, error, particles, wrong) in totals.items():
        show_row(rows, f"{h:g}", (whole, matched, error / max(matched, 1), particles, wrong), 1)
    add_result(result, "h", rows, seed=seed, scans=scans)
    packings: Rows = {}
    for spread in SPREADS:
        found_balls = np.array([lost_balls(spread, rng) for _ in range(scans)])
        show_row(packings, f"{spread:g}", found_balls.sum(axis=0), 0)
    add_result(result, "spread of ln d", packings, seed=seed, scans=scans)


if __name__ == "__main__":
    words = [*sys.argv[1:], *("7", "2", "")[len(sys.argv) - 1 :]]
    main(int(words[0]), int(words[1]), words[2])
