"""Exports of compounds, read back by MuJoCo, LAMMPS, YADE, trimesh and readers of the published syntax."""

import csv
import json
import re
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull, HalfspaceIntersection

from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import ExportOptions, write_export
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dataset.multisphere import fit_spheres, sphere_fit_errors
from regolith_studio.dataset.sampling import fitted_cylinder, pack_on_lattice
from regolith_studio.errors import DatasetError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.jobs.dataset_jobs import export_dataset_folder
from tests.tolerance import relative

from .example import elbow_entry, elbow_moments, entry
from .programs import needs_yade, run_yade
from .test_export_shapes import read_shp

OPTIONS = ExportOptions(coarse_graining_factor=10.0, n_particles=10, n_spheres=12)
DENSITY = 3075.0
PART = 12 / 20
"""Volume of a bar over that of the elbow: together they have 1.2."""


@pytest.fixture(scope="module")
def dataset() -> Dataset:
    return build_dataset([elbow_entry(), entry(1)], name="mixed")


def exported(dataset: Dataset, key: str, folder: Path) -> Path:
    return write_export(dataset, EXPORTERS[key], folder, OPTIONS, accept_loss=True).folder


def wanted_moments(dataset: Dataset, which: int) -> FloatArray:
    """Principal moments at volume and density 1, ascending: the closed form, or those of trimesh's hull."""
    if which == 0:
        return elbow_moments()
    hull = trimesh.convex.convex_hull(dataset.representatives[which].shape.vertices)
    return np.linalg.eigvalsh(hull.moment_inertia)


