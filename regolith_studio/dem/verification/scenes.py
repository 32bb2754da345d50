"""Single bodies on the plate: friction on an incline, sliding, a fall and a stack. Units as in the solver:
mean diameter d, density 1, gravity 1, time sqrt(d/g)."""

from collections.abc import Generator

import numpy as np
from scipy.spatial.transform import Rotation

from regolith_studio.dem.engine import MASS
from regolith_studio.dem.lifting_cylinder import Solver, advance_to_look
from regolith_studio.dem.verification import MeasuredLine, VerifiableEngine, timed
from regolith_studio.dem.verification.bodies import cuboid, lowest_heights, random_polyhedron, scene
from regolith_studio.geometry.arrays import FloatArray

FRICTIONS = (0.2, 0.5, 0.8)
SLAB = (2.0, 2.0, 1.0)
"""Ratios of the edges of the body that slides: so flat that it does not tip over at any of the slopes."""
N_SLABS, SPACING = 8, 4.0
"""Slabs of a scene, each turned about the vertical by another angle, and their distance."""
TOLERANCES = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0)
"""Degrees beyond and below arctan(friction) at which it is tried whether slabs slide."""
MAX_TILT_ERROR, MAX_FRICTION_ERROR, MAX_ENERGY_RISE = 0.2, 0.02, 1e-3
SETTLING, WATCHED = 5.0, 20.0
"""Time in which contacts come into balance, and after it that in which slabs are watched."""
STEEP = 50.0
"""Slope in degrees on which all slabs slide."""
SLIDING = 10.0
FALL_HEIGHT, FALL_TIME, N_FALLS = 1.0, 30.0, 5
STACKED, STACK_TIME = 5, 100.0
STANDS = 0.1
"""Distance by which no box of a stack that stands has moved."""


@timed
def incline(engine: VerifiableEngine) -> Generator[None, None, MeasuredLine]:
    """Whether a flat polyhedron slides beyond and holds below arctan(friction)."""
    worst: float | None = 0.0
    for friction in FRICTIONS:
        critical = float(np.degrees(np.arctan(friction)))
        for tolerance in TOLERANCES:
            worst = max(worst or 0.0, tolerance)
            below = _slid(engine, friction, critical - tolerance)
            yield
            beyond = _slid(engine, friction, critical + tolerance)
            yield
            # a slab that slides as it should covers this way; what only creeps does not
            way = 0.5 * np.sin(np.radians(tolerance)) / np.cos(np.radians(critical)) * WATCHED**2
            if below.max() < 0.25 * way < 0.5 * way < beyond.min():
                break
        else:
            worst = None
            break
    return MeasuredLine(
        key="incline",
        what="A flat polyhedron on an incline slides beyond and holds below arctan μ (μ = 0.2, 0.5, 0.8)",
        value=worst,
        unit="°",
        band=f"within {MAX_TILT_ERROR:g}°",
        passed=worst is not None and worst <= MAX_TILT_ERROR,
        note="" if worst is not None else f"more than {TOLERANCES[-1]:g}° off",
    )


def _slid(engine: VerifiableEngine, friction: float, degrees: float) -> FloatArray:
    """Way of each slab down a slope in :data:`WATCHED`, shape (n,)."""
    solver = _slabs(engine, friction, degrees)
    _run(solver, SETTLING)
    before = solver.points.copy()
    _run(solver, WATCHED)
    return np.asarray((solver.points - before)[:, 0])


def _slabs(engine: VerifiableEngine, friction: float, degrees: float) -> Solver:
    """Slabs that lie flat on a slope down x, released at rest."""
    prepared = scene([cuboid(*SLAB)], friction, N_SLABS)
    solver = engine.solver(prepared, engine.Settings())
    places = np.column_stack([np.zeros(N_SLABS), SPACING * np.arange(N_SLABS), lowest_heights(prepared)])
    turns = Rotation.from_euler("z", np.linspace(0.0, 90.0, N_SLABS)[:, None], degrees=True)
    slope = np.radians(degrees)
    _place(solver, places, turns, np.array([np.sin(slope), 0.0, -np.cos(slope)]))
    return solver


