"""Volumes and areas of balls that touch each other, by number of contacts, and extents in anisotropic voxels.

    python -m benchmarks.touching_grains [SEED] [REPEATS] [RESULT.json]

Balls of 22 voxels in diameter, turned lattices at random places, partial volumes, a blur of 0.8 voxels,
noise of 3 %; segmented and extracted as a user does. Then single grains in voxels of 1:1:2, 1:1:3 and 2:3:5,
six times as many, with a blur of the same length along all axes: volume, extents along the axes of the
voxels, and area.
"""

import sys
from dataclasses import replace
from itertools import product

import numpy as np
from scipy import ndimage
from scipy.spatial.transform import Rotation

from benchmarks.grain_surfaces import shape_of
from benchmarks.result_files import Rows, add_result, show_row
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.imaging.extraction import extract_particles
from regolith_studio.imaging.segmentation.segment import SegmentationSettings, segment
from regolith_studio.imaging.segmentation.splitting import SplittingSettings
from regolith_studio.imaging.volume import Volume
from regolith_studio.imaging.voxelize import coverage

RADIUS, BLUR, NOISE = 11.0, 0.8, 0.03
UNPARTED = replace(SegmentationSettings(), splitting=SplittingSettings(enabled=False))
COLUMNS = 6
"""Columns along the edge of a voxel by which its coverage is measured."""
LATTICES = {
    "single": (np.eye(3) * 9, 0),
    "pair": (np.eye(3), 1),
    "cubic": (np.eye(3), 6),
    "close": (np.array([[0, 1, 1], [1, 0, 1], [1, 1, 0]]) / np.sqrt(2), 12),
}
SPACINGS = ((1.0, 1.0, 1.0), (1.0, 1.0, 2.0), (1.0, 1.0, 3.0), (2.0, 3.0, 5.0))
GRAINS = ("ellipsoids", "polyhedra of 14 faces")


def centres(name: str, rng: np.random.Generator, gap: float = 0.0) -> FloatArray:
    """Centres of one ball, its neighbours and theirs, the first in the middle, shape (n, 3), in voxels."""
    basis = LATTICES[name][0] * (2 * RADIUS + gap)
    steps = np.array(np.meshgrid(*[np.arange(-2, 3)] * 3)).reshape(3, -1).T
    points = steps @ basis
    reach = 0.1 if name == "single" else 2 * RADIUS + gap + 0.1
    points = points[np.linalg.norm(points, axis=1) < reach]
    points = points[np.argsort(np.linalg.norm(points, axis=1), kind="stable")]
    points = points[:2] if name == "pair" else points
    return points @ Rotation.random(random_state=rng).as_matrix().T + rng.random(3)


def scan(covered: FloatArray, voxel: FloatArray, rng: np.random.Generator) -> Volume:
    """Grey values with blur and noise."""
    blurred = ndimage.gaussian_filter(covered, BLUR * np.cbrt(voxel.prod()) / voxel)
    noisy = 60 + 120 * (blurred + NOISE * rng.standard_normal(covered.shape))
    return Volume(np.clip(np.rint(noisy), 0, 255).astype(np.uint8), voxel, "grey", "scan")


def balls(name: str, rng: np.random.Generator) -> tuple[float, float]:
    """Errors of the middle ball's volume and area, in percent."""
    points = centres(name, rng)
    half = int(np.ceil(np.abs(points).max() + RADIUS)) + 8
    places = np.stack(np.meshgrid(*[np.arange(-half, half + 1.0)] * 3, indexing="ij"), axis=-1)
    shares = [np.clip(0.5 + RADIUS - np.linalg.norm(places - point, axis=-1), 0, 1) for point in points]
    volume = scan(np.minimum(np.sum(shares, axis=0), 1.0), np.ones(3), rng)
    labels = segment(volume).labels
    found = extract_particles(labels, grey=volume)
    middle = labels.array[half, half, half]
    mesh = next(each.particle.mesh for each in found.found if each.label == middle)
    radius = np.cbrt(RADIUS**3 + RADIUS / 4)  # of the ball with the volume of all shares
    true = 4 / 3 * np.pi * radius**3, 4 * np.pi * radius**2
    return 100 * (mesh.volume / true[0] - 1), 100 * (mesh.surface_area / true[1] - 1)


def extents(name: str, spacing: tuple[float, float, float], rng: np.random.Generator) -> FloatArray:
    """Errors of a single grain's volume, extents along x, y and z, and area, in percent, shape (5,)."""
    voxel = np.array(spacing)
    body = shape_of(name, rng)
    body = body.moved(shift=-body.centroid, scale=float(np.cbrt(voxel.prod())))
    half = np.ceil(np.abs(body.vertices).max(axis=0) / voxel).astype(int) + 9
    places = body.vertices / voxel + half + rng.uniform(-0.5, 0.5, 3)
    nx, ny, nz = (2 * half + 1).tolist()
    volume = scan(coverage(Mesh(places, body.faces), (nx, ny, nz), COLUMNS), voxel, rng)
    mesh = extract_particles(segment(volume, UNPARTED).labels, grey=volume).found[0].particle.mesh
    seen, true = ([each.volume, *np.ptp(each.vertices, axis=0), each.surface_area] for each in (mesh, body))
    return 100 * (np.array(seen) / true - 1)


def main(seed: int, repeats: int, result: str) -> None:
    """Print both tables: means and largest errors; and means of volume, extents and area."""
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    touching: Rows = {}
    for name, (_, contacts) in LATTICES.items():
        found = np.array([balls(name, rng) for _ in range(repeats)])
        both = np.array([found.mean(axis=0), np.abs(found).max(axis=0)])
        show_row(touching, str(contacts), both.T.ravel(), 1)
    add_result(result, "contacts", touching, seed=seed, repeats=repeats)
    stretched: Rows = {}
    for name, spacing in product(GRAINS, SPACINGS):
        found = np.array([extents(name, spacing, rng) for _ in range(6 * repeats)])
        title = f"{' : '.join(f'{edge:g}' for edge in spacing)}, {name}"
        show_row(stretched, title, found.mean(axis=0), 1)
    add_result(result, "voxels of", stretched, seed=seed, repeats=6 * repeats)


if __name__ == "__main__":
    words = [*sys.argv[1:], *("3", "6", "")[len(sys.argv) - 1 :]]
    main(int(words[0]), int(words[1]), words[2])
