"""Settings of the MuJoCo engine."""

from dataclasses import dataclass

from regolith_studio.dataset.parameters import check_limits
from regolith_studio.dem.lifting_cylinder import LiftingSettings
from regolith_studio.messages import N_
from regolith_studio.settings import setting


@dataclass(frozen=True)
class MujocoSettings(LiftingSettings):
    """Numerics of the constraint solver; times in sqrt(d/g).

    - ``time_step``: of the integration.
    - ``contact_steps``: time constant of a contact in time steps: the softness of the constraints.
    - ``iterations``, ``tolerance``: of the conjugate-gradient solver.

    Raises InputError if a value is out of its range.
    """

    time_step: float = setting(0.025, N_("Time step"), minimum=1e-4, maximum=0.1, decimals=4)
    contact_steps: float = setting(2.0, N_("Contact time in steps"), minimum=2.0, maximum=20.0)
    iterations: int = setting(25, N_("Iterations"), minimum=1, maximum=1000)
    tolerance: float = setting(1e-5, N_("Tolerance"), minimum=1e-12, maximum=1e-2, decimals=12)

    def __post_init__(self) -> None:
        check_limits(self, "MuJoCo setting")
