"""The lifting-cylinder test in YADE: fill, settle, lift, rest. Run by Regolith Studio:

    yade -n -x -j1 yade_repose.py FOLDER

reads input.json in FOLDER and writes state.000000.json, state.000001.json ... there until the heap is at
rest (or the longest wait is over); each state is whole, and any of them can be the beginning of another
run. Numbers are in SI units.
"""

import json
import math
import sys
from pathlib import Path

from yade import O, Vector3, log, polyhedra_utils, utils, wrapper
from yade.minieigenHP import Quaternion

FOLDER = Path(sys.argv[1])
INPUT = json.loads((FOLDER / "input.json").read_text(encoding="utf-8"))
GONE = 1000.0
ANY, SEGMENT = 1, 2
"""Bits of masks: bodies with a common bit meet, but not the blocks of the tube, which touch for good."""


def material(label, friction):
    """One material; the stiffness is force by overlapping volume."""
    made = wrapper.PolyhedraMat(
        density=INPUT["density"],
        young=INPUT["young"],
        poisson=INPUT["poisson"],
        frictionAngle=math.atan(friction),
        label=label,
    )
    O.materials.append(made)
    return made


def add_particles():
    """Numbers of the particles' bodies, and the turn that each began with in YADE's own axes.

    The corners lie in the shape's principal axes, and position and orientation are set afterwards: YADE turns
    a body into its principal axes only where a product of inertia exceeds an absolute 1e-13 m^5.
    """
    grain, numbers, first = material("grain", INPUT["friction"]), [], []
    for one in INPUT["particles"]:
        turn, place = Quaternion(*one["turn"]), Vector3(*one["place"])
        corners = INPUT["shapes"][one["shape"]]
        body = polyhedra_utils.polyhedra(grain, v=[Vector3(*corner) * one["scale"] for corner in corners])
        body.state.pos, body.state.ori = place + turn * body.state.pos, turn * body.state.ori
        set_motion(body.state, Vector3(*one["velocity"]), Vector3(*one["spin"]))
        numbers.append(O.bodies.append(body))
        first.append(body.state.ori.inverse() * turn)
    return numbers, first


def set_motion(state, velocity, spin):
    """Velocity and spin; YADE takes the spin of bodies that are no spheres from their angular momentum."""
    local = state.ori.inverse() * spin
    state.vel, state.angVel = velocity, spin
    state.angMom = state.ori * Vector3(*(state.inertia[axis] * local[axis] for axis in range(3)))


def add_walls():
    """Numbers of the segments of the tube: convex blocks side by side."""
    wall, segment = INPUT["tube"], material("tube", INPUT["wall_friction"])
    O.bodies.append(utils.wall(0.0, axis=2, sense=1, material=material("plate", INPUT["plate_friction"])))
    numbers, half = [], math.pi / wall["n_segments"]
    inner, outer = wall["radius"], wall["radius"] + wall["thickness"]
    for k in range(wall["n_segments"]):
        corners = []
        for radius in (inner, outer):
            for side in (-half, half):
                angle, reach = 2 * math.pi * k / wall["n_segments"] + side, radius / math.cos(half)
                x, y = reach * math.cos(angle), reach * math.sin(angle)
                corners += [Vector3(x, y, INPUT["rim"] + z) for z in (0.0, wall["height"])]
        body = polyhedra_utils.polyhedra(segment, v=corners, fixed=True)
        body.mask = ANY | SEGMENT
        numbers.append(O.bodies.append(body))
    return numbers


def set_engines():
    """Contacts by overlapping volume, gravity, local damping."""
    O.engines = [
        wrapper.ForceResetter(),
        wrapper.InsertionSortCollider(
            [wrapper.Bo1_Polyhedra_Aabb(), wrapper.Bo1_Wall_Aabb()],
            verletDist=INPUT["skin"],
            avoidSelfInteractionMask=SEGMENT,
        ),
        wrapper.InteractionLoop(
            [
                wrapper.Ig2_Wall_Polyhedra_PolyhedraGeom(),
                wrapper.Ig2_Polyhedra_Polyhedra_PolyhedraGeom(),
            ],
            [wrapper.Ip2_PolyhedraMat_PolyhedraMat_PolyhedraPhys()],
            [wrapper.Law2_PolyhedraGeom_PolyhedraPhys_Volumetric()],
        ),
        wrapper.NewtonIntegrator(gravity=(0.0, 0.0, -INPUT["gravity"]), damping=INPUT["damping"]),
    ]
    O.dt = INPUT["time_step"]


