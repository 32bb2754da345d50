"""YADE (GPL-2, a program of its own): the polyhedra with a force that grows with the overlapping volume."""

from collections.abc import Generator
from dataclasses import dataclass

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import Availability, EngineCapabilities, SimulationResult
from regolith_studio.dem.engines.yade.program import YadeSettings, find_yade
from regolith_studio.dem.lifting_cylinder import expected_duration
from regolith_studio.dem.snapshot import Snapshot
from regolith_studio.errors import InputError
from regolith_studio.messages import N_

SECONDS_PER_PARTICLE_AND_STEP = 4e-4
"""Processor time at 150 packed particles of 8 facets, on a machine that others used too."""
REPRESENTS = EngineCapabilities(
    shape=N_("the convex polyhedra themselves"),
    normal=N_("force in proportion to the overlapping volume: neither Hertz nor restitution"),
    tangential=N_(
        "Coulomb friction while sliding, one coefficient (the static one), without contact history"
    ),
    cohesion=N_("none"),
    rolling=N_("none besides that of edges and faces"),
    coarse_graining=N_("by size"),
    missing=N_("Hertz, Mindlin, restitution, cohesion, rolling resistance: qualitative; some 200 particles"),
)


@dataclass(frozen=True)
class YadeEngine:
    """Runs the program ``yade``; nothing of it is loaded here."""

    key: str = "yade"
    label: str = "YADE"
    order: int = 3
    licence: str = "GPL-2.0, run as a separate program"
    Settings: type[YadeSettings] = YadeSettings
    capabilities: EngineCapabilities = REPRESENTS

    def find(self) -> Availability:
        """Whether the program is on the path."""
        return find_yade()

    def seconds(self, prepared: PreparedCase, settings: YadeSettings) -> float:
        """From the cost of a step and the expected length of the phases."""
        from regolith_studio.dem.engines.yade.simulation import TIME, time_step

        steps = expected_duration(prepared) * TIME / time_step(prepared, settings)
        return 3.0 + SECONDS_PER_PARTICLE_AND_STEP * len(prepared) * steps

    def simulate(
        self, prepared: PreparedCase, settings: YadeSettings
    ) -> Generator[Snapshot, None, SimulationResult]:
        """Fill, settle, lift, rest.

        Raises InputError if the case has what YADE's law for polyhedra does not know.
        """
        from regolith_studio.dem.engines.yade.simulation import simulate

        if prepared.case.shapes == "spheres":
            raise InputError("YADE is driven with polyhedra here; take MuJoCo or LAMMPS for spheres.")
        if prepared.surface_energy > 0.0:
            raise InputError("YADE's law for polyhedra has no cohesion; take LAMMPS, or cohesion none.")
        if prepared.case.contact.rolling_friction > 0.0:
            raise InputError("YADE's law for polyhedra has no rolling resistance; take MuJoCo or LAMMPS.")
        return simulate(prepared, settings)


ENGINE = YadeEngine()
