"""MuJoCo (Apache 2): real convex polyhedra, Coulomb friction, a constraint solver in place of a stiffness."""

from collections.abc import Generator
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import Availability, EngineCapabilities, SimulationResult
from regolith_studio.dem.engines.mujoco.settings import MujocoSettings
from regolith_studio.dem.lifting_cylinder import (
    LiftingRun,
    expected_duration,
    resume_lifting,
    simulate_lifting,
)
from regolith_studio.dem.snapshot import EngineState, Snapshot
from regolith_studio.messages import N_

SECONDS_PER_PARTICLE_AND_STEP = {"polyhedra": 18e-6, "spheres": 6e-6}
"""Measured on one core at 1,000 particles of 20 facets."""
COST_EXPONENT = 0.3
"""Of the number of particles over 1,000; measured from 300 to 5,000, which cost 1.6 times as much a step."""
HALVED_STEPS = 2.5
"""Number of steps over that of steps never halved; measured: 2.1 to 2.5 at 300 particles, 2.8 at 1,000."""
FURTHER_PART = 0.15
"""Cost of a further part of a compound, in that of a convex particle; measured: 1.4 times at four parts."""

REPRESENTS = EngineCapabilities(
    shape=N_("the convex polyhedra themselves"),
    normal=N_("unilateral constraint without restitution; penetration is reported, stiffness is not used"),
    tangential=N_("Coulomb friction in an elliptic cone, one coefficient (the static one)"),
    cohesion=N_(
        "pull-off force 3/2 π w R*, shared by the contact points; little effect on a heap: use LAMMPS"
    ),
    rolling=N_("Coulomb friction against rolling and spinning"),
    coarse_graining=N_("by size; scaling the surface energy keeps cohesion over weight"),
    missing=N_("Hertz and Mindlin stiffness, restitution, different static and dynamic friction"),
    compounds=N_("one body of several convex parts, with mass and inertia of their union"),
)


@dataclass(frozen=True)
class MujocoEngine:
    """The default engine; needs no program besides its Python package."""

    key: str = "mujoco"
    label: str = "MuJoCo"
    order: int = 0
    licence: str = "Apache-2.0"
    Settings: type[MujocoSettings] = MujocoSettings
    capabilities: EngineCapabilities = REPRESENTS

    def find(self) -> Availability:
        """Whether the package is installed."""
        for package in ("mujoco-core", "mujoco"):
            try:
                return Availability(version(package))
            except PackageNotFoundError:
                continue
        return Availability(problem=N_("MuJoCo is not installed; install the package mujoco-core."))

    def seconds(self, prepared: PreparedCase, settings: MujocoSettings) -> float:
        """From the cost of a step and the expected length of the phases."""
        steps = HALVED_STEPS * expected_duration(prepared) / settings.time_step
        cost = SECONDS_PER_PARTICLE_AND_STEP[prepared.case.shapes] * (
            1.0 + FURTHER_PART * prepared.further_parts
        )
        return 1.0 + cost * len(prepared) * steps * float((len(prepared) / 1000) ** COST_EXPONENT)

    def simulate(
        self, prepared: PreparedCase, settings: MujocoSettings
    ) -> Generator[Snapshot, None, SimulationResult]:
        """Fill, settle, lift, rest."""
        return simulate_lifting(_run(prepared, settings))

    def resume(
        self, prepared: PreparedCase, settings: MujocoSettings, state: EngineState
    ) -> Generator[Snapshot, None, SimulationResult]:
        """Go on from a state."""
        return resume_lifting(_run(prepared, settings), state)


def _run(prepared: PreparedCase, settings: MujocoSettings) -> LiftingRun:
    from regolith_studio.dem.engines.mujoco.simulation import MujocoSolver

    return LiftingRun(prepared, settings, MujocoSolver(prepared, settings))


ENGINE = MujocoEngine()
