"""Heaps on the cylinder test: rest, contacts, threads, time step, gravity; and poured or tapped dice."""

import tempfile
from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import ConvexHull
from scipy.stats import t
from scipy.stats.qmc import Sobol

from regolith_studio.dataset.parameters import GRAVITIES, ContactParameters, LiftingCylinderTest
from regolith_studio.dem.angle_of_repose import measure_repose
from regolith_studio.dem.case import PreparedCase, ReposeCase, prepare
from regolith_studio.dem.engine import SimulationResult
from regolith_studio.dem.engine_process import run_engine
from regolith_studio.dem.evaluation.section import NotAPileError
from regolith_studio.dem.heap_packing import within_particles
from regolith_studio.dem.lifting_cylinder import (
    LiftingRun,
    advance_to_look,
    engine_state,
    fill_cylinder,
    lift_cylinder,
    particles_of,
    resume_lifting,
    simulate_lifting,
)
from regolith_studio.dem.run_io import SNAPSHOTS
from regolith_studio.dem.separation import overlap_depths
from regolith_studio.dem.snapshot import EngineState
from regolith_studio.dem.verification import MeasuredLine, VerifiableEngine, timed
from regolith_studio.dem.verification.bodies import DIAMETER, polyhedra_dataset
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.steps import as_events

N_PARTICLES, SEEDS = 500, (0, 1, 2, 3, 4)
AFTER_REST = 100.0
"""Time for which a settled heap is watched, in sqrt(d/g)."""
MAX_MEDIAN, MAX_QUANTILE, QUANTILE = 1e-3, 1e-2, 0.9
"""Maximum of the median displacement and of a quantile of it in mean diameters, and that quantile."""
DEEP, DEEPEST, MAX_DEEP_SHARE = 0.02, 0.05, 0.01
"""Depth of a contact in mean diameters above which it is deep, depth that none has, and share of the deep."""
EARTH, MOON = GRAVITIES["Earth"], GRAVITIES["Moon"]
CONFIDENCE = 0.95
AnglePair = tuple[float, float]


def heap_case(seed: int, gravity: float = EARTH) -> PreparedCase:
    """The cylinder test of Table 2 with 500 polyhedra; it is lifted at the same Froude number everywhere."""
    usual = LiftingCylinderTest()
    speed = usual.lift_speed * float(np.sqrt(gravity / usual.gravity))
    test = replace(usual, gravity=gravity, lift_speed=speed)
    return prepare(polyhedra_dataset(), ReposeCase(test, n_particles=N_PARTICLES, seed=seed))


@dataclass(frozen=True, eq=False)
class LiftedHeap:
    """A heap at rest: its run, whose solver can go on, the state of its filling, and the result."""

    run: LiftingRun
    filled: EngineState
    result: SimulationResult


@dataclass(eq=False)
class HeapRuns:
    """Heaps of one engine with its usual settings, each simulated once for all lines that need it."""

    engine: VerifiableEngine
    further_pairs: Callable[[], Generator[None, None, list[AnglePair]]] | None = None
    """:func:`step_pair` of all seeds after the first, where other processes compute them."""
    first: LiftedHeap | None = None
    known_pairs: list[AnglePair] | None = None

    def lifted(self) -> Generator[None, None, LiftedHeap]:
        """The heap of the first seed."""
        if self.first is None:
            self.first = yield from _lifted(self.engine, SEEDS[0])
        return self.first

    def pairs(self) -> Generator[None, None, list[AnglePair]]:
        """:func:`step_pair` of all seeds."""
        if self.known_pairs is None:
            pairs = [(yield from _with_half_step(self.engine, (yield from self.lifted())))]
            if self.further_pairs is not None:
                pairs += yield from self.further_pairs()
            else:
                for seed in SEEDS[1:]:
                    pairs.append((yield from step_pair(self.engine, seed)))
            self.known_pairs = pairs
        return self.known_pairs


