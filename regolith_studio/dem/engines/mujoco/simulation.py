"""MuJoCo as a solver of the lifting-cylinder test."""

from dataclasses import dataclass

import mujoco
import numpy as np

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.cohesion import RANGE, pull_off_forces, pulls
from regolith_studio.dem.engines.mujoco.settings import MujocoSettings
from regolith_studio.dem.initial_packing import enclosing_radii, loose_column
from regolith_studio.dem.lifting_cylinder import (
    Units,
    diverged,
    friction_in,
    halved_step,
    lift_speed,
    steps_note,
    wall_ring,
)
from regolith_studio.dem.snapshot import PHASES
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.messages import N_, Message

WALL_THICKNESS = 2.0
PARTICLE, WALL, PLATE = 1, 2, 4
"""Bits of contact: particles meet all, walls and plate only particles."""
# MuJoCo's solimp: impedance at no overlap and at an overlap of the width, 0.05 d; midpoint and power of the
# curve.
CONTACT_SOFTNESS = (0.95, 0.99, 0.05, 0.5, 2.0)
ARENA, ARENA_PER_PARTICLE = 64 << 20, 128 << 10
"""Bytes for contacts and solver: ten times what a run was seen to use, touched only as far as it is used.
MuJoCo's own guess grows with the square of the number: 14 GB at 3,000 particles; 5,000 could not begin."""


@dataclass(frozen=True, eq=False)
class BuiltModel:
    """A compiled model.

    - ``model``: MuJoCo's.
    - ``walls``: identifiers of the walls' geoms.
    - ``top``: height of the highest particle at the start.
    """

    model: mujoco.MjModel
    walls: IntArray
    top: float


def build_model(prepared: PreparedCase, settings: MujocoSettings) -> BuiltModel:
    """The model with its particles in a loose column above the plate, turned at random."""
    units = Units.of(prepared)
    spec = mujoco.MjSpec()
    _set_options(spec, settings)
    spec.memory = ARENA + ARENA_PER_PARTICLE * len(prepared)
    sizes = prepared.scales / units.length
    column = loose_column(prepared)
    places, turns = column.points / units.length, column.orientations
    top = float((places[:, 2] + enclosing_radii(prepared) / units.length).max())
    _add_plate(spec, prepared, settings)
    _add_walls(spec, prepared, settings, 1.1 * top + 2.0)
    _add_particles(spec, prepared, settings, sizes, places, turns)
    model = spec.compile()
    walls = np.flatnonzero(model.geom_contype == WALL)
    return BuiltModel(model, walls.astype(np.int64), top)


def _set_options(spec: mujoco.MjSpec, settings: MujocoSettings) -> None:
    option = spec.option
    option.timestep = settings.time_step
    option.gravity = [0.0, 0.0, -1.0]
    # Coulomb's cone: the friction of the pyramid depends on the direction.
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.solver = mujoco.mjtSolver.mjSOL_CG
    option.iterations = settings.iterations
    option.tolerance = settings.tolerance
    option.jacobian = mujoco.mjtJacobian.mjJAC_SPARSE
    option.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    # A diverged run would begin again from its first state without a word.
    option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    spec.stat.extent = 10.0


def _contact(prepared: PreparedCase, settings: MujocoSettings, friction: float) -> dict[str, object]:
    # MuJoCo's coefficients of rolling and spinning are lengths: the fraction times the radius, half of d.
    rolling = prepared.case.contact.rolling_friction / 2
    return {
        "friction": [friction, rolling, rolling],
        "condim": 6 if rolling > 0.0 else 3,
        "solref": [settings.contact_steps * settings.time_step, 1.0],
        "solimp": list(CONTACT_SOFTNESS),
    }


def _add_plate(spec: mujoco.MjSpec, prepared: PreparedCase, settings: MujocoSettings) -> None:
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[0.0, 0.0, 1.0],
        contype=PLATE,
        conaffinity=0,
        priority=1,
        **_contact(prepared, settings, prepared.case.test.plate_friction),
    )


def _add_walls(spec: mujoco.MjSpec, prepared: PreparedCase, settings: MujocoSettings, height: float) -> None:
    frame = spec.worldbody.add_body(name="cylinder", mocap=True)
    for half, place, angle in wall_ring(prepared, height, WALL_THICKNESS):
        frame.add_geom(
            type=mujoco.mjtGeom.mjGEOM_BOX,
            size=half,
            pos=place,
            quat=[np.cos(angle / 2), 0.0, 0.0, np.sin(angle / 2)],
            contype=WALL,
            conaffinity=0,
            priority=1,
            density=0.0,
            # a surface that never moves would be compiled away
            surfacevel=[0.0, 0.0, lift_speed(prepared), 0.0, 0.0, 0.0],
            **_contact(prepared, settings, prepared.case.test.wall_friction),
        )


