"""What several programs measure of the same grains: errors against voxels across, with noise and without.

    python -m benchmarks.grain_surfaces [SEED] [REPEATS] [RESULT.json]

Single grains of known shape, turned at random and anywhere on the grid, blurred by 0.8 voxels, segmented by
the defaults. Of the same labels the surface is that of ``extract`` (`this program`), that of scikit-image's
marching cubes at 0.5 of the mask, and the faces of its voxels. Errors in percent: mean and standard deviation
over all shapes, then over each; at last of balls that are not of one grey value, with a threshold half-way
between air and rim. `REPEATS` grains of each shape up to 20 voxels across, a third of it of larger ones.
"""

import sys
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray
from skimage.measure import marching_cubes

from benchmarks.grain_errors import KEYS, ball, placed, polyhedron, relative_errors, rough, scanned
from benchmarks.result_files import Rows, add_result, show_row
from regolith_studio.descriptors.describe import describe
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.arrays import BoolArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.imaging.extraction import extract_particles
from regolith_studio.imaging.grain_surface import coverage
from regolith_studio.imaging.segmentation.segment import SegmentationSettings, segment
from regolith_studio.imaging.settings import ExtractionSettings, ThresholdSettings
from regolith_studio.imaging.volume import Volume

ACROSS, MANY, NOISES, BLUR = (8, 12, 20, 40, 100), 20, (0.0, 0.2), 0.8
SHAPES: dict[str, Callable[[np.random.Generator], Mesh]] = {
    "balls": ball,
    "ellipsoids": lambda _: Mesh(icosphere(4).vertices * (1.5, 1.1, 0.6), icosphere(4).faces),
    "polyhedra": lambda rng: polyhedron(14, rng),
    "drawn particles": lambda rng: rough((1.3, 1.0, 0.8), rng),
}
PORE, CORE, CLIPPED = 0.11, 0.38, 0.7
"""Of the volume of a ball: pore, and core twice as bright; share of the contrast that the scanner sees."""
INHOMOGENEOUS_NOISE, INHOMOGENEOUS_ACROSS = 0.05, 20
HALF_WAY = SegmentationSettings(threshold=ThresholdSettings("manual", 11000.0))
Errors = dict[str, list[list[float]]]
"""Rows of errors by method."""


