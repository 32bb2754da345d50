"""Exports read back by the programs they are for: YADE, LAMMPS, MuJoCo. Skipped where one is absent."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import ExportOptions, write_export
from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dataset.sampling import fitted_cylinder, pack_on_lattice
from regolith_studio.dataset.size_distributions import PAPER_CLASSES_UM, DiscreteSizeDistribution
from regolith_studio.errors import DatasetError, InputError
from regolith_studio.geometry.particle import Particle
from tests.tolerance import relative

from .example import Coarse, cuboid, entry
from .programs import needs_yade, run_yade

OPTIONS = ExportOptions(n_particles=40, seed=1)


@pytest.fixture(scope="module")
def dataset() -> Dataset:
    sizes = DiscreteSizeDistribution.of(PAPER_CLASSES_UM, [50, 30, 15, 4, 1])
    return build_dataset([entry(seed) for seed in range(3)], sizes=sizes, name="solver test")


def exported(dataset: Dataset, key: str, folder: Path, options: ExportOptions = OPTIONS) -> Path:
    return write_export(dataset, EXPORTERS[key], folder, options, accept_loss=True).folder


def moments(dataset: Dataset, which: int, mass: float, scale: float) -> np.ndarray:
    """Principal moments of a particle by Monte-Carlo-free means: tetrahedra of scipy's hull."""
    hull = ConvexHull(dataset.representatives[which].shape.vertices)
    second = np.zeros((3, 3))
    for triangle in hull.points[hull.simplices]:
        volume = abs(np.linalg.det(triangle)) / 6
        total = triangle.sum(axis=0)
        second += volume / 20 * (triangle.T @ triangle + np.outer(total, total))
    inertia = np.trace(second) * np.eye(3) - second
    return np.linalg.eigvalsh(inertia) * mass * scale**2


# --- layout


def test_that_bodies_do_not_touch_and_lie_inside_the_cylinder(dataset: Dataset) -> None:
    bodies = pack_on_lattice(dataset, OPTIONS.replaced(n_particles=300), within=0.004)
    reach = max(np.linalg.norm(one.shape.vertices, axis=1).max() for one in dataset.representatives)
    radii = reach * bodies.scale
    gaps = np.linalg.norm(bodies.position[:, None] - bodies.position[None], axis=2)
    np.fill_diagonal(gaps, np.inf)
    assert (gaps > radii[:, None] + radii[None]).all()
    assert (np.linalg.norm(bodies.position[:, :2], axis=1) + radii < 0.002).all()
    assert (bodies.position[:, 2] > radii).all()


def test_that_orientations_are_even_over_all_rotations(dataset: Dataset) -> None:
    turned = pack_on_lattice(dataset, OPTIONS.replaced(n_particles=20_000)).orientation
    axes = Rotation.from_quat(turned[:, [1, 2, 3, 0]]).as_matrix()
    assert np.linalg.norm(turned, axis=1) == pytest.approx(np.ones(len(turned)))
    assert np.abs(axes.mean(axis=0)).max() < 4 / np.sqrt(3 * len(turned))
    assert (axes**2).mean(axis=0) == pytest.approx(np.full((3, 3), 1 / 3), abs=0.01)


def test_that_a_particle_larger_than_the_cylinder_is_refused(dataset: Dataset, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="does not fit into a cylinder"):
        exported(dataset, "yade", tmp_path / "x", OPTIONS.replaced(diameter=1e-4))


def test_that_a_tube_for_few_particles_is_as_full_as_the_papers(dataset: Dataset) -> None:
    options = OPTIONS.replaced(n_particles=20_000)
    tube = fitted_cylinder(dataset, options)
    volume = (np.pi / 6 * pack_on_lattice(dataset, options).diameter ** 3).sum()
    assert tube.height / tube.diameter == pytest.approx(4)
    fill = volume / 0.55 / (np.pi / 4 * tube.diameter**2)
    assert fill / tube.diameter == pytest.approx(2.75 / 2)
    assert fitted_cylinder(dataset, OPTIONS.replaced(n_particles=1_000_000, diameter=0.003)).diameter == 0.003


# --- sizes