def _add_particles(
    spec: mujoco.MjSpec,
    prepared: PreparedCase,
    settings: MujocoSettings,
    sizes: FloatArray,
    places: FloatArray,
    turns: FloatArray,
) -> None:
    contact = _contact(prepared, settings, prepared.case.contact.static_friction)
    spheres = prepared.case.shapes == "spheres"
    names: dict[tuple[int, float], list[str]] = {}
    for k in range(len(prepared)):
        kind, size = int(prepared.class_index[k]), float(sizes[k])
        if spheres:
            radius = size / (np.pi / 6) ** (1 / 3) / 2
            forms = [{"type": mujoco.mjtGeom.mjGEOM_SPHERE, "size": [radius, 0, 0]}]
        else:
            if (kind, size) not in names:
                names[kind, size] = _add_meshes(spec, prepared, kind, size)
            forms = [{"type": mujoco.mjtGeom.mjGEOM_MESH, "meshname": name} for name in names[kind, size]]
        body = spec.worldbody.add_body(pos=places[k], quat=turns[k])
        body.add_freejoint()
        if len(forms) > 1:  # masses of parts that overlap would add up to more than the body's
            _set_inertia(body, prepared.inertias[kind], size)
        for form in forms:
            body.add_geom(
                density=1.0,
                contype=PARTICLE,
                conaffinity=PARTICLE | WALL | PLATE,
                gap=RANGE if prepared.case.is_cohesive else 0.0,
                **form,
                **contact,
            )


def _add_meshes(spec: mujoco.MjSpec, prepared: PreparedCase, kind: int, size: float) -> list[str]:
    """Meshes of the convex parts of a shape at one size, by their names."""
    names = []
    for vertices in prepared.part_vertices[kind]:
        names.append(f"shape{len(spec.meshes)}")
        spec.add_mesh(
            name=names[-1],
            uservert=(vertices * size).ravel(),
            inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX,
        )
    return names


def _set_inertia(body: "mujoco.MjsBody", inertia: FloatArray, size: float) -> None:
    """Mass and inertia of a unit-volume shape about its centroid, at density 1 and a size."""
    body.explicitinertial = True
    body.mass = size**3
    body.ipos = [0.0, 0.0, 0.0]
    body.fullinertia = (inertia * size**5)[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]


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
        self.bodies = np.flatnonzero(self.model.body_jntnum == 1)
        self.particle = np.full(self.model.nbody, -1)
        self.particle[self.bodies] = np.arange(len(prepared))
        self.pull_off = pull_off_forces(prepared) if prepared.case.is_cohesive else None

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
        if self.phase in ("fill", "lift") or self.pull_off is not None:
            for _ in range(count):
                if self.phase == "fill":
                    self._limit_speed()
                elif self.phase == "lift":
                    self.data.mocap_pos[0, 2] += self.lift_speed * step
                self._pull()
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

    def place(self, points: FloatArray, orientations: FloatArray) -> None:
        self.data.qpos.reshape(-1, 7)[:] = np.column_stack([points, orientations])
        self.data.qvel[:] = 0.0

    def set_gravity(self, gravity: FloatArray) -> None:
        self.model.opt.gravity = gravity

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
        # Speed of walls and friction belong to the model, energies to the last step: none is in MuJoCo's
        # state.
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

    def _pull(self) -> None:
        """Draw together what touched in the last step, each pair at the middle of its points."""
        if self.pull_off is None:
            return
        contact, n = self.data.contact, len(self.prepared)
        pairs = self.particle[self.model.geom_bodyid[contact.geom]]
        near = (contact.dist <= RANGE) & (pairs >= 0).all(axis=1)
        keys, place = np.unique(pairs[near] @ [n, 1], return_inverse=True)
        normals, points = np.zeros((len(keys), 3)), np.zeros((len(keys), 3))
        np.add.at(normals, place, contact.frame[near, :3])
        np.add.at(points, place, contact.pos[near])
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        points /= np.bincount(place, minlength=len(keys))[:, None]
        pairs = np.column_stack(np.divmod(keys, n))
        centres = self.data.xipos[self.bodies]
        arms = points - centres[pairs[:, 0]], points - centres[pairs[:, 1]]
        self.data.xfrc_applied[self.bodies] = pulls(*self.pull_off, pairs, normals, arms)

    def _check_state(self) -> None:
        bad = self.data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number
        if bad or not np.isfinite(self.data.qpos).all():
            raise diverged(self.time, self.unit_time, self.settings.time_step)


def _be_silent(_message: str) -> None:
    """MuJoCo would write a file into the current folder; what it warns of is looked at after every look."""
