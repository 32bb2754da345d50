"""The measuring itself is right, and the plain programs do the same work as the program."""

from pathlib import Path

import numpy as np
import pytest

from benchmarks import contests, plain, steps
from benchmarks.contests import Contest, Growth
from benchmarks.plain import by_trimesh
from benchmarks.steps import polyhedron, stone
from regolith_studio.dem.angle_of_repose import measure_repose
from regolith_studio.descriptors.describe import describe
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.sample import Sample

pytestmark = pytest.mark.filterwarnings("default")  # the plain programs are full of them


def test_that_a_ratio_is_plain_by_ours_within_a_round(monkeypatch: pytest.MonkeyPatch) -> None:
    rounds = iter([(1.0, 4.0), (3.0, 15.0), (2.0, 6.0)])
    times = iter([time for pair in rounds for time in pair])
    monkeypatch.setattr(contests, "_seconds", lambda *_: next(times))
    outcome = contests.held(Contest("s", "t", dict, dict), 3)
    assert (outcome.ours, outcome.plain, outcome.ratio) == (2000.0, 6000.0, 4.0)
    assert outcome.low == pytest.approx(3.2)
    assert outcome.high == pytest.approx(4.8)
    assert outcome.clock == "processor"


def test_that_memory_is_the_peak_of_a_call() -> None:
    outcome = contests.held(Contest("s", "t", lambda: np.ones(2**20).sum()), 1)
    assert outcome.memory == pytest.approx(8.0, abs=0.5)
    assert outcome.ratio is None


def test_that_the_exponent_is_the_power_of_the_size() -> None:
    growth = Growth("t", "n", (1, 2, 4, 8), (3.0, 12.0, 48.0, 192.0))
    assert growth.exponent == pytest.approx(2.0)


def test_that_the_plain_descriptors_are_those_of_the_program() -> None:
    mesh = stone(3)
    ours, theirs = describe(mesh), by_trimesh(mesh.vertices, mesh.faces)
    for key in ("volume", "surface_area", "sphericity", "convex_hull_volume"):
        assert theirs[key] == pytest.approx(ours[key], rel=1e-9)


def test_that_the_plain_pile_has_the_angle_of_the_program() -> None:
    points, diameter = steps.cone(5000, 30.0)
    assert measure_repose(points, diameter).angle == pytest.approx(30.0, abs=2.0)
    assert plain.repose_angle(points, diameter, 6) == pytest.approx(30.0, abs=3.0)


def test_that_the_plain_field_has_the_spectrum_of_the_program() -> None:
    rows = np.random.default_rng(0).normal(size=(50, 16)) * 0.1
    rows[:, 0] = np.random.default_rng(1).normal(30.0, 2.0, 50)
    power, _ = plain.fit_field(rows, 3)
    degrees = [np.arange(d * d, (d + 1) ** 2) for d in range(1, 4)]
    assert power[1:] == pytest.approx([np.mean(rows[:, each] ** 2) for each in degrees])
    kind = MODELS["gaussian_field"]
    fitted = kind.fit(Sample(rows), kind.Settings(l_max=3))
    ours = fitted.draw(400, 0).coefficients
    theirs = np.stack([clm.coeffs for clm in plain.draw_field(power, 30.0, 400, 0)])
    for degree, each in enumerate(degrees, start=1):
        spread = (theirs[:, :, degree] ** 2).sum() / 400 / (2 * degree + 1)
        assert spread == pytest.approx(power[degree], rel=0.15)
        assert np.mean(ours[:, each] ** 2) == pytest.approx(power[degree], rel=0.15)


def test_that_the_plain_reader_and_writer_keep_the_volume(tmp_path: Path) -> None:
    shape = polyhedron(12)
    planes = shape.half_spaces
    plain.write_dataset(tmp_path, [(shape.mesh.vertices, shape.mesh.faces, planes.normals, planes.offsets)])
    assert abs(plain.read(tmp_path / "meshes" / "particle_0000.stl").volume) == pytest.approx(1.0, abs=1e-5)
    (tmp_path / "stone.stl").write_bytes(stl_bytes(stone(2).triangles, "test"))
    assert plain.read(tmp_path / "stone.stl").volume == pytest.approx(stone(2).volume, rel=1e-5)
