"""Drops the particles of a dataset into a cylinder, lifts it, and lets the pile come to rest: YADE.

Written by Regolith Studio; all numbers are in case.json beside this file, in SI units.

    yade -j1 yade_case.py              build the case; press play in the window
    yade -n -x -j1 yade_case.py --check    build it, write check.json (volumes, masses, inertia), stop
    yade -n -x -j1 yade_case.py --run      settle, lift and rest without a window, then write positions.csv
    yade -n -x -j1 yade_case.py --run 20000    only that many steps

YADE's law for polyhedra is volumetric: the force grows with the overlapping volume. It is neither
Hertz nor JKR, so an angle of repose from it is qualitative. The stiffness in case.json is chosen soft.
"""

import csv
import json
import math
import sys
from pathlib import Path

from yade import O, Vector3, log, polyhedra_utils, utils, wrapper
from yade.minieigenHP import Quaternion

FOLDER = Path(sys.argv[0]).resolve().parent
BLOCKS = 24
TETRAHEDRON = ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1))
ANY, BLOCK = 1, 2
"""Bits of masks: bodies with a common bit meet, but not the blocks of the tube, which touch for good."""


def build(case):
    """Material, particles, plate and tube; the ids of the tube's blocks."""
    contact = case["contact"]
    test = case["test"]
    frictions = {
        "regolith": contact["dynamic_friction"],
        "tube": test["wall_friction"],
        "plate": test["plate_friction"],
    }
    for label, friction in frictions.items():
        O.materials.append(
            wrapper.PolyhedraMat(
                density=contact["density"],
                young=case["volumetric_stiffness"],
                poisson=contact["poissons_ratio"],
                frictionAngle=math.atan(friction),
                label=label,
            )
        )
    grain = O.materials["regolith"]
    for record in read_particles():
        add_particle(case, record, grain)
    O.bodies.append(utils.wall(0.0, axis=2, sense=1, material="plate"))
    return [O.bodies.append(block) for block in make_tube(case, O.materials["tube"])]


def make_tube(case, material):
    """Flat convex blocks side by side: YADE handles them better and faster than thin facets."""
    test, half = case["test"], math.pi / BLOCKS
    height, inner = test["height"] * case["tube_stretch"], test["diameter"] / 2
    for k in range(BLOCKS):
        corners = []
        for radius in (inner, inner + 2 * case["largest_diameter"]):
            for side in (-half, half):
                angle, reach = 2 * math.pi * k / BLOCKS + side, radius / math.cos(half)
                x, y = reach * math.cos(angle), reach * math.sin(angle)
                corners += [Vector3(x, y, z) for z in (0.0, height)]
        block = polyhedra_utils.polyhedra(material, v=corners, fixed=True)
        block.mask = ANY | BLOCK
        yield block


def read_particles():
    """Rows of particles.csv with numbers as numbers."""
    with (FOLDER / "particles.csv").open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            yield {key: float(value) for key, value in row.items()}


def add_particle(case, record, material):
    """The scaled and turned hull of a shape's vertices, or a clump of those of its convex parts.

    YADE finds mass and moments of inertia itself, but turns a body into its principal axes only where a
    product of inertia exceeds an absolute 1e-13 m^5: a shape is built in its principal axes, which are those
    of its vertices, and then placed. Mass and inertia of a clump are sums over its members: the parts weigh a
    hundredth, and points, which touch nothing, the rest, so that the sums are those of the union. No member
    has an inertia of its own, since YADE turns those of members the wrong way.
    """
    turn = Quaternion(record["qw"], record["qx"], record["qy"], record["qz"])
    middle, scale = Vector3(record["x"], record["y"], record["z"]), record["scale"]

    def placed(point):
        return middle + turn * (Vector3(*point) * scale)

    shape, mass = case["shapes"][int(record["class"])], material.density * scale**3
    if len(shape["parts"]) == 1:
        corners = [Vector3(*corner) * scale for corner in shape["parts"][0]]
        body = polyhedra_utils.polyhedra(material, v=corners)
        body.state.pos, body.state.ori = middle + turn * body.state.pos, turn * body.state.ori
        return O.bodies.append(body)
    solids = [polyhedra_utils.polyhedra(material, v=list(map(placed, part))) for part in shape["parts"]]
    for solid, share in zip(solids, shape["mass_shares"], strict=True):
        solid.state.mass, solid.state.inertia = share * mass, Vector3(0, 0, 0)
    points = []
    for *point, share in shape["points"]:
        corners = [[x + 0.05 * side for x, side in zip(point, corner, strict=True)] for corner in TETRAHEDRON]
        body = polyhedra_utils.polyhedra(
            material, v=list(map(placed, corners))
        )  # of spheres YADE takes volumes
        body.state.mass, body.state.inertia = share * mass, Vector3(0, 0, 0)
        body.mask, body.bounded = 0, False
        points.append(body)
    clump, _ = O.bodies.appendClumped([*solids, *points])
    O.bodies[clump].aspherical = True
    return clump


