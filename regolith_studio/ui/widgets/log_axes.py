"""Logarithmic axes that cannot be dragged to where numbers end."""

from typing import Any

DECADES = 300.0
"""Powers of ten that a logarithmic axis may reach; pyqtgraph raises ten to the ends of what is seen."""


def set_log_mode(canvas: Any, x: bool, y: bool) -> None:
    """Make axes of a pyqtgraph plot logarithmic or linear, and keep logarithmic ones within the numbers."""
    canvas.setLogMode(x=x, y=y)
    across, up = DECADES if x else None, DECADES if y else None
    canvas.setLimits(
        xMin=None if across is None else -across, xMax=across, yMin=None if up is None else -up, yMax=up
    )
