"""Settings of the MuJoCo engine, and the expected duration of a test."""

from dataclasses import dataclass, field

import numpy as np

from regolith_studio.dataset.parameters import check_limits
from regolith_studio.dem.case import PreparedCase
from regolith_studio.messages import N_


@dataclass(frozen=True)
class MujocoSettings:
    """Numerics of the constraint solver; times in sqrt(d/g).

    Parameters
    ----------
    time_step
        Of the integration.
    contact_steps
        Time constant of a contact in time steps: the softness of the constraints.
    iterations, tolerance
        Of the conjugate-gradient solver.
    max_fill_speed
        Speed limit during filling, in sqrt(g d).
    rest_energy
        Mean kinetic energy of a particle, in units of its weight times d, below which a heap is at rest.
    rest_time
        Time for which it must stay below.
    max_rest_time
        Maximum time of waiting for rest.
    snapshots
        Number of snapshots of a run.

    Raises
    ------
    InputError
        If a value is out of its range.
    """

    time_step: float = field(
        default=0.025, metadata={"label": N_("Time step"), "minimum": 1e-4, "maximum": 0.1, "decimals": 4}
    )
    contact_steps: float = field(
        default=2.0, metadata={"label": N_("Contact time in steps"), "minimum": 2.0, "maximum": 20.0}
    )
    iterations: int = field(default=25, metadata={"label": N_("Iterations"), "minimum": 1, "maximum": 1000})
    tolerance: float = field(
        default=1e-5, metadata={"label": N_("Tolerance"), "minimum": 1e-12, "maximum": 1e-2, "decimals": 12}
    )
    max_fill_speed: float = field(
        default=6.0, metadata={"label": N_("Filling speed"), "minimum": 0.1, "maximum": 100.0}
    )
    rest_energy: float = field(
        default=2e-4, metadata={"label": N_("Energy at rest"), "minimum": 1e-9, "maximum": 0.1, "decimals": 9}
    )
    rest_time: float = field(
        default=3.0, metadata={"label": N_("Time at rest"), "minimum": 0.1, "maximum": 1000.0}
    )
    max_rest_time: float = field(
        default=60.0, metadata={"label": N_("Longest wait"), "minimum": 1.0, "maximum": 1e5}
    )
    snapshots: int = field(default=120, metadata={"label": N_("Snapshots"), "minimum": 2, "maximum": 10_000})

    def __post_init__(self) -> None:
        check_limits(self, "MuJoCo setting")


FALL = 25.0
SETTLE = 6.0
REST = 18.0


def lift_duration(prepared: PreparedCase) -> float:
    """Until the rim is above the pile, which is about 0.6 of the filling's height."""
    speed = prepared.case.test.lift_speed / np.sqrt(prepared.case.test.gravity * prepared.mean_diameter)
    return float(0.75 * prepared.fill_height / prepared.mean_diameter / speed)


def expected_duration(prepared: PreparedCase) -> float:
    """Of the whole test."""
    return FALL + SETTLE + lift_duration(prepared) + REST
