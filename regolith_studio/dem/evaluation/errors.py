"""Where there is no angle of repose, and the sentence that says why."""

from typing import Literal

from regolith_studio.errors import InputError

Status = Literal["pile", "too few particles", "layer", "column stands", "no flanks", "scattered"]
"""What particles that came to rest can be."""

STEEPEST = 60.0
"""Degrees; a steeper heap is a column that has not collapsed."""
STRAIGHTEST_SHARE = 0.7
"""Least share of the surface's variance (R squared) that two straight flanks must explain."""
HEAP_SHARE = 0.6
"""Least share of the particles that must lie in the heap."""


class NotAPileError(InputError):
    """The particles form no pile whose angle could be measured.

    Parameters
    ----------
    sentence
        Why not, for the user.
    status
        The same as a word for programs and tables.
    """

    def __init__(self, sentence: str, status: Status = "no flanks") -> None:
        super().__init__(sentence)
        self.status: Status = status
