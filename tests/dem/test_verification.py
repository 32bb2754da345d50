"""The lines of the verification against bodies whose motion is known in closed form."""

import json
from collections.abc import Generator
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from regolith_studio.cli.repose import certificate_in_words
from regolith_studio.cli.terminal import print_json
from regolith_studio.dem import engines
from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engines import ENGINES
from regolith_studio.dem.lifting_cylinder import SubstepSettings
from regolith_studio.dem.verification import MeasuredLine, heaps, scenes
from regolith_studio.dem.verification.bodies import N_FACETS, polyhedra_dataset
from regolith_studio.dem.verification.certificate import (
    Certificate,
    certificate_document,
    verifiable_engine,
)
from regolith_studio.dem.verification.heaps import CLOSE, LOOSE, HeapRuns, paired_line, platonic_solids
from regolith_studio.errors import InputError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.steps import result_of


@dataclass
class CoulombSolver:
    """Blocks on a plane with Coulomb's friction, solved exactly; they gain `gain` of energy in each step."""

    prepared: PreparedCase
    friction: float
    gain: float = 0.0
    time: float = 0.0
    gravity: FloatArray = field(default_factory=lambda: np.array([0.0, 0.0, -1.0]))
    points: FloatArray = field(default_factory=lambda: np.zeros((1, 3)))
    speed: float = 0.0

    def begin(self, phase: str) -> None:
        assert phase == "rest"

    def place(self, points: FloatArray, _orientations: FloatArray) -> None:
        self.points = points.copy()

    def set_gravity(self, gravity: FloatArray) -> None:
        self.gravity = gravity

    def time_step(self) -> float:
        return 0.05

    def advance(self, step: float, count: int) -> None:
        pull = max(0.0, self.gravity[0] + self.friction * self.gravity[2])
        for _ in range(count):
            self.points[:, 0] += self.speed * step + 0.5 * pull * step**2
            self.speed += pull * step
            self.time += step

    def energies(self) -> tuple[float, float]:
        return float(self.points[:, 2].sum()), self.gain * np.pi / 6 * self.time


@dataclass
class CoulombEngine:
    """Gives solvers whose friction is a share of what is asked for."""

    share: float = 1.0
    gain: float = 0.0
    Settings: type[Any] = SubstepSettings

    def solver(self, prepared: PreparedCase, _settings: Any) -> CoulombSolver:
        return CoulombSolver(prepared, self.share * prepared.case.contact.static_friction, self.gain)


def measured(measure: Any, engine: Any) -> MeasuredLine:
    line = result_of(measure(engine))
    assert isinstance(line, MeasuredLine)
    return line


def test_that_an_exact_friction_passes_at_the_finest_angle() -> None:
    line = measured(scenes.incline, CoulombEngine())
    assert line.passed
    assert line.value == scenes.TOLERANCES[0]


@pytest.mark.parametrize(("share", "degrees"), [(0.97, 1.0), (1.02, 1.0), (0.995, 0.2)])
def test_that_the_angle_of_a_wrong_friction_is_found(share: float, degrees: float) -> None:
    """At mu 0.8 a friction that is 3, 2 and 0.5 % off shifts the angle by 0.85, 0.56 and 0.14 degrees."""
    line = measured(scenes.incline, CoulombEngine(share))
    assert line.value == degrees
    assert line.passed is (degrees <= 0.2)


@pytest.mark.parametrize("share", [0.9, 0.97, 1.0, 1.05])
def test_that_sliding_blocks_tell_their_friction(share: float) -> None:
    line = measured(scenes.sliding, CoulombEngine(share))
    assert line.value == pytest.approx(100 * (share - 1.0), abs=1e-6)
    assert line.passed is (abs(share - 1.0) <= 0.02)


def test_that_energy_from_nowhere_fails() -> None:
    assert measured(scenes.fall, CoulombEngine()).passed
    line = measured(scenes.fall, CoulombEngine(gain=1e-4))
    assert line.value == pytest.approx(1e-4 * scenes.FALL_TIME, rel=0.01)
    assert not line.passed


def test_that_a_difference_passes_where_its_interval_contains_zero() -> None:
    """Student's interval of 1, 2, 3, 4, 5 is 3 +- 1.963; that of -2 ... 2 is 0 +- 1.963."""
    off = paired_line("half_step", [(30.0, 30.0 + k) for k in range(1, 6)])
    assert not off.passed
    assert off.value == pytest.approx(3.0)
    assert "2.0°" in off.note
    assert paired_line("half_step", [(30.0, 30.0 + k) for k in range(-2, 3)]).passed


