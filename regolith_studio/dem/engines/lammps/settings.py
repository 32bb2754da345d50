"""Settings of the LAMMPS engine; where the mean diameter, the density and gravity are 1."""

from dataclasses import dataclass, field

from regolith_studio.dataset.parameters import check_limits
from regolith_studio.messages import N_


@dataclass(frozen=True)
class LammpsSettings:
    """Numerics; times in sqrt(d/g).

    Parameters
    ----------
    spheres
        Inscribed spheres per polyhedron.
    max_stiffness
        Maximum of Young's modulus over rho g d: the real one would need millions of steps. 0: no limit.
    step_share
        Time step as a share of Rayleigh's time of the smallest particle.
    rest
        Time after the lift.
    snapshots
        Number of snapshots of a run.

    Raises
    ------
    InputError
        If a value is out of its range.
    """

    spheres: int = field(default=8, metadata={"label": N_("Spheres a particle"), "minimum": 1, "maximum": 64})
    max_stiffness: float = field(
        default=2e4, metadata={"label": N_("Young's modulus / ρgd"), "minimum": 0.0, "maximum": 1e12}
    )
    step_share: float = field(
        default=0.15, metadata={"label": N_("Step, in Rayleigh's time"), "minimum": 0.01, "maximum": 0.5}
    )
    rest: float = field(default=25.0, metadata={"label": N_("Rest: time"), "minimum": 1.0, "maximum": 1e5})
    snapshots: int = field(default=80, metadata={"label": N_("Snapshots"), "minimum": 2, "maximum": 10_000})

    def __post_init__(self) -> None:
        check_limits(self, "LAMMPS setting")
