"""Rigid clumps of spheres with the mass and inertia of the polyhedra, and the files that LAMMPS reads.

Units: mean diameter, density and gravity are 1. The contact laws are those of the paper: Hertz with material
parameters and restitution (or Johnson-Kendall-Roberts), Mindlin with Coulomb's limit, rolling resistance.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from regolith_studio.dataset.multisphere import (
    SphereFitErrors,
    fit_spheres,
    fit_spheres_within,
    sphere_fit_errors,
)
from regolith_studio.dem.case import PreparedCase, rayleigh_time
from regolith_studio.dem.engines.lammps.program import LammpsSettings
from regolith_studio.dem.initial_packing import loose_column
from regolith_studio.dem.lifting_cylinder import SETTLE
from regolith_studio.dem.snapshot import PHASES
from regolith_studio.geometry.arrays import FloatArray, IntArray
from regolith_studio.geometry.convex_compound import ConvexCompound, Polyhedron
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.geometry.half_spaces import HalfSpaces

BALL = (3 / (4 * np.pi)) ** (1 / 3)
"""Radius of a ball of unit volume."""
COMPANION = 0.1
"""Radius of the second sphere of a body that has only one, and its place along each axis, in radii of the
first."""


@dataclass(frozen=True, eq=False)
class ClumpShape:
    """One unit-volume shape as spheres.

    - ``spheres``: rows x, y, z, r about the centroid, shape (k, 4).
    - ``inertia``: of the shape at density 1 about its centroid, shape (3, 3).
    - ``errors``: of the union of the spheres; mass, centre and inertia are the shape's all the same.
    """

    spheres: FloatArray
    inertia: FloatArray
    errors: SphereFitErrors


@dataclass(frozen=True, eq=False)
class Clumps:
    """All particles where a simulation begins; lengths in mean diameters, density 1.

    - ``shapes``: one a class.
    - ``centres``, ``turns``: of the particles: shape (n, 3), and rotations.
    - ``scales``: factor from the unit-volume shape to each particle, shape (n,).
    - ``class_index``: shape (n,).
    """

    shapes: tuple[ClumpShape, ...]
    centres: FloatArray
    turns: Rotation
    scales: FloatArray
    class_index: IntArray

    def atoms(self, centres: FloatArray, turns: Rotation) -> tuple[IntArray, FloatArray, FloatArray]:
        """Body (m,), centre (m, 3) and radius (m,) of every sphere of particles placed like this."""
        counts = np.array([len(shape.spheres) for shape in self.shapes])[self.class_index]
        body = np.repeat(np.arange(len(counts)), counts)
        local = np.concatenate([self.shapes[kind].spheres for kind in self.class_index])
        scale = self.scales[body]
        places = centres[body] + turns[body].apply(local[:, :3] * scale[:, None])
        return body, places, local[:, 3] * scale

    def atoms_of_bodies(self) -> tuple[IntArray, FloatArray, FloatArray]:
        """As :meth:`atoms`, where the simulation begins, with at least two spheres a body.

        LAMMPS knows no rigid body of one: a second one within, so small that nothing can touch it, keeps it
        company. Mass and inertia are given for the whole body and do not change.
        """
        body, places, radius = self.atoms(self.centres, self.turns)
        alone = np.bincount(body)[body] == 1
        return (
            np.concatenate([body, body[alone]]),
            np.concatenate([places, places[alone] + COMPANION * np.outer(radius[alone], [1.0, 1.0, 1.0])]),
            np.concatenate([radius, COMPANION * radius[alone]]),
        )

    @property
    def extent(self) -> float:
        """Distance that no two centres of spheres of one particle exceed."""
        far = [float(np.linalg.norm(shape.spheres[:, :3], axis=1).max()) for shape in self.shapes]
        return float((2.0 * np.array(far)[self.class_index] * self.scales).max())

    def inertias(self) -> FloatArray:
        """Of every particle about its centre, along the axes of space, shape (n, 3, 3)."""
        own = np.array([shape.inertia for shape in self.shapes])[self.class_index]
        matrix = self.turns.as_matrix()
        return np.asarray(matrix @ own @ matrix.transpose(0, 2, 1) * (self.scales**5)[:, None, None])


def clumps_of(prepared: PreparedCase, count: int, max_error: float = 0.0) -> Clumps:
    """The particles of a case as clumps of at most `count` spheres, or as many as `max_error` needs."""
    length = prepared.mean_diameter
    column = loose_column(prepared)
    ball = prepared.case.shapes == "spheres"
    shapes = tuple(
        _ball() if ball else clump_shape(parts, count, max_error) for parts in prepared.part_vertices
    )
    return Clumps(
        shapes,
        column.points / length,
        Rotation.from_quat(column.orientations, scalar_first=True),
        prepared.scales / length,
        prepared.class_index,
    )


def clump_shape(parts: Sequence[FloatArray], count: int, max_error: float = 0.0) -> ClumpShape:
    """A unit-volume shape as spheres: `count`, or as many as a Jaccard distance above 0 needs.

    ``parts``: vertices of its convex parts, each of shape (k, 3); spheres fill their union.
    """
    places = np.array([part.mean(axis=0) if len(parts) > 1 else np.zeros(3) for part in parts])
    solids = tuple(_solid(part - place) for part, place in zip(parts, places, strict=True))
    solid: Polyhedron = ConvexCompound(solids, places) if len(parts) > 1 else solids[0]
    spheres = fit_spheres_within(solid, max_error) if max_error else fit_spheres(solid, count)
    return ClumpShape(spheres, np.asarray(solid.mesh.inertia), sphere_fit_errors(solid, spheres))


def _solid(vertices: FloatArray) -> ConvexPolyhedron:
    # Qhull gives a facet of k corners as k - 2 triangles with equations that differ in the last bits.
    planes = np.unique(np.round(ConvexHull(vertices).equations, 10), axis=0)
    return ConvexPolyhedron.from_half_spaces(HalfSpaces(planes[:, :3], -planes[:, 3]))


def _ball() -> ClumpShape:
    return ClumpShape(
        np.array([[0.0, 0.0, 0.0, BALL]]), np.eye(3) * 0.4 * BALL**2, SphereFitErrors(0.0, 0.0, 0.0, 0.0)
    )


TANGENTIAL_DAMPING = 1.0
# By Hertz's law that of a contact that bears ten particles, about the column above the middle of a filling of
# 1,000, at the largest modulus of the settings.
TYPICAL_OVERLAP = 0.005
"""Mean diameters, where the two laws of damping are made equal."""


@dataclass(frozen=True)
class Schedule:
    """Times of the phases in sqrt(d/g), and the step.

    - ``step``: of the integration.
    - ``fill``, ``settle``, ``lift``, ``rest``: durations.
    - ``speed``: of the cylinder, in sqrt(g d).
    - ``picture``: steps between two snapshots.
    - ``start``: time that earlier attempts have done; steps count from there.
    """

    step: float
    fill: float
    settle: float
    lift: float
    rest: float
    speed: float
    picture: int
    start: float = 0.0

    @property
    def total(self) -> float:
        """Duration of the test."""
        return self.fill + self.settle + self.lift + self.rest

    @property
    def steps(self) -> int:
        """Number of steps from the start on."""
        return sum(self.steps_left(phase) for phase in PHASES)

    @property
    def raised(self) -> float:
        """Height of the cylinder's lower rim at the start."""
        return max(0.0, self.start - self.fill - self.settle) * self.speed

    def steps_left(self, phase: str) -> int:
        """Number of steps of a phase from the start on."""
        durations = [self.fill, self.settle, self.lift, self.rest][: PHASES.index(phase) + 1]
        left = min(durations[-1], sum(durations) - self.start)
        return int(np.ceil(max(0.0, left) / self.step))

    def time(self, step: int) -> float:
        """Since the beginning of the test."""
        return self.start + step * self.step

    def phase(self, step: int) -> str:
        """What is going on at a step."""
        for name in PHASES[:-1]:
            step -= self.steps_left(name)
            if step <= 0 < self.steps_left(name):
                return name
        return PHASES[-1]

    def rim(self, step: int) -> float:
        """Height of the cylinder's lower rim at a step; infinite once it is gone."""
        late = (step - self.steps_left("fill") - self.steps_left("settle")) * self.step
        return float("inf") if self.phase(step) == "rest" else max(0.0, self.raised + late * self.speed)

    def restarted(self, start: float) -> "Schedule":
        """The rest of the test in steps half as long."""
        return replace(self, step=self.step / 2, picture=2 * self.picture, start=start)


