"""MuJoCo as a solver of the lifting-cylinder test."""

import mujoco
import numpy as np

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engines.mujoco.model import PARTICLE, build_model
from regolith_studio.dem.engines.mujoco.settings import MujocoSettings
from regolith_studio.dem.lifting_cylinder import (
    Units,
    friction_in,
    halved_step,
    lift_speed,
    steps_note,
)
from regolith_studio.dem.snapshot import PHASES
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.messages import N_, Message

MAX_MOVE = 0.01
"""Largest way in a step of all but one in a hundred particles, in mean diameters. Grains that slide faster
bounce: on a slope of 50 degrees boxes lose a tenth of a friction of 0.8 with the default step, and a fortieth
with this limit, in the mean over three seeds (``benchmarks/sliding_friction.py``)."""
SMALLEST_SHARE = 1 / 8
"""Of the time step that is set, however fast particles move."""
STATE = mujoco.mjtState.mjSTATE_INTEGRATION


class MujocoSolver:
    """MuJoCo's model and state."""

    def __init__(self, prepared: PreparedCase, settings: MujocoSettings) -> None:
        mujoco.set_mju_user_warning(_be_silent)
        self.prepared, self.settings, self.lift_speed = prepared, settings, lift_speed(prepared)
        self.unit_time, self.phase = Units.of(prepared).time, PHASES[0]
        built = build_model(prepared, settings)
        self.model, self.walls, self.top = built.model, built.walls, built.top
        self.data = mujoco.MjData(built.model)
        self.model.geom_surfacevel[self.walls] = 0.0

    @property
    def time(self) -> float:
        return float(self.data.time)

    @property
    def points(self) -> FloatArray:
        """A view into the state."""
        return np.asarray(self.data.qpos.reshape(-1, 7)[:, :3])

    @property
    def orientations(self) -> FloatArray:
        return np.asarray(self.data.qpos.reshape(-1, 7)[:, 3:])

    @property
    def rim(self) -> float:
        return float(self.data.mocap_pos[0, 2])

    def energies(self) -> tuple[float, float]:
        potential, kinetic = self.data.energy
        return float(potential), float(kinetic)

    def overlaps(self) -> FloatArray:
        return np.asarray(np.maximum(-self.data.contact.dist, 0.0))

    def begin(self, phase: str) -> None:
        """The surface of walls moves with them, as friction must feel."""
        self.phase = phase
        self.model.geom_surfacevel[self.walls, 2] = self.lift_speed if phase == "lift" else 0.0
        self._set_friction()
        if phase == "rest":
            self.data.mocap_pos[0, 2] += 10.0 * self.top

    def time_step(self) -> float:
        """The step that is set, halved until what moves does not go too far in it; the contacts stay as they
        are.

        While particles fall into the cylinder nothing slides, and their speed is limited.
        """
        step = self.settings.time_step
        if self.phase == "fill":
            return step
        speeds = np.linalg.norm(self.data.qvel.reshape(-1, 6)[:, :3], axis=1)
        return halved_step(step, speeds, MAX_MOVE, SMALLEST_SHARE)

    def advance(self, step: float, count: int) -> None:
        self.model.opt.timestep = step
        if self.phase in ("fill", "lift"):
            for _ in range(count):
                self._limit_speed() if self.phase == "fill" else self._raise_walls(step)
                mujoco.mj_step(self.model, self.data)
        else:
            mujoco.mj_step(self.model, self.data, count)
        self._check_state()

    def problems(self) -> list[str]:
        full = (mujoco.mjtWarning.mjWARN_CONTACTFULL, mujoco.mjtWarning.mjWARN_CNSTRFULL)
        crowded = any(self.data.warning[each].number for each in full)
        return [Message(N_("MuJoCo's memory for contacts was full."))] if crowded else []

    def notes(self, times: dict[float, float]) -> list[str]:
        return [steps_note(times)]

    def state(self) -> bytes:
        values = np.empty(mujoco.mj_stateSize(self.model, STATE))
        mujoco.mj_getState(self.model, self.data, values, STATE)
        wall_speed = self.model.geom_surfacevel[self.walls[0], 2]
        return np.concatenate([values, [wall_speed, *self.data.energy]]).tobytes()

    def load(self, state: bytes) -> None:
        values = np.frombuffer(state)
        if len(values) != mujoco.mj_stateSize(self.model, STATE) + 3:
            raise RegolithError("The state of MuJoCo to go on from is that of other particles.")
        mujoco.mj_setState(self.model, self.data, values[:-3], STATE)
        self.model.geom_surfacevel[self.walls, 2] = values[-3]
        self.data.energy[:] = values[-2:]
        self._set_friction()

    def _set_friction(self) -> None:
        particles = self.model.geom_contype == PARTICLE
        self.model.geom_friction[particles, 0] = friction_in(self.phase, self.prepared, self.settings)

    def _limit_speed(self) -> None:
        velocity = self.data.qvel.reshape(-1, 6)[:, :3]
        speed = np.linalg.norm(velocity, axis=1)
        fast = speed > self.settings.max_fill_speed
        velocity[fast] *= (self.settings.max_fill_speed / speed[fast])[:, None]

    def _raise_walls(self, step: float) -> None:
        self.data.mocap_pos[0, 2] += self.lift_speed * step

    def _check_state(self) -> None:
        bad = self.data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number
        if bad or not np.isfinite(self.data.qpos).all():
            raise RegolithError(
                f"The simulation diverged after {self.time * self.unit_time:.3g} s; take a smaller time step "
                f"than {self.settings.time_step:g}."
            )


def _be_silent(_message: str) -> None:
    """MuJoCo would write a file into the current folder; what it warns of is looked at after every look."""
