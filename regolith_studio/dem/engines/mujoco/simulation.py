"""The lifting-cylinder test, step by step: fill, settle, lift, rest."""

from collections.abc import Callable, Generator
from dataclasses import dataclass, field

import mujoco
import numpy as np

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import RunChecks, SimulationResult
from regolith_studio.dem.engines.mujoco.model import BuiltModel, Units, build_model
from regolith_studio.dem.engines.mujoco.settings import MujocoSettings, expected_duration
from regolith_studio.dem.run_checks import check_run, measure_filling
from regolith_studio.dem.snapshot import ParticleState, Snapshot
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.arrays import FloatArray

LOOK = 0.5
"""Simulated time between two samples of the energies and speeds."""
MAX_MOVE = 0.01
"""Largest way in a step of all but one in a hundred particles, in mean diameters. Grains that slide faster
bounce: on a slope of 50 degrees they lose a twelfth of a friction of 0.8 with the default step, and nothing
with this limit; with 0.025 they lose as much as without."""
SMALLEST_SHARE = 1 / 8
"""Of the time step that is set, however fast particles move."""
CLEAR = 0.5
"""Distance between rim and pile, in mean diameters, at which the cylinder is removed."""


@dataclass(eq=False)
class MujocoRun:
    """MuJoCo's state and the records of a run."""

    prepared: PreparedCase
    settings: MujocoSettings
    built: BuiltModel
    data: mujoco.MjData
    units: Units
    phase: str = "fill"
    energy: float = float("inf")
    energy_gain: float = 0.0
    steps: int = 0
    next_picture: float = 0.0
    calm_since: float | None = None
    fill: tuple[float, float] = (0.0, 0.0)
    times: dict[float, float] = field(default_factory=dict)
    expected: float = field(init=False)

    def __post_init__(self) -> None:
        self.expected = expected_duration(self.prepared)

    @property
    def time(self) -> float:
        return float(self.data.time)

    @property
    def points(self) -> FloatArray:
        """Centres in mean diameters; a view into the state."""
        return np.asarray(self.data.qpos.reshape(-1, 7)[:, :3])

    @property
    def rim(self) -> float:
        """Height of the cylinder's lower rim."""
        return float(self.data.mocap_pos[0, 2])


def simulate(prepared: PreparedCase, settings: MujocoSettings) -> Generator[Snapshot, None, SimulationResult]:
    """Run the test.

    Raises
    ------
    RegolithError
        If the solver diverges.
    """
    mujoco.set_mju_user_warning(_be_silent)
    built = build_model(prepared, settings)
    run = MujocoRun(prepared, settings, built, mujoco.MjData(built.model), Units.of(prepared))
    yield _snapshot(run)
    yield from _fill(run)
    yield from _lift(run)
    yield from _rest(run)
    return SimulationResult(
        _particles(run), _checks(run), run.steps, run.time * run.units.time, (steps_in_words(run),)
    )


def _be_silent(_message: str) -> None:
    """MuJoCo would write a file into the current folder; what it warns of is looked at after every look."""


def _fill(run: MujocoRun) -> Generator[Snapshot, None, None]:
    """Let the particles fall, with a limit on their speed, until they lie still in the cylinder."""
    run.built.model.geom_surfacevel[run.built.walls] = 0.0
    yield from advance(run, _limit_speed, _is_calm, 40.0 + 2.0 * run.built.top / run.settings.max_fill_speed)
    run.phase, run.calm_since = "settle", None
    yield from advance(run, None, _is_calm, run.settings.max_rest_time)
    run.fill = measure_filling(run.prepared, _particles(run))


def _lift(run: MujocoRun) -> Generator[Snapshot, None, None]:
    """Raise the walls at constant speed; their surface moves with them, as friction must feel."""
    run.phase = "lift"
    speed = run.prepared.case.test.lift_speed / run.units.speed
    run.built.model.geom_surfacevel[run.built.walls, 2] = speed

    def rise(run: MujocoRun) -> None:
        run.data.mocap_pos[0, 2] += speed * run.built.model.opt.timestep

    longest = 2.0 * run.built.top / speed + 10.0
    yield from advance(run, rise, _is_clear, longest)
    run.data.mocap_pos[0, 2] += 10.0 * run.built.top
    run.built.model.geom_surfacevel[run.built.walls] = 0.0


def _rest(run: MujocoRun) -> Generator[Snapshot, None, None]:
    """Wait until the heap is at rest."""
    run.phase, run.calm_since = "rest", None
    yield from advance(run, None, _is_calm, run.settings.max_rest_time)


