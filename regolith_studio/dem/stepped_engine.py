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
    resume_lifting,
    simulate_lifting,
)
from regolith_studio.dem.rotating_drum import TURNING
from regolith_studio.dem.snapshot import EngineState, Snapshot


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
