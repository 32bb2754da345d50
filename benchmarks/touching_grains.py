"""Volumes and areas of balls that touch each other, by number of contacts, and extents in anisotropic voxels.

    python -m benchmarks.touching_grains [SEED] [REPEATS] [RESULT.json]

Balls of 22 voxels in diameter, turned lattices at random places, partial volumes, a blur of 0.8 voxels,
noise of 3 %; segmented and extracted as a user does. Then single ellipsoids in voxels of 1:1:2, 1:1:3 and
2:3:5, with a blur of the same length along all axes: volume, and extents along the axes of the voxels.
"""

import sys
from collections.abc import Callable

import numpy as np
from scipy import ndimage
from scipy.spatial.transform import Rotation

from benchmarks.result_files import Rows, add_result, show_row
from regolith_studio.geometry.arrays import BoolArray, FloatArray
from regolith_studio.imaging.extraction import extract_particles
from regolith_studio.imaging.segmentation.segment import segment
from regolith_studio.imaging.volume import Volume

Inside = Callable[[FloatArray], BoolArray]
RADIUS, BLUR, NOISE = 11.0, 0.8, 0.03
SUPERSAMPLING = 4
LATTICES = {
    "single": (np.eye(3) * 9, 0),
    "pair": (np.eye(3), 1),
    "cubic": (np.eye(3), 6),
    "close": (np.array([[0, 1, 1], [1, 0, 1], [1, 1, 0]]) / np.sqrt(2), 12),
}
SPACINGS = ((1.0, 1.0, 1.0), (1.0, 1.0, 2.0), (1.0, 1.0, 3.0), (2.0, 3.0, 5.0))
AXES = np.array([14.0, 11.0, 9.0])


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


def coverage(inside: Inside, shape: tuple[int, int, int], voxel: FloatArray) -> FloatArray:
    """Share of each voxel in a body given by a function of positions (n, 3), its origin in the middle one."""
    fine = [n * SUPERSAMPLING for n in shape]
    axes = [(np.arange(n) + 0.5) / SUPERSAMPLING - 0.5 - m // 2 for n, m in zip(fine, shape, strict=True)]
    covered = np.empty(shape, dtype=np.float32)
    for i in range(shape[0]):
        x = axes[0][i * SUPERSAMPLING : (i + 1) * SUPERSAMPLING]
        places = np.stack(np.meshgrid(x, axes[1], axes[2], indexing="ij"), axis=-1) * voxel
        block = inside(places.reshape(-1, 3)).reshape(SUPERSAMPLING, shape[1], SUPERSAMPLING, shape[2], -1)
        covered[i] = block.mean(axis=(0, 2, 4))
    return covered


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


def extents(spacing: tuple[float, float, float], rng: np.random.Generator) -> FloatArray:
    """Errors of an ellipsoid's volume and extents along x, y and z, in percent, shape (4,)."""
    voxel = np.array(spacing)
    axes = AXES * np.cbrt(voxel.prod())
    turn = Rotation.random(random_state=rng).as_matrix()
    centre = rng.random(3) * voxel
    half = np.ceil(axes.max() / voxel).astype(int) + 9
    nx, ny, nz = (2 * half + 1).tolist()
    covered = coverage(
        lambda at: np.linalg.norm((at - centre) @ turn / axes, axis=1) < 1.0, (nx, ny, nz), voxel
    )
    volume = scan(covered, voxel, rng)
    mesh = extract_particles(segment(volume).labels, grey=volume).found[0].particle.mesh
    true = 2 * np.linalg.norm(turn * axes, axis=1)
    ratio = [mesh.volume / (4 / 3 * np.pi * axes.prod()), *(np.ptp(mesh.vertices, axis=0) / true)]
    return 100 * (np.array(ratio) - 1)


def main(seed: int, repeats: int, result: str) -> None:
    """Print both tables: means and largest errors; and volume and extents along x, y and z."""
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    touching: Rows = {}
    for name, (_, contacts) in LATTICES.items():
        found = np.array([balls(name, rng) for _ in range(repeats)])
        both = np.array([found.mean(axis=0), np.abs(found).max(axis=0)])
        show_row(touching, str(contacts), both.T.ravel(), 1)
    add_result(result, "contacts", touching, seed=seed, repeats=repeats)
    stretched: Rows = {}
    for spacing in SPACINGS:
        found = np.array([extents(spacing, rng) for _ in range(repeats)])
        show_row(stretched, " : ".join(f"{edge:g}" for edge in spacing), found.mean(axis=0), 1)
    add_result(result, "voxels of", stretched, seed=seed, repeats=repeats)


if __name__ == "__main__":
    words = [*sys.argv[1:], *("3", "6", "")[len(sys.argv) - 1 :]]
    main(int(words[0]), int(words[1]), words[2])
