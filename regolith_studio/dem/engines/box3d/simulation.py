"""Box3D as a solver of the lifting-cylinder test: plate, a ring of boxes, free convex bodies."""

import os
import weakref
from collections.abc import Sequence
from typing import Any

import numpy as np
from robox3d._ffi import ffi, lib, shim  # the package's layer of Box3D's own functions
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.cohesion import RANGE, pull_off_forces, pulls
from regolith_studio.dem.engine import ENGINE_THREADS, lowest_corners
from regolith_studio.dem.initial_packing import enclosing_radii, loose_column
from regolith_studio.dem.lifting_cylinder import (
    SubstepSettings,
    diverged,
    friction_in,
    lift_speed,
    speed_limit,
    wall_ring,
)
from regolith_studio.dem.separation import overlap_depths
from regolith_studio.dem.snapshot import DRUM_PHASES, ParticleState
from regolith_studio.dem.stepped_engine import SubstepSolver
from regolith_studio.errors import InputError, RegolithError
from regolith_studio.geometry.arrays import FloatArray

CONTACT = np.dtype(
    {
        "names": ["contact", "first", "second", "manifold"],
        "formats": ["i4", "i4", "i4", "u8"],
        "offsets": [0, 12, 20, 32],
        "itemsize": ffi.sizeof("b3ContactData"),
    }
)
POINTS, POINT_FLOATS, NORMAL, COUNT = 4, 14, 56, 66
"""Points of a manifold, floats of each (two anchors, then the gap), and where its normal and count stand."""


