"""Errors of digitised grains by voxels across, noise and roundness: the table of their intervals.

    python -m benchmarks.grain_errors [SEED] [REPEATS] [RESULT.json]

Single grains of known shape at random places, turned at random, blurred by 0.6 or 1 voxel, with noise of up
to a third of the contrast, segmented and contoured as ``extract`` does it by default, once with the surface
that follows the grey values (`grey`), once with that of the mask scaled to the volume by grey values
(`mask`). Errors of each descriptor in percent: mean, and ends of the interval that holds that of another
grain in 90 % of cases, if errors are normal (Student's t).
"""

import sys
from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import ConvexHull, HalfspaceIntersection
from scipy.stats import t

from benchmarks.result_files import Rows, add_result
from regolith_studio.descriptors.describe import describe
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.imaging import grain_surface
from regolith_studio.imaging.extraction import extract_particles
from regolith_studio.imaging.grain_surface import coverage
from regolith_studio.imaging.segmentation.segment import segment
from regolith_studio.imaging.settings import ExtractionSettings
from regolith_studio.imaging.volume import Volume
from tools.make_samples.grains import even_sphere, random_rotation
from tools.make_samples.random_fields import SphereField, power_law

KEYS = (
    "volume",
    "surface_area",
    "sphericity",
    "min_diameter",
    "max_diameter",
    "aspect_ratio",
    "convex_hull_volume",
)
ACROSS, NOISES, BLURS = (8, 12, 18, 30), (0.0, 0.1, 0.2, 0.33), (0.6, 1.0)
MARGIN = 9
LEAST_FOUND = 0.75
"""Share of the grains of a cell that must be found for a row: others are lost or in pieces."""
Random = np.random.Generator
Cells = dict[tuple[str, int, float, str], list[list[float]]]


def polyhedron(n_faces: int, rng: np.random.Generator) -> Mesh:
    """The intersection of half-spaces with about evenly spread normals."""
    normals = even_sphere(n_faces).vertices + 0.3 * rng.standard_normal((n_faces, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    offsets = rng.uniform(0.85, 1.15, n_faces)
    corners = HalfspaceIntersection(np.column_stack([normals, -offsets]), np.zeros(3)).intersections
    return Mesh(corners[ConvexHull(corners).vertices], np.empty((0, 3), dtype=np.int64)).hull


def ball(_rng: Random) -> Mesh:
    return Mesh(icosphere(4).vertices, icosphere(4).faces)


def rough(axes: tuple[float, float, float], rng: Random) -> Mesh:
    sphere = icosphere(4)
    field = SphereField(power_law(2, 20, 0.06, 1.4), rng)
    return Mesh(sphere.vertices * axes * np.exp(field(sphere.vertices))[:, None], sphere.faces)


SHAPES: dict[str, tuple[Callable[[Random], Mesh], ...]] = {
    "round": (ball, lambda rng: rough((1.0, 1.0, 1.0), rng)),
    "other": (
        lambda rng: polyhedron(14, rng),
        lambda rng: polyhedron(8, rng),
        lambda rng: rough((1.5, 1.1, 0.6), rng),
    ),
}


def _is_grey(surface: str, _across: float, _noise: float) -> bool:
    return surface == "grey"


def placed(truth: Mesh, across: float, rng: Random) -> tuple[Mesh, int]:
    """The shape turned at random, as large as a ball of so many voxels, and the edge of its volume."""
    scale = across / 2 / (3 * truth.volume / (4 * np.pi)) ** (1 / 3)
    turned = truth.moved(shift=-truth.centroid, rotation=random_rotation(rng), scale=scale)
    edge = int(np.ceil(np.ptp(turned.vertices, axis=0).max())) + 2 * MARGIN
    return turned.moved(shift=edge // 2 + rng.uniform(-0.5, 0.5, 3)), edge


def scanned(
    share: NDArray[np.float32], noise: float, blur: float, rng: Random, most: float = np.inf
) -> Volume:
    """A scan of these shares of each voxel, 16 bits; brighter than `most` is clipped."""
    seen = ndimage.gaussian_filter(share, blur) + noise * rng.standard_normal(share.shape)
    return Volume(
        np.round(8000 + 6000 * np.minimum(seen, most)).astype(np.uint16), np.ones(3), "grey", "grain"
    )


def errors(truth: Mesh, across: float, noise: float, blur: float, rng: Random) -> dict[str, list[float]]:
    """Relative errors of both surfaces in percent; empty where no grain is found."""
    body, edge = placed(truth, across, rng)
    known = describe(body, KEYS)
    grey = scanned(coverage(body, (edge,) * 3, 6), noise, blur, rng)
    found = {}
    try:
        labels = segment(grey).labels
        for name in ("grey", "mask"):
            grain_surface.follows_grey = partial(_is_grey, name)  # type: ignore[attr-defined]
            made = extract_particles(labels, ExtractionSettings(min_voxels=30), grey=grey).particles
            found[name] = relative_errors(
                max((each.mesh for each in made), key=lambda mesh: mesh.volume), known
            )
    except (RegolithError, ValueError) as error:
        print(across, noise, error, file=sys.stderr)
        return {}
    return found


def relative_errors(mesh: Mesh, known: Mapping[str, float]) -> list[float]:
    """Of each descriptor in percent."""
    described = describe(mesh, KEYS)
    return [100 * (described[key] / known[key] - 1) for key in KEYS]


def errors_at(seed: int, across: int) -> Cells:
    """A row of errors a grain by class of shape, voxels across, noise and surface; one grain a shape."""
    rng = np.random.default_rng(np.random.SeedSequence((seed, across)))
    rows: Cells = {}
    for noise in NOISES:
        for kind, makers in SHAPES.items():
            for number, make in enumerate(makers):
                blur = BLURS[(seed + number) % 2]
                for surface, row in errors(make(rng), across, noise, blur, rng).items():
                    rows.setdefault((kind, across, noise, surface), []).append(row)
    return rows


def summary(rows: Cells) -> dict[str, Rows]:
    """Mean error of each descriptor, and ends of its interval, by class of shape and surface."""
    tables: dict[str, Rows] = {}
    for (kind, across, noise, surface), found in sorted(rows.items()):
        table = np.array(found)
        if len(table) < LEAST_FOUND * len(rows[kind, across, 0.0, surface]):
            continue
        n, mean = len(table), table.mean(axis=0)
        half = t.ppf(0.95, n - 1) * table.std(axis=0, ddof=1) * np.sqrt(1 + 1 / n)
        numbers = np.array([mean, mean - half, mean + half])
        name = f"{across} voxels, noise {100 * noise:g} %"
        tables.setdefault(f"{kind}, {surface}", {})[name] = np.round(numbers.T.ravel(), 2).tolist()
    return tables


def main(seed: int, repeats: int, result: str) -> None:
    """Measure and write all tables."""
    rows: Cells = {}
    for number in range(repeats):
        for across in ACROSS:
            for cell, found in errors_at(seed + number, across).items():
                rows.setdefault(cell, []).extend(found)
    for name, table in summary(rows).items():
        for row, numbers in table.items():
            print(name, row, numbers)
        shapes = len(SHAPES[name.partition(",")[0]])
        add_result(result, name, table, seed=seed, repeats=repeats, shapes=shapes)


if __name__ == "__main__":
    words = [*sys.argv[1:], *("1", "3", "")[len(sys.argv) - 1 :]]
    main(int(words[0]), int(words[1]), words[2])
