"""Volumes and areas of single grains of known shape, from masks and from grey values.

    python -m benchmarks.grain_surfaces [SEED] [REPEATS] [RESULT.json]

Shapes of 24 voxels in diameter at random places, turned at random, partial volumes, a blur of 0.8 voxels,
noise of 5 % of the contrast, segmented by median and the true mid-level. Masks are those of the truth, in
where half of a voxel is covered. Errors in percent, mean and largest, each against the shape itself; then
means of what is wrong before: the area of the mask's contour, and the volume of the mask by the threshold.
"""

import sys

import numpy as np
from scipy import ndimage
from scipy.spatial import ConvexHull, HalfspaceIntersection

from benchmarks.result_files import Rows, add_result, show_row
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.imaging.contours import contour
from regolith_studio.imaging.grain_surface import grey_mesh, mask_mesh
from regolith_studio.imaging.label_table import GrainCrop
from regolith_studio.imaging.surface_refinement import coverage
from tools.make_samples.grains import even_sphere, random_rotation
from tools.make_samples.random_fields import SphereField, power_law

DIAMETER, EDGE, BLUR, NOISE, CONTRAST = 24.0, 53, 0.8, 0.05, 76
FACES = (40, 14, 8)
BEFORE = "area of contours, volume of thresholds"
AXES = np.array([1.5, 1.1, 0.6])


def shape_of(name: str, rng: np.random.Generator) -> Mesh:
    """A body of the kind, turned and placed at random near the middle of the volume."""
    sphere = icosphere(5)
    if name == "balls":
        body = Mesh(sphere.vertices, sphere.faces)
    elif name == "ellipsoids":
        body = Mesh(sphere.vertices * AXES, sphere.faces)
    elif name == "rough grains":
        field = SphereField(power_law(2, 20, 0.06, 1.4), rng)
        body = Mesh(sphere.vertices * np.exp(field(sphere.vertices))[:, None], sphere.faces)
    else:
        body = polyhedron(int(name.split()[2]), rng)
    scale = DIAMETER / 2 / (3 * body.volume / (4 * np.pi)) ** (1 / 3)
    turned = body.moved(shift=-body.centroid, rotation=random_rotation(rng), scale=scale)
    return turned.moved(shift=EDGE // 2 + rng.uniform(-0.5, 0.5, 3))


def polyhedron(n_faces: int, rng: np.random.Generator) -> Mesh:
    """The intersection of half-spaces with about evenly spread normals."""
    normals = even_sphere(n_faces).vertices + 0.3 * rng.standard_normal((n_faces, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    offsets = rng.uniform(0.85, 1.15, n_faces)
    corners = HalfspaceIntersection(np.column_stack([normals, -offsets]), np.zeros(3)).intersections
    return Mesh(corners[ConvexHull(corners).vertices], np.empty((0, 3), dtype=np.int64)).hull


def errors(truth: Mesh, rng: np.random.Generator) -> list[float]:
    """Errors in percent: of volume and area of the mask, then from grey values; of the area of the mask's
    contour; of the volume of the mask that the threshold leaves."""
    share = coverage(truth, (EDGE,) * 3, 8)
    seen = ndimage.gaussian_filter(share, BLUR) + NOISE * rng.standard_normal(share.shape)
    grey = np.round(62 + CONTRAST * seen)
    bright, _ = ndimage.label(ndimage.median_filter(grey, 3) >= 62 + CONTRAST / 2)
    own = bright == bright[(EDGE // 2,) * 3]
    found = grey_mesh(GrainCrop(own, np.zeros_like(own), grey.astype(np.int16)), own)
    if isinstance(found, str):
        sys.exit(f"The grey values did not tell: {found}")
    meshes = mask_mesh(share >= 0.5), found.mesh
    true = truth.volume, truth.surface_area
    made = [
        100 * (value / wanted - 1)
        for mesh in meshes
        for value, wanted in zip((mesh.volume, mesh.surface_area), true, strict=True)
    ]
    steps = contour((share >= 0.5).astype(np.float32), 0.5, (1.0, 1.0, 1.0)).surface_area
    return [*made, 100 * (steps / true[1] - 1), 100 * (np.count_nonzero(own) / true[0] - 1)]


def main(seed: int, repeats: int, result: str) -> None:
    """Print a row for each kind of shape: mean and largest error of each number."""
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    rows: Rows = {}
    before: Rows = {}
    for name in ("balls", "ellipsoids", *(f"polyhedra of {n} faces" for n in FACES), "rough grains"):
        found = np.array([errors(shape_of(name, rng), rng) for _ in range(repeats)])
        both = np.array([found[:, :4].mean(axis=0), np.abs(found[:, :4]).max(axis=0)])
        show_row(rows, name, both.T.ravel())
        show_row(before, name, found[:, 4:].mean(axis=0))
    add_result(result, "shape", rows, seed=seed, repeats=repeats)
    add_result(result, BEFORE, before, seed=seed, repeats=repeats)


if __name__ == "__main__":
    words = [*sys.argv[1:], *("3", "10", "")[len(sys.argv) - 1 :]]
    main(int(words[0]), int(words[1]), words[2])