def test_that_mujoco_finds_mass_centre_and_inertia_of_the_union(dataset: Dataset, tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    folder = exported(dataset, "mujoco", tmp_path / "x")
    model = mujoco.MjModel.from_xml_path(str(folder / "particles.xml"))
    bodies = pack_on_lattice(dataset, OPTIONS)
    assert model.body_geomnum[1:].tolist() == [(2, 1)[which] for which in bodies.class_index]
    masses = DENSITY * np.pi / 6 * bodies.diameter**3 * 1e6
    assert model.body_mass[1:] == pytest.approx(masses, rel=1e-5)
    assert model.body_ipos[1:] == pytest.approx(np.zeros((len(bodies), 3)), abs=1e-5)
    for index, which in enumerate(bodies.class_index.tolist()):
        expected = wanted_moments(dataset, which) * masses[index] * (bodies.scale[index] * 1e3) ** 2
        assert np.sort(model.body_inertia[index + 1]) == relative(expected, rel=1e-5)
    volumes = [model.mesh_vertnum[model.geom_dataid[geom]] for geom in range(1, model.ngeom)]
    assert set(volumes) == {8, dataset.representatives[1].shape.vertices.shape[0]}


def test_that_gltf_draws_the_union_with_its_volume_and_inertia(dataset: Dataset, tmp_path: Path) -> None:
    folder = exported(dataset, "gltf", tmp_path / "x")
    scene = trimesh.load_scene(folder / "particles.glb")
    union = scene.geometry["shape_00_elbow"].copy()
    union.merge_vertices(merge_norm=True)
    assert union.is_watertight
    assert not union.is_convex
    assert union.volume == pytest.approx(1.0, rel=1e-5)
    assert np.linalg.eigvalsh(union.moment_inertia) == pytest.approx(elbow_moments(), rel=1e-4)
    stored = scene.geometry["shape_00_elbow"]
    across = np.einsum("ij,ij->i", stored.vertex_normals[stored.faces[:, 0]], stored.face_normals)
    assert across == pytest.approx(np.ones(len(across)), abs=1e-4)


def test_that_chrono_gets_the_union_its_parts_and_its_mass_data(dataset: Dataset, tmp_path: Path) -> None:
    folder = exported(dataset, "chrono", tmp_path / "x")
    first, second = json.loads((folder / "particles.json").read_text())["shapes"]
    union = trimesh.load_mesh(folder / first["mesh"])
    assert union.is_watertight
    assert (union.volume, first["volume"]) == pytest.approx((1.0, 1.0), rel=1e-9)
    assert union.moment_inertia == pytest.approx(np.diag(first["moments"]), abs=1e-9)
    assert sorted(first["moments"]) == pytest.approx(elbow_moments())
    assert [trimesh.load_mesh(folder / part).volume for part in first["parts"]] == pytest.approx([PART] * 2)
    assert second["parts"] == []


def test_that_convex_bodies_of_aspherix_add_up_to_mass_and_centre_of_the_union(
    dataset: Dataset, tmp_path: Path
) -> None:
    folder = exported(dataset, "aspherix", tmp_path / "x")
    lines = (folder / "templates.asx").read_text().splitlines()
    body = re.compile(r"convex_body id (\S+) file (\S+) mass (\S+) center_of_mass \((.*)\)")
    bodies = {found.group(1): found for line in lines if (found := body.fullmatch(line))}
    template = re.compile(
        r"particle_template id shape_00_elbow_00 material regolith shape concave convex_bodies {(.*)} "
        r"moment_of_inertia principal \((.*)\) off_diagonal \((.*)\)  # mass fraction \S+"
    )
    (found,) = [match for line in lines if (match := template.fullmatch(line))]
    names = found.group(1).split(",")
    assert sorted(names) == sorted(bodies)
    masses = np.array([float(bodies[name].group(3)) for name in names])
    centres = np.array([np.array(bodies[name].group(4).split(","), float) for name in names])
    diameter = dataset.representatives[0].sizes.quantile(0.5) * 1e-5
    mass, scale = DENSITY * np.pi / 6 * diameter**3, diameter * (np.pi / 6) ** (1 / 3)
    assert masses.sum() == relative(mass)
    assert masses @ centres == pytest.approx(np.zeros(3), abs=1e-12 * mass)
    assert sorted(np.array(found.group(2).split(","), float)) == relative(elbow_moments() * mass * scale**2)
    for name in names:
        part = trimesh.load_mesh(folder / bodies[name].group(2))
        assert part.is_convex
        assert part.volume == relative(PART * scale**3, rel=1e-5)
    assert any("shape_01_grain_1_00 material regolith shape convex file" in line for line in lines)


def test_that_rockable_gets_the_facets_of_all_parts_and_the_mass_data_of_the_union(
    dataset: Dataset, tmp_path: Path
) -> None:
    folder = exported(dataset, "rockable", tmp_path / "x")
    shape = read_shp((folder / "shapes.shp").read_text())[0]
    corners, radius = shape["nv"], float(shape["radius"][0])
    assert (len(corners), len(shape["ne"]), len(shape["nf"])) == (16, 24, 12)
    for normals, offsets in dataset.representatives[0].shape.part_planes:
        for normal, offset in zip(normals, offsets, strict=True):
            level = corners @ normal + radius - offset
            assert any(np.abs(level[face]).max() < 1e-9 for face in shape["nf"])
    halves = [ConvexHull(corners[:8]).volume, ConvexHull(corners[8:]).volume]
    assert halves == pytest.approx([PART, PART], rel=0.15)
    assert float(shape["volume"][0]) == pytest.approx(1.0)
    assert sorted(np.array(shape["I/m"], float)) == pytest.approx(elbow_moments())


def test_that_half_spaces_of_a_compound_intersect_to_its_parts(dataset: Dataset, tmp_path: Path) -> None:
    folder = exported(dataset, "half-spaces", tmp_path / "x")
    first, second = json.loads((folder / "half_spaces.json").read_text())["shapes"]
    assert "parts" not in second
    with (folder / "half_spaces.csv").open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["class"] == "0"]
    corners = dataset.representatives[0].shape.vertices.reshape(2, 8, 3)
    for number, (part, own) in enumerate(zip(first["parts"], corners, strict=True)):
        normals, offsets = np.array(part["normals"]), np.array(part["offsets"])
        meeting = HalfspaceIntersection(np.column_stack([normals, -offsets]), own.mean(axis=0)).intersections
        assert ConvexHull(meeting).volume == pytest.approx(PART)
        assert np.abs(np.sort(meeting, axis=0) - np.sort(own, axis=0)).max() < 1e-9
        mine = [[float(row[key]) for key in ("nx", "ny", "nz")] for row in rows if row["part"] == str(number)]
        assert np.array_equal(mine, normals)


def test_that_spheres_of_a_compound_leave_its_open_corner_free(dataset: Dataset) -> None:
    one = dataset.representatives[0]
    spheres = fit_spheres(one.shape, 40)
    errors = sphere_fit_errors(one.shape, spheres)
    assert abs(errors.volume) < 1e-3
    assert errors.inertia < 5e-3
    assert errors.jaccard < 0.3
    hull_only = 1.0 - 20 / 28
    assert errors.jaccard < hull_only + 0.05


