"""Rapier as a solver of the lifting-cylinder test: plate, a ring of boxes, free convex bodies."""

import os
from dataclasses import replace

import numpy as np
import rapier3d as rapier
from scipy.spatial import ConvexHull, HalfspaceIntersection
from scipy.spatial.transform import Rotation

from regolith_studio.dem.case import PreparedCase
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
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.dem.stepped_engine import SubstepSolver
from regolith_studio.errors import InputError, RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.half_spaces import inscribed_ball

WALL_THICKNESS = 2.0
PLATE_WIDTH = 12.0
"""In diameters of the cylinder; a box, since contacts of a half-space with polyhedra get lost."""
ROUNDING = 0.005
"""Radius of the edges in equivalent diameters. The solver loses contacts beside edges, the more the larger it
is: with 0.02, three of 1,600 contacts of a heap at rest overlap by more than 2 %, and the sharp polyhedra,
whose corners stand out of the rounded ones, by up to 7 %. Heaps of hulls without a radius go on moving."""
UNIT_DIAMETER = (6 / np.pi) ** (1 / 3)
"""Equivalent diameter of a shape of unit volume."""
Parts = tuple[FloatArray, ...]
"""Vertices of each convex part of a shape."""
IN_PLACE = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
"""Place and turn of a part in its body."""
CONTACT_FREQUENCY, CONTACT_DAMPING = 20.0, 3.0
"""Natural frequency and damping ratio with which overlaps are pushed apart. With the solver's own (30, 60 for
what does not move, and 10) heaps at rest tremble and creep: half of their particles move by 0.05 diameters in
25 sqrt(d/g), and by 0.013 with these; overlaps are no deeper (docs/repose_engines.md)."""