@timed
def settled_heap(runs: HeapRuns) -> Generator[None, None, MeasuredLine]:
    """How far particles of a heap at rest move."""
    run = (yield from runs.lifted()).run
    before, end = run.solver.points.copy(), run.solver.time + AFTER_REST
    while run.solver.time < end:
        advance_to_look(run.solver)
        yield
    displacements = np.linalg.norm(run.solver.points - before, axis=1)
    median, quantile = float(np.median(displacements)), float(np.quantile(displacements, QUANTILE))
    return MeasuredLine(
        key="rest",
        what="Median displacement in a settled heap of 500 during 100 √(d/g)",
        value=median,
        unit="d",
        band=f"at most {MAX_MEDIAN:g} d, and 90 % within {MAX_QUANTILE:g} d",
        passed=median <= MAX_MEDIAN and quantile <= MAX_QUANTILE,
        note=f"90 % within {quantile:.2g} d",
    )


@timed
def contacts(runs: HeapRuns) -> Generator[None, None, MeasuredLine]:
    """How deep the polyhedra of a heap at rest overlap, by separating axes, not as the engine reports it."""
    prepared = heap_case(0)
    heap = (yield from runs.lifted()).result.particles
    depths = overlap_depths(prepared, heap) / prepared.mean_diameter
    deep, deepest = float((depths > DEEP).mean()) if len(depths) else 0.0, float(depths.max(initial=0.0))
    return MeasuredLine(
        key="contacts",
        what="Contacts at rest that are deeper than 0.02 d, by separating axes",
        value=100 * deep,
        unit="%",
        band=f"at most {100 * MAX_DEEP_SHARE:g} %, and none deeper than {DEEPEST:g} d",
        passed=deep <= MAX_DEEP_SHARE and deepest <= DEEPEST,
        note=f"the deepest {deepest:.2g} d",
    )


@timed
def repeats(runs: HeapRuns) -> Generator[None, None, MeasuredLine]:
    """Whether the same seed gives the same heap to the last byte on two threads, in another process."""
    first, prepared = (yield from runs.lifted()).result.particles, heap_case(SEEDS[0])
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / SNAPSHOTS).mkdir()
        running = run_engine(runs.engine.key, prepared, runs.engine.Settings(), Path(folder), threads=2)
        again = (yield from _turns(running)).particles
    apart = float(np.abs(again.points - first.points).max())
    return MeasuredLine(
        key="repeats",
        what="Largest difference of two heaps of one seed, on one thread and on two",
        value=apart / prepared.mean_diameter,
        unit="d",
        band="none",
        passed=apart == 0.0,
    )


@timed
def half_step(runs: HeapRuns) -> Generator[None, None, MeasuredLine]:
    """The angle with half the time step, of the same filling."""
    return paired_line("half_step", (yield from runs.pairs()))


@timed
def gravities(runs: HeapRuns) -> Generator[None, None, MeasuredLine]:
    """The angle under the gravity of the Moon against that of the Earth, with one step in seconds."""
    pairs = []
    for seed, (on_earth, _) in zip(SEEDS, (yield from runs.pairs()), strict=True):
        pairs.append((on_earth, (yield from angle_on_moon(runs.engine, seed))))
    return paired_line("gravity", pairs)


def angle_on_moon(engine: VerifiableEngine, seed: int) -> Generator[None, None, float]:
    """Angle of the heap of a seed on the Moon, with the step in seconds that it has on the Earth."""
    prepared, usual = heap_case(seed, MOON), engine.Settings()
    # Settings are in sqrt(d/g), which is longer on the Moon.
    shorter = replace(usual, time_step=usual.time_step * (MOON / EARTH) ** 0.5)
    run = LiftingRun(prepared, shorter, engine.solver(prepared, shorter))
    return _angle((yield from _turns(simulate_lifting(run))))


def step_pair(engine: VerifiableEngine, seed: int) -> Generator[None, None, AnglePair]:
    """Angles of the heap of a seed with the usual step and with half of it, of the same filling."""
    return (yield from _with_half_step(engine, (yield from _lifted(engine, seed))))


def _with_half_step(engine: VerifiableEngine, heap: LiftedHeap) -> Generator[None, None, AnglePair]:
    prepared, usual = heap.run.prepared, engine.Settings()
    finer = replace(usual, time_step=usual.time_step / 2)
    again = LiftingRun(prepared, finer, engine.solver(prepared, finer))
    other = yield from _turns(resume_lifting(again, heap.filled))
    return _angle(heap.result), _angle(other)


def _lifted(engine: VerifiableEngine, seed: int) -> Generator[None, None, LiftedHeap]:
    prepared, settings = heap_case(seed), engine.Settings()
    run = LiftingRun(prepared, settings, engine.solver(prepared, settings))
    yield from _turns(fill_cylinder(run))
    filled = engine_state(run)
    return LiftedHeap(run, filled, (yield from _turns(lift_cylinder(run))))


