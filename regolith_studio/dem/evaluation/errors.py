"""The error raised for particles that form no pile, and its limits."""

from typing import Literal

from regolith_studio.errors import InputError

Status = Literal["pile", "too few particles", "layer", "column stands", "no flanks", "scattered"]
"""Classification of particles at rest."""

MAX_ANGLE = 60.0
"""Maximum angle in degrees; a steeper heap is a column that has not collapsed."""
MIN_R_SQUARED = 0.7
"""Minimum R squared of the fit of two straight flanks."""
MAX_CURVATURE = 0.5
"""Maximum difference of the slopes at foot and top of a flank, in units of its slope. Measured: 0.8 to 1.4 on
domes, -0.7 to -1.1 on exponential heaps, 0.3 at most on cones of 1,000 balls."""
HEAP_SHARE = 0.6
"""Minimum share of the particles that must lie in the heap."""


class NotAPileError(InputError):
    """The particles form no pile whose angle could be measured.

    Parameters
    ----------
    sentence
        Reason, for the user.
    status
        Reason, for programs and tables.
    """

    def __init__(self, sentence: str, status: Status = "no flanks") -> None:
        super().__init__(sentence)
        self.status: Status = status
