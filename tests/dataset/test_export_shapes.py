"""Exported shapes read back by strangers: scipy, trimesh, and readers of the published syntax."""

import csv
import json
import re
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial import HalfspaceIntersection
from scipy.stats import qmc

from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import ExportOptions, shape_names, write_export
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dataset.multisphere import (
    COUNTS,
    fit_spheres,
    fit_spheres_within,
    inscribed_spheres,
    sphere_fit_errors,
    union_moments,
)
from regolith_studio.dataset.rounded_polyhedra import rounded
from regolith_studio.dataset.sampling import pack_on_lattice
from regolith_studio.dataset.size_distributions import (
    DiscreteSizeDistribution,
    LogNormalSizeDistribution,
    RosinRammlerSizeDistribution,
    SieveSizeDistribution,
    size_classes,
)
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.readers.particles import read_mesh
from tests.tolerance import relative

from .example import entry

OPTIONS = ExportOptions(coarse_graining_factor=10.0, n_particles=30, n_spheres=12)


@pytest.fixture(scope="module")
def dataset() -> Dataset:
    return build_dataset([entry(seed) for seed in range(3)], name="shapes")


def exported(dataset: Dataset, key: str, folder: Path) -> Path:
    return write_export(dataset, EXPORTERS[key], folder, OPTIONS, accept_loss=True).folder


def cube() -> ConvexPolyhedron:
    return ConvexPolyhedron.from_half_spaces(HalfSpaces(np.vstack([np.eye(3), -np.eye(3)]), np.full(6, 0.5)))


def test_that_half_spaces_intersect_to_volume_one_about_the_origin(dataset: Dataset, tmp_path: Path) -> None:
    folder = exported(dataset, "half-spaces", tmp_path / "x")
    shapes = json.loads((folder / "half_spaces.json").read_text())["shapes"]
    with (folder / "half_spaces.csv").open(newline="") as file:
        table = list(csv.DictReader(file))
    for index, (shape, one) in enumerate(zip(shapes, dataset.representatives, strict=True)):
        normals, offsets = np.array(shape["normals"]), np.array(shape["offsets"])
        assert np.array_equal(normals, one.shape.half_spaces.normals)
        assert np.array_equal(offsets, one.shape.half_spaces.offsets)
        meeting = HalfspaceIntersection(np.column_stack([normals, -offsets]), np.zeros(3)).intersections
        solid = trimesh.convex.convex_hull(meeting)
        assert solid.volume == pytest.approx(1.0, rel=1e-9)
        assert np.abs(solid.center_mass).max() < 1e-9
        rows = [row for row in table if row["class"] == str(index)]
        read = np.array([[float(row[key]) for key in ("nx", "ny", "nz", "offset")] for row in rows])
        assert np.array_equal(read, np.column_stack([normals, offsets]))


def test_that_hoomd_gets_the_vertices_of_the_same_solid(dataset: Dataset, tmp_path: Path) -> None:
    folder = exported(dataset, "hoomd", tmp_path / "x")
    content = json.loads((folder / "type_shapes.json").read_text())
    assert content["types"] == ["shape_00_grain_0", "shape_01_grain_1", "shape_02_grain_2"]
    for shape, moments in zip(content["type_shapes"], content["moments"], strict=True):
        assert (shape["type"], shape["rounding_radius"]) == ("ConvexPolyhedron", 0.0)
        hull = trimesh.convex.convex_hull(np.array(shape["vertices"]))
        assert hull.volume == pytest.approx(1.0, rel=1e-9)
        assert np.diag(moments) == pytest.approx(hull.moment_inertia, abs=1e-9)