def set_engines(case):
    """Contacts between polyhedra, plate and tube; gravity; the lift."""
    O.engines = [
        wrapper.ForceResetter(),
        wrapper.InsertionSortCollider(
            [wrapper.Bo1_Polyhedra_Aabb(), wrapper.Bo1_Wall_Aabb()],
            verletDist=0.02 * case["largest_diameter"],
            avoidSelfInteractionMask=BLOCK,
        ),
        wrapper.InteractionLoop(
            [
                wrapper.Ig2_Wall_Polyhedra_PolyhedraGeom(),
                wrapper.Ig2_Polyhedra_Polyhedra_PolyhedraGeom(),
            ],
            [wrapper.Ip2_PolyhedraMat_PolyhedraMat_PolyhedraPhys()],
            [wrapper.Law2_PolyhedraGeom_PolyhedraPhys_Volumetric()],
        ),
        wrapper.NewtonIntegrator(gravity=(0.0, 0.0, -case["test"]["gravity"]), damping=case["damping"]),
        wrapper.PyRunner(command="lift()", virtPeriod=case["times"]["settling_time"] / 20, label="lifter"),
    ]
    O.dt = case["time_step"]


def lift():
    """Once the particles have settled, the tube moves up; called by the engine."""
    if O.time >= CASE["times"]["settling_time"]:
        for number in TUBE:
            O.bodies[number].state.vel = Vector3(0.0, 0.0, CASE["test"]["lift_speed"])


def particles():
    """Bodies that are neither plate nor tube nor members of a clump."""
    return [
        body
        for body in O.bodies
        if body.isClump
        or (body.isStandalone and isinstance(body.shape, wrapper.Polyhedra) and body.mask == ANY)
    ]


def volume(body):
    """Of a clump by its mass, which is that of the union."""
    return body.state.mass / CASE["contact"]["density"] if body.isClump else body.shape.GetVolume()


def check():
    """What YADE made of the particles, for comparison with the dataset."""
    rows = []
    for body in particles():
        inertia = sorted(body.state.inertia)
        place = list(body.state.pos)
        rows.append({"volume": volume(body), "mass": body.state.mass, "inertia": inertia, "position": place})
    text = json.dumps({"time_step": O.dt, "particles": rows})
    (FOLDER / "check.json").write_text(text, encoding="utf-8")


def write_positions():
    """Centroid and equivalent radius of each particle, metres."""
    with (FOLDER / "positions.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("x", "y", "z", "radius"))
        for body in particles():
            radius = (3 * volume(body) / (4 * math.pi)) ** (1 / 3)
            writer.writerow((*body.state.pos, radius))


def run(steps):
    """Run in fifty parts without a window, with positions.csv after each: a fault then loses little."""
    O.labeledEngine("lifter").dead = True
    done, part = 0, max(1, steps // 50)
    while done < steps:
        O.run(min(part, steps - done), wait=True)
        done += part
        lift()
        write_positions()


def steps_wanted():
    """The number behind --run, or what the whole case takes."""
    rest = sys.argv[sys.argv.index("--run") + 1 :]
    if rest and rest[0].isdigit():
        return int(rest[0])
    return math.ceil(CASE["duration"] / O.dt)


CASE = json.loads((FOLDER / "case.json").read_text(encoding="utf-8"))
log.setLevel("Polyhedra_support.cpp", log.ERROR)  # else it warns at the first touch of every pair
TUBE = build(CASE)
set_engines(CASE)
if "--check" in sys.argv:
    check()
if "--run" in sys.argv:
    run(steps_wanted())
