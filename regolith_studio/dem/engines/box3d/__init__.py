"""Box3D (MIT): convex polyhedra with friction, restitution and rolling resistance, on several threads."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.cohesion import PULL_OFF
from regolith_studio.dem.engine import Availability, EngineCapabilities
from regolith_studio.dem.lifting_cylinder import Solver, SubstepSettings
from regolith_studio.dem.stepped_engine import WITH_SUBSTEPS, SteppedEngine
from regolith_studio.errors import InputError
from regolith_studio.messages import N_

MAX_VERTICES = 84
"""Box3D's hulls have at most 126 edges, which are two thirds as many vertices; of more points it may search
for a hull for ever."""
REPRESENTS = EngineCapabilities(
    shape=N_("the convex polyhedra themselves, of at most 44 facets"),
    cohesion=PULL_OFF,
    rolling=N_("resistance to rolling and spinning"),
    **WITH_SUBSTEPS,
)


@dataclass(frozen=True)
class Box3dEngine(SteppedEngine):
    """For heaps that come wholly to rest, and for rolling resistance."""

    key: str = "box3d"
    label: str = "Box3D"
    order: int = 2
    licence: str = "MIT"
    Settings: type[SubstepSettings] = SubstepSettings
    capabilities: EngineCapabilities = REPRESENTS
    seconds_per_step: Mapping[str, float] = field(default_factory={"polyhedra": 10e-6, "spheres": 3e-6}.copy)
    exponent: float = 0.1
    further_part: float = 0.5

    def find(self) -> Availability:
        """Whether the package is installed."""
        return Availability.of(N_("Box3D is not installed; install the package robox3d."), "robox3d")

    def check(self, prepared: PreparedCase) -> None:
        """Check shapes and frictions."""
        case = prepared.case
        if prepared.are_compounds and case.is_cohesive:
            raise InputError("Box3D has cohesion between convex particles only; take cohesion none.")
        if case.contact.static_friction == 0.0 < max(case.test.wall_friction, case.test.plate_friction):
            raise InputError(
                "Box3D takes the geometric mean of two frictions, so that wall and plate have none where the "
                "particles have none; take Rapier or MuJoCo, or a friction above 0."
            )
        most = max(len(part) for parts in prepared.part_vertices for part in parts)
        if case.shapes == "polyhedra" and most > MAX_VERTICES:
            raise InputError(
                f"Box3D takes convex polyhedra of at most 44 facets (126 edges), and one with {most} "
                f"vertices has more; take fewer facets, or another engine."
            )

    def solver(self, prepared: PreparedCase, settings: SubstepSettings) -> Solver:
        """Box3D with the particles of a case."""
        from regolith_studio.dem.engines.box3d.simulation import Box3dSolver

        return Box3dSolver(prepared, settings)


ENGINE = Box3dEngine()
