"""MuJoCo (Apache 2): real convex polyhedra, Coulomb friction, a constraint solver in place of a stiffness."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.cohesion import PULL_OFF
from regolith_studio.dem.engine import Availability, EngineCapabilities
from regolith_studio.dem.engines.mujoco.settings import MujocoSettings
from regolith_studio.dem.lifting_cylinder import Solver
from regolith_studio.dem.stepped_engine import UNION, SteppedEngine
from regolith_studio.messages import N_

REPRESENTS = EngineCapabilities(
    shape=N_("the convex polyhedra themselves"),
    normal=N_("unilateral constraint without restitution; penetration is reported, stiffness is not used"),
    tangential=N_("Coulomb friction in an elliptic cone, one coefficient (the static one)"),
    cohesion=PULL_OFF,
    rolling=N_("Coulomb friction against rolling and spinning"),
    coarse_graining=N_("by size; scaling the surface energy keeps cohesion over weight"),
    missing=N_("Hertz and Mindlin stiffness, restitution, different static and dynamic friction"),
    compounds=UNION,
)


@dataclass(frozen=True)
class MujocoEngine(SteppedEngine):
    """The default engine; needs no program besides its Python package."""

    key: str = "mujoco"
    label: str = "MuJoCo"
    order: int = 0
    licence: str = "Apache-2.0"
    Settings: type[MujocoSettings] = MujocoSettings
    capabilities: EngineCapabilities = REPRESENTS
    seconds_per_step: Mapping[str, float] = field(default_factory={"polyhedra": 18e-6, "spheres": 6e-6}.copy)
    """Measured on one core at 1,000 particles of 20 facets."""
    exponent: float = 0.3
    """Measured from 300 to 5,000 particles, which cost 1.6 times as much a step."""
    further_part: float = 0.15
    """Measured: 1.4 times at four parts."""
    halved_steps: float = 2.5
    """Measured: 2.1 to 2.5 at 300 particles, 2.8 at 1,000."""

    def find(self) -> Availability:
        """Whether the package is installed."""
        return Availability.of(
            N_("MuJoCo is not installed; install the package mujoco-core."), "mujoco-core", "mujoco"
        )

    def solver(self, prepared: PreparedCase, settings: MujocoSettings) -> Solver:
        """MuJoCo with the particles of a case."""
        from regolith_studio.dem.engines.mujoco.simulation import MujocoSolver

        return MujocoSolver(prepared, settings)


ENGINE = MujocoEngine()