def stiffness(prepared: PreparedCase, settings: LammpsSettings) -> float:
    """Young's modulus as simulated, over rho g d."""
    contact, test = prepared.case.contact, prepared.case.test
    real = contact.youngs_modulus / (contact.density * test.gravity * prepared.mean_diameter)
    return min(real, settings.max_stiffness) if settings.max_stiffness > 0.0 else real


def schedule(prepared: PreparedCase, settings: LammpsSettings, top: float) -> Schedule:
    """When what happens; `top` is the height of the column at the start in mean diameters."""
    contact, test = prepared.case.contact, prepared.case.test
    smallest = float(prepared.diameters.min()) / prepared.mean_diameter
    young = stiffness(prepared, settings)
    step = settings.step_share * rayleigh_time(smallest, 1.0, young, contact.poissons_ratio)
    speed = test.lift_speed / np.sqrt(test.gravity * prepared.mean_diameter)
    height = prepared.fill_height / prepared.mean_diameter
    fill, lift = np.sqrt(2.0 * top) + 6.0, (0.9 * height + 2.0) / speed
    total = fill + SETTLE + lift + settings.rest
    picture = max(1, int(total / step / settings.snapshots))
    return Schedule(step, float(fill), SETTLE, float(lift), settings.rest, float(speed), picture)


