"""Drag handles in a view: the line of a wipe, the plane of a section."""

from collections.abc import Callable

import numpy as np
from PySide6.QtCore import Qt

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.scene.cameras import Projection
from regolith_studio.scene.clipping import SectionPlane
from regolith_studio.scene.comparison import Divider

REACH = 8.0
"""Pixels from what is drawn at which it is still held."""
EDGE = 0.02
"""Share of the picture that the line of a wipe keeps from its edges."""


class DividerGrip:
    """Moves the line of a wipe.

    Parameters
    ----------
    moved
        Told the new share of the picture's width.
    """

    cursor = Qt.CursorShape.SplitHCursor

    def __init__(self, divider: Divider, moved: Callable[[float], None]) -> None:
        self._divider, self._moved = divider, moved

    def is_under_cursor(self, sight: Projection, x: float, y: float) -> bool:  # noqa: ARG002
        """Whether the line is under the mouse."""
        return self._divider.shown and abs(x - self._divider.share * sight.width) <= REACH

    def pull(self, sight: Projection, right: float, down: float) -> None:  # noqa: ARG002
        """Follow the mouse."""
        share = self._divider.share + right / max(sight.width, 1.0)
        self._moved(min(max(share, EDGE), 1.0 - EDGE))


class PlaneGrip:
    """Moves the plane of a section along its normal, held at its frame.

    Parameters
    ----------
    plane
        The plane and the corners of its frame, shape (4, 3), or ``None`` while there is no section.
    moved
        Told the new offset.
    """

    cursor = Qt.CursorShape.SizeAllCursor

    def __init__(
        self,
        plane: Callable[[], tuple[SectionPlane, FloatArray] | None],
        moved: Callable[[float], None],
    ) -> None:
        self._plane, self._moved = plane, moved

    def is_under_cursor(self, sight: Projection, x: float, y: float) -> bool:
        """Whether the frame is under the mouse."""
        known = self._plane()
        if known is None:
            return False
        corners = sight.seen(known[1])
        following = np.roll(corners, -1, axis=0)
        return _distance(np.array([x, y]), corners, following) <= REACH

    def pull(self, sight: Projection, right: float, down: float) -> None:
        """Follow the mouse along the normal."""
        known = self._plane()
        if known is not None:
            self._moved(known[0].offset + sight.along(known[0].normal, right, down))


def _distance(point: FloatArray, starts: FloatArray, ends: FloatArray) -> float:
    """Of a point from the nearest of some line segments in the plane."""
    along = ends - starts
    square = np.maximum(np.einsum("ij,ij->i", along, along), 1e-12)
    share = np.clip(np.einsum("ij,ij->i", point - starts, along) / square, 0.0, 1.0)
    return float(np.linalg.norm(point - starts - share[:, None] * along, axis=1).min())
