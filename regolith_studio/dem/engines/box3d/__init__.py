"""Box3D (MIT): convex polyhedra with friction, restitution and rolling resistance, on several threads."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version

from regolith_studio.dem.case import PreparedCase
from regolith_studio.dem.engine import Availability, EngineCapabilities
from regolith_studio.dem.lifting_cylinder import Solver, SubstepSettings
from regolith_studio.dem.stepped_engine import SteppedEngine
from regolith_studio.errors import InputError
from regolith_studio.messages import N_

REPRESENTS = EngineCapabilities(
    shape=N_("the convex polyhedra themselves, of at most 44 facets"),
    normal=N_("unilateral constraint with restitution; penetration is reported, stiffness is not used"),
    tangential=N_("Coulomb friction of each patch of contact, one coefficient (the static one)"),
    cohesion=N_("one pull-off force for each pair that touches, none on walls and plate"),
    rolling=N_("resistance to rolling and spinning"),
    coarse_graining=N_("by size"),
    missing=N_("Hertz and Mindlin stiffness; single precision"),
    compounds=N_("one body of several convex parts, with mass and inertia of their union"),
    drum=N_("a closed ring of boxes and two end plates that turn"),
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
        try:
            return Availability(version("robox3d"))
        except PackageNotFoundError:
            return Availability(problem=N_("Box3D is not installed; install the package robox3d."))

    def solver(self, prepared: PreparedCase, settings: SubstepSettings) -> Solver:
        """Box3D with the particles of a case.

        Raises InputError if the case has what the solver does not represent.
        """
        if prepared.surface_energy > 0.0 and prepared.parts and prepared.case.shapes == "polyhedra":
            raise InputError("Box3D has cohesion between convex particles only; take cohesion none.")
        case = prepared.case
        if case.contact.static_friction == 0.0 < max(case.test.wall_friction, case.test.plate_friction):
            raise InputError(
                "Box3D takes the geometric mean of two frictions, so that wall and plate have none where the "
                "particles have none; take Rapier or MuJoCo, or a friction above 0."
            )
        from regolith_studio.dem.engines.box3d.simulation import Box3dSolver

        return Box3dSolver(prepared, settings)


ENGINE = Box3dEngine()
