"""Settings of the Rapier engine."""

from dataclasses import dataclass, field

from regolith_studio.dataset.parameters import check_limits
from regolith_studio.dem.lifting_cylinder import LiftingSettings
from regolith_studio.messages import N_


@dataclass(frozen=True)
class RapierSettings(LiftingSettings):
    """Numerics of the contact solver; times in sqrt(d/g).

    ``time_step``: between two searches for contacts; halved once or twice while particles move fast.
    ``iterations``: small steps of the solver in a time step.

    Raises InputError if a value is out of its range.
    """

    time_step: float = field(
        default=0.05, metadata={"label": N_("Time step"), "minimum": 1e-4, "maximum": 0.1, "decimals": 4}
    )
    iterations: int = field(default=8, metadata={"label": N_("Iterations"), "minimum": 1, "maximum": 100})

    def __post_init__(self) -> None:
        check_limits(self, "Rapier setting")
