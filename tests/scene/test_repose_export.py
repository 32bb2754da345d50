"""Exports of runs, read back by VTK, pyvista, trimesh and numpy, and placed again by scipy."""

import hashlib
import json
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
import trimesh
from PIL import Image
from scipy.spatial.transform import Rotation
from vtkmodules.vtkRenderingCore import vtkActor, vtkGlyph3DMapper

from benchmarks.sliding_friction import box_dataset
from regolith_studio.cli.entry import run
from regolith_studio.dataset.build import build_dataset
from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.folder_io import write_dataset
from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest
from regolith_studio.dem.case import ReposeCase, ShapeKind, prepare
from regolith_studio.dem.evaluation import EvaluationSettings
from regolith_studio.dem.run_io import (
    FORMAT,
    case_document,
    read_final_state,
    read_run,
    save_result,
    save_shapes,
    save_snapshot,
)
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.errors import FileError, InputError, RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.jobs.repose_jobs import ReposeRequest, repose_steps
from regolith_studio.scene import cameras, plotter_setup
from regolith_studio.scene.repose_export import export_repose, run_shapes
from regolith_studio.steps import result_of
from tests.dataset.example import elbow_entry, entry
from tests.tolerance import relative

N = 30
TOP_VIEW = """
import runpy, sys
view = runpy.run_path(sys.argv[1])["view"]
view.ViewSize, view.OrientationAxesVisibility, view.CameraParallelProjection = [600, 600], 0, 1
camera = view.GetActiveCamera()
camera.SetPosition(0.0, 0.0, 1.0)
camera.SetFocalPoint(0.0, 0.0, 0.0)
camera.SetViewUp(0.0, 1.0, 0.0)
camera.SetParallelScale(0.03)
from paraview import simple
simple.SaveScreenshot(sys.argv[2], view)
"""
"""Has ParaView draw what the script of an export shows, from above: 600 pixels of 0.1 mm."""


@pytest.fixture(scope="module")
def grains() -> Dataset:
    """Two convex bodies and a compound of two bars."""
    return build_dataset([entry(1), entry(2, 8), elbow_entry()], name="grains")


def particles(n_shapes: int, time: float, phase: str = "rest") -> ParticleState:
    generator = np.random.default_rng(3)
    return ParticleState(
        generator.uniform(-0.02, 0.02, (N, 3)) + np.array([0.0, 0.0, 0.03 + time]),
        generator.uniform(1e-3, 3e-3, N),
        Rotation.random(N, random_state=4).as_quat(scalar_first=True),
        np.arange(N) % n_shapes,
        time,
        0.01 if phase == "lift" else float("inf"),
        phase,
    )


def write_run(
    folder: Path, dataset: Dataset, shapes: ShapeKind = "polyhedra", state: str = "finished"
) -> Path:
    """A run with three snapshots, the last of which is the final state too if it was finished."""
    (folder / "snapshots").mkdir(parents=True)
    save_shapes(folder, prepare(dataset, ReposeCase(n_particles=N)))
    for number, time in enumerate((0.0, 0.25, 0.5)):
        save_snapshot(folder, number, particles(len(dataset), time, "lift" if time < 0.5 else "rest"))
    final = particles(len(dataset), 0.5) if state == "finished" else None
    case = case_document(ReposeCase(n_particles=N, shapes=shapes))
    save_result(folder, {"format": FORMAT, "state": state, "case": case}, final, 1.0)
    return folder


