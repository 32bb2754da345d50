"""LAMMPS (GPL-2, a program of its own): the paper's contact laws on rigid clumps of spheres."""

from collections.abc import Generator
from dataclasses import dataclass

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import Availability, EngineCapabilities, SimulationResult
from regolith_studio.dem.engines.lammps.program import LammpsSettings, find_lammps
from regolith_studio.dem.snapshot import Snapshot
from regolith_studio.messages import N_

SECONDS_PER_SPHERE_AND_STEP = 0.7e-6
"""Measured on one core."""
REPRESENTS = EngineCapabilities(
    shape=N_(
        "rigid clumps of overlapping spheres (12 by default) with the polyhedra's volume, mass and inertia"
    ),
    normal=N_("Hertz with a reduced Young's modulus (recorded) and restitution; approximate with cohesion"),
    tangential=N_("Mindlin with history and Coulomb friction, one coefficient (the static one)"),
    cohesion=N_("Johnson, Kendall and Roberts between spheres"),
    rolling=N_("spring, dashpot and slider (where resistance is above 0)"),
    coarse_graining=N_("by size; scaling the surface energy keeps cohesion over weight"),
    compounds=N_("rigid clumps of spheres that fill the union of the parts, with its mass and inertia"),
    missing=N_("edges, corners and flat faces; different static and dynamic friction"),
)


@dataclass(frozen=True)
class LammpsEngine:
    """Runs the program ``lmp``; nothing of it is loaded here."""

    key: str = "lammps"
    label: str = "LAMMPS"
    order: int = 2
    licence: str = "GPL-2.0, run as a separate program"
    Settings: type[LammpsSettings] = LammpsSettings
    capabilities: EngineCapabilities = REPRESENTS

    def find(self) -> Availability:
        """Whether the program and its MPI library are there."""
        return find_lammps()

    def seconds(self, prepared: PreparedCase, settings: LammpsSettings) -> float:
        """From the cost of a step and the length of the phases."""
        from regolith_studio.dem.engines.lammps.script import schedule

        top = 3.0 * prepared.fill_height / prepared.mean_diameter
        count = 1 if prepared.case.shapes == "spheres" else settings.spheres
        return SECONDS_PER_SPHERE_AND_STEP * count * len(prepared) * schedule(prepared, settings, top).steps

    def simulate(
        self, prepared: PreparedCase, settings: LammpsSettings
    ) -> Generator[Snapshot, None, SimulationResult]:
        """Fill, settle, lift, rest."""
        from regolith_studio.dem.engines.lammps.simulation import simulate

        return simulate(prepared, settings)


ENGINE = LammpsEngine()
