"""Rapier (Apache 2): real convex polyhedra, Coulomb friction and restitution, on several threads."""

from collections.abc import Generator
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import Availability, EngineCapabilities, SimulationResult
from regolith_studio.dem.engines.rapier.settings import RapierSettings
from regolith_studio.dem.lifting_cylinder import (
    LiftingRun,
    expected_duration,
    resume_lifting,
    simulate_lifting,
)
from regolith_studio.dem.snapshot import EngineState, Snapshot
from regolith_studio.errors import InputError
from regolith_studio.messages import N_

SECONDS_PER_PARTICLE_AND_STEP = {"polyhedra": 10e-6, "spheres": 3e-6}
"""Of processor time; that of polyhedra measured at 1,000 particles of 20 facets."""
COST_EXPONENT = 0.2
"""Of the number of particles over 1,000: measured up to 100,000, which cost 2.4 times as much a step."""
FURTHER_PART = 0.5
"""Cost of a further part of a compound, in that of a convex particle; measured: 2.5 times at four parts."""

REPRESENTS = EngineCapabilities(
    shape=N_("the convex polyhedra, their edges rounded by 0.5 % of the diameter"),
    normal=N_("unilateral constraint with restitution; penetration is reported, stiffness is not used"),
    tangential=N_("Coulomb friction of each patch of contact, one coefficient (the static one)"),
    cohesion=N_("none"),
    rolling=N_("none besides that of edges and faces"),
    coarse_graining=N_("by size"),
    missing=N_("Hertz and Mindlin stiffness, cohesion, rolling resistance; single precision"),
    compounds=N_("one body of several convex parts, with mass and inertia of their union"),
)


@dataclass(frozen=True)
class RapierEngine:
    """For many particles; needs no program besides its Python package."""

    key: str = "rapier"
    label: str = "Rapier"
    order: int = 1
    licence: str = "Apache-2.0"
    Settings: type[RapierSettings] = RapierSettings
    capabilities: EngineCapabilities = REPRESENTS

    def find(self) -> Availability:
        """Whether the package is installed."""
        try:
            return Availability(version("rapier3d"))
        except PackageNotFoundError:
            return Availability(problem=N_("Rapier is not installed; install the package rapier3d."))

    def seconds(self, prepared: PreparedCase, settings: RapierSettings) -> float:
        """From the cost of a step and the expected length of the phases."""
        steps = expected_duration(prepared) / settings.time_step
        cost = SECONDS_PER_PARTICLE_AND_STEP[prepared.case.shapes] * (
            1.0 + FURTHER_PART * prepared.further_parts
        )
        return 1.0 + cost * len(prepared) * steps * float((len(prepared) / 1000) ** COST_EXPONENT)

    def simulate(
        self, prepared: PreparedCase, settings: RapierSettings
    ) -> Generator[Snapshot, None, SimulationResult]:
        """Fill, settle, lift, rest.

        Raises
        ------
        InputError
            If the case has what the solver does not represent.
        """
        return simulate_lifting(_run(prepared, settings))

    def resume(
        self, prepared: PreparedCase, settings: RapierSettings, state: EngineState
    ) -> Generator[Snapshot, None, SimulationResult]:
        """Go on from a state."""
        return resume_lifting(_run(prepared, settings), state)


def _run(prepared: PreparedCase, settings: RapierSettings) -> LiftingRun:
    if prepared.surface_energy > 0.0:
        raise InputError("Rapier has no cohesion; take LAMMPS, or cohesion none.")
    if prepared.case.contact.rolling_friction > 0.0:
        raise InputError("Rapier has no rolling resistance; take MuJoCo or LAMMPS.")
    from regolith_studio.dem.engines.rapier.simulation import RapierSolver

    return LiftingRun(prepared, settings, RapierSolver(prepared, settings))


ENGINE = RapierEngine()
