"""The lifting-cylinder test on a solver that is stepped from here: fill, settle, lift, rest.

Inside, lengths are in mean diameters d, the density is 1 and gravity is 1; the unit of time is
sqrt(d / g). Friction, shape and the ratio of cohesion to weight are free of units already.
"""

import json
from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from regolith_studio.dataset.parameters import check_limits
from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import (
    MASS,
    RunChecks,
    SimulationResult,
    check_run,
    lowest_corners,
    measure_filling,
)
from regolith_studio.dem.snapshot import PHASES, EngineState, ParticleState, Snapshot, progress_message
from regolith_studio.errors import RegolithError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.messages import N_, Message, Number
from regolith_studio.settings import setting

LOOK = 0.5
"""Simulated time between two samples of the energies and speeds."""
CLEAR = 0.5
"""Distance between rim and pile, in mean diameters, at which the cylinder is removed."""
SETTLE, REST = 8.0, 25.0
"""Expected durations of settling and of coming to rest; LAMMPS settles for so long. The duration of a test is
overestimated: four heaps of 500 on MuJoCo took 67 to 73 of 84 sqrt(d/g)."""
FILLED = 25.0
"""Mean kinetic energy of a particle at which filling ends, in energies at rest: nothing falls any more."""


@dataclass(frozen=True, eq=False)
class Units:
    """From the solver's numbers to SI."""

    length: float
    time: float

    @classmethod
    def of(cls, prepared: PreparedCase) -> "Units":
        """Mean diameter, and the time in which it is about fallen through."""
        length = prepared.mean_diameter
        return cls(length, float(np.sqrt(length / prepared.case.test.gravity)))

    @property
    def speed(self) -> float:
        return self.length / self.time


@dataclass(frozen=True)
class LiftingSettings:
    """Course of the test; times in sqrt(d/g).

    - ``max_fill_speed``: speed limit during filling, in sqrt(g d).
    - ``fill_friction``: share of the friction between particles that acts during filling. The smaller it is,
      the denser is the filling, and the sooner it is at rest.
    - ``rest_energy``: mean kinetic energy of a particle in m g d below which a heap is at rest.
    - ``rest_time``: time for which it must stay below.
    - ``max_rest_time``: maximum time of waiting for rest.
    - ``snapshots``: number of snapshots of a run.
    """

    max_fill_speed: float = setting(6.0, N_("Filling speed"), minimum=0.1, maximum=100.0)
    # Half packs as a rain from a high column does: 1,000 particles fill to 3.0 cm, the paper says 2.5 to 3
    # cm.
    fill_friction: float = setting(0.5, N_("Friction share while filling"), minimum=0.01, maximum=1.0)
    rest_energy: float = setting(4e-4, N_("Energy at rest"), minimum=1e-9, maximum=0.1, decimals=9)
    rest_time: float = setting(3.0, N_("Time at rest"), minimum=0.1, maximum=1000.0)
    max_rest_time: float = setting(60.0, N_("Maximum duration"), minimum=1.0, maximum=1e5)
    snapshots: int = setting(120, N_("Snapshots"), minimum=2, maximum=10_000)


@dataclass(frozen=True)
class SubstepSettings(LiftingSettings):
    """Numerics of a solver that takes small steps between two searches for contacts; times in sqrt(d/g).

    ``time_step``: between two searches for contacts; halved once or twice while particles move fast.
    ``substeps``: small steps of the solver in a time step.

    Raises InputError if a value is out of its range.
    """

    time_step: float = setting(0.05, N_("Time step"), minimum=1e-4, maximum=0.1, decimals=4)
    substeps: int = setting(8, N_("Substeps"), minimum=1, maximum=100)

    def __post_init__(self) -> None:
        check_limits(self, "setting of the solver")


