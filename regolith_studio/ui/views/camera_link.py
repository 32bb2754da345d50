"""Linked cameras: the pose of one view is copied to the others."""

from collections.abc import Callable, Sequence

from numpy.typing import ArrayLike

from regolith_studio.scene.cameras import CameraPose, framing_pose, turned
from regolith_studio.ui.views.protocol import SceneView


class CameraLink:
    """Copies the pose of one view to the others while it is on.

    Parameters
    ----------
    views
        All in one frame of coordinates.
    """

    def __init__(self, views: Sequence[SceneView]) -> None:
        self._views = tuple(views)
        self._linked = True
        self._direction = "isometric"
        for view in self._views:
            view.when_moved(self._follower(view))

    @property
    def linked(self) -> bool:
        """Whether the cameras move together."""
        return self._linked

    def set_linked(self, linked: bool) -> None:
        """Link, to the pose of the first view, or let go."""
        self._linked = linked
        if linked:
            self._spread(self._views[0])

    def frame(self, points: ArrayLike) -> None:
        """Show points whole in every view, from the direction chosen last."""
        for view in self._views:
            width, height = view.widget.width(), view.widget.height()
            view.set_pose(framing_pose(points, self._direction, width / max(height, 1)))

    def look_from(self, direction: str) -> None:
        """Look from a standard direction, at the same point and scale."""
        self._direction = direction
        for view in self._views:
            view.set_pose(turned(view.pose, direction))

    def _follower(self, moved: SceneView) -> Callable[[CameraPose], None]:
        def follow(pose: CameraPose) -> None:
            if self._linked:
                for view in self._views:
                    if view is not moved:
                        view.set_pose(pose)

        return follow

    def _spread(self, source: SceneView) -> None:
        pose = source.pose
        for view in self._views:
            if view is not source:
                view.set_pose(pose)