def _turns(steps: Generator[Any, None, Any]) -> Generator[None, None, Any]:
    """The result of a simulation; the caller gets a turn at every snapshot."""
    return as_events(steps, lambda _step: (None,))


def _angle(result: SimulationResult) -> float:
    """Angle of repose in degrees; not a number of what is no heap."""
    try:
        return measure_repose(result.particles.points, result.particles.diameters).angle
    except NotAPileError:
        return float("nan")


COMPARED = {
    "half_step": "Change of the angle of repose with half the time step, same fillings",
    "gravity": "Change of the angle of repose from 9.81 to 1.62 m/s², with one time step",
}


def paired_line(key: str, pairs: Sequence[AnglePair]) -> MeasuredLine:
    """The mean difference of pairs of angles with Student's interval; it passes if that contains zero."""
    measured = np.array([pair for pair in pairs if np.isfinite(pair).all()]).reshape(-1, 2)
    differences = measured[:, 1] - measured[:, 0]
    n = len(differences)
    mean, half, note = None, 0.0, f"{n} heaps with an angle are too few"
    if n >= 2:
        mean = float(differences.mean())
        half = float(t.ppf(0.5 + CONFIDENCE / 2, n - 1) * differences.std(ddof=1) / np.sqrt(n))
        note = f"± {half:.1f}° from {n} heaps"
    return MeasuredLine(
        key=key,
        what=COMPARED[key],
        value=mean,
        unit="°",
        band="its 95 % interval contains 0",
        passed=mean is not None and n == len(pairs) and abs(mean) <= half,
        note=note,
    )


GOLDEN = (1 + np.sqrt(5)) / 2
LOOSE = {"tetrahedra": 0.51, "cubes": 0.54, "octahedra": 0.52, "dodecahedra": 0.51, "icosahedra": 0.50}
CLOSE = {"tetrahedra": 0.64, "cubes": 0.67, "octahedra": 0.64, "dodecahedra": 0.63, "icosahedra": 0.59}
"""Measured solid fractions, +- 0.01."""
MAX_DEVIATION = 0.03
N_DICE, ACROSS, FRICTION = 1000, 10.0, 0.4
"""Dice, diameter of the cylinder in theirs, and friction of plastic on plastic and of the walls."""
MARGIN = 2.0
"""Distance of the region that is measured from wall, bottom and top, in mean diameters."""
# Of as many random points the fraction would scatter by 0.003, a tenth of the band.
N_POINTS = 2**15
N_TAPS, TAP_ACCELERATION, TAP_TIME, PAUSE = 150, 4.0, 1.5, 6.0
"""Taps, each one period of a vertical vibration in the frame of the cylinder, and the pause after it; the
acceleration in g, times in sqrt(d/g)."""


def platonic_solids() -> dict[str, FloatArray]:
    """Vertices of the five, of unit volume, shape (k, 3) each."""
    signs = np.array(np.meshgrid(*[[-1.0, 1.0]] * 3)).reshape(3, 8).T
    pairs = np.array([[0.0, a, b] for a in (-1.0, 1.0) for b in (-1.0, 1.0)])

    def turned(scale: tuple[float, float, float]) -> FloatArray:
        return np.concatenate([np.roll(pairs * scale, k, axis=1) for k in range(3)])

    vertices = {
        "tetrahedra": signs[signs.prod(axis=1) > 0.0],
        "cubes": signs,
        "octahedra": np.concatenate([np.eye(3), -np.eye(3)]),
        "dodecahedra": np.concatenate([signs, turned((0.0, 1 / GOLDEN, GOLDEN))]),
        "icosahedra": turned((0.0, 1.0, GOLDEN)),
    }
    return {name: points / ConvexHull(points).volume ** (1 / 3) for name, points in vertices.items()}


@timed
def loose_dice(engine: VerifiableEngine) -> Generator[None, None, MeasuredLine]:
    """Solid fractions of dice that have settled with all of their friction."""
    return (yield from _dice(engine, "loose_dice"))


@timed
def tapped_dice(engine: VerifiableEngine) -> Generator[None, None, MeasuredLine]:
    """Solid fractions of dice after they were tapped."""
    return (yield from _dice(engine, "tapped_dice"))


