"""Packings of Platonic dice against the experiment of Baker and Kudrolli, Phys. Rev. E 82, 061304 (2010).

They fluidised 3 mm to 2 cm plastic dice with water and let them settle (random loose), and shook or tapped
them (random close); the solid fractions were measured inside, away from the walls.
"""

from collections.abc import Generator
from dataclasses import replace

import numpy as np
from scipy.spatial import ConvexHull
from scipy.stats.qmc import Sobol

from regolith_studio.dataset.parameters import ContactParameters, LiftingCylinderTest
from regolith_studio.dem.case import PreparedCase, ReposeCase
from regolith_studio.dem.heap_packing import within_particles
from regolith_studio.dem.lifting_cylinder import LiftingRun, fill_cylinder, particles_of
from regolith_studio.dem.verification import MeasuredLine, VerifiableEngine, timed
from regolith_studio.dem.verification.bodies import DIAMETER
from regolith_studio.geometry.arrays import FloatArray

GOLDEN = (1 + np.sqrt(5)) / 2
LOOSE = {"tetrahedra": 0.51, "cubes": 0.54, "octahedra": 0.52, "dodecahedra": 0.51, "icosahedra": 0.50}
CLOSE = {"tetrahedra": 0.64, "cubes": 0.67, "octahedra": 0.64, "dodecahedra": 0.63, "icosahedra": 0.59}
"""Measured solid fractions, +- 0.01."""
MAX_DEVIATION = 0.03
N_DICE, ACROSS, FRICTION = 1000, 10.0, 0.4
"""Dice, diameter of the cylinder in theirs, and friction of plastic on plastic and of the walls."""
MARGIN = 2.0
"""Distance of the region that is measured from wall, bottom and top, in mean diameters."""
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
    fractions = {}
    for name, vertices in platonic_solids().items():
        run = yield from _settled(engine, vertices)
        fractions[name] = _solid_fraction(run)
    return _line("loose_dice", "Solid fraction of poured Platonic dice, largest deviation", fractions, LOOSE)


@timed
def tapped_dice(engine: VerifiableEngine) -> Generator[None, None, MeasuredLine]:
    """Solid fractions of dice after they were tapped."""
    fractions = {}
    for name, vertices in platonic_solids().items():
        run = yield from _settled(engine, vertices)
        for _ in range(N_TAPS):
            _tap(run)
            yield
        fractions[name] = _solid_fraction(run)
    return _line("tapped_dice", "Solid fraction of tapped Platonic dice, largest deviation", fractions, CLOSE)


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
        step = solver.time_step()
        solver.advance(step, max(1, round(0.5 / step)))


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


def _line(key: str, what: str, fractions: dict[str, float], measured: dict[str, float]) -> MeasuredLine:
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