def test_that_a_heap_without_an_angle_fails_the_line() -> None:
    pairs = [(30.0, 30.1), (30.0, 29.9), (30.0, 30.0), (30.0, float("nan"))]
    assert not paired_line("half_step", pairs).passed


def test_that_what_has_no_value_is_said_and_written_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    """Infinities and NaN are no JSON: a friction 20 % off, and heaps without an angle."""
    nothing = paired_line("half_step", [(float("nan"), 30.0)] * 5)
    far = measured(scenes.incline, CoulombEngine(0.8))
    document = certificate_document(Certificate("rapier", "1", (far, nothing)))
    print_json(document)
    assert [each["value"] for each in json.loads(capsys.readouterr().out)["lines"]] == [None, None]
    words = certificate_in_words(document)
    assert f"FAILED  {heaps.COMPARED['half_step']}: no value" in words
    assert "0 heaps with an angle are too few" in words
    assert "more than 2° off" in words


@pytest.mark.parametrize(
    ("name", "vertices", "surface"),
    [
        ("tetrahedra", 4, 7.2056),
        ("cubes", 8, 6.0),
        ("octahedra", 6, 5.7191),
        ("dodecahedra", 20, 5.3116),
        ("icosahedra", 12, 5.1483),
    ],
)
def test_that_the_five_solids_are_regular(name: str, vertices: int, surface: float) -> None:
    """Their surfaces at unit volume, that of the tetrahedron (216 sqrt 3)**(1/3), of the octahedron
    (108 sqrt 3)**(1/3)."""
    hull = ConvexHull(platonic_solids()[name])
    assert len(hull.vertices) == vertices
    assert hull.volume == pytest.approx(1.0)
    assert hull.area == pytest.approx(surface, abs=2e-4)
    assert list(LOOSE) == list(CLOSE) == list(platonic_solids())


def test_that_the_polyhedra_of_heaps_have_twenty_facets_and_their_centroid_at_the_origin() -> None:
    for each in polyhedra_dataset().representatives:
        assert each.shape.n_facets == N_FACETS
        assert each.shape.volume == pytest.approx(1.0)
        assert np.abs(each.shape.centroid).max() < 1e-9


def test_that_only_an_engine_whose_bodies_can_be_placed_is_verified() -> None:
    with pytest.raises(InputError, match="mujoco, rapier"):
        verifiable_engine("lammps")
    with pytest.raises(InputError, match="cannot be verified"):
        verifiable_engine("nothing")


def test_that_an_angle_comes_with_the_lines_that_its_engine_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    engine = ENGINES["rapier"]
    version = engine.find().version
    lines = [{"key": "half_step", "passed": False}, {"key": "rest", "passed": True}]
    known: dict[str, Any] = {"rapier": {"version": version, "lines": lines}}
    monkeypatch.setattr(engines, "shipped_certificates", lambda: known)
    assert engines.engine_notes(engine) == [
        "Rapier does not pass these lines of its verification: half step."
    ]
    known["rapier"] |= {"version": "0.1", "lines": []}
    assert engines.engine_notes(engine) == [f"Rapier was verified in version 0.1, not in {version}."]
    del known["rapier"]
    assert engines.engine_notes(engine) == ["Rapier was not verified."]


@pytest.mark.parametrize("apart", [0.0, 1e-9])
def test_that_a_heap_of_the_same_seed_that_differs_fails(
    apart: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    def heap(points: FloatArray) -> Any:
        return SimpleNamespace(particles=SimpleNamespace(points=points))

    def second_run(*_arguments: Any, threads: int) -> Generator[None, None, Any]:
        assert threads == 2
        yield None
        return heap(np.full((500, 3), apart))

    first: Any = SimpleNamespace(result=heap(np.zeros((500, 3))))
    monkeypatch.setattr(heaps, "run_engine", second_run)
    line = measured(heaps.repeats, HeapRuns(verifiable_engine("rapier"), first=first))
    assert line.passed is (apart == 0.0)
    assert line.value == pytest.approx(apart / heaps.heap_case(0).mean_diameter)