SHAPES = {"flat": cuboid(8.0, 8.0, 0.8), "needle": cuboid(10.0, 1.0, 1.0), "round": entry(1)[1].polyhedron}


def of_size(micrometres: float) -> tuple[Dataset, ExportOptions]:
    """A flat box, a needle and a round polyhedron of one size, in a cylinder that they fit into."""
    entries = [(Particle(name, shape.mesh), Coarse(shape, np.zeros(3))) for name, shape in SHAPES.items()]
    sizes = DiscreteSizeDistribution.of([micrometres], [1])
    options = OPTIONS.replaced(n_particles=12, diameter=0.2, height=0.8)
    return build_dataset(entries, sizes=sizes, name="sizes"), options


def mass_of(options: ExportOptions, micrometres: float) -> float:
    """Of a particle, in kilograms."""
    return options.contact.density * np.pi / 6 * (micrometres * 1e-6) ** 3


@pytest.mark.slow
@pytest.mark.parametrize("size", [0.5, 50.0, 5000.0])
def test_that_mujoco_loads_particles_of_any_size(size: float, tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    dataset, options = of_size(size)
    folder = exported(dataset, "mujoco", tmp_path / "x", options)
    model = mujoco.MjModel.from_xml_path(str(folder / "particles.xml"))
    data = mujoco.MjData(model)
    per_metre, per_kilogram = (1e6, 1e15) if size < 1.0 else (1e3, 1e6)
    assert model.body_mass[1:] == relative(np.full(12, mass_of(options, size) * per_kilogram), 1e-5)
    assert -model.opt.gravity[2] == relative(9.81 * per_metre * 1e-6)
    for _ in range(20):
        mujoco.mj_step(model, data)
    assert np.isfinite(data.qpos).all()


@pytest.mark.slow
@pytest.mark.parametrize("size", [0.5, 50.0, 5000.0])
def test_that_lammps_loads_particles_of_any_size(size: float, tmp_path: Path, lammps) -> None:
    dataset, options = of_size(size)
    folder = exported(dataset, "lammps", tmp_path / "x", options)
    done = lammps("-in", "in.particles", "-var", "steps", "20", cwd=folder)
    assert done.returncode == 0, done.stdout[-2000:]
    mass = float(done.stdout.split("total mass ")[-1].split()[0])
    assert mass == relative(12 * mass_of(options, size), 1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("size", [0.5, 50.0, 5000.0])
def test_that_trimesh_loads_particles_of_any_size(size: float, tmp_path: Path) -> None:
    dataset, options = of_size(size)
    scene = trimesh.load_scene(exported(dataset, "gltf", tmp_path / "gltf", options) / "particles.glb")
    assert len(scene.graph.nodes_geometry) == 12
    for name in scene.graph.nodes_geometry:
        matrix, mesh = scene.graph[name]
        volume = scene.geometry[mesh].volume * np.linalg.det(matrix[:3, :3])
        assert volume == relative(np.pi / 6 * (size * 1e-6) ** 3, 1e-4)
    for key in ("chrono", "aspherix", "edem"):
        folder = exported(dataset, key, tmp_path / key, options)
        meshes = [path for path in sorted(folder.rglob("shape_*")) if path.suffix in (".stl", ".obj")]
        assert len(meshes) == 3
        for path in meshes:
            assert trimesh.load_mesh(path).volume == relative(1.0, 1e-6)


@needs_yade
@pytest.mark.slow
@pytest.mark.parametrize("size", [2.5, 50.0, 5000.0])
def test_that_yade_loads_particles_of_any_size(size: float, tmp_path: Path) -> None:
    dataset, options = of_size(size)
    folder = exported(dataset, "yade", tmp_path / "x", options)
    run_yade(folder, "--check", "--run", "50")
    found = json.loads((folder / "check.json").read_text())["particles"]
    assert [body["mass"] for body in found] == relative([mass_of(options, size)] * 12, 1e-9)
    assert (folder / "positions.csv").exists()


def test_that_sizes_which_a_target_refuses_are_named_with_what_would_do(tmp_path: Path) -> None:
    dataset, options = of_size(0.5)
    with pytest.raises(DatasetError, match=r"of 0\.5 um.*a coarse-graining factor of 5 would do"):
        exported(dataset, "yade", tmp_path / "x", options)
    assert not (tmp_path / "x").exists()
    exported(dataset, "yade", tmp_path / "x", options.replaced(coarse_graining_factor=5.0))
    tiny = of_size(1e-4)[0]
    with pytest.raises(DatasetError, match=r"MuJoCo refuses .* a coarse-graining factor \d+ times as large"):
        exported(tiny, "mujoco", tmp_path / "y", options)
    assert not (tmp_path / "y").exists()


# --- YADE


@needs_yade
def test_that_yade_finds_the_volumes_masses_and_inertia_of_the_dataset(
    dataset: Dataset, tmp_path: Path
) -> None:
    folder = exported(dataset, "yade", tmp_path / "yade")
    run_yade(folder, "--check")
    found = json.loads((folder / "check.json").read_text())["particles"]
    bodies = pack_on_lattice(dataset, OPTIONS, within=fitted_cylinder(dataset, OPTIONS).diameter)
    assert len(found) == len(bodies)
    for which, scale, diameter, body in zip(
        bodies.class_index, bodies.scale, bodies.diameter, found, strict=True
    ):
        assert body["volume"] == relative(np.pi / 6 * diameter**3, 1e-9)
        assert body["mass"] == relative(3075 * np.pi / 6 * diameter**3, 1e-9)
        assert body["inertia"] == relative(moments(dataset, which, body["mass"], scale), 1e-9)


@needs_yade
def test_that_yade_has_the_moments_of_turned_boxes_of_any_size(tmp_path: Path) -> None:
    """Boxes of proportions 8 : 2 : 1, of 5 um to 2 cm, against m (b^2 + c^2) / 12."""
    box = np.array([4.0, 1.0, 0.5])
    record = (Particle("box", cuboid(*box).mesh), Coarse(cuboid(*box), np.zeros(3), n_facets_asked=6))
    sizes = DiscreteSizeDistribution.of([5.0, 50.0, 1500.0, 2e4], [1, 1, 1, 1])
    options = OPTIONS.replaced(diameter=0.2, height=0.8)
    folder = exported(build_dataset([record], sizes=sizes, name="boxes"), "yade", tmp_path / "x", options)
    run_yade(folder, "--check")
    found = json.loads((folder / "check.json").read_text())["particles"]
    squares = box**2 / box.prod() ** (2 / 3)
    shape = np.sort(squares.sum() - squares) / 12
    assert max(body["volume"] for body in found) > 1e9 * min(body["volume"] for body in found)
    for body in found:
        assert body["inertia"] == relative(shape * body["mass"] * body["volume"] ** (2 / 3), 1e-9)


@pytest.mark.slow
@needs_yade
def test_that_yade_lets_the_particles_fall_and_lifts_the_tube(dataset: Dataset, tmp_path: Path) -> None:
    """Twelve particles in a tube that is lifted at once: they fall, stay above the plate, and spread."""
    options = OPTIONS.replaced(
        n_particles=12, diameter=0.004, height=0.004, settling_time=0.002, lift_speed=0.5
    )
    folder = exported(dataset, "yade", tmp_path / "yade", options)
    run_yade(folder, "--run", "3000")
    with (folder / "positions.csv").open() as file:
        end = np.array([[float(row[key]) for key in ("x", "y", "z")] for row in csv.DictReader(file)])
    start = pack_on_lattice(dataset, options, within=fitted_cylinder(dataset, options).diameter).position
    assert len(end) == 12
    assert np.isfinite(end).all()
    assert end[:, 2].max() < start[:, 2].max()
    assert end[:, 2].min() > 0.0


# --- LAMMPS


def test_that_lammps_reads_the_bodies_and_finds_their_mass_and_vertices(
    dataset: Dataset, tmp_path: Path, lammps
) -> None:
    folder = exported(dataset, "lammps", tmp_path / "lammps")
    script = (folder / "in.particles").read_text()
    look = "compute corners all body/local id 1 2 3\ndump look all local 1 corners.txt c_corners[*]\n"
    look += 'dump_modify look format line "%.12g %.12g %.12g %.12g"\n'
    (folder / "in.test").write_text(script.replace("run   ", look + "run   "))
    done = lammps("-in", "in.test", "-var", "steps", "0", cwd=folder)
    assert done.returncode == 0, done.stdout[-2000:]
    bodies = pack_on_lattice(dataset, OPTIONS)
    mass = float(done.stdout.split("total mass ")[-1].split()[0])
    assert mass == relative((3075 * np.pi / 6 * bodies.diameter**3).sum(), rel=1e-9)
    lines = (folder / "corners.txt").read_text().split("ITEM: ENTRIES")[1].splitlines()[1:]
    table = np.array([[float(word) for word in line.split()] for line in lines])
    for index, (which, scale) in enumerate(zip(bodies.class_index, bodies.scale, strict=True)):
        mine = table[table[:, 0] == index + 1, 1:4]
        corners = mine[: len(mine)] - bodies.position[index]
        planes = dataset.representatives[which].shape.half_spaces
        turn = Rotation.from_quat(bodies.orientation[index][[1, 2, 3, 0]])
        reach = (turn.inv().apply(corners) @ planes.normals.T).max(axis=0)
        radius = OPTIONS.rounding * planes.offsets.min()
        assert (reach + radius * scale) / scale == pytest.approx(planes.offsets, abs=1e-6)


def test_that_lammps_moves_the_bodies(dataset: Dataset, tmp_path: Path, lammps) -> None:
    folder = exported(dataset, "lammps", tmp_path / "lammps")
    done = lammps("-in", "in.particles", "-var", "steps", "20", cwd=folder)
    assert done.returncode == 0, done.stdout[-2000:]
    assert "ERROR" not in done.stdout


def test_that_the_sections_of_lammps_data_have_the_names_that_it_reads(
    dataset: Dataset, tmp_path: Path
) -> None:
    lines = (exported(dataset, "lammps", tmp_path / "lammps") / "particles.data").read_text().splitlines()
    assert [line for line in lines if line[:1].isalpha()][1:] == ["Atoms # body", "Bodies"]


def test_that_shapes_beyond_the_lines_of_lammps_are_refused(tmp_path: Path) -> None:
    many = build_dataset([entry(0, n_facets=150)])
    with pytest.raises(DatasetError, match="coarsen to fewer faces"):
        exported(many, "lammps", tmp_path / "x")


# --- MuJoCo


def test_that_mujoco_finds_the_masses_and_inertia_of_the_dataset_and_rolling_resistance(
    dataset: Dataset, tmp_path: Path
) -> None:
    mujoco = pytest.importorskip("mujoco")
    options = OPTIONS.replaced(rolling_friction=0.2)
    folder = exported(dataset, "mujoco", tmp_path / "mujoco", options)
    model = mujoco.MjModel.from_xml_path(str(folder / "particles.xml"))
    bodies = pack_on_lattice(dataset, OPTIONS)
    assert model.nbody == len(bodies) + 1
    masses = 3075 * np.pi / 6 * bodies.diameter**3 * 1e6
    assert model.body_mass[1:] == relative(masses, rel=1e-5)
    for index, which in enumerate(bodies.class_index):
        expected = moments(dataset, which, masses[index], bodies.scale[index] * 1e3)
        assert np.sort(model.body_inertia[index + 1]) == relative(expected, rel=1e-5)
    assert model.body_pos[1:] == pytest.approx(bodies.position * 1e3, rel=1e-5)
    assert model.geom_condim[1:].tolist() == [6] * (model.ngeom - 1)
    assert model.geom_friction[1:, 2] == relative(np.full(model.ngeom - 1, 100.0 * bodies.diameter.mean()))


def test_that_mujoco_lets_the_particles_fall_at_9_81(dataset: Dataset, tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    folder = exported(dataset, "mujoco", tmp_path / "mujoco", OPTIONS.replaced(n_particles=4))
    model = mujoco.MjModel.from_xml_path(str(folder / "particles.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    start = data.xipos[1:, 2].copy()
    for _ in range(50):
        mujoco.mj_step(model, data)
    fallen = (start - data.xipos[1:, 2]) * 1e-3
    assert fallen.max() == pytest.approx(9.81 / 2 * (data.time * 1e-3) ** 2, rel=0.05)