def test_that_chrono_gets_closed_outward_meshes_and_true_mass_data(dataset: Dataset, tmp_path: Path) -> None:
    folder = exported(dataset, "chrono", tmp_path / "x")
    content = json.loads((folder / "particles.json").read_text())
    assert sum(one["weight_number"] for one in content["shapes"]) == pytest.approx(1.0)
    for one, representative in zip(content["shapes"], dataset.representatives, strict=True):
        mesh = trimesh.load_mesh(folder / one["mesh"])
        assert mesh.is_watertight
        assert mesh.volume == pytest.approx(1.0, rel=1e-9)
        assert mesh.moment_inertia == pytest.approx(np.diag(one["moments"]), abs=1e-9)
        assert one["circumscribed_radius"] == pytest.approx(np.linalg.norm(mesh.vertices, axis=1).max())
        diameter = representative.sizes.quantile(0.5) * 1e-5
        assert one["scales_m"] == pytest.approx([diameter * (np.pi / 6) ** (1 / 3)])


def test_that_aspherix_templates_scale_to_the_sizes_and_share_the_mass(
    dataset: Dataset, tmp_path: Path
) -> None:
    folder = exported(dataset, "aspherix", tmp_path / "x")
    pattern = re.compile(
        r"particle_template id (\S+) material regolith shape convex file (\S+) scale (\S+)"
        r"  # mass fraction (\S+)"
    )
    found = [pattern.fullmatch(line) for line in (folder / "templates.asx").read_text().splitlines()[1:]]
    assert all(found)
    assert len({one.group(1) for one in found}) == len(found) == 3
    assert sum(float(one.group(4)) for one in found) == pytest.approx(1.0)
    for one, representative in zip(found, dataset.representatives, strict=True):
        mesh = trimesh.load_mesh(folder / one.group(2))
        diameter = representative.sizes.quantile(0.5) * 1e-5
        assert mesh.volume * float(one.group(3)) ** 3 == relative(np.pi / 6 * diameter**3, rel=1e-6)


# --- Rockable


def read_shp(text: str) -> list[dict]:
    """Shapes of a .shp by the published syntax: keywords, and counted lists after nv, ne, nf."""
    words, shapes, place = text.split(), [], 0
    lengths = {"name": 1, "radius": 1, "preCompDone": 1, "obb.extent": 3, "obb.e1": 3, "obb.e2": 3}
    lengths |= {"obb.e3": 3, "obb.center": 3, "position": 3, "orientation": 4, "volume": 1, "I/m": 3}
    while place < len(words):
        word, place = words[place], place + 1
        if word == "<":
            shapes.append({})
        elif word in ("nv", "ne"):
            width, count = {"nv": 3, "ne": 2}[word], int(words[place])
            numbers = np.array(words[place + 1 : place + 1 + width * count], dtype=float)
            shapes[-1][word] = numbers.reshape(count, width)
            place += 1 + width * count
        elif word == "nf":
            count, place, faces = int(words[place]), place + 1, []
            for _ in range(count):
                size = int(words[place])
                faces.append([int(corner) for corner in words[place + 1 : place + 1 + size]])
                place += 1 + size
            shapes[-1]["nf"] = faces
        elif word != ">":
            shapes[-1][word] = words[place : place + lengths[word]]
            place += lengths[word]
    return shapes


def test_that_rockable_shapes_keep_their_facets_planes_and_mass_data(
    dataset: Dataset, tmp_path: Path
) -> None:
    folder = exported(dataset, "rockable", tmp_path / "x")
    shapes = read_shp((folder / "shapes.shp").read_text())
    assert [shape["name"] for shape in shapes] == [[name] for name in shape_names(dataset)]
    for shape, one in zip(shapes, dataset.representatives, strict=True):
        corners, radius = shape["nv"], float(shape["radius"][0])
        assert len(shape["nf"]) == one.shape.n_facets
        assert len(corners) - len(shape["ne"]) + len(shape["nf"]) == 2
        for face, normal, offset in zip(
            shape["nf"], one.shape.half_spaces.normals, one.shape.half_spaces.offsets, strict=True
        ):
            assert corners[face] @ normal + radius == pytest.approx(np.full(len(face), offset))
            a, b, c = corners[face[:3]]
            assert np.cross(b - a, c - a) @ normal > 0
        assert 0.98 < float(shape["volume"][0]) < 1.0
        box = np.array(shape["obb.extent"], dtype=float)
        middle = np.array(shape["obb.center"], dtype=float)
        assert box == pytest.approx(np.abs(corners - middle).max(axis=0) + radius)
        assert np.array(shape["I/m"], float) == pytest.approx(np.diag(one.shape.mesh.inertia))