class Solver(Protocol):
    """Particles, plate and cylinder in a solver."""

    top: float
    """Height of the highest particle at the start."""
    phase: str

    @property
    def time(self) -> float: ...

    @property
    def points(self) -> FloatArray:
        """Centres, shape (n, 3)."""
        ...

    @property
    def orientations(self) -> FloatArray:
        """Quaternions (w, x, y, z), shape (n, 4)."""
        ...

    @property
    def rim(self) -> float:
        """Height of the cylinder's lower rim."""
        ...

    def energies(self) -> tuple[float, float]:
        """Potential and kinetic energy of all particles, in units of density, g and d."""
        ...

    def overlaps(self) -> FloatArray:
        """Depths to which particles overlap, shape (m,)."""
        ...

    def begin(self, phase: str) -> None:
        """Set the speed of walls, and the friction and maximum speed of particles; no walls in ``rest``."""
        ...

    def time_step(self) -> float:
        """Step for the next look."""
        ...

    def advance(self, step: float, count: int) -> None:
        """Take steps.

        Raises RegolithError if the solver diverges.
        """
        ...

    def problems(self) -> list[str]:
        """Sentences on what failed."""
        ...

    def notes(self, times: dict[float, float]) -> list[str]:
        """Sentences on the run, from the simulated time with each step."""
        ...

    def place(self, points: FloatArray, orientations: FloatArray) -> None:
        """Put the particles at rest at these centres, shape (n, 3), with these quaternions, shape (n, 4)."""
        ...

    def set_gravity(self, gravity: FloatArray) -> None:
        """Let another gravity act, shape (3,), of length 1 as a rule; on a slope it is not vertical."""
        ...

    def state(self) -> bytes:
        """Everything that is needed to go on."""
        ...

    def load(self, state: bytes) -> None:
        """Go on from a state."""
        ...


NOT_FILLED = (0.0, 0.0)
"""Height and solid fraction of a filling that has not settled yet."""


@dataclass(frozen=True)
class Course:
    """What a test does with the cylinder.

    - ``phases``: in their order; the first two fill the cylinder.
    - ``is_done``: whether a phase is over; the others end when the particles are at rest.
    - ``longest``: duration of a phase after which it ends in any case.
    - ``expected``: duration of the whole test.
    - ``interval``: between two snapshots.
    - ``move_walls``: sets walls and gravity after the solver has begun a phase.
    - ``in_plane``: the particles as they are shown: z up.
    - ``checks``: after the last phase.
    """

    phases: tuple[str, ...]
    is_done: Mapping[str, Callable[["LiftingRun"], bool]]
    longest: Callable[["LiftingRun", str], float]
    expected: Callable[[PreparedCase], float]
    interval: Callable[["LiftingRun"], float]
    move_walls: Callable[["LiftingRun"], None]
    in_plane: Callable[["LiftingRun", ParticleState], ParticleState]
    checks: Callable[["LiftingRun"], RunChecks]