@timed
def sliding(engine: VerifiableEngine) -> Generator[None, None, MeasuredLine]:
    """The friction that slabs feel which slide down a slope of 50 degrees."""
    errors = []
    slope = np.radians(STEEP)
    for friction in FRICTIONS:
        solver = _slabs(engine, friction, STEEP)
        _run(solver, SLIDING / 2)
        half = solver.points.copy()
        _run(solver, SLIDING / 2)
        yield
        # x(T) - x(T/2) = 3/8 a T^2 from rest; a small shift at the release weighs little in it
        acceleration = (solver.points - half)[:, 0].mean() * 8.0 / 3.0 / SLIDING**2
        effective = np.tan(slope) - acceleration / np.cos(slope)
        errors.append(float(effective / friction - 1.0))
    worst = max(errors, key=abs)
    return MeasuredLine(
        key="sliding",
        what="Effective friction of a flat polyhedron that slides at 50° (μ = 0.2, 0.5, 0.8)",
        value=100 * worst,
        unit="%",
        band=f"within {100 * MAX_FRICTION_ERROR:g} %",
        passed=abs(worst) <= MAX_FRICTION_ERROR,
    )


@timed
def fall(engine: VerifiableEngine) -> Generator[None, None, MeasuredLine]:
    """The largest rise of the energy of a polyhedron that falls on the plate, over several orientations."""
    rise = 0.0
    for seed in range(N_FALLS):
        prepared = scene([random_polyhedron(seed)], 0.5, 1)
        solver = engine.solver(prepared, engine.Settings())
        height = (
            np.linalg.norm(prepared.shapes[0], axis=1).max() * prepared.scales[0] / prepared.mean_diameter
        )
        turn = Rotation.random(1, random_state=seed)
        _place(solver, np.array([[0.0, 0.0, height + FALL_HEIGHT]]), turn, DOWN)
        rise = max(rise, (yield from _energy_rise(solver, FALL_TIME)))
    return _energy_line("fall", "A polyhedron that falls on the plate gains no energy", rise)


@timed
def stack(engine: VerifiableEngine) -> Generator[None, None, MeasuredLine]:
    """Whether a stack of five cubes stands for 100 sqrt(d/g), and gains no energy."""
    prepared = scene([cuboid(1, 1, 1)], 0.5, STACKED)
    solver = engine.solver(prepared, engine.Settings())
    half = lowest_heights(prepared)
    places = np.column_stack([np.zeros(STACKED), np.zeros(STACKED), half * (2 * np.arange(STACKED) + 1)])
    _place(solver, places, Rotation.identity(STACKED), DOWN)
    rise = yield from _energy_rise(solver, STACK_TIME)
    moved = float(np.linalg.norm(solver.points - places, axis=1).max())
    if moved > STANDS:
        return MeasuredLine(
            key="stack",
            what="A stack of five cubes stands for 100 √(d/g)",
            value=moved,
            unit="d",
            band=f"moves by at most {STANDS:g} d",
            passed=False,
        )
    return _energy_line("stack", "A stack of five cubes stands for 100 √(d/g) and gains no energy", rise)


DOWN = np.array([0.0, 0.0, -1.0])


def _energy_line(key: str, what: str, rise: float) -> MeasuredLine:
    return MeasuredLine(
        key=key,
        what=what,
        value=rise,
        unit="m g d",
        band=f"at most {MAX_ENERGY_RISE:g} m g d",
        passed=rise <= MAX_ENERGY_RISE,
    )


def _place(solver: Solver, places: FloatArray, turns: Rotation, gravity: FloatArray) -> None:
    """Put the bodies at rest where they shall begin, without the cylinder."""
    solver.begin("rest")
    solver.place(places, turns.as_quat(scalar_first=True))
    solver.set_gravity(gravity)


def _run(solver: Solver, duration: float) -> None:
    end = solver.time + duration
    # Steps add up to the duration with rounding, after which a further step would count.
    while solver.time < end - 1e-9:
        advance_to_look(solver)


def _energy_rise(solver: Solver, duration: float) -> Generator[None, None, float]:
    """The largest rise of the energy above an earlier value, from step to step, in m g d."""
    lowest, rise, end = float("inf"), 0.0, solver.time + duration
    while solver.time < end:
        solver.advance(solver.time_step(), 1)
        energy = sum(solver.energies())
        lowest = min(lowest, energy)
        rise = max(rise, energy - lowest)
        yield
    return rise / MASS
