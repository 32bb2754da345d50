"""The course of a rotating drum: fill the standing cylinder, close it, lay it on its side, turn it.

In the solver the axis stays vertical and gravity turns: it acts along -y. The particles that a run gives are
shown as they lie in the drum: its axis along y, the lowest point of its wall at z = 0.
"""

from dataclasses import replace
from typing import Protocol, runtime_checkable

import numpy as np
from scipy.spatial.transform import Rotation

from regolith_studio.dataset.parameters import DrumRotation
from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import RunChecks, check_run
from regolith_studio.dem.lifting_cylinder import (
    NOT_FILLED,
    SETTLE,
    Course,
    LiftingRun,
    Solver,
    Units,
    is_filled,
    longest_phase,
    mean_energies,
)
from regolith_studio.dem.snapshot import DRUM_PHASES, LEVEL, TURN, ParticleState

RUN_UP = 0.25
"""Part of a turn in which the bed is tilted to its angle, before it is measured."""
SIDEWAYS = np.array([0.0, -1.0, 0.0])
UPRIGHT = Rotation.from_euler("x", 90.0, degrees=True)
"""From the solver, whose axis is z, to the drum."""


@runtime_checkable
class DrumSolver(Solver, Protocol):
    """A solver whose walls turn."""

    def turn_walls(self, angle: float, speed: float) -> None:
        """Close the cylinder by its lid, and turn wall, lid and plate about z from an angle on.

        The angle is in radians, the speed in radians in sqrt(d/g).
        """
        ...


def rotation_of(prepared: PreparedCase) -> DrumRotation:
    """How the drum of a case turns."""
    drum = prepared.case.drum
    assert drum is not None
    return drum


def _speed(prepared: PreparedCase) -> float:
    """Radians in sqrt(d/g)."""
    return rotation_of(prepared).angular_speed * Units.of(prepared).time


def _turning_time(prepared: PreparedCase) -> float:
    return float(2 * np.pi * (RUN_UP + rotation_of(prepared).turns) / _speed(prepared))


def _longest(run: LiftingRun, phase: str) -> float:
    return _turning_time(run.prepared) if phase == TURN else longest_phase(run, phase)


def _expected(prepared: PreparedCase) -> float:
    height = prepared.fill_height / prepared.mean_diameter
    return float(5.0 + 0.22 * height + 2 * SETTLE) + _turning_time(prepared)


def _interval(run: LiftingRun) -> float:
    if run.phase == TURN:
        drum = rotation_of(run.prepared)
        return 2 * np.pi * drum.turns / _speed(run.prepared) / drum.moments
    return run.expected / run.settings.snapshots


def _move_walls(run: LiftingRun) -> None:
    if run.phase not in (LEVEL, TURN):
        return
    assert isinstance(run.solver, DrumSolver)
    run.solver.set_gravity(SIDEWAYS)
    speed = _speed(run.prepared) if run.phase == TURN else 0.0
    begun = run.end - _turning_time(run.prepared)
    run.solver.turn_walls(speed * (run.solver.time - begun), speed)


def _in_drum(run: LiftingRun, state: ParticleState) -> ParticleState:
    if state.phase not in (LEVEL, TURN):
        return state
    test = run.prepared.case.test
    turns = UPRIGHT * Rotation.from_quat(state.orientations.copy(), scalar_first=True)
    return replace(
        state,
        points=UPRIGHT.apply(state.points.copy()) + np.array([0.0, test.height / 2, test.diameter / 2]),
        orientations=turns.as_quat(scalar_first=True),
        wall=float("inf"),
    )


def _checks(run: LiftingRun) -> RunChecks:
    points, test = run.solver.points, run.prepared.case.test
    radius, depth = test.diameter / 2 / run.units.length, test.height / run.units.length
    # Depth within the drum takes the place of the height above the plate: what left the drum counts as lost.
    inside = np.min(
        [radius - np.hypot(points[:, 0], points[:, 1]), points[:, 2], depth - points[:, 2]], axis=0
    )
    return check_run(
        inside,
        run.solver.overlaps(),
        energy_gain=run.energy_gain,
        kinetic_energy=mean_energies(run)[1],
        # A turning bed never rests: what has to have come to rest is its filling.
        at_rest=run.fill != NOT_FILLED,
        filling=run.fill,
        lowest=inside,
        problems=run.solver.problems(),
    )


TURNING = Course(
    phases=DRUM_PHASES,
    is_done={"fill": is_filled, TURN: lambda _run: False},
    longest=_longest,
    expected=_expected,
    interval=_interval,
    move_walls=_move_walls,
    in_plane=_in_drum,
    checks=_checks,
)