def test_that_a_rounded_cube_has_steiners_volume() -> None:
    body = rounded(cube(), 0.2)
    side, r = 0.8, 0.1
    assert body.radius == pytest.approx(r)
    assert body.volume == pytest.approx(
        side**3 + 6 * side**2 * r + 3 * np.pi * side * r**2 + 4 / 3 * np.pi * r**3
    )


def test_that_rounding_gives_way_where_a_facet_would_vanish() -> None:
    tip = np.array([1.0, 1.0, 1.0]) / np.sqrt(3)
    planes = cube().half_spaces
    cut = ConvexPolyhedron.from_half_spaces(
        HalfSpaces(np.vstack([planes.normals, tip]), np.append(planes.offsets, 0.5 * np.sqrt(3) - 0.01))
    )
    body = rounded(cut, 0.2)
    assert body.core.n_facets == cut.n_facets == 7
    assert 0.0 < body.radius < 0.1


def test_that_the_volume_of_a_rounded_polyhedron_agrees_with_monte_carlo(dataset: Dataset) -> None:
    body = rounded(dataset.representatives[0].shape, 0.3)
    generator = np.random.default_rng(0)
    low, high = body.core.vertices.min(0) - body.radius, body.core.vertices.max(0) + body.radius
    points = generator.uniform(low, high, (20_000, 3))
    core = trimesh.Trimesh(body.core.mesh.vertices, body.core.mesh.faces)
    _, distance, _ = trimesh.proximity.closest_point(core, points)
    inside = core.contains(points) | (distance <= body.radius)
    expected = inside.mean() * np.prod(high - low)
    error = np.sqrt(inside.mean() * (1 - inside.mean()) / len(points)) * np.prod(high - low)
    assert body.volume == pytest.approx(expected, abs=4 * error)


# --- spheres


def test_that_inscribed_spheres_lie_inside_and_the_first_is_the_largest_that_fits(dataset: Dataset) -> None:
    shape = dataset.representatives[0].shape
    spheres = inscribed_spheres(shape, 15)
    reach = spheres[:, :3] @ shape.half_spaces.normals.T + spheres[:, 3:]
    assert (reach <= shape.half_spaces.offsets + 1e-9).all()
    assert spheres[0, 3] == pytest.approx(spheres[:, 3].max())
    assert len(spheres) == 15
    assert inscribed_spheres(cube(), 1)[0] == pytest.approx([0, 0, 0, 0.5], abs=1e-9)


def test_that_two_spheres_share_a_lens() -> None:
    """Caps of height 0.4 of two unit spheres 1.2 apart lie in each other; the second moment along the axis
    by integrating the discs."""
    union = union_moments(np.array([[-0.6, 0.0, 0.0, 1.0], [0.6, 0.0, 0.0, 1.0]]))
    assert union.values[0] == pytest.approx(8 / 3 * np.pi - 2 * np.pi * 0.4**2 * (3 - 0.4) / 3, rel=2e-4)
    assert union.area == pytest.approx(8 * np.pi - 2 * 2 * np.pi * 0.4, rel=3e-4)
    x = np.linspace(0.0, 1.6, 200_001)
    assert union.values[4] == pytest.approx(
        2 * np.trapezoid(np.pi * (1 - (x - 0.6) ** 2) * x**2, x), rel=3e-4
    )
    assert union.values[[1, 2, 3, 5, 6, 8]] == pytest.approx(np.zeros(6), abs=2e-3)


