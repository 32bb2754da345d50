"""Rapier (Apache 2): real convex polyhedra, Coulomb friction and restitution, on several threads."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import Availability, EngineCapabilities
from regolith_studio.dem.lifting_cylinder import Solver, SubstepSettings
from regolith_studio.dem.stepped_engine import WITH_SUBSTEPS, SteppedEngine
from regolith_studio.messages import N_

REPRESENTS = EngineCapabilities(
    shape=N_("the convex polyhedra, their edges rounded by 0.5 % of the diameter"),
    cohesion="",
    rolling="",
    **WITH_SUBSTEPS,
)


@dataclass(frozen=True)
class RapierEngine(SteppedEngine):
    """For many particles; needs no program besides its Python package."""

    key: str = "rapier"
    label: str = "Rapier"
    order: int = 1
    licence: str = "Apache-2.0"
    Settings: type[SubstepSettings] = SubstepSettings
    capabilities: EngineCapabilities = REPRESENTS
    seconds_per_step: Mapping[str, float] = field(default_factory={"polyhedra": 10e-6, "spheres": 3e-6}.copy)
    """That of polyhedra measured at 1,000 particles of 20 facets."""
    exponent: float = 0.2
    """Measured up to 100,000 particles, which cost 2.4 times as much a step."""
    further_part: float = 0.5
    """Measured: 2.5 times at four parts."""

    def find(self) -> Availability:
        """Whether the package is installed."""
        return Availability.of(N_("Rapier is not installed; install the package rapier3d."), "rapier3d")

    def solver(self, prepared: PreparedCase, settings: SubstepSettings) -> Solver:
        """Rapier with the particles of a case."""
        from regolith_studio.dem.engines.rapier.simulation import RapierSolver

        return RapierSolver(prepared, settings)


ENGINE = RapierEngine()