class Cohesion:
    """Pulls together what touches."""

    def __init__(self, prepared: PreparedCase, bodies: Sequence[Any], shapes: Sequence[Any]) -> None:
        self.force, self.sizes = pull_off_forces(prepared)
        self.bodies, self.capacity = bodies, 0
        numbers = [shape.index1 for shape in shapes]
        self.particle = np.full(max(numbers) + 1, -1)
        self.particle[numbers] = np.arange(len(shapes))

    def pull(self) -> None:
        """Set the forces of the next step."""
        first, second, manifolds = self._touching()
        gaps = manifolds[:, : POINTS * POINT_FLOATS].reshape(-1, POINTS, POINT_FLOATS)
        counts = manifolds.view(np.int32)[:, COUNT]
        near = (np.arange(POINTS) < counts[:, None]) & (gaps[:, :, 6] <= RANGE)
        touching = near.any(axis=1)
        weights = near[touching] / near[touching].sum(axis=1)[:, None]
        anchors = np.einsum("np,npk->nk", weights, gaps[touching, :, :6])
        pairs = np.column_stack([first[touching], second[touching]])
        normals = manifolds[touching, NORMAL : NORMAL + 3]
        forces = pulls(self.force, self.sizes, pairs, normals, (anchors[:, :3], anchors[:, 3:]))
        for body, force in zip(self.bodies, forces.tolist(), strict=True):
            lib.b3Body_ApplyForceToCenter(body, force[:3], True)
            lib.b3Body_ApplyTorque(body, force[3:], True)

    def _touching(self) -> tuple[Any, Any, Any]:
        """First and second particle of each pair that Box3D keeps, shape (m,), and its manifold as floats."""
        capacities = [lib.b3Body_GetContactCapacity(body) for body in self.bodies]
        if sum(capacities) > self.capacity:
            self.capacity = 2 * sum(capacities)
            self.buffer = ffi.new("b3ContactData[]", self.capacity)
        count = 0
        for body, capacity in zip(self.bodies, capacities, strict=True):
            count += lib.b3Body_GetContactData(body, self.buffer + count, capacity) if capacity else 0
        if count == 0:
            return np.zeros(0, dtype=int), np.zeros(0, dtype=int), np.zeros((0, COUNT + 1), dtype=np.float32)
        rows = np.frombuffer(ffi.buffer(self.buffer, count * CONTACT.itemsize), dtype=CONTACT)
        rows = rows[np.unique(rows["contact"], return_index=True)[1]]  # both bodies of a pair list it
        first, second = self._particles(rows["first"]), self._particles(rows["second"])
        pairs = (first >= 0) & (second >= 0)
        size = ffi.sizeof("b3Manifold")
        manifolds = b"".join(
            ffi.buffer(ffi.cast("char*", address), size)[:] for address in rows["manifold"][pairs].tolist()
        )
        floats = np.frombuffer(manifolds, dtype=np.float32).reshape(-1, size // 4)
        return first[pairs], second[pairs], floats

    def _particles(self, shapes: Any) -> Any:
        """Of each shape its particle, -1 for walls."""
        inside = shapes < len(self.particle)
        return np.where(inside, self.particle[np.where(inside, shapes, 0)], -1)


SHIM: Any = shim
WALL_THICKNESS, PLATE_WIDTH = 0.6, 12.0
"""Thickness of the boxes of the cylinder and of the plate in mean diameters; width of the plate in
diameters of the cylinder. Box3D resists rolling by the larger of two bodies' radii, so these must be thin."""
ROLLING_RADIUS = 0.25
"""Radius by which Box3D resists the rolling of a hull, in radii of its largest inner ball (measured)."""
LENGTH_UNIT = 0.2
"""Mean diameters that Box3D takes for a metre: bodies may overlap by half a hundredth of it, which its
contacts need to persist from step to step."""
# Box3D limits the frequency to an eighth of that of its substeps, which is 20 by default and 40 with half the
# step. With a damping of 3 a stack of five cubes gains 1e-7 m g d of energy in 100 sqrt(d/g), with 1, 10 and
# 30 it gains 3e-5, 4e-5 and 4e-4; in a fall a polyhedron gains 0.046, and 0.053, 0.045 and 0.055.
CONTACT_HERTZ, CONTACT_DAMPING = 60.0, 3.0
"""Frequency and damping ratio with which overlaps are pushed apart."""
RESTITUTION_SPEED = 0.1
"""Speed in sqrt(g d) below which an impact has no restitution, so that what touches comes to rest."""


class Box3dSolver(SubstepSolver):
    """Box3D's world: the particles, the cylinder, the plate."""

    def __init__(self, prepared: PreparedCase, settings: SubstepSettings) -> None:
        super().__init__(prepared, settings)
        lib.b3SetLengthUnitsPerMeter(LENGTH_UNIT)  # of the process; worlds keep what was set
        self.world = _new_world()
        self._end = weakref.finalize(self, lib.b3DestroyWorld, self.world)
        self._build()

    def _build(self) -> None:
        """Particles in a loose column, the cylinder, and the plate."""
        prepared, length = self.prepared, self.unit_length
        column = loose_column(prepared)
        places, turns = column.points / length, np.roll(column.orientations, -1, axis=1)
        self.top = float((places[:, 2] + enclosing_radii(prepared) / length).max())
        forms = _Forms(prepared)
        self.particles, self.shapes, inertias = [], [], []
        for kind, size, place, turn in zip(
            prepared.class_index.tolist(), prepared.scales / length, places, turns, strict=True
        ):
            body = self._body(lib.b3_dynamicBody, place, turn)
            self.shapes += forms.add(body, kind, float(size))
            inertias.append(forms.inertia(kind, float(size)))
            self.particles.append(body)
        self.identifiers = ffi.new("b3BodyId[]", self.particles)
        self.cohesion = Cohesion(prepared, self.particles, self.shapes) if prepared.surface_energy else None
        self.masses, self.inertias = (prepared.scales / length) ** 3, np.array(inertias)
        self.cylinder = self._body(lib.b3_kinematicBody, np.zeros(3), IDENTITY)
        test = prepared.case.test
        self.walls = [
            _add_box(self.cylinder, half, place, _about_z(turn), _definition(prepared, test.wall_friction))
            for half, place, turn in wall_ring(prepared, 1.1 * self.top + 2.0, WALL_THICKNESS)
        ]
        half = test.diameter / length * PLATE_WIDTH / 2
        drum = prepared.case.drum is not None
        plate = self._body(lib.b3_kinematicBody if drum else lib.b3_staticBody, np.zeros(3), IDENTITY)
        self.ends = [plate]
        if drum:
            # Above the column until `turn_walls` closes the drum with it.
            self.ends.append(self._body(lib.b3_kinematicBody, np.array([0.0, 0.0, 2.0 * self.top]), IDENTITY))
        self.plates = []
        for body, side in zip(self.ends, (-1, 1), strict=False):
            box = (half, half, WALL_THICKNESS / 2), (0.0, 0.0, side * WALL_THICKNESS / 2), IDENTITY
            self.plates.append(_add_box(body, *box, _definition(prepared, test.plate_friction)))

    def _body(self, kind: int, place: FloatArray, turn: Any) -> Any:
        definition = lib.b3DefaultBodyDef()
        definition.type, definition.enableSleep = kind, False
        definition.position, definition.rotation = _vector(place), _quaternion(turn)
        return lib.b3CreateBody(self.world, ffi.new("b3BodyDef*", definition))

    def _poses(self) -> FloatArray:
        """Centres and quaternions (x, y, z, w), shape (n, 7)."""
        values = np.empty((self.n, 7), dtype=np.float32)
        SHIM.rxBodyGetPoses(self.identifiers, self.n, ffi.cast("float*", ffi.from_buffer(values)))
        return values.astype(np.float64)

    def _velocities(self) -> FloatArray:
        """Linear and angular velocities, shape (n, 6)."""
        values = np.empty((self.n, 6), dtype=np.float32)
        SHIM.rxBodyGetVelocities(self.identifiers, self.n, ffi.cast("float*", ffi.from_buffer(values)))
        return values.astype(np.float64)

    @property
    def points(self) -> FloatArray:
        return np.asarray(self._poses()[:, :3])

    @property
    def orientations(self) -> FloatArray:
        return np.asarray(np.roll(self._poses()[:, 3:], 1, axis=1))

    @property
    def rim(self) -> float:
        return float(lib.b3Body_GetPosition(self.cylinder).z)

    def energies(self) -> tuple[float, float]:
        velocities, poses = self._velocities(), self._poses()
        spins = Rotation.from_quat(poses[:, 3:]).apply(velocities[:, 3:], inverse=True)
        kinetic = 0.5 * self.masses @ (velocities[:, :3] ** 2).sum(axis=1)
        kinetic += 0.5 * np.einsum("ni,nij,nj->", spins, self.inertias, spins)
        return float(self.masses @ poses[:, 2]), float(kinetic)

    def overlaps(self) -> FloatArray:
        """Of the polyhedra with each other and with the plate, from where they are."""
        length = self.unit_length
        heap = ParticleState(
            self.points * length, self.prepared.diameters, self.orientations, self.prepared.class_index
        )
        depths = overlap_depths(self.prepared, heap)
        if self.prepared.case.shapes == "spheres":
            below = self.prepared.diameters / 2 - heap.points[:, 2]
        else:
            below = -lowest_corners(self.prepared, heap)
        return np.concatenate([depths, below[below > 0.0]]) / length

    def begin(self, phase: str) -> None:
        self.phase = phase
        limit = speed_limit(phase, self.prepared, self.settings)
        lib.b3World_SetMaximumLinearSpeed(self.world, limit)
        self._set_friction()
        speed = lift_speed(self.prepared) if phase == "lift" else 0.0
        lib.b3Body_SetLinearVelocity(self.cylinder, _vector((0.0, 0.0, speed)))
        if phase == "rest":
            self._raise_cylinder(self.rim + 10.0 * self.top)

    def turn_walls(self, angle: float, speed: float) -> None:
        height = self.prepared.case.test.height / self.unit_length
        for body, z in zip((self.cylinder, *self.ends), (0.0, 0.0, height), strict=True):
            lib.b3Body_SetTransform(body, _vector((0.0, 0.0, z)), _quaternion(_about_z(angle)))
            lib.b3Body_SetAngularVelocity(body, _vector((0.0, 0.0, speed)))

    def _raise_cylinder(self, height: float) -> None:
        lib.b3Body_SetTransform(self.cylinder, _vector((0.0, 0.0, height)), _quaternion(IDENTITY))

    def _set_friction(self) -> None:
        """That of particles in this phase; wall and plate are felt as before.

        Box3D takes the geometric mean of two bodies' friction.
        """
        test, friction = self.prepared.case.test, friction_in(self.phase, self.prepared, self.settings)
        for shape in self.shapes:
            lib.b3Shape_SetFriction(shape, friction)
        # sqrt(f_wall^2 / f * f) = f_wall, whatever the particles have in this phase.
        if friction > 0.0:
            for shape in self.walls:
                lib.b3Shape_SetFriction(shape, test.wall_friction**2 / friction)
            for shape in self.plates:
                lib.b3Shape_SetFriction(shape, test.plate_friction**2 / friction)

    def speeds(self) -> FloatArray:
        return np.asarray(np.linalg.norm(self._velocities()[:, :3], axis=1))

    def advance(self, step: float, count: int) -> None:
        at_once = count if self.cohesion is None else 1
        for _ in range(count // at_once):
            if self.cohesion is not None:
                self.cohesion.pull()  # Box3D forgets forces after a step
            SHIM.rxWorldStepN(self.world, step, self.substeps(step), at_once)
        self.time += count * step
        if not np.isfinite(self._velocities()).all():
            raise diverged(self.time, self.unit_time, self.settings.time_step)

    def place(self, points: FloatArray, orientations: FloatArray) -> None:
        self._move(np.column_stack([points, np.roll(orientations, -1, axis=1)]), np.zeros((self.n, 6)))

    def _move(self, poses: FloatArray, velocities: FloatArray) -> None:
        for body, pose, velocity in zip(self.particles, poses, velocities, strict=True):
            lib.b3Body_SetTransform(body, _vector(pose[:3]), _quaternion(pose[3:]))
            lib.b3Body_SetLinearVelocity(body, _vector(velocity[:3]))
            lib.b3Body_SetAngularVelocity(body, _vector(velocity[3:]))

    def set_gravity(self, gravity: FloatArray) -> None:
        lib.b3World_SetGravity(self.world, _vector(gravity))

    def state(self) -> bytes:
        """Places and velocities; the impulses of contacts are computed again when the run goes on."""
        gravity, turn = lib.b3World_GetGravity(self.world), lib.b3Body_GetRotation(self.cylinder)
        angle, speed = 2 * np.arctan2(turn.v.z, turn.s), lib.b3Body_GetAngularVelocity(self.cylinder).z
        head = [self.time, self.rim, gravity.x, gravity.y, gravity.z, float(angle), speed]
        return np.concatenate([head, self._poses().ravel(), self._velocities().ravel()]).tobytes()

    def load(self, state: bytes) -> None:
        values = np.frombuffer(state)
        head, rest = np.split(values, [7])
        if len(rest) != 13 * self.n:
            raise RegolithError("The state of Box3D to go on from is that of other particles.")
        self.begin(self.phase)
        self.time = float(head[0])
        self._raise_cylinder(float(head[1]))
        self.set_gravity(head[2:5])
        if self.phase in DRUM_PHASES[2:]:
            self.turn_walls(float(head[5]), float(head[6]))
        self._move(rest[: 7 * self.n].reshape(-1, 7), rest[7 * self.n :].reshape(-1, 6))


IDENTITY = (0.0, 0.0, 0.0, 1.0)
UNIT_RADIUS = (3 / (4 * np.pi)) ** (1 / 3)
"""Radius of a ball of unit volume."""


class _Forms:
    """Hulls of the shapes at each of their sizes, made once."""

    def __init__(self, prepared: PreparedCase) -> None:
        self.prepared = prepared
        self.hulls: dict[tuple[int, float], list[Any]] = {}
        friction = prepared.case.contact.static_friction
        self.definition = _definition(prepared, friction)

    def add(self, body: Any, kind: int, size: float) -> list[Any]:
        """Shapes of a particle, which are added to its body with its mass."""
        prepared = self.prepared
        if prepared.case.shapes == "spheres":
            self.definition.baseMaterial.rollingResistance = prepared.case.contact.rolling_friction
            ball = ffi.new("b3Sphere*", {"radius": size * UNIT_RADIUS})
            return [lib.b3CreateSphereShape(body, self.definition, ball)]
        hulls = self.hulls.setdefault((kind, size), [])
        if not hulls:
            hulls += [_hull(part * size) for part in prepared.part_vertices[kind]]
        shapes = []
        for hull in hulls:
            ratio = size * UNIT_RADIUS / (ROLLING_RADIUS * hull.innerRadius)
            self.definition.baseMaterial.rollingResistance = ratio * prepared.case.contact.rolling_friction
            shapes.append(lib.b3CreateHullShape(body, self.definition, hull))
        if len(hulls) > 1:  # masses of parts that overlap would add up to more than the body's
            inertia = self.inertia(kind, size)
            columns = [_vector(inertia[:, k]) for k in range(3)]
            tensor = ffi.new("b3Matrix3*", columns)[0]
            lib.b3Body_SetMassData(body, ffi.new("b3MassData*", [size**3, _vector(np.zeros(3)), tensor])[0])
        return shapes

    def inertia(self, kind: int, size: float) -> FloatArray:
        """About the centre, at density 1."""
        prepared = self.prepared
        if prepared.case.shapes == "spheres":
            return np.asarray(0.4 * size**5 * UNIT_RADIUS**2 * np.eye(3))
        if prepared.inertias:
            return np.asarray(prepared.inertias[kind] * size**5)
        tensor = lib.b3ComputeHullMass(self.hulls[kind, size][0], 1.0).inertia
        return np.array([[getattr(each, way) for way in "xyz"] for each in (tensor.cx, tensor.cy, tensor.cz)])


MAX_HULL_ERROR = 1e-4
"""Part of its volume by which Box3D's hull of a polyhedron may differ. Vertices that single precision cannot
tell apart become one."""


def _hull(vertices: FloatArray) -> Any:
    points = ffi.new("b3Vec3[]", [tuple(map(float, each)) for each in vertices])
    hull, volume = lib.b3CreateHull(points, len(vertices), len(vertices)), ConvexHull(vertices).volume
    if hull == ffi.NULL or abs(lib.b3ComputeHullMass(hull, 1.0).mass - volume) > MAX_HULL_ERROR * volume:
        raise InputError(
            f"Box3D makes no hull of a polyhedron of {len(vertices)} vertices; take another engine."
        )
    return ffi.gc(hull, lib.b3DestroyHull)


def _new_world() -> Any:
    definition = lib.b3DefaultWorldDef()
    definition.gravity = _vector((0.0, 0.0, -1.0))
    definition.enableSleep = False
    definition.workerCount = int(os.environ.get(ENGINE_THREADS, "1"))
    definition.contactHertz, definition.contactDampingRatio = CONTACT_HERTZ, CONTACT_DAMPING
    definition.restitutionThreshold = RESTITUTION_SPEED
    return lib.b3CreateWorld(ffi.new("b3WorldDef*", definition))


def _definition(prepared: PreparedCase, friction: float) -> Any:
    definition = lib.b3DefaultShapeDef()
    definition.density = 1.0
    definition.baseMaterial.friction = friction
    definition.baseMaterial.restitution = prepared.case.contact.restitution
    return ffi.new("b3ShapeDef*", definition)


def _add_box(body: Any, half: Any, place: Any, turn: Any, definition: Any) -> Any:
    pose = ffi.new("b3Transform*", [_vector(place), _quaternion(turn)])[0]
    box = ffi.new("b3BoxHull*", lib.b3MakeTransformedBoxHull(*map(float, half), pose))
    return lib.b3CreateHullShape(body, definition, ffi.addressof(box.base))


def _vector(values: Any) -> Any:
    return ffi.new("b3Vec3*", [float(each) for each in values])[0]


def _about_z(angle: float) -> Any:
    return (0.0, 0.0, np.sin(angle / 2), np.cos(angle / 2))


def _quaternion(xyzw: Any) -> Any:
    return ffi.new("b3Quat*", [_vector(xyzw[:3]), float(xyzw[3])])[0]