def test_that_a_sphere_within_another_adds_nothing_and_one_apart_adds_itself() -> None:
    ball = 4 / 3 * np.pi
    within = union_moments(np.array([[0.0, 0.0, 0.0, 1.0], [0.1, 0.0, 0.0, 0.5]]))
    assert (within.values[0], within.area) == pytest.approx((ball, 4 * np.pi), rel=1e-4)
    assert np.all(within.gradient[:, 1] == 0.0)
    apart = union_moments(np.array([[0.0, 0.0, 0.0, 1.0], [3.0, 0.0, 0.0, 0.5]]))
    assert (apart.values[0], apart.area) == pytest.approx((1.125 * ball, 5 * np.pi), rel=1e-4)


def test_that_one_sphere_for_a_cube_has_its_volume_and_centre_and_more_match_better() -> None:
    ball = fit_spheres(cube(), 1)
    assert ball[0] == pytest.approx([0, 0, 0, (3 / (4 * np.pi)) ** (1 / 3)], abs=5e-3)
    errors = [sphere_fit_errors(cube(), fit_spheres(cube(), count)).jaccard for count in (1, 4, 9)]
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < 0.2


def test_that_the_inscribed_ball_of_a_cube_has_the_errors_of_the_formulas() -> None:
    errors = sphere_fit_errors(cube(), inscribed_spheres(cube(), 1))
    assert errors.volume == pytest.approx(np.pi / 6 - 1, abs=1e-4)
    assert errors.area == pytest.approx(np.pi / 6 - 1, abs=1e-4)
    assert errors.inertia == pytest.approx(1 - 0.4 * 0.25 / (1 / 6), abs=1e-3)
    assert errors.jaccard == pytest.approx(1 - np.pi / 6, abs=1e-3)


@pytest.mark.parametrize("index", [0, *(pytest.param(k, marks=pytest.mark.slow) for k in (1, 2))])
def test_that_the_union_has_the_polyhedron_s_volume_and_inertia_to_a_thousandth(
    dataset: Dataset, index: int
) -> None:
    """Compared with the mean over points that a generator of random numbers spreads."""
    shape = dataset.representatives[index].shape
    spheres = fit_spheres(shape, 12)
    reach = np.abs(spheres[:, :3]).max(axis=0) + spheres[:, 3].max()
    points = qmc.Sobol(3, seed=5).random_base2(20) * 2 * reach - reach
    inside = np.zeros(len(points), dtype=bool)
    for x, y, z, radius in spheres:
        inside |= ((points - (x, y, z)) ** 2).sum(axis=1) <= radius**2
    assert inside.mean() * np.prod(2 * reach) == pytest.approx(1.0, abs=1e-3)
    second = points[inside].T @ points[inside] / inside.sum()
    moments = np.linalg.eigvalsh(np.trace(second) * np.eye(3) - second)
    assert moments == pytest.approx(np.linalg.eigvalsh(shape.mesh.inertia), rel=2e-3)
    assert points[inside].mean(axis=0) == pytest.approx(np.zeros(3), abs=1e-3)


def test_that_spheres_follow_their_polyhedron_where_it_is_moved_and_scaled() -> None:
    planes = cube().half_spaces
    shift, factor = np.array([0.3, -0.1, 0.2]), 50.0
    moved = ConvexPolyhedron.from_half_spaces(
        HalfSpaces(planes.normals, factor * planes.offsets + planes.normals @ (factor * shift))
    )
    errors = sphere_fit_errors(moved, fit_spheres(moved, 8))
    assert errors.volume == pytest.approx(0.0, abs=1e-3)
    assert errors.jaccard < 0.25


def test_that_no_more_spheres_are_taken_than_a_stated_error_needs(dataset: Dataset) -> None:
    shape = dataset.representatives[0].shape
    spheres = fit_spheres_within(shape, 0.2)
    assert sphere_fit_errors(shape, spheres).jaccard <= 0.2
    before = max(count for count in COUNTS if count < len(spheres))
    assert sphere_fit_errors(shape, fit_spheres(shape, before)).jaccard > 0.2


