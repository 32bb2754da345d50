"""How long the phases of a test last, in units of sqrt(d / g)."""

import numpy as np

from regolith_studio.dem.case import Prepared

FALL = 25.0
SETTLE = 6.0
REST = 18.0


def lift_duration(prepared: Prepared) -> float:
    """Until the rim is above the pile, which is about 0.6 of the filling's height."""
    speed = prepared.case.test.lift_speed / np.sqrt(prepared.case.test.gravity * prepared.mean_diameter)
    return float(0.75 * prepared.fill_height / prepared.mean_diameter / speed)


def expected_duration(prepared: Prepared) -> float:
    """Of the whole test."""
    return FALL + SETTLE + lift_duration(prepared) + REST