def voxel_faces(body: BoolArray) -> Mesh:
    """The faces between voxels inside and outside, as triangles that turn outwards."""
    corners, faces = [], []
    for axis in range(3):
        one, two = (axis + 1) % 3, (axis + 2) % 3
        step = np.diff(np.pad(body, 1).astype(np.int8), axis=axis)
        for sign in (-1, 1):  # leaving the body along the axis, and entering it
            places = np.argwhere(step == sign).astype(np.float64) - 1.0
            places[:, axis] += 0.5
            square = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])[::-sign]
            quads = np.repeat(places[:, None], 4, axis=1)
            quads[:, :, [one, two]] += square
            first = 4 * (np.arange(len(quads)) + sum(map(len, corners)) // 4)[:, None]
            corners.append(quads.reshape(-1, 3))
            faces.append((first[:, None] + np.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3))
    return Mesh(np.concatenate(corners), np.concatenate(faces))


def surfaces(grey: Volume, settings: SegmentationSettings | None = None) -> dict[str, Mesh]:
    """The largest grain's surface by each method; nothing where no grain is found."""
    try:
        labels = segment(grey, settings).labels
        found = extract_particles(labels, ExtractionSettings(min_voxels=30), grey=grey).found
        own = max(found, key=lambda each: each.n_voxels)
    except (RegolithError, ValueError) as error:
        print(error, file=sys.stderr)
        return {}
    body = np.pad(np.asarray(labels.array) == own.label, 1)
    vertices, faces, _, _ = marching_cubes(body.astype(np.float32), 0.5)
    cubes = Mesh(vertices.astype(np.float64), faces.astype(np.int64))
    if cubes.volume < 0.0:
        cubes = Mesh(cubes.vertices, cubes.faces[:, ::-1])
    return {"this program": own.particle.mesh, "marching cubes": cubes, "voxels": voxel_faces(body)}


def errors_at(name: str, across: int, noise: float, repeats: int, rng: np.random.Generator) -> Errors:
    """Errors of grains of one shape and size by each method."""
    rows: Errors = {}
    for _ in range(repeats):
        body, edge = placed(SHAPES[name](rng), across, rng)
        grey = scanned(coverage(body, (edge,) * 3, 6), noise, BLUR, rng)
        for method, mesh in surfaces(grey).items():
            rows.setdefault(method, []).append(relative_errors(mesh, describe(body, KEYS)))
    return rows


def inhomogeneous(repeats: int, rng: np.random.Generator) -> Iterator[tuple[str, Errors]]:
    """Errors of balls with a pore, with a core, and of a scan that is clipped."""
    for name in ("pore", "core", "clipped"):
        rows: Errors = {}
        for _ in range(repeats):
            body, edge = placed(ball(rng), INHOMOGENEOUS_ACROSS, rng)
            share = coverage(body, (edge,) * 3, 6)
            share += {"pore": -1.0, "core": 1.0, "clipped": 0.0}[name] * _inside(body, share, name)
            most = CLIPPED if name == "clipped" else np.inf
            grey = scanned(share, INHOMOGENEOUS_NOISE, BLUR, rng, most)
            for method, mesh in surfaces(grey, HALF_WAY).items():
                rows.setdefault(method, []).append(relative_errors(mesh, describe(body, KEYS)))
        yield name, rows


def _inside(body: Mesh, share: NDArray[np.float32], name: str) -> NDArray[np.float32]:
    size = (PORE if name == "pore" else CORE) ** (1 / 3)
    middle = body.centroid
    return coverage(Mesh(middle + size * (body.vertices - middle), body.faces), share.shape, 6)


def mean_and_spread(rows: list[list[float]]) -> list[float]:
    """Of the errors of each descriptor, one after the other."""
    table = np.array(rows)
    spread = table.std(axis=0, ddof=1) if len(table) > 1 else np.zeros(len(KEYS))
    return [float(each) for each in np.column_stack([table.mean(axis=0), spread]).ravel()]


def main(seed: int, repeats: int, result: str) -> None:
    """Measure and write all tables."""
    made_with = {"seed": seed, "repeats": repeats}
    for noise in NOISES:
        level = f"noise {100 * noise:g} %"
        tables: dict[str, Rows] = {name: {} for name in (level, *(f"{shape}, {level}" for shape in SHAPES))}
        for across in ACROSS:
            rng = np.random.default_rng(np.random.SeedSequence((seed, across, round(100 * noise))))
            n = repeats if across <= MANY else max(1, repeats // 3)
            pooled: Errors = {}
            for shape in SHAPES:
                for method, rows in errors_at(shape, across, noise, n, rng).items():
                    show_row(tables[f"{shape}, {level}"], f"{across} voxels, {method}", mean_and_spread(rows))
                    pooled.setdefault(method, []).extend(rows)
            for method, rows in pooled.items():
                show_row(tables[level], f"{across} voxels, {method}", mean_and_spread(rows))
        for name, table in tables.items():
            add_result(result, name, table, **made_with)
    others: Rows = {}
    for name, found in inhomogeneous(repeats, np.random.default_rng(np.random.SeedSequence(seed))):
        for method, rows in found.items():
            show_row(others, f"{name}, {method}", mean_and_spread(rows))
    add_result(result, "inhomogeneous", others, **made_with)


if __name__ == "__main__":
    words = [*sys.argv[1:], *("3", "9", "")[len(sys.argv) - 1 :]]
    main(int(words[0]), int(words[1]), words[2])