@pytest.fixture(scope="module")
def heap(grains: Dataset, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_run(tmp_path_factory.mktemp("runs") / "heap", grains)


@pytest.fixture(scope="module")
def exported(heap: Path) -> Path:
    return export_repose(heap, heap.parent / "export").folder


def placed(vertices: FloatArray, pile: ParticleState, k: int) -> FloatArray:
    """Vertices of a shape of unit volume where particle `k` is, by scipy."""
    volume = np.pi / 6 * pile.diameters[k] ** 3
    turn = Rotation.from_quat(pile.orientations[k], scalar_first=True)
    return turn.apply(vertices) * volume ** (1 / 3) + pile.points[k]


def unit_vertices(dataset: Dataset, kind: int) -> FloatArray:
    return np.array(dataset.representatives[kind].shape.mesh.vertices)


def test_that_the_series_of_paraview_has_the_times_of_the_snapshots(exported: Path) -> None:
    reader = pv.get_reader(str(exported / "particles.pvd"))
    assert reader.time_values == [0.0, 0.25, 0.5]
    reader.set_active_time_value(0.25)
    moment = reader.read()[0]
    assert moment.field_data["phase"][0] == "lift"
    assert moment.field_data["cylinder_rim"][0] == 0.01
    pile = particles(3, 0.25)
    np.testing.assert_allclose(moment.points, pile.points, atol=1e-8)
    np.testing.assert_allclose(moment.point_data["diameter"], pile.diameters, rtol=1e-6)
    np.testing.assert_array_equal(moment.point_data["shape"], pile.class_index)


def test_that_paraview_s_glyphs_are_drawn_where_scipy_places_the_polyhedra(
    exported: Path, grains: Dataset
) -> None:
    """ParaView's representation "3D Glyphs" is VTK's mapper, with the options that the README names."""
    plotter_setup.choose_off_screen_window()
    plotter = pv.Plotter(off_screen=True, window_size=[300, 300])
    moment = pv.read(exported / "particles" / "particles_000002.vtp")
    mapper = vtkGlyph3DMapper()
    mapper.SetSourceTableTree(pv.read(exported / "shapes.vtm"))
    mapper.SetUseSourceTableTree(True)
    mapper.SetSourceIndexing(True)
    mapper.SetSourceIndexArray("shape")
    mapper.SetOrientationArray("orientation")
    mapper.SetOrientationModeToQuaternion()
    mapper.SetScaleArray("diameter")
    mapper.SetScaleModeToScaleByMagnitude()
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    actor.GetProperty().SetColor(0.0, 0.0, 0.0)
    plotter.add_actor(actor)
    pile = particles(3, 0.5)
    for k in range(9):
        mapper.SetInputData(moment.extract_points([k], include_cells=False))
        corners = placed(unit_vertices(grains, k % 3), pile, k)
        half = 1.1 * float(np.abs(corners - pile.points[k]).max())
        pose = cameras.CameraPose((*pile.points[k, :2], 1.0), tuple(pile.points[k]), (0, 1, 0), half)
        cameras.apply_pose(plotter, pose)
        plotter.render()
        drawn = plotter.screenshot(return_img=True)[:, :, 0] < 128
        rows, columns = np.flatnonzero(drawn.any(axis=1)), np.flatnonzero(drawn.any(axis=0))
        pixel = 2 * half / 300
        left, right = pixel * (columns[[0, -1]] + [0, 1] - 150)
        top, bottom = pixel * (150 - rows[[0, -1]] - [0, 1])
        low, high = (corners - pile.points[k]).min(axis=0), (corners - pile.points[k]).max(axis=0)
        assert [left, right, bottom, top] == pytest.approx(
            [low[0], high[0], low[1], high[1]], abs=2.5 * pixel
        )
    plotter.close()


@pytest.mark.slow
@pytest.mark.skipif(not shutil.which("pvpython"), reason="ParaView is not installed")
def test_that_paraview_draws_the_heap_by_the_script_of_the_export(
    exported: Path, grains: Dataset, tmp_path: Path
) -> None:
    (tmp_path / "top.py").write_text(TOP_VIEW)
    words = ["pvpython", tmp_path / "top.py", exported / "show_in_paraview.py", tmp_path / "top.png"]
    subprocess.run(words, check=True, timeout=300, capture_output=True)
    picture = np.asarray(Image.open(tmp_path / "top.png").convert("RGB"))
    drawn = (picture != picture[0, 0]).any(axis=2)
    pile = particles(3, 0.5)
    corners = np.concatenate([placed(unit_vertices(grains, k % 3), pile, k) for k in range(N)])
    rows, columns = np.flatnonzero(drawn.any(axis=1)), np.flatnonzero(drawn.any(axis=0))
    found = [columns[0] - 300, columns[-1] - 299, 299 - rows[-1], 300 - rows[0]]
    (left, bottom, _), (right, top, _) = corners.min(axis=0) / 1e-4, corners.max(axis=0) / 1e-4
    assert found == pytest.approx([left, right, bottom, top], abs=2.5)


def test_that_ovito_s_series_has_type_position_radius_and_orientation(exported: Path) -> None:
    lines = (exported / "ovito" / "particles.000002.xyz").read_text("ascii").splitlines()
    assert lines[0] == str(N)
    assert lines[1].startswith("Properties=species:S:1:pos:R:3:radius:R:1:orientation:R:4 Time=0.5")
    rows = [line.split() for line in lines[2:]]
    pile = particles(3, 0.5)
    assert [row[0] for row in rows] == [f"shape_{k % 3:02d}" for k in range(N)]
    numbers = np.array([row[1:] for row in rows], dtype=float)
    np.testing.assert_allclose(numbers[:, :3], pile.points, rtol=1e-6)
    np.testing.assert_allclose(numbers[:, 3], pile.diameters / 2, rtol=1e-6)
    turned = Rotation.from_quat(numbers[:, 4:]).inv() * Rotation.from_quat(
        pile.orientations, scalar_first=True
    )
    assert turned.magnitude().max() < 1e-5
    solid = trimesh.load(exported / "ovito" / "shape_02.stl")
    assert solid.is_watertight
    assert solid.volume == pytest.approx(4 / 3 * np.pi, rel=1e-5), "radius 1, as OVITO scales it"


def test_that_trimesh_reads_the_heap_with_its_volume_and_places(exported: Path, grains: Dataset) -> None:
    scene = trimesh.load(exported / "heap.glb")
    pile = particles(3, 0.5)
    assert len(scene.graph.nodes_geometry) == N
    assert len(scene.geometry) == 3
    bodies = scene.dump()
    assert sum(body.volume for body in bodies) == relative((np.pi / 6 * pile.diameters**3).sum(), 1e-5)
    corners = np.concatenate([placed(unit_vertices(grains, k % 3), pile, k) for k in range(N)])
    low, high = corners.min(axis=0), corners.max(axis=0)
    np.testing.assert_allclose(
        scene.bounds, [[low[0], low[2], -high[1]], [high[0], high[2], -low[1]]], atol=1e-7
    )


def test_that_spheres_are_spheres_of_their_diameters(grains: Dataset, tmp_path: Path) -> None:
    folder = export_repose(write_run(tmp_path / "balls", grains, "spheres"), tmp_path / "export").folder
    pile = particles(3, 0.5)
    assert not list(folder.glob("ovito/*.stl"))
    ball = pv.read(folder / "shapes.vtm")["shape_00"]
    np.testing.assert_allclose(np.linalg.norm(ball.points, axis=1), 0.5, rtol=1e-6)
    scene = trimesh.load(folder / "heap.glb")
    total = sum(body.volume for body in scene.dump())
    assert total == relative((np.pi / 6 * pile.diameters**3).sum(), 0.04)
    assert scene.bounds[1][1] == pytest.approx((pile.points[:, 2] + pile.diameters / 2).max(), abs=1e-4)


def test_that_the_record_names_inputs_versions_and_every_file(exported: Path, heap: Path) -> None:
    record = json.loads((exported / "export.json").read_text("utf-8"))
    assert record["software"].startswith("regolith-studio ")
    assert record["run"]["state"] == "finished"
    assert record["inputs"]["repose.json"] == hashlib.sha256((heap / "repose.json").read_bytes()).hexdigest()
    assert {"final.npz", "shapes.npz", "snapshots/000000.npz"} <= set(record["inputs"])
    found = {path.relative_to(exported).as_posix() for path in exported.rglob("*") if path.is_file()}
    assert set(record["files"]) == found - {"export.json"}
    for name, digest in record["files"].items():
        assert digest == hashlib.sha256((exported / name).read_bytes()).hexdigest()
    assert "Quaternion" in (exported / "README.txt").read_text("utf-8")


def test_that_the_same_run_gives_the_same_bytes(exported: Path, heap: Path, tmp_path: Path) -> None:
    again = export_repose(heap, tmp_path / "again").folder
    for path in exported.rglob("*"):
        if path.is_file():
            assert (again / path.relative_to(exported)).read_bytes() == path.read_bytes(), path


def test_that_fewer_moments_end_with_the_last_one(
    heap: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["repose", "export", str(heap), "-o", str(tmp_path / "few"), "--every", "2", "--json"]
    assert run(words) == 0
    assert json.loads(capsys.readouterr().out)["times_s"] == [0.0, 0.5]
    assert run(words) == 0, "an earlier export may be replaced"
    with pytest.raises(InputError):
        export_repose(heap, tmp_path / "none", 0)


def test_that_a_stopped_run_is_exported_up_to_its_last_snapshot(grains: Dataset, tmp_path: Path) -> None:
    done = export_repose(write_run(tmp_path / "run", grains, state="stopped"), tmp_path / "export")
    assert done.times == (0.0, 0.25, 0.5)
    assert (done.folder / "heap.glb").is_file()


def test_that_other_folders_are_refused_and_stay_as_they_were(
    heap: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "mine.txt").write_text("mine")
    assert run(["repose", "export", str(heap), "-o", str(tmp_path / "mine")]) == 1
    assert "mine.txt" in capsys.readouterr().err
    assert [path.name for path in tmp_path.rglob("*") if path.is_file()] == ["mine.txt"]
    assert run(["repose", "export", str(tmp_path / "mine"), "-o", str(tmp_path / "out")]) == 1
    problem = capsys.readouterr().err
    assert "holds no result of a run" in problem
    assert len(problem.strip().splitlines()) == 1
    assert not (tmp_path / "out").exists()
    with pytest.raises(FileError, match="in the folder of the run"):
        export_repose(heap, heap / "export")


def test_that_broken_runs_are_one_sentence(heap: Path, tmp_path: Path) -> None:
    def broken(name: str) -> Path:
        shutil.copytree(heap, tmp_path / name)
        return tmp_path / name

    (broken("shapes") / "shapes.npz").write_bytes(b"PK")
    (broken("moment") / "snapshots" / "000001.npz").write_bytes(b"PK")
    few = broken("few")
    save_shapes(few, prepare(build_dataset([entry(1)], name="one"), ReposeCase(n_particles=400)))
    flat = broken("flat")
    np.savez(flat / "shapes.npz", **{"shape_00000.part_00": np.eye(3)})
    empty = broken("empty")
    shutil.rmtree(empty / "snapshots")
    (empty / "final.npz").unlink()
    other = broken("other")
    save_snapshot(other, 1, replace(particles(3, 0.25), class_index=np.full(N, 9)))
    for folder in (tmp_path / "shapes", tmp_path / "moment", few, flat, empty, other):
        with pytest.raises(RegolithError) as problem:
            export_repose(folder, tmp_path / "out")
        assert "regolith-new" not in str(problem.value)
        assert not list(tmp_path.glob("*out*"))


def test_that_compounds_are_the_surface_of_their_union(heap: Path) -> None:
    shapes = run_shapes(read_run(heap))
    assert [mesh.volume for mesh in shapes.meshes] == pytest.approx([np.pi / 6] * 3, rel=1e-9)
    assert trimesh.Trimesh(shapes.meshes[2].vertices, shapes.meshes[2].faces).is_watertight


def test_that_mujoco_loads_the_heap_with_its_masses_and_places(heap: Path, tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    export_repose(heap, tmp_path / "export")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "export" / "heap.xml"))
    pile = particles(3, 0.5)
    density = ContactParameters().density
    assert model.nbody == N + 1
    masses = density * np.pi / 6 * pile.diameters**3 * 1e6
    assert model.body_mass[1:] == pytest.approx(masses, rel=1e-5)
    data = mujoco.MjData(model)
    assert data.qpos.reshape(-1, 7)[:, :3] == pytest.approx(1e3 * pile.points, abs=1e-5)
    assert model.geom_friction[1:, 0] == pytest.approx(0.8)


def test_that_usd_opens_the_heap_with_its_masses_inertia_and_hulls(heap: Path, tmp_path: Path) -> None:
    """Checked by usd-core: moments and axes give the tensor that trimesh finds for the same hull."""
    usd = pytest.importorskip("pxr.Usd")
    physics = pytest.importorskip("pxr.UsdPhysics")
    geometry = pytest.importorskip("pxr.UsdGeom")
    shade = pytest.importorskip("pxr.UsdShade")
    export_repose(heap, tmp_path / "export")
    stage = usd.Stage.Open(str(tmp_path / "export" / "heap.usda"))
    assert geometry.GetStageMetersPerUnit(stage) == 1.0
    assert geometry.GetStageUpAxis(stage) == "Z"
    pile = particles(3, 0.5)
    bodies = [each for each in stage.Traverse() if each.HasAPI(physics.RigidBodyAPI)]
    assert len(bodies) == N
    for number, body in enumerate(bodies[:6]):
        mass = physics.MassAPI(body)
        expected = ContactParameters().density * np.pi / 6 * pile.diameters[number] ** 3
        assert mass.GetMassAttr().Get() == pytest.approx(expected, rel=1e-6)
        place = geometry.Xformable(body).ComputeLocalToWorldTransform(0)
        assert tuple(place.ExtractTranslation()) == pytest.approx(pile.points[number], abs=1e-8)
        (shape,) = body.GetChildren()
        scale = geometry.Xformable(shape).GetLocalTransformation().GetRow(0).GetLength()
        hulls = [geometry.Mesh(each) for each in shape.GetChildren()]
        assert len(hulls) == (2 if number % 3 == 2 else 1)
        bound, _ = shade.MaterialBindingAPI(hulls[0]).ComputeBoundMaterial("physics")
        assert str(bound.GetPath()) == "/heap/grains_material"
        if len(hulls) == 1:
            solid = trimesh.Trimesh(
                scale * np.array(hulls[0].GetPointsAttr().Get()),
                np.array(hulls[0].GetFaceVertexIndicesAttr().Get()).reshape(-1, 3),
            )
            turn = mass.GetPrincipalAxesAttr().Get()
            axes = Rotation.from_quat([*turn.GetImaginary(), turn.GetReal()]).as_matrix()
            tensor = axes @ np.diag(mass.GetDiagonalInertiaAttr().Get()) @ axes.T
            solid.density = ContactParameters().density
            assert tensor == pytest.approx(solid.moment_inertia, rel=1e-4, abs=1e-4 * np.abs(tensor).max())
    scene = physics.Scene(stage.GetPrimAtPath("/heap/scene"))
    assert scene.GetGravityMagnitudeAttr().Get() == pytest.approx(9.81)


@pytest.mark.slow
def test_that_a_heap_stays_at_rest_in_mujoco(boxes_run: Path, tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    export_repose(boxes_run, tmp_path / "export")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "export" / "heap.xml"))
    data = mujoco.MjData(model)
    begun = data.qpos.reshape(-1, 7)[:, :3].copy()
    mujoco.mj_step(model, data, 5000)  # 50 ms
    moved = np.linalg.norm(data.qpos.reshape(-1, 7)[:, :3] - begun, axis=1)
    diameter = 1e3 * read_final_state(boxes_run / "final.npz").diameters.mean()
    assert np.median(moved) < 0.01 * diameter


@pytest.fixture(scope="module")
def boxes_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run on MuJoCo of few particles to its end."""
    folder = tmp_path_factory.mktemp("rest")
    case = ReposeCase(LiftingCylinderTest(mass=0.003, lift_speed=0.15), n_particles=40, seed=1)
    request = ReposeRequest(case, evaluation=EvaluationSettings(min_particles=40))
    result_of(repose_steps(write_dataset(folder / "boxes", box_dataset()), folder / "run", request))
    return folder / "run"
