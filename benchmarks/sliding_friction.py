"""The friction that boxes feel which slide down a slope on MuJoCo, over settings of the solver.

    python -m benchmarks.sliding_friction [DEGREES] [RESULT.json] [FIRST CASES]

40 boxes, cubes and bricks (3 : 2 : 1.5) that lie flat, of two sizes, on the plate with a friction of 0.8, for
12 sqrt(d/g); three seeds. Felt is tan(slope) - a / (g cos(slope)). A row holds the mean over all boxes, over
cubes and over bricks, the share that has turned by more than 20 degrees, and the number of steps.
"""

import sys
from collections.abc import Mapping, Sequence
from typing import Any

import mujoco
import numpy as np

from benchmarks.result_files import Rows, add_result, show_row
from regolith_studio.dataset.dataset import Dataset, Frame, Representative
from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dataset.size_distributions import DiscreteSizeDistribution
from regolith_studio.dem.case import ReposeCase, prepare
from regolith_studio.dem.engines.mujoco import simulation
from regolith_studio.dem.engines.mujoco.settings import MujocoSettings
from regolith_studio.dem.lifting_cylinder import advance_to_look
from regolith_studio.dem.verification.bodies import cuboid
from regolith_studio.geometry.arrays import FloatArray

FRICTION, DURATION, N_BOXES, SEEDS = 0.8, 12.0, 40, (2, 3, 4)
TUMBLED = 20.0
USUAL = (simulation.MAX_MOVE, simulation.SMALLEST_SHARE)
CASES: Mapping[str, tuple[tuple[float, float], dict[str, Any]]] = {
    "as it is": (USUAL, {}),
    "one step for all speeds": ((1.0, USUAL[1]), {}),
    "steps down to 1/32": ((USUAL[0] / 4, 1 / 32), {}),
    "steps down to 1/128": ((USUAL[0] / 10, 1 / 128), {}),
    "200 iterations, tolerance 1e-9": (USUAL, {"iterations": 200, "tolerance": 1e-9}),
    "Newton's solver": (USUAL, {"solver": mujoco.mjtSolver.mjSOL_NEWTON, "tolerance": 1e-10}),
    "impratio 10": (USUAL, {"impratio": 10.0}),
    "impratio 100": (USUAL, {"impratio": 100.0}),
    "20 noslip iterations": (USUAL, {"noslip_iterations": 20}),
    "pyramidal cone": (USUAL, {"cone": mujoco.mjtCone.mjCONE_PYRAMIDAL}),
}
"""Largest move in a step and smallest share of the step, and options of the solver."""
STIFFNESS: Mapping[str, MujocoSettings] = {
    "contact time of 4 steps": MujocoSettings(contact_steps=4),
    "contact time of 8 steps": MujocoSettings(contact_steps=8),
    "an eighth of the step, contact time of 2": MujocoSettings(time_step=0.025 / 8),
    "an eighth of the step, contact time of 16, exact": MujocoSettings(
        time_step=0.025 / 8, contact_steps=16, iterations=200, tolerance=1e-10
    ),
}
"""Steps that a contact takes, and the step."""


def box_dataset() -> Dataset:
    """Cubes and bricks with two sizes."""
    sizes = DiscreteSizeDistribution.of((80.0, 100.0), (1.0, 1.0))
    frame = Frame(np.eye(3), np.zeros(3), 100.0)
    shapes = {"cube": cuboid(1, 1, 1), "brick": cuboid(3, 2, 1.5)}
    return Dataset("boxes", tuple(Representative(k, v, 0.5, sizes, frame) for k, v in shapes.items()))


def slide(
    degrees: float,
    seed: int,
    options: Mapping[str, Any] | None = None,
    settings: MujocoSettings | None = None,
) -> tuple[FloatArray, FloatArray, FloatArray, dict[float, int]]:
    """What each box feels, its largest turn in degrees, whether it is a brick (each of shape (40,)); and the
    number of steps of each length."""
    test = LiftingCylinderTest(mass=0.003, plate_friction=FRICTION)
    prepared = prepare(box_dataset(), ReposeCase(test, n_particles=N_BOXES, seed=seed))
    solver = simulation.MujocoSolver(prepared, settings or MujocoSettings())
    half = np.array([shape[:, 2].max() for shape in prepared.shapes])[prepared.class_index]
    rows = solver.data.qpos.reshape(-1, 7)
    heights = half * prepared.scales / prepared.mean_diameter
    rows[:, :3] = np.column_stack([np.zeros(N_BOXES), 4.0 * np.arange(N_BOXES), heights])
    rows[:, 3:] = (1.0, 0.0, 0.0, 0.0)
    solver.begin("rest")
    for name, value in (options or {}).items():
        setattr(solver.model.opt, name, value)
    slope = np.radians(degrees)
    solver.model.opt.gravity = (np.sin(slope), 0.0, -np.cos(slope))
    steps: dict[float, int] = {}
    turn = np.zeros(N_BOXES)
    while solver.time < DURATION:
        step, count = advance_to_look(solver)
        steps[step] = steps.get(step, 0) + count
        upright = 1.0 - 2.0 * (rows[:, 4] ** 2 + rows[:, 5] ** 2)
        turn = np.maximum(turn, np.degrees(np.arccos(np.clip(upright, -1.0, 1.0))))
    speed = solver.data.qvel.reshape(-1, 6)[:, 0]
    felt = np.tan(slope) - speed / solver.time / np.cos(slope)
    return felt, turn, np.array(prepared.class_index == 1), steps


def main(degrees: float, result: str, n_cases: int) -> None:
    """Print a row for each of the first cases, and for each stiffness of the contacts."""
    rows: Rows = {}
    for name, (limits, options) in list(CASES.items())[:n_cases]:
        simulation.MAX_MOVE, simulation.SMALLEST_SHARE = limits
        add_row(rows, name, [slide(degrees, seed, options) for seed in SEEDS])
    simulation.MAX_MOVE, simulation.SMALLEST_SHARE = USUAL
    for name, settings in STIFFNESS.items():
        add_row(rows, name, [slide(degrees, seed, None, settings) for seed in SEEDS])
    add_result(result, f"slope of {degrees:g} degrees", rows, seeds=list(SEEDS))


def add_row(rows: Rows, name: str, found: Sequence[tuple[Any, ...]]) -> None:
    """Print a row and keep it."""
    felt, turn, brick = (np.concatenate([each[k] for each in found]) for k in range(3))
    steps = np.mean([sum(each[3].values()) for each in found])
    share = np.mean(turn > TUMBLED)
    values = (felt.mean(), felt[~brick].mean(), felt[brick].mean(), share, steps)
    show_row(rows, name, [float(value) for value in values], 3)


if __name__ == "__main__":
    words = [*sys.argv[1:], *("50", "", str(len(CASES)))[len(sys.argv) - 1 :]]
    main(float(words[0]), words[1], int(words[2]))