class RapierSolver(SubstepSolver):
    """Rapier's world: the particles, then the cylinder, then the plate."""

    def __init__(self, prepared: PreparedCase, settings: SubstepSettings) -> None:
        super().__init__(prepared, settings)
        self.world = rapier.PhysicsWorld(gravity=(0.0, 0.0, -1.0))
        self.cores = rounded_cores(prepared)
        self.top = _build(self.world, prepared, self.cores)
        self.masses = np.pi / 6 * (prepared.diameters / prepared.mean_diameter) ** 3
        self._find_bodies()

    def _find_bodies(self) -> None:
        """Handles of the bodies, and the threads and numerics of the world."""
        bodies = self.world.rigid_bodies
        handles = [rapier.RigidBodyHandle.from_raw_parts(k, 0) for k in range(len(bodies))]
        handled = [bodies[handle] for handle in handles]
        self.particles, (self.cylinder, self.plate, *self.lids) = handled[: self.n], handled[self.n :]
        self.world.set_num_threads(int(os.environ.get(ENGINE_THREADS, "1")))
        numerics = self.world.integration_parameters
        # heaps are calmer and overlap less with both; sharp columns walk and fall with recycled contacts
        numerics.contact_recycling = False
        numerics.friction_in_bias_pass = True
        for name in ("contact_softness", "static_contact_softness"):
            softness = getattr(numerics, name)
            softness.natural_frequency, softness.damping_ratio = CONTACT_FREQUENCY, CONTACT_DAMPING
            setattr(numerics, name, softness)

    @property
    def points(self) -> FloatArray:
        return np.array([body.translation.to_tuple() for body in self.particles], dtype=np.float64)

    @property
    def orientations(self) -> FloatArray:
        xyzw = [body.rotation.quaternion for body in self.particles]
        return np.roll(np.array(xyzw, dtype=np.float64), 1, axis=1)

    @property
    def rim(self) -> float:
        return float(self.cylinder.translation.z)

    def energies(self) -> tuple[float, float]:
        heights = np.array([body.translation.z for body in self.particles])
        return float(self.masses @ heights), float(sum(body.kinetic_energy() for body in self.particles))

    def overlaps(self) -> FloatArray:
        """Of the rounded polyhedra with each other and with the plate, from where they are.

        The solver's own depths miss contacts and keep old ones: it may say 0.022 where 0.014 is the deepest.
        """
        if self.prepared.case.shapes == "spheres":
            pairs = self.world.narrow_phase.contact_pairs()
            points = (point for pair in pairs for each in pair.manifolds for point in each.points)
            return np.array([-point.dist for point in points if point.dist < 0.0])
        prepared, length = self.prepared, self.unit_length
        counts = tuple(tuple(map(len, parts)) for parts in self.cores)
        cased = replace(prepared, shapes=tuple(map(np.concatenate, self.cores)), parts=counts)
        heap = ParticleState(
            self.points * length, prepared.diameters, self.orientations, prepared.class_index
        )
        below = ROUNDING * prepared.diameters - lowest_corners(cased, heap)
        return np.concatenate([overlap_depths(cased, heap, ROUNDING), below[below > 0.0]]) / length

    def begin(self, phase: str) -> None:
        self.phase = phase
        limit = speed_limit(phase, self.prepared, self.settings)
        self.world.integration_parameters.normalized_max_linear_velocity = limit
        self._set_friction(phase)
        self.cylinder.linvel = rapier.Vec3(0.0, 0.0, lift_speed(self.prepared) if phase == "lift" else 0.0)
        if phase == "rest":
            self.cylinder.translation = rapier.Vec3(0.0, 0.0, self.rim + 10.0 * self.top)

    def turn_walls(self, angle: float, speed: float) -> None:
        for body in (self.cylinder, self.plate, *self.lids):
            body.rotation = rapier.Rotation3.from_tuple((0.0, 0.0, np.sin(angle / 2), np.cos(angle / 2)))
            body.angvel = rapier.Vec3(0.0, 0.0, speed)
        for lid in self.lids:
            lid.translation = rapier.Vec3(0.0, 0.0, self.prepared.case.test.height / self.unit_length)

    def _set_friction(self, phase: str) -> None:
        """That of particles in this phase; wall and plate are felt as before, as a product with it."""
        test, friction = self.prepared.case.test, friction_in(phase, self.prepared, self.settings)
        if friction == 0.0:
            return
        bodies = [
            (self.cylinder, test.wall_friction / friction),
            *[(plate, test.plate_friction / friction) for plate in (self.plate, *self.lids)],
        ]
        for body, value in bodies + [(body, friction) for body in self.particles]:
            for handle in body.colliders:
                self.world.colliders[handle].friction = value

    def speeds(self) -> FloatArray:
        velocities = np.array([body.linvel.to_tuple() for body in self.particles])
        return np.asarray(np.linalg.norm(velocities, axis=1))

    def advance(self, step: float, count: int) -> None:
        numerics = self.world.integration_parameters
        numerics.dt = step
        numerics.num_solver_iterations = self.substeps(step)
        for _ in range(count):
            self.world.step()
            if not self.world.quarantine.is_empty():
                raise diverged(self.time, self.unit_time, self.settings.time_step)
            self.time += step

    def place(self, points: FloatArray, orientations: FloatArray) -> None:
        still = rapier.Vec3(0.0, 0.0, 0.0)
        turns = np.roll(orientations, -1, axis=1)
        for body, place, turn in zip(self.particles, points.tolist(), turns.tolist(), strict=True):
            body.translation, body.linvel, body.angvel = rapier.Vec3(*place), still, still
            body.rotation = rapier.Rotation3.from_tuple(tuple(turn))

    def set_gravity(self, gravity: FloatArray) -> None:
        self.world.gravity = rapier.Vec3(*gravity.tolist())

    def state(self) -> bytes:
        return np.float64(self.time).tobytes() + self.world.snapshot()

    def load(self, state: bytes) -> None:
        self.time = float(np.frombuffer(state[:8])[0])
        try:
            self.world = rapier.PhysicsWorld.restore(state[8:])
        except rapier.SerializationError as error:
            raise RegolithError(f"The state of Rapier to go on from cannot be read ({error}).") from error
        self._find_bodies()


def _build(world: rapier.PhysicsWorld, prepared: PreparedCase, cores: tuple[Parts, ...]) -> float:
    """Particles in a loose column, the cylinder, and the plate; returns the height of the column."""
    length = prepared.mean_diameter
    column = loose_column(prepared)
    places, turns = column.points / length, np.roll(column.orientations, -1, axis=1)
    forms: dict[tuple[int, float], tuple[rapier.SharedShape, rapier.MassProperties]] = {}
    sizes = prepared.scales / length
    for kind, size, place, turn in zip(
        prepared.class_index.tolist(), sizes.tolist(), places.tolist(), turns.tolist(), strict=True
    ):
        if (kind, size) not in forms:
            forms[kind, size] = _form(prepared, cores, kind, size)
        shape, mass = forms[kind, size]
        collider = rapier.Collider.new(shape).mass_properties(mass)
        collider = _with_friction(collider, prepared, prepared.case.contact.static_friction)
        body = rapier.RigidBody.dynamic().position((place, turn)).can_sleep(False)
        world.add_body(body, colliders=[collider])
    top = float((places[:, 2] + enclosing_radii(prepared) / length).max())
    walls = _walls(prepared, 1.1 * top + 2.0)
    world.add_body(rapier.RigidBody.kinematic_velocity_based(), colliders=walls)
    half = prepared.case.test.diameter / length * PLATE_WIDTH / 2
    if prepared.case.drum is None:
        world.add_body(rapier.RigidBody.fixed(), colliders=[_plate(prepared, half, -half)])
    else:
        end, lid = rapier.RigidBody.kinematic_velocity_based(), rapier.RigidBody.kinematic_velocity_based()
        world.add_body(end, colliders=[_plate(prepared, half, -half)])
        world.add_body(lid.translation((0.0, 0.0, 2.0 * top)), colliders=[_plate(prepared, half, half)])
    return top