class Test:
    """Where the test stands."""

    def __init__(self, grains, first, segments):
        self.grains, self.first, self.segments = grains, first, segments
        self.phase, self.time, self.rim = INPUT["phase"], INPUT["time"], INPUT["rim"]
        self.began, self.calm_since = self.time, None
        self.number, self.next_picture = INPUT["number"], self.time

    def advance(self):
        """A look's worth of steps; whether the test goes on."""
        plan = INPUT["plan"]
        steps = max(1, round(plan["look"] / O.dt))
        if self.phase == "lift":
            self.set_lift(plan["lift_speed"])
        O.run(steps, wait=True)
        self.time += steps * O.dt
        if self.phase == "lift":
            self.rim += steps * O.dt * plan["lift_speed"]
        if self.phase == "fill":
            self.limit_speed(plan["max_fill_speed"])
        going = self.go_on(plan)
        if self.time >= self.next_picture or not going:
            self.next_picture = self.time + plan["picture"]
            self.write(going)
        return going

    def go_on(self, plan):
        """Move on to the next phase where this one is over; whether the test goes on."""
        kinetic = self.kinetic()
        calm = kinetic < plan["rest_energy"]
        self.calm_since = (self.calm_since if self.calm_since is not None else self.time) if calm else None
        still = calm and self.time - self.calm_since >= plan["rest_time"]
        late = self.time - self.began
        if self.phase == "fill" and (still or late > plan["max_fill_time"]):
            self.enter("settle")
        elif self.phase == "settle" and (still or late > plan["max_rest_time"]):
            self.enter("lift")
        elif self.phase == "lift" and (self.is_clear() or late > plan["max_lift_time"]):
            self.set_lift(0.0)
            self.remove_tube()
            self.enter("rest")
        elif self.phase == "rest" and (still or late > plan["max_rest_time"]):
            self.at_rest = still
            return False
        return True

    def enter(self, phase):
        self.phase, self.began, self.calm_since = phase, self.time, None

    def set_lift(self, speed):
        for number in self.segments:
            O.bodies[number].state.vel = Vector3(0.0, 0.0, speed)

    def remove_tube(self):
        """Far up and out of the way; a body that is erased would leave contacts behind."""
        for number in self.segments:
            O.bodies[number].state.pos += Vector3(0.0, 0.0, GONE * INPUT["tube"]["height"])

    def is_clear(self):
        reach = INPUT["plan"]["reach"]
        return self.rim > max(O.bodies[number].state.pos[2] for number in self.grains) + reach

    def limit_speed(self, max_fill_speed):
        for number in self.grains:
            state = O.bodies[number].state
            speed = state.vel.norm()
            if speed > max_fill_speed:
                state.vel *= max_fill_speed / speed

    def kinetic(self):
        """Mean kinetic energy of a particle."""
        total = 0.0
        for number in self.grains:
            state = O.bodies[number].state
            spin = state.ori.inverse() * state.angVel
            turning = sum(state.inertia[axis] * spin[axis] ** 2 for axis in range(3))
            total += 0.5 * (state.mass * state.vel.squaredNorm() + turning)
        return total / len(self.grains)

    def potential(self):
        """Mean energy of height of a particle."""
        heights = sum(O.bodies[n].state.mass * O.bodies[n].state.pos[2] for n in self.grains)
        return INPUT["gravity"] * heights / len(self.grains)

    def write(self, going):
        """One state, whole or not at all."""
        rows = []
        for number, first in zip(self.grains, self.first):  # noqa: B905  YADE's Python may be older
            state = O.bodies[number].state
            turn = state.ori * first
            rows.append([*state.pos, turn[3], turn[0], turn[1], turn[2], *state.vel, *state.angVel])
        content = {
            "phase": self.phase,
            "time": self.time,
            "rim": self.rim,
            "kinetic": self.kinetic(),
            "potential": self.potential(),
            "steps": O.iter,
            "last": not going,
            "at_rest": not going and self.at_rest,
            "particles": rows,
        }
        fresh = FOLDER / "state.new"
        fresh.write_text(json.dumps(content), encoding="utf-8")
        fresh.replace(FOLDER / f"state.{self.number:06d}.json")
        self.number += 1


log.setLevel("Polyhedra_support.cpp", log.ERROR)  # else it warns at the first touch of every pair
GRAINS, FIRST = add_particles()
TEST = Test(GRAINS, FIRST, add_walls())
set_engines()
if TEST.phase == "rest":
    TEST.remove_tube()
while TEST.advance():
    pass
