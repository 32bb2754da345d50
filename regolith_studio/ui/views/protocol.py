"""The interface of three-dimensional views, independent of the backend."""

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from PySide6.QtWidgets import QWidget

from regolith_studio.scene.cameras import CameraPose
from regolith_studio.scene.palette import ThemeColors
from regolith_studio.ui.views.camera_mouse import CameraMouse

Picture = NDArray[np.uint8]


class SceneView(Protocol):
    """One view. ``draw`` schedules a repaint; calls are coalesced."""

    @property
    def widget(self) -> QWidget:
        """What is placed in the window."""
        ...

    @property
    def pose(self) -> CameraPose:
        """Where the camera stands."""
        ...

    def draw(self, fill: Callable[[Any], None]) -> None:
        """Let `fill` change what the plotter shows, and ask for a new picture."""
        ...

    def set_pose(self, pose: CameraPose) -> None:
        """Move the camera, fit its clipping range, ask for a new picture; tells nobody."""
        ...

    def when_moved(self, callback: Callable[[CameraPose], None]) -> None:
        """Call `callback` with the new pose whenever the user moves the camera."""
        ...

    @property
    def mouse(self) -> CameraMouse:
        """Its ``grips`` can be dragged; ``pointed`` are told where the mouse rests, ``left`` when it left."""
        ...

    def set_surroundings(self, surroundings: ThemeColors) -> None:
        """Change background and inks."""
        ...

    def picture(self) -> Picture:
        """What the view shows now, shape (height, width, 3)."""
        ...

    def shot(self, scale: int = 1, transparent: bool = False) -> Picture:
        """What the view shows at a multiple of its size, shape (height, width, 3), or 4 if transparent.

        Without what is laid out in pixels: the scale bar.
        """
        ...

    def release(self) -> None:
        """Give the graphics memory back; the view is of no use afterwards."""
        ...
