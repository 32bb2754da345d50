"""An engine whose solver is stepped from here, through the course of a test."""

from abc import ABC, abstractmethod
from collections.abc import Generator, Mapping
from dataclasses import dataclass
from typing import Any

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import SimulationResult
from regolith_studio.dem.lifting_cylinder import (
    LIFTING,
    LiftingRun,
    Solver,
    SubstepSettings,
    Units,
    halved_step,
    resume_lifting,
    simulate_lifting,
    steps_note,
)
from regolith_studio.dem.rotating_drum import TURNING
from regolith_studio.dem.snapshot import PHASES, EngineState, Snapshot
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.messages import N_

MAX_MOVE, SMALLEST_SHARE = 0.1, 1 / 4
"""Largest way of all but one in a hundred particles in a step of a solver with substeps, in mean diameters,
and smallest share of the time step that is set."""
REPEATABLE = "Equal seeds give equal bytes on one machine, with any number of threads."
UNION = N_("one body of several convex parts, with mass and inertia of their union")
WITH_SUBSTEPS = {
    "normal": N_("unilateral constraint with restitution; penetration is reported, stiffness is not used"),
    "tangential": N_("Coulomb friction of each patch of contact, one coefficient (the static one)"),
    "coarse_graining": N_("by size"),
    "missing": N_("Hertz and Mindlin stiffness; single precision"),
    "compounds": UNION,
    "drum": N_("a closed ring of boxes and two end plates that turn"),
}
"""Capabilities of all engines with substeps."""


@dataclass(frozen=True)
class SteppedEngine(ABC):
    """An engine of which only the solver is its own.

    - ``seconds_per_step``: processor time of a particle and a step at 1,000 particles, by the kind of their
      shapes.
    - ``exponent``: by which a step of a particle costs more, of the number of particles over 1,000.
    - ``further_part``: cost of a further part of a compound, in that of a convex particle.
    - ``halved_steps``: number of steps over that of steps that are never halved.
    """

    seconds_per_step: Mapping[str, float]
    exponent: float
    further_part: float
    halved_steps: float = 1.0

    @abstractmethod
    def solver(self, prepared: PreparedCase, settings: Any) -> Solver:
        """The solver of a case."""

    def seconds(self, prepared: PreparedCase, settings: Any) -> float:
        """From the cost of a step and the expected length of the phases."""
        course = LIFTING if prepared.case.drum is None else TURNING
        steps = self.halved_steps * course.expected(prepared) / settings.time_step
        parts = 1.0 + self.further_part * prepared.further_parts
        cost = self.seconds_per_step[prepared.case.shapes] * parts * (len(prepared) / 1000) ** self.exponent
        return float(1.0 + cost * len(prepared) * steps)

    def simulate(self, prepared: PreparedCase, settings: Any) -> Generator[Snapshot, None, SimulationResult]:
        """Fill, settle, lift, rest; or fill, settle, level and turn a drum."""
        return simulate_lifting(self._run(prepared, settings))

    def resume(
        self, prepared: PreparedCase, settings: Any, state: EngineState
    ) -> Generator[Snapshot, None, SimulationResult]:
        """Go on from a state."""
        return resume_lifting(self._run(prepared, settings), state)

    def _run(self, prepared: PreparedCase, settings: Any) -> LiftingRun:
        course = LIFTING if prepared.case.drum is None else TURNING
        return LiftingRun(prepared, settings, self.solver(prepared, settings), course)


class SubstepSolver(ABC):
    """A solver that takes small steps between two searches for contacts; it repeats itself on any threads."""

    def __init__(self, prepared: PreparedCase, settings: SubstepSettings) -> None:
        self.prepared, self.settings = prepared, settings
        units = Units.of(prepared)
        self.unit_length, self.unit_time = units.length, units.time
        self.n, self.time, self.phase = len(prepared), 0.0, PHASES[0]

    @abstractmethod
    def speeds(self) -> FloatArray:
        """Of the particles in sqrt(g d), shape (n,)."""

    def time_step(self) -> float:
        """The step that is set, halved until what moves does not go too far in it.

        Not while particles fall into the cylinder: these overlaps are gone when the filling has settled.
        """
        if self.phase == "fill":
            return self.settings.time_step
        return halved_step(self.settings.time_step, self.speeds(), MAX_MOVE, SMALLEST_SHARE)

    def substeps(self, step: float) -> int:
        """Substeps of a step, which stay as long as they are in the step that is set."""
        return max(1, round(self.settings.substeps * step / self.settings.time_step))

    def problems(self) -> list[str]:
        return []

    def notes(self, times: dict[float, float]) -> list[str]:
        return [steps_note(times), REPEATABLE]