@dataclass(eq=False)
class LiftingRun:
    """A test on its way, with the records of the run."""

    prepared: PreparedCase
    settings: LiftingSettings
    solver: Solver
    course: Course = field(default_factory=lambda: LIFTING)
    units: Units = field(init=False)
    expected: float = field(init=False)
    phase: str = "fill"
    end: float = 0.0
    energy: float = float("inf")
    energy_gain: float = 0.0
    steps: int = 0
    next_picture: float = 0.0
    calm_since: float | None = None
    fill: tuple[float, float] = NOT_FILLED
    times: dict[float, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.units, self.expected = Units.of(self.prepared), self.course.expected(self.prepared)


RECORDS = ("phase", "end", "energy", "energy_gain", "steps", "next_picture", "calm_since", "fill")
"""Fields of a run that its state keeps beside that of the solver."""


def friction_in(phase: str, prepared: PreparedCase, settings: LiftingSettings) -> float:
    """Friction between particles in a phase."""
    share = settings.fill_friction if phase == "fill" else 1.0
    return share * prepared.case.contact.static_friction


def speed_limit(phase: str, prepared: PreparedCase, settings: LiftingSettings) -> float:
    """Maximum speed of particles in a phase, in sqrt(g d)."""
    if phase == "fill":
        return settings.max_fill_speed
    if phase == "rest" or prepared.case.drum is not None:
        return float("inf")
    # small particles that are squeezed out of the foot of the heap would be shot off the plate
    return float(np.sqrt(2.0 * prepared.fill_height / prepared.mean_diameter))


def halved_step(step: float, speeds: FloatArray, max_move: float, smallest_share: float) -> float:
    """The step, halved until 99 in 100 particles move by at most `max_move` mean diameters in it.

    It is never less than `smallest_share` of the step; speeds are in sqrt(g d), shape (n,).
    """
    halvings = np.ceil(np.log2(max(1.0, float(np.quantile(speeds, 0.99)) * step / max_move)))
    return float(step * max(0.5**halvings, smallest_share))


def steps_note(times: dict[float, float]) -> str:
    """Sentence on the steps of a run, from the simulated time with each of them."""
    shares = {step: time / sum(times.values()) for step, time in sorted(times.items(), reverse=True)}
    steps = "; ".join(f"{step:.3g} ({100 * share:.1f} %)" for step, share in shares.items())
    template = N_("Time steps in sqrt(d/g), with their shares of the simulated time, by what moved: {steps}.")
    return Message(template, steps=Number.of_text(steps))


def diverged(time: float, unit: float, step: float) -> RegolithError:
    """Error of a solver at a time in its own units, of `unit` seconds, with a time step of the settings."""
    return RegolithError(
        f"The simulation diverged after {time * unit:.3g} s; take a smaller time step than {step:g}."
    )


def lift_speed(prepared: PreparedCase) -> float:
    """Of the cylinder in sqrt(g d)."""
    return prepared.case.test.lift_speed / Units.of(prepared).speed


# The cross-section of 32 flat walls is 0.3 % larger than the circle's, their corners lie 0.5 % farther out.
N_WALLS = 32


def wall_ring(
    prepared: PreparedCase, height: float, thickness: float
) -> list[tuple[tuple[float, float, float], tuple[float, float, float], float]]:
    """Half edges, centre and turn about z of each box of the cylinder, in mean diameters and radians.

    A box is so wide that it overlaps its neighbours: no gap is between them. In a drum they reach its lid.
    """
    if prepared.case.drum is not None:
        height = max(height, prepared.case.test.height / prepared.mean_diameter)
    radius = prepared.case.test.diameter / 2 / prepared.mean_diameter
    half_width = float((radius + thickness) * np.tan(np.pi / N_WALLS))
    distance = radius + thickness / 2
    angles = (2 * np.pi * np.arange(N_WALLS) / N_WALLS).tolist()
    half = thickness / 2, half_width, height / 2
    return [(half, (distance * float(np.cos(a)), distance * float(np.sin(a)), height / 2), a) for a in angles]


def expected_duration(prepared: PreparedCase) -> float:
    """Of the whole test: what falls is limited to 6 sqrt(g d), and the rim must rise above the pile, which is
    about 0.6 of the filling's height."""
    height = prepared.fill_height / prepared.mean_diameter
    return float(5.0 + 0.22 * height + SETTLE + 0.75 * height / lift_speed(prepared) + REST)


def simulate_lifting(run: LiftingRun) -> Generator[Snapshot, None, SimulationResult]:
    """Run the test from its beginning.

    Raises RegolithError if the solver diverges.
    """
    yield from fill_cylinder(run)
    return (yield from lift_cylinder(run))


def fill_cylinder(run: LiftingRun) -> Generator[Snapshot, None, None]:
    """Let the particles fall into the cylinder and settle there, or take them from an earlier filling.

    The last snapshot is that of the settled filling.
    """
    filling = run.prepared.filling
    _begin(run, PHASES[0] if filling is None else "settle")
    if filling is not None:
        run.solver.place(filling.points / run.units.length, filling.orientations)
    yield _snapshot(run)
    yield from _phases(run, last="settle")


def lift_cylinder(run: LiftingRun) -> Generator[Snapshot, None, SimulationResult]:
    """Go on from a settled filling: lift the cylinder off it, and wait until the heap is at rest."""
    _begin(run, run.course.phases[2])
    yield from _phases(run, last=run.course.phases[-1])
    return _simulation_result(run)


def resume_lifting(run: LiftingRun, state: EngineState) -> Generator[Snapshot, None, SimulationResult]:
    """Go on from a state that a snapshot offered."""
    for name in RECORDS:
        setattr(run, name, state.records[name])
    # A list in JSON, which would not equal NOT_FILLED.
    run.fill = (run.fill[0], run.fill[1])
    run.times = {float(step): time for step, time in state.records["times"].items()}
    run.solver.phase = run.phase
    run.solver.load(state.solver)
    yield from _phases(run, last=run.course.phases[-1], resumed=True)
    return _simulation_result(run)


def _phases(run: LiftingRun, last: str, *, resumed: bool = False) -> Generator[Snapshot, None, None]:
    """From where the run is to the end of the phase `last`."""
    while True:
        done = run.course.is_done.get(run.phase, is_calm)
        if not (resumed and run.steps and done(run)):  # a snapshot comes before this question
            yield from advance(run, done)
        resumed = False
        if run.phase == "settle" and run.fill == NOT_FILLED:  # a state of this very moment knows the filling
            run.fill = measure_filling(run.prepared, particles_of(run))
            yield _snapshot(run)
        if run.phase == last:
            return
        _begin(run, run.course.phases[run.course.phases.index(run.phase) + 1])


def _simulation_result(run: LiftingRun) -> SimulationResult:
    simulated = run.solver.time * run.units.time
    return SimulationResult(
        particles_of(run), run.course.checks(run), run.steps, simulated, tuple(run.solver.notes(run.times))
    )


def _begin(run: LiftingRun, phase: str) -> None:
    run.solver.begin(phase)
    run.phase, run.end = phase, run.solver.time + run.course.longest(run, phase)
    run.calm_since, run.energy = None, float("inf")
    run.course.move_walls(run)


def longest_phase(run: LiftingRun, phase: str) -> float:
    """Duration after which a phase ends in any case."""
    top = run.solver.top
    if phase == "fill":
        return 40.0 + 2.0 * top / run.settings.max_fill_speed
    if phase == "lift":
        return 2.0 * top / lift_speed(run.prepared) + 10.0
    return run.settings.max_rest_time


def advance(run: LiftingRun, done: Callable[[LiftingRun], bool]) -> Generator[Snapshot, None, None]:
    """Step until `done` or the phase is over; `done` is asked and energies are noted once a look."""
    while run.solver.time < run.end:
        step, count = advance_to_look(run.solver)
        run.steps += count
        run.times[step] = run.times.get(step, 0.0) + count * step
        if run.phase in ("settle", "rest"):  # where no wall moves and no speed is limited
            total = sum(mean_energies(run))
            run.energy_gain = max(run.energy_gain, total - run.energy)
            run.energy = total
        if run.solver.time >= run.next_picture:
            run.next_picture = max(run.next_picture + run.course.interval(run), run.solver.time)
            yield _snapshot(run)
        if done(run):
            return


def advance_to_look(solver: Solver) -> tuple[float, int]:
    """Advance a solver by :data:`LOOK`; the step that it took, and how many of them."""
    step = solver.time_step()
    count = max(1, round(LOOK / step))
    solver.advance(step, count)
    return step, count


def mean_energies(run: LiftingRun) -> tuple[float, float]:
    """Potential and kinetic energy of a particle in m g d; m is the mass of one of mean diameter."""
    potential, kinetic = run.solver.energies()
    unit = MASS * len(run.prepared)
    return potential / unit, kinetic / unit


def is_filled(run: LiftingRun) -> bool:
    """Whether no particle falls any more."""
    return mean_energies(run)[1] < FILLED * run.settings.rest_energy


def is_calm(run: LiftingRun) -> bool:
    """Whether the mean kinetic energy has been small for long enough."""
    if mean_energies(run)[1] > run.settings.rest_energy:
        run.calm_since = None
        return False
    if run.calm_since is None:
        run.calm_since = run.solver.time
    return run.solver.time - run.calm_since >= run.settings.rest_time


def _is_clear(run: LiftingRun) -> bool:
    """Whether the rim is above everything."""
    # A whole diameter, since polyhedra reach farther than their equivalent radius.
    reach = run.prepared.diameters / run.units.length
    return bool(run.solver.rim > (run.solver.points[:, 2] + reach).max() + CLEAR)


def _snapshot(run: LiftingRun) -> Snapshot:
    share = min(0.99, run.solver.time / run.expected)
    simulated = run.solver.time * run.units.time
    return Snapshot(
        particles_of(run), share, progress_message(run.phase, simulated), lambda: engine_state(run)
    )


def engine_state(run: LiftingRun) -> EngineState:
    """All that :func:`resume_lifting` needs to go on from here."""
    records = {name: getattr(run, name) for name in RECORDS} | {"times": run.times}
    # A copy as a file gives it back: the run goes on and changes its own records.
    return EngineState(json.loads(json.dumps(records)), run.solver.state())


def particles_of(run: LiftingRun) -> ParticleState:
    """The particles in SI units."""
    removed = run.phase == "rest"
    state = ParticleState(
        points=run.solver.points * run.units.length,
        diameters=run.prepared.diameters,
        orientations=run.solver.orientations,
        class_index=run.prepared.class_index,
        time=run.solver.time * run.units.time,
        wall=float("inf") if removed else run.solver.rim * run.units.length,
        phase=run.phase,
    )
    return run.course.in_plane(run, state)


def _lifting_checks(run: LiftingRun) -> RunChecks:
    rested = run.calm_since is not None and run.solver.time - run.calm_since >= run.settings.rest_time
    return check_run(
        run.solver.points[:, 2],
        run.solver.overlaps(),
        energy_gain=run.energy_gain,
        kinetic_energy=mean_energies(run)[1],
        at_rest=rested,
        filling=run.fill,
        lowest=lowest_corners(run.prepared, particles_of(run)) / run.prepared.mean_diameter,
        problems=run.solver.problems(),
    )


LIFTING: Course = Course(
    phases=PHASES,
    is_done={"fill": is_filled, "lift": _is_clear},
    longest=longest_phase,
    expected=expected_duration,
    interval=lambda run: run.expected / run.settings.snapshots,
    move_walls=lambda _run: None,  # the solver lifts the cylinder
    in_plane=lambda _run, state: state,
    checks=_lifting_checks,
)