def test_that_the_stated_volume_of_the_spheres_agrees_with_monte_carlo(
    dataset: Dataset, tmp_path: Path
) -> None:
    folder = exported(dataset, "multi-sphere", tmp_path / "x")
    with (folder / "fit.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        spheres = np.loadtxt(folder / "spheres" / f"{row['shape']}.txt")
        low = (spheres[:, :3] - spheres[:, 3:]).min(axis=0)
        high = (spheres[:, :3] + spheres[:, 3:]).max(axis=0)
        points = np.random.default_rng(0).uniform(low, high, (100_000, 3))
        inside = (((points[:, None] - spheres[None, :, :3]) ** 2).sum(-1) <= spheres[:, 3] ** 2).any(1)
        assert float(row["union_volume"]) == pytest.approx(inside.mean() * np.prod(high - low), abs=0.01)
        said = (folder / "README.txt").read_text()
        assert f"mismatch {float(row['jaccard_distance']):.3f}" in said
        assert f"area {100 * float(row['area_error']):+.1f} %" in said
        assert f"up to {100 * float(row['inertia_error']):.2f} % off" in said


# --- glTF


def test_that_gltf_shows_every_particle_where_it_is_in_metres(dataset: Dataset, tmp_path: Path) -> None:
    folder = exported(dataset, "gltf", tmp_path / "x")
    scene = trimesh.load_scene(folder / "particles.glb")
    bodies, names = pack_on_lattice(dataset, OPTIONS), shape_names(dataset)
    assert len(scene.geometry) == 3
    assert len(scene.graph.nodes_geometry) == len(bodies)
    for index in range(len(bodies)):
        transform, geometry = scene.graph[f"particle_{index:06d}"]
        assert geometry == names[bodies.class_index[index]]
        placed = scene.geometry[geometry].copy()
        placed.merge_vertices(merge_norm=True)
        placed.apply_transform(transform)
        assert placed.is_watertight
        assert placed.volume == relative(np.pi / 6 * bodies.diameter[index] ** 3, 1e-4)
        x, y, z = bodies.position[index]
        assert placed.center_mass == pytest.approx([x, z, -y], abs=1e-7)


def test_that_our_own_gltf_is_read_back_in_its_size(dataset: Dataset, tmp_path: Path) -> None:
    path = exported(dataset, "gltf", tmp_path / "x") / "particles.glb"
    expected = trimesh.load_scene(path).to_mesh().bounds * 1e6
    assert read_mesh(path, repair=False).mesh.bounds == relative(expected, 1e-6)


# --- sizes


SIZES = {
    "discrete": DiscreteSizeDistribution.of([20, 40], [3, 1]),
    "many": DiscreteSizeDistribution.empirical(np.random.default_rng(0).lognormal(3.5, 0.5, 500)),
    "by volume": DiscreteSizeDistribution.of([20, 40, 60], [1, 1, 1], "volume"),
    "sieve": SieveSizeDistribution.of([20, 30, 60, 90], [1, 2, 1]),
    "log-normal": LogNormalSizeDistribution(median_um=50.0, log_deviation=0.5),
    "log-normal by volume": LogNormalSizeDistribution(weighting="volume", median_um=50.0, log_deviation=0.4),
    "rosin-rammler": RosinRammlerSizeDistribution(
        weighting="volume", scale_um=60.0, shape=2.0, min_um=10.0, max_um=200.0
    ),
}


@pytest.mark.parametrize("kind", SIZES)
def test_that_size_classes_keep_the_mean_mass_of_a_particle(kind: str) -> None:
    sizes = SIZES[kind]
    classes = size_classes(sizes)
    assert 1 <= len(classes.diameters) <= 16
    assert (np.diff(classes.diameters) > 0).all()
    assert classes.number.sum() == pytest.approx(1.0)
    assert classes.mass == relative(
        classes.number * classes.diameters**3 / (classes.number * classes.diameters**3).sum()
    )
    assert classes.number @ classes.diameters**3 == pytest.approx(sizes.mean_cube(), rel=5e-3)
    spread = np.abs(np.cumsum(classes.number) - sizes.weighted("number").cdf(classes.diameters))
    assert spread.max() <= classes.number.max() + 1e-9
