"""Keeps what a view shows framed when the view is resized."""

from regolith_studio.scene.cameras import refitted
from regolith_studio.ui.views.protocol import SceneView


class KeepFramed:
    """Adapts the camera to the aspect ratio of its view.

    What is shown along the shorter side is kept, whatever the user has done with the camera: a body that was
    framed is framed again, and what was looked at closely stays as close.

    Parameters
    ----------
    view
        Tells when its camera was placed and when it was resized.
    """

    def __init__(self, view: SceneView) -> None:
        self._view = view
        self._aspect: float | None = None

    def placed(self) -> None:
        """The camera stands where it should, for the present size of the view."""
        size = self._view.widget.size()
        self._aspect = size.width() / max(size.height(), 1)

    def resized(self) -> None:
        """The view has another size."""
        size, before = self._view.widget.size(), self._aspect
        if before is not None and size.width() and size.height():
            self._view.set_pose(refitted(self._view.pose, before, size.width() / size.height()))