def _dice(engine: VerifiableEngine, key: str) -> Generator[None, None, MeasuredLine]:
    fractions = {}
    for name, vertices in platonic_solids().items():
        fractions[name] = yield from dice_fraction(engine, vertices, DICE[key][1])
    return dice_line(key, fractions)


def dice_fraction(engine: VerifiableEngine, vertices: FloatArray, taps: int) -> Generator[None, None, float]:
    """Solid fraction of dice that have settled with all of their friction, and were tapped so many times."""
    run = yield from _settled(engine, vertices)
    for _ in range(taps):
        _tap(run)
        yield
    return _solid_fraction(run)


def dice_case(vertices: FloatArray) -> PreparedCase:
    """Equal dice in a cylinder."""
    volume = N_DICE * np.pi / 6 * DIAMETER**3
    contact = ContactParameters(static_friction=FRICTION, dynamic_friction=FRICTION)
    test = LiftingCylinderTest(
        diameter=ACROSS * DIAMETER,
        mass=float(volume * contact.density),
        wall_friction=FRICTION,
        plate_friction=FRICTION,
    )
    return PreparedCase(
        case=ReposeCase(test, contact, n_particles=N_DICE),
        shapes=(vertices,),
        class_index=np.zeros(N_DICE, dtype=np.int64),
        diameters=np.full(N_DICE, DIAMETER),
        coarse_graining=1.0,
    )


def _settled(engine: VerifiableEngine, vertices: FloatArray) -> Generator[None, None, LiftingRun]:
    """Dice that have come to rest in the cylinder."""
    prepared = dice_case(vertices)
    settings = replace(engine.Settings(), fill_friction=1.0)
    run = LiftingRun(prepared, settings, engine.solver(prepared, settings))
    for _moment in fill_cylinder(run):
        yield
    return run


def _tap(run: LiftingRun) -> None:
    """One period of vibration, and the time in which the dice come to rest."""
    solver, begun = run.solver, run.solver.time
    while (since := solver.time - begun) < TAP_TIME:
        push = TAP_ACCELERATION * np.sin(2 * np.pi * since / TAP_TIME)
        solver.set_gravity(np.array([0.0, 0.0, -1.0 + push]))
        solver.advance(solver.time_step(), 1)
    solver.set_gravity(np.array([0.0, 0.0, -1.0]))
    while solver.time - begun < TAP_TIME + PAUSE:
        advance_to_look(solver)


def _solid_fraction(run: LiftingRun) -> float:
    """Share of quasi-random points inside that lie in a die."""
    particles, d = particles_of(run), run.prepared.mean_diameter
    top = float(np.quantile(particles.points[:, 2], 0.95)) / d
    # Walls order the dice next to them, which the experiment did not count.
    radius, low, high = ACROSS / 2 - MARGIN, MARGIN, top - MARGIN
    places = Sobol(3, scramble=False).random(N_POINTS)
    # The square root spreads the points evenly over the disc.
    across, angle = radius * np.sqrt(places[:, 0]), 2 * np.pi * places[:, 1]
    height = low + (high - low) * places[:, 2]
    points = d * np.column_stack([across * np.cos(angle), across * np.sin(angle), height])
    return float(within_particles(run.prepared, particles, points).mean())


DICE = {
    "loose_dice": ("Solid fraction of poured Platonic dice, largest deviation", 0, LOOSE),
    "tapped_dice": ("Solid fraction of tapped Platonic dice, largest deviation", N_TAPS, CLOSE),
}
"""By line: what is measured, number of taps, and the solid fractions of the experiment."""


def dice_line(key: str, fractions: Mapping[str, float]) -> MeasuredLine:
    """The largest deviation of the solid fractions, by kind of dice, from those of the experiment."""
    what, _, measured = DICE[key]
    worst = max((fractions[name] - measured[name] for name in measured), key=abs)
    each = ", ".join(f"{name} {fractions[name]:.2f} ({value:.2f})" for name, value in measured.items())
    return MeasuredLine(
        key=key,
        what=what,
        value=worst,
        unit="",
        band=f"within {MAX_DEVIATION:g}",
        passed=abs(worst) <= MAX_DEVIATION,
        note=f"{each}; in brackets measured; friction {FRICTION:g}",
    )
