"""LAMMPS: clumps against exact volume and inertia, its input, and a whole run where the program is."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.distance import pdist
from scipy.spatial.transform import Rotation

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest
from regolith_studio.dem.case import CohesionKind, ReposeCase, ShapeKind, prepare
from regolith_studio.dem.engines.lammps import ENGINE, simulation
from regolith_studio.dem.engines.lammps.program import LammpsSettings
from regolith_studio.dem.engines.lammps.script import (
    clump_shape,
    clumps_of,
    schedule,
    script,
    stiffness,
    viscosity,
)
from regolith_studio.dem.engines.lammps.simulation import early_end, kinetic_energies, read_bodies
from regolith_studio.errors import InputError, RegolithError
from regolith_studio.geometry.arrays import FloatArray
from tests.steps import played

SMALL = ReposeCase(LiftingCylinderTest(mass=0.003, lift_speed=0.3), n_particles=40, seed=2)


def test_that_a_clump_has_the_polyhedron_s_volume_and_carries_its_inertia(boxes: Dataset) -> None:
    brick = clump_shape((boxes.representatives[1].shape.vertices,), 8)
    half = np.array([3, 2, 1.5]) / 9 ** (1 / 3) / 2
    assert ((np.abs(brick.spheres[:, :3]) + brick.spheres[:, 3:]) <= half + 0.2).all()
    squares = (2 * half) ** 2
    assert brick.inertia == pytest.approx(np.diag((squares.sum() - squares) / 12), abs=1e-9)
    assert brick.errors.volume == pytest.approx(0.0, abs=1e-3)
    assert brick.errors.jaccard < 0.25
    cube = clump_shape((boxes.representatives[0].shape.vertices,), 1)
    assert cube.spheres[0] == pytest.approx([0, 0, 0, (3 / (4 * np.pi)) ** (1 / 3)], abs=5e-3)


def test_that_clumps_turn_with_their_particles(boxes: Dataset) -> None:
    clumps = clumps_of(prepare(boxes, SMALL), 6)
    body, places, radius = clumps.atoms(clumps.centres, clumps.turns)
    assert np.array_equal(np.unique(body), np.arange(40))
    turned = clumps.inertias()
    for k in range(5):
        own = clumps.shapes[clumps.class_index[k]].inertia * clumps.scales[k] ** 5
        assert np.linalg.eigvalsh(turned[k]) == pytest.approx(np.linalg.eigvalsh(own))
    identity = Rotation.identity(40)
    _, still, _ = clumps.atoms(np.zeros((40, 3)), identity)
    assert np.linalg.norm(places - clumps.centres[body], axis=1) == pytest.approx(
        np.linalg.norm(still, axis=1)
    )
    assert (radius > 0.0).all()


def test_that_balls_are_single_spheres_of_the_same_volume(boxes: Dataset) -> None:
    prepared = prepare(boxes, ReposeCase(SMALL.test, n_particles=40, shapes="spheres"))
    body, _, radius = (clumps := clumps_of(prepared, 8)).atoms(clumps.centres, clumps.turns)
    assert len(body) == 40
    assert 2 * radius * prepared.mean_diameter == pytest.approx(prepared.diameters)
    bodies, places, radii = clumps.atoms_of_bodies()
    assert (np.bincount(bodies) == 2).all()
    assert radii[:40] == pytest.approx(radius)
    away = np.linalg.norm(places[40:] - clumps.centres, axis=1)
    assert (away > 0.0).all()
    assert (away + radii[40:] < 0.3 * radius).all()  # nothing from outside reaches them


def test_that_what_lammps_knows_of_reaches_over_the_longest_particle(boxes: Dataset) -> None:
    """LAMMPS ends with an error where two spheres of a body are farther apart."""
    prepared, settings = prepare(boxes, SMALL), LammpsSettings()
    clumps = clumps_of(prepared, 30)
    body, places, _ = clumps.atoms(clumps.centres, clumps.turns)
    longest = max(float(pdist(places[body == each]).max()) for each in range(len(clumps.scales)))
    assert longest <= clumps.extent <= 1.5 * longest
    text = script(prepared, settings, schedule(prepared, settings, 30.0), 4.0, 30.0, clumps.extent)
    assert f"comm_modify vel yes cutoff {clumps.extent!r}" in text


def test_that_the_material_is_softened_only_as_far_as_asked(boxes: Dataset) -> None:
    prepared = prepare(boxes, SMALL)
    real = 30e9 / (3075 * 9.81 * prepared.mean_diameter)
    assert stiffness(prepared, LammpsSettings(max_stiffness=0.0)) == pytest.approx(real)
    assert stiffness(prepared, LammpsSettings()) == 4e4
    slow, fast = (schedule(prepared, LammpsSettings(max_stiffness=soft), 30.0) for soft in (4e4, 1e4))
    assert fast.step == pytest.approx(2 * slow.step)


def test_that_a_restart_does_the_rest_of_the_test_in_steps_half_as_long(boxes: Dataset) -> None:
    prepared = prepare(boxes, SMALL)
    plan = schedule(prepared, LammpsSettings(), 30.0)
    late = plan.fill + plan.settle + 0.25 * plan.lift
    rest = plan.restarted(late)
    assert (rest.steps_left("fill"), rest.steps_left("settle")) == (0, 0)
    assert rest.steps_left("lift") * rest.step == pytest.approx(0.75 * plan.lift, abs=2 * rest.step)
    assert rest.rim(0) == pytest.approx(0.25 * plan.lift * plan.speed)
    assert (rest.phase(0), rest.phase(rest.steps)) == ("lift", "rest")
    assert rest.time(rest.steps) == pytest.approx(plan.total, abs=4 * rest.step)
    assert rest.picture * rest.step == pytest.approx(plan.picture * plan.step)
    text = script(prepared, LammpsSettings(), rest, 4.0, 30.0, 1.0)
    assert text.count("region tube cylinder") == 1
    assert f"variable up equal {rest.raised!r}+" in text
    over = plan.restarted(plan.total - 1.0)
    assert "tube" not in script(prepared, LammpsSettings(), over, 4.0, 30.0, 1.0)
    assert over.rim(0) == float("inf")


def test_that_the_script_says_the_paper_s_contact_laws(boxes: Dataset) -> None:
    contact = ContactParameters(rolling_friction=0.1)
    case = ReposeCase(SMALL.test, contact, n_particles=40, cohesion="given")
    prepared, settings = prepare(boxes, case), LammpsSettings()
    text = script(prepared, settings, schedule(prepared, settings, 30.0), 4.0, 30.0, 1.0)
    energy = 0.010 / (3075 * 9.81 * prepared.mean_diameter**2) / 2
    assert f"jkr 40000.0 {viscosity(4e4, 0.2, 0.3)!r} 0.2 {energy!r}" in text
    assert "damping viscoelastic" in text
    assert "tsuji" not in text
    assert "mindlin_rescale NULL 1.0 0.8" in text
    assert "sds" in text
    dry = prepare(boxes, SMALL)
    text = script(dry, settings, schedule(dry, settings, 30.0), 4.0, 30.0, 1.0)
    assert "hertz/material 40000.0 0.3 0.2" in text
    assert "rolling none" in text
    assert "damping tsuji" in text


@pytest.mark.parametrize("restitution", [0.0, 1.0])
def test_that_lammps_is_given_the_restitution_that_is_set(boxes: Dataset, restitution: float) -> None:
    contact = ContactParameters(restitution=restitution)
    prepared, settings = prepare(boxes, replace(SMALL, contact=contact)), LammpsSettings()
    text = script(prepared, settings, schedule(prepared, settings, 30.0), 4.0, 30.0, 1.0)
    assert set(re.findall(r"hertz/material 40000.0 (\S+) 0.2", text)) == {str(restitution)}


def test_that_what_lammps_writes_is_read_and_losses_are_noticed(tmp_path) -> None:
    rows = ["2 1 2 3 1 0 0 0", "1 4 5 6 0 1 0 0"]
    head = ["ITEM: TIMESTEP", "0", "ITEM: NUMBER OF ENTRIES", "2", "ITEM: ENTRIES"]
    path = tmp_path / "body.0.dump"
    path.write_text("\n".join([*head, *rows]) + "\n")
    assert read_bodies(path)[:, :4].tolist() == [[1, 4, 5, 6], [2, 1, 2, 3]]
    head[3] = "1"
    path.write_text("\n".join([*head, rows[0]]) + "\n")
    with pytest.raises(RegolithError, match="lost particles"):
        read_bodies(path)
    assert kinetic_energies("   Step  a b\n 0 1.5 0.5 \n 40 atoms left\n 10 2 1\n") == {0: 2.0, 10: 3.0}


@pytest.mark.parametrize(
    ("output", "expected"),
    [
        (
            "Step 1\nERROR on proc 0: Rigid body atoms 410 110 missing on proc 0 at step 42807 (f.cpp:3418)",
            r"^The particles flew apart; take a smaller step than 0\.15 .*: LAMMPS reports: ERROR .* missing",
        ),
        ("ERROR: Lost atoms: original 99 current 98 (src/thermo.cpp:494)", "flew apart; take a smaller step"),
        ("ERROR: Unknown fix style (src/modify.cpp:9)", "^LAMMPS ended early: ERROR: Unknown fix"),
        ("", "^LAMMPS ended early: it said nothing$"),
    ],
)
def test_that_the_message_says_what_to_do_when_lammps_loses_its_particles(output, expected) -> None:
    assert re.search(expected, str(early_end(output.splitlines(), 0.15)))


def test_that_bad_settings_are_one_sentence() -> None:
    with pytest.raises(InputError, match="spheres"):
        LammpsSettings(spheres=0)


@pytest.mark.slow
@pytest.mark.skipif(not ENGINE.find().there, reason="LAMMPS or its MPI library is not here")
@pytest.mark.parametrize("lost_at", [8, 20])
def test_that_a_run_goes_on_from_its_last_snapshot_where_particles_fly_apart(
    boxes: Dataset, monkeypatch: pytest.MonkeyPatch, lost_at: int
) -> None:
    """Particles are lost once, in the fall or under the rising cylinder."""
    settings = LammpsSettings(spheres=4, rest=15.0, snapshots=30)
    read, count = simulation.read_bodies, iter(range(1000))

    def read_or_lose(path: Path) -> FloatArray:
        if next(count) == lost_at:
            raise simulation.FlewApartError("lost")
        return read(path)

    monkeypatch.setattr(simulation, "read_bodies", read_or_lose)
    moments, ending = played(ENGINE.simulate(prepare(boxes, SMALL), settings))
    times = [moment.particles.time for moment in moments]
    assert np.diff(times) == pytest.approx(np.full(len(times) - 1, times[1]), rel=1e-2)
    assert f"went on from its snapshots at {times[lost_at - 1]:.2f} s" in ending.notes[-1]
    heights = [moment.particles.points[:, 2].mean() for moment in moments]
    before, after = heights[lost_at - 2] - heights[lost_at - 1], heights[lost_at - 1] - heights[lost_at]
    assert after == pytest.approx(before, abs=0.1 * heights[0])  # what falls goes on falling
    assert ending.checks.particles_out == 40
    assert ending.checks.energy_gain < 0.05
    assert ending.particles.time == pytest.approx(times[-1])


@pytest.mark.slow
@pytest.mark.skipif(not ENGINE.find().there, reason="LAMMPS or its MPI library is not here")
def test_that_particles_faster_than_a_fall_end_a_run_without_restarts(
    boxes: Dataset, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(simulation, "MAX_SPEED", 0.3)
    with pytest.raises(RegolithError, match=r"flew apart.*faster than any fall"):
        played(ENGINE.simulate(prepare(boxes, SMALL), LammpsSettings(spheres=4, restarts=0)))


@pytest.mark.slow
@pytest.mark.skipif(not ENGINE.find().there, reason="LAMMPS or its MPI library is not here")
@pytest.mark.parametrize(
    ("cohesion", "shapes"), [("none", "polyhedra"), ("scaled", "polyhedra"), ("none", "spheres")]
)
def test_that_lammps_fills_lifts_and_comes_to_rest(
    boxes: Dataset, cohesion: CohesionKind, shapes: ShapeKind
) -> None:
    prepared = prepare(boxes, replace(SMALL, cohesion=cohesion, shapes=shapes))
    moments, ending = played(ENGINE.simulate(prepared, LammpsSettings(spheres=4, rest=15.0, snapshots=30)))
    assert ending.checks.particles_out == 40
    assert ending.checks.max_overlap < 0.05
    assert ending.checks.energy_gain < 0.05
    assert ending.particles.points[:, 2].max() < 0.6 * moments[0].particles.points[:, 2].max()
    assert list(dict.fromkeys(moment.particles.phase for moment in moments)) == [
        "fill",
        "settle",
        "lift",
        "rest",
    ]


@pytest.mark.slow
@pytest.mark.skipif(not ENGINE.find().there, reason="LAMMPS or its MPI library is not here")
def test_that_balls_which_roll_away_for_ever_do_not_end_a_run_and_count_as_no_part_of_the_heap(
    boxes: Dataset, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Balls without rolling resistance leave the plate of 12 cylinder radii; LAMMPS' own energies are the
    sums of those of its bodies."""
    seen: list[simulation._Run] = []
    checks = simulation._checks
    monkeypatch.setattr(simulation, "_checks", lambda run: seen.append(run) or checks(run))
    prepared = prepare(boxes, replace(SMALL, shapes="spheres"))
    _, ending = played(ENGINE.simulate(prepared, LammpsSettings(rest=50.0, snapshots=30)))
    away = np.hypot(*ending.particles.points[:, :2].T)
    assert away.max() > 12.0 * prepared.case.test.diameter / 2
    assert ending.checks.particles_out == 40
    (run,) = seen
    energies = simulation._kinetic_energies(run.clumps, run.states[-1])
    assert energies.sum() == pytest.approx(run.kinetic[max(run.kinetic)], rel=0.02)
    assert ending.checks.kinetic_energy < 0.5 * energies.sum() / 40 / (np.pi / 6)


def test_that_only_bodies_near_each_other_are_neighbours() -> None:
    """Bodies 0 and 1 overlap by .02, 1 and 2 have a gap of .04, body 3 is alone and has two spheres."""
    places = np.array([[0.0, 0.0, 0.0], [0.98, 0.0, 0.0], [2.02, 0.0, 0.0], [9.0, 0.0, 0.0], [9.3, 0.0, 0.0]])
    pairs, depths = simulation._neighbours(np.array([0, 1, 2, 3, 3]), places, np.full(5, 0.5))
    found = {tuple(sorted(pair)): depth for pair, depth in zip(pairs.tolist(), depths, strict=True)}
    assert found == {(0, 1): pytest.approx(0.02), (1, 2): pytest.approx(-0.04)}