def _plate(prepared: PreparedCase, half: float, height: float) -> rapier.ColliderBuilder:
    """A cube with the friction of the plate about a height."""
    plate = rapier.Collider.cuboid(half, half, half).translation((0.0, 0.0, height))
    return _with_friction(plate, prepared, prepared.case.test.plate_friction, of_particles=False)


def _form(
    prepared: PreparedCase, cores: tuple[Parts, ...], kind: int, size: float
) -> tuple[rapier.SharedShape, rapier.MassProperties]:
    """Shape and mass of a particle, shared by all of a kind and size, which saves memory."""
    if prepared.case.shapes == "spheres":
        ball = rapier.SharedShape.ball(size * UNIT_DIAMETER / 2)
        return ball, ball.compute_mass_properties(1.0)
    edge = ROUNDING * size * UNIT_DIAMETER
    rounded = [rapier.SharedShape.round_convex_hull(core * size, edge) for core in cores[kind]]
    if len(rounded) == 1:
        sharp = rapier.SharedShape.convex_hull(prepared.shapes[kind] * size)
        return rounded[0], sharp.compute_mass_properties(1.0)
    moments, axes = np.linalg.eigh(prepared.inertias[kind] * size**5)
    # eigh may return a reflection, which is no rotation.
    frame = Rotation.from_matrix(axes * np.linalg.det(axes)).as_quat().tolist()
    union = rapier.MassProperties((0.0, 0.0, 0.0), size**3, moments.tolist(), frame)
    return rapier.SharedShape.compound([(IN_PLACE, each) for each in rounded]), union


def rounded_cores(prepared: PreparedCase) -> tuple[Parts, ...]:
    """Vertices of the parts of each unit-volume shape, moved inwards by the radius of their edges.

    None of spheres.

    Raises InputError if a part is thinner than its rounded edges.
    """
    if prepared.case.shapes == "spheres":
        return ()
    return tuple(
        tuple(inner_parallel_body(part, ROUNDING * UNIT_DIAMETER) for part in parts)
        for parts in prepared.part_vertices
    )


def inner_parallel_body(vertices: FloatArray, distance: float) -> FloatArray:
    """Vertices of a convex polyhedron whose facets are moved inwards, shape (k, 3).

    With a ball of this radius added (Minkowski), it has the planes of the polyhedron and rounded edges.

    Raises InputError if nothing is left of it.
    """
    # Qhull gives a facet of k corners as k - 2 triangles with equations that differ in the last bits.
    planes = np.unique(np.round(ConvexHull(vertices).equations, 9), axis=0)
    planes[:, 3] += distance
    centre, left = inscribed_ball(planes[:, :3], -planes[:, 3])
    if not left > 0.0:
        raise InputError(
            "A shape or a part of one is so thin that nothing is left within Rapier's rounded edges; take"
            " MuJoCo."
        )
    return np.asarray(HalfspaceIntersection(planes, centre).intersections)


def _walls(prepared: PreparedCase, height: float) -> list[rapier.Collider | rapier.ColliderBuilder]:
    """A ring of boxes; each is so wide that it overlaps its neighbours, and no gap is between them."""
    walls: list[rapier.Collider | rapier.ColliderBuilder] = []
    for half, place, angle in wall_ring(prepared, height, WALL_THICKNESS):
        turn = (0.0, 0.0, np.sin(angle / 2), np.cos(angle / 2))
        wall = rapier.Collider.cuboid(*half).position((place, turn))
        friction = prepared.case.test.wall_friction
        walls.append(_with_friction(wall, prepared, friction, of_particles=False))
    return walls


def _with_friction(
    collider: rapier.ColliderBuilder, prepared: PreparedCase, friction: float, *, of_particles: bool = True
) -> rapier.ColliderBuilder:
    """Coefficients of a pair: the mean of two particles, the product of a particle and what is not one."""
    rules = rapier.CoefficientCombineRule
    own = prepared.case.contact.static_friction
    collider = collider.restitution(prepared.case.contact.restitution)
    if of_particles:
        return collider.friction(friction).friction_combine_rule(rules.AVERAGE)
    if own > 0.0:
        return collider.friction(friction / own).friction_combine_rule(rules.MULTIPLY)
    return collider.friction(friction).friction_combine_rule(rules.MAX)
