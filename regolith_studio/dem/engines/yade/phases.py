"""How long the phases of a test last, in units of sqrt(d / g)."""

import numpy as np

from regolith_studio.dem.case import Prepared

FALL, SETTLE, REST = 18.0, 4.0, 12.0


def expected_duration(prepared: Prepared) -> float:
    """Of the whole test; the rim must rise above the pile, which is about 0.6 of the filling's height."""
    speed = prepared.case.test.lift_speed / np.sqrt(prepared.case.test.gravity * prepared.mean_diameter)
    lift = 0.75 * prepared.fill_height / prepared.mean_diameter / speed
    return float(FALL + SETTLE + lift + REST)