def data_file(clumps: Clumps, reach: float, top: float) -> str:
    """Atoms of all clumps; each atom carries the number of its body."""
    body, places, radius = clumps.atoms_of_bodies()
    lines = [
        "clumps",
        "",
        f"{len(body)} atoms",
        "1 atom types",
        "",
        f"{-reach!r} {reach!r} xlo xhi",
        f"{-reach!r} {reach!r} ylo yhi",
        f"-2.0 {top + 20.0!r} zlo zhi",
        "",
        "Atoms # hybrid sphere bond",
        "",
    ]
    for k in range(len(body)):
        x, y, z = (float(value) for value in places[k])
        lines.append(f"{k + 1} 1 {x!r} {y!r} {z!r} {2 * float(radius[k])!r} 1.0 {body[k] + 1}")
    return "\n".join(lines) + "\n"


def bodies_file(clumps: Clumps, motion: FloatArray) -> str:
    """Mass, centre and inertia of the polyhedra, in place of those of overlapping spheres.

    `motion` holds velocity and angular momentum, shape (n, 6).
    """
    inertias, lines = clumps.inertias(), [str(len(clumps.scales))]
    for k in range(len(clumps.scales)):
        i = inertias[k]
        numbers = (*clumps.centres[k], i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2])
        text = " ".join(repr(float(number)) for number in (clumps.scales[k] ** 3, *numbers))
        moving = " ".join(repr(float(number)) for number in motion[k])
        lines.append(f"{k + 1} {text} {moving} 0 0 0")
    return "\n".join(lines) + "\n"