def test_that_liggghts_and_pfc_get_mass_and_inertia_of_the_union(dataset: Dataset, tmp_path: Path) -> None:
    line = (exported(dataset, "liggghts", tmp_path / "x") / "templates.in").read_text().splitlines()[1]
    found = re.search(r" mass (\S+) inertia_tensor (\S+) 0 0 (\S+) 0 (\S+) use_density", line)
    assert found is not None
    diameter = dataset.representatives[0].sizes.quantile(0.5) * 1e-5
    mass = DENSITY * np.pi / 6 * diameter**3
    moments = sorted(float(found.group(k)) for k in (2, 3, 4))
    assert float(found.group(1)) == relative(mass)
    assert moments == relative(elbow_moments() * mass * diameter**2 * (np.pi / 6) ** (2 / 3))
    folder = exported(dataset, "pfc", tmp_path / "y")
    text = (folder / "templates.dat").read_text()
    found = re.search(r"volume (\S+) \.\.\.\s+inertia (\S+) (\S+) (\S+) 0 0 0", text)
    assert found is not None
    assert float(found.group(1)) == pytest.approx(1.0)
    assert sorted(float(found.group(k)) for k in (2, 3, 4)) == pytest.approx(elbow_moments())
    assert not trimesh.load_mesh(folder / "meshes" / "shape_00_elbow.stl").is_convex


@needs_yade
def test_that_yade_gives_clumps_the_mass_centre_and_inertia_of_their_union(
    dataset: Dataset, tmp_path: Path
) -> None:
    folder = exported(dataset, "yade", tmp_path / "x")
    run_yade(folder, "--check")
    found = json.loads((folder / "check.json").read_text())["particles"]
    bodies = pack_on_lattice(dataset, OPTIONS, within=fitted_cylinder(dataset, OPTIONS).diameter)
    order = np.argsort([body["position"][2] for body in found], kind="stable")
    assert len(found) == len(bodies)
    masses = DENSITY * bodies.scale**3
    assert sorted(body["mass"] for body in found) == relative(np.sort(masses), 1e-9)
    for body in [found[index] for index in order]:
        place = np.linalg.norm(bodies.position - body["position"], axis=1)
        index = int(place.argmin())
        scale, which = float(bodies.scale[index]), int(bodies.class_index[index])
        assert place[index] < 1e-6 * scale
        expected = wanted_moments(dataset, which) * masses[index] * scale**2
        assert body["inertia"] == relative(expected, 1e-9)


def test_that_points_and_parts_of_a_clump_of_yade_add_up_to_the_union(
    dataset: Dataset, tmp_path: Path
) -> None:
    """As YADE adds up members without moments of their own: mass, centre, and second moments."""
    folder = exported(dataset, "yade", tmp_path / "x")
    first, second = json.loads((folder / "case.json").read_text())["shapes"]
    assert set(second) == {"key", "name", "parts"}
    points, parts = np.array(first["points"]), [trimesh.convex.convex_hull(part) for part in first["parts"]]
    masses = np.array([*first["mass_shares"], *points[:, 3]])
    assert masses.min() > 0.0
    assert masses.sum() == pytest.approx(1.0)
    centres = np.vstack([[part.center_mass for part in parts], points[:, :3]])
    assert masses @ centres == pytest.approx(np.zeros(3), abs=1e-12)
    inertia = np.zeros((3, 3))
    for mass, centre in zip(masses, centres, strict=True):
        inertia += mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    assert np.linalg.eigvalsh(inertia) == pytest.approx(elbow_moments())


def test_that_one_format_of_convex_particles_stops_all_before_anything_is_written(
    dataset: Dataset, tmp_path: Path
) -> None:
    from regolith_studio.dataset.folder_io import write_dataset

    source = write_dataset(tmp_path / "set", dataset)
    with pytest.raises(DatasetError, match="Leave the format hoomd out"):
        list(export_dataset_folder(source, ["gltf", "hoomd"], tmp_path / "out", OPTIONS))
    with pytest.raises(DatasetError, match="Leave the formats edem, hoomd out") as refused:
        list(export_dataset_folder(source, ["edem", "gltf", "hoomd"], tmp_path / "out", OPTIONS))
    assert str(refused.value).count("a compound of convex parts: ") == 2
    assert not (tmp_path / "out").exists()