def advance(
    run: MujocoRun,
    each_step: Callable[[MujocoRun], None] | None,
    done: Callable[[MujocoRun], bool],
    longest: float,
) -> Generator[Snapshot, None, None]:
    """Step until `done` or `longest` is over; `done` is asked and energies are noted once a look."""
    end = run.time + longest
    run.energy = float("inf")
    while run.time < end:
        step = run.built.model.opt.timestep = time_step(run)
        per_look = max(1, round(LOOK / step))
        if each_step is None:
            mujoco.mj_step(run.built.model, run.data, per_look)
        else:
            for _ in range(per_look):
                each_step(run)
                mujoco.mj_step(run.built.model, run.data)
        run.steps += per_look
        run.times[step] = run.times.get(step, 0.0) + per_look * step
        _check_state(run)
        if each_step is None:
            _note_energy(run)
        if run.time >= run.next_picture:
            run.next_picture = run.time + run.expected / run.settings.snapshots
            yield _snapshot(run)
        if done(run):
            return


def time_step(run: MujocoRun) -> float:
    """The step that is set, halved until what moves does not go too far in it; the contacts stay as they are.

    While particles fall into the cylinder nothing slides, and their speed is limited.
    """
    step = run.settings.time_step
    if run.phase == "fill":
        return step
    speed = float(np.quantile(np.linalg.norm(run.data.qvel.reshape(-1, 6)[:, :3], axis=1), 0.99))
    halvings = np.ceil(np.log2(max(1.0, speed * step / MAX_MOVE)))
    return float(step * max(0.5**halvings, SMALLEST_SHARE))


def steps_in_words(run: MujocoRun) -> str:
    shares = {step: time / sum(run.times.values()) for step, time in sorted(run.times.items(), reverse=True)}
    parts = ", ".join(f"{step:.3g} for {100 * share:.1f} %" for step, share in shares.items())
    return f"Time step in sqrt(d/g), by what moved: {parts} of the simulated time."


def _limit_speed(run: MujocoRun) -> None:
    velocity = run.data.qvel.reshape(-1, 6)[:, :3]
    speed = np.linalg.norm(velocity, axis=1)
    fast = speed > run.settings.max_fill_speed
    velocity[fast] *= (run.settings.max_fill_speed / speed[fast])[:, None]


def _is_calm(run: MujocoRun) -> bool:
    """Whether the mean kinetic energy has been small for long enough."""
    if run.data.energy[1] / len(run.prepared) > run.settings.rest_energy:
        run.calm_since = None
        return False
    if run.calm_since is None:
        run.calm_since = run.time
    return run.time - run.calm_since >= run.settings.rest_time


def _is_clear(run: MujocoRun) -> bool:
    """Whether the rim is above everything."""
    reach = run.prepared.diameters / run.units.length
    return bool(run.rim > (run.points[:, 2] + reach).max() + CLEAR)


def _note_energy(run: MujocoRun) -> None:
    total = float(run.data.energy.sum()) / len(run.prepared)
    run.energy_gain = max(run.energy_gain, total - run.energy)
    run.energy = total


def _check_state(run: MujocoRun) -> None:
    if not np.isfinite(run.data.qpos).all() or run.data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number:
        raise RegolithError(
            f"The simulation diverged after {run.time * run.units.time:.3g} s; take a smaller time step than "
            f"{run.settings.time_step:g}."
        )


def _snapshot(run: MujocoRun) -> Snapshot:
    share = min(0.99, run.time / run.expected)
    simulated = run.time * run.units.time
    return Snapshot(_particles(run), share, f"{run.phase}, {simulated:.2f} s simulated")


def _particles(run: MujocoRun) -> ParticleState:
    state = run.data.qpos.reshape(-1, 7)
    gone = run.phase == "rest"
    return ParticleState(
        points=state[:, :3] * run.units.length,
        diameters=run.prepared.diameters,
        orientations=state[:, 3:],
        class_index=run.prepared.class_index,
        time=run.time * run.units.time,
        wall=float("inf") if gone else run.rim * run.units.length,
        phase=run.phase,
    )


def _checks(run: MujocoRun) -> RunChecks:
    full = (mujoco.mjtWarning.mjWARN_CONTACTFULL, mujoco.mjtWarning.mjWARN_CNSTRFULL)
    crowded = any(run.data.warning[each].number for each in full)
    return check_run(
        run.points[:, 2],
        np.maximum(-run.data.contact.dist, 0.0),
        energy_gain=run.energy_gain,
        kinetic_energy=float(run.data.energy[1]) / len(run.prepared),
        at_rest=run.calm_since is not None and run.time - run.calm_since >= run.settings.rest_time,
        filling=run.fill,
        problems=["MuJoCo had no room for all contacts."] if crowded else [],
    )