def script(
    prepared: PreparedCase,
    settings: LammpsSettings,
    plan: Schedule,
    radius: float,
    top: float,
    extent: float,
) -> str:
    """The input of LAMMPS for clumps of this extent; the snapshots are ``body.*.dump``."""
    case = prepared.case
    friction = case.contact.static_friction
    plate, wall = (
        _contact(prepared, settings, mu) for mu in (case.test.plate_friction, case.test.wall_friction)
    )
    tube = f"region tube cylinder z 0 0 {radius!r} 0 {top!r} side in open 1 open 2"
    hold = f"fix tube all wall/gran/region granular {wall} region tube"
    still, lift = plan.steps_left("fill") + plan.steps_left("settle"), plan.steps_left("lift")
    filling = f"{tube}\n{hold}\nrun {still}\nunfix tube\nregion tube delete\n" if still else ""
    lifting = (
        f"variable begin equal $(step)\n"
        f"variable up equal {plan.raised!r}+(step-v_begin)*{plan.step!r}*{plan.speed!r}\n"
        f"{tube} move NULL NULL v_up\n{hold}\nrun {lift}\nunfix tube\n"
    )
    # Neighbours are listed to 0.12 d beyond contact: 100 clumps take 10.4, 10.5, 17.8 and 30.5 s of processor
    # time with 0.05, 0.12, 0.3 and 0.6.
    # Ghosts reach over a whole particle: LAMMPS refuses bodies that are longer than neighbours are far.
    # The box grows along x and y (boundary s): a rounded clump without rolling resistance rolls on at
    # constant speed and would leave a fixed one.
    return f"""units lj
atom_style hybrid sphere bond
boundary s s f
newton off
comm_modify vel yes cutoff {extent!r}
read_data clumps.data
neighbor 0.12 bin
neigh_modify delay 0 every 1 check yes exclude molecule/intra all
pair_style granular
pair_coeff * * {_contact(prepared, settings, friction)}
timestep {plan.step!r}
fix down all gravity 1.0 vector 0 0 -1
fix bodies all rigid/small molecule infile bodies.txt gravity down
fix plate all wall/gran granular {plate} zplane 0 NULL
compute place all rigid/local bodies mol x y z quatw quati quatj quatk &
 vx vy vz angmomx angmomy angmomz
compute motion all ke/rigid bodies
compute spin all erotate/rigid bodies
dump place all local {plan.picture} body.*.dump c_place[1] c_place[2] c_place[3] c_place[4] &
 c_place[5] c_place[6] c_place[7] c_place[8] c_place[9] c_place[10] c_place[11] &
 c_place[12] c_place[13] c_place[14]
dump_modify place format float %.10g
thermo {plan.picture}
thermo_style custom step c_motion c_spin
thermo_modify lost warn flush yes norm no
{filling}{lifting if lift else ""}run {plan.steps_left("rest")}
"""


def _contact(prepared: PreparedCase, settings: LammpsSettings, friction: float) -> str:
    """Normal, tangential and rolling law with their numbers."""
    contact = prepared.case.contact
    young, poisson = stiffness(prepared, settings), contact.poissons_ratio
    bounce = contact.restitution
    weight = contact.density * prepared.case.test.gravity * prepared.mean_diameter**2
    energy = prepared.surface_energy / weight / 2  # two surfaces of LAMMPS make the w of 3/2 pi w R*
    normal, damping = f"hertz/material {young!r} {bounce!r} {poisson!r}", "tsuji"
    if energy > 0.0:  # LAMMPS has no law of restitution for cohesive contacts
        normal = f"jkr {young!r} {viscosity(young, poisson, bounce)!r} {poisson!r} {energy!r}"
        damping = "viscoelastic"
    rolling = "none"
    if contact.rolling_friction > 0.0:
        rolling = f"sds {0.1 * young!r} {0.02 * young!r} {contact.rolling_friction!r}"
    return (
        f"{normal} tangential mindlin_rescale NULL {TANGENTIAL_DAMPING!r} {friction!r} "
        f"rolling {rolling} damping {damping}"
    )


def viscosity(young: float, poisson: float, bounce: float) -> float:
    """Coefficient of viscoelastic damping that equals Tsuji's at the typical contact of two mean particles.

    Tsuji's damping is alpha(e) sqrt(m k) with k = 4/3 E* a, the viscoelastic one is this coefficient times
    a m, where a is the radius of the contact and m the reduced mass.
    """
    # LAMMPS' own polynomial for Tsuji's alpha(e).
    alpha = float(np.polyval([4.8218, -18.022, 27.467, -22.348, 11.087, -4.2783, 1.2728], bounce))
    effective = young / (2 * (1 - poisson**2))
    radius, mass = np.sqrt(0.25 * TYPICAL_OVERLAP), np.pi / 12
    return float(alpha * np.sqrt(4 / 3 * effective / (radius * mass)))
