"""The grains of a segmentation in three dimensions, in the colours that they have in the slices."""

from collections.abc import Set

import numpy as np
from numpy.typing import NDArray

from regolith_studio.imaging.label_surface import LabelSurface
from regolith_studio.imaging.volume import Volume
from regolith_studio.messages import N_
from regolith_studio.scene.cameras import framing_pose
from regolith_studio.scene.grains import show_grains
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import tr, tr_count
from regolith_studio.ui.translation.numbers import number_text
from regolith_studio.ui.views.camera_link import CameraLink
from regolith_studio.ui.views.factory import make_view
from regolith_studio.ui.views.view_frame import ViewFrame

_NONE = np.zeros((0, 3), dtype=np.uint8)


class GrainsView:
    """A view with its title; the camera is placed anew for another volume only.

    Parameters
    ----------
    views
        Backend of three-dimensional views.
    """

    def __init__(self, views: str) -> None:
        self.frame = ViewFrame(make_view(views, current_theme().surroundings), "grains_view")
        self._camera = CameraLink([self.frame.view])
        self._size = np.ones(3)

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self.frame.view.set_surroundings(theme.surroundings)

    def set_volume(self, volume: Volume) -> None:
        """Show the empty box of another volume."""
        self._size = np.array(volume.shape) * volume.voxel_size
        extent = " × ".join(number_text(edge, ".4g" if edge < 1e4 else ".0f") for edge in self._size.tolist())
        self._extent = tr("{edges} µm", edges=extent)
        self.frame.view.set_pose(framing_pose(np.array([np.zeros(3), self._size]), turning=True))
        self.clear()

    def clear(self) -> None:
        """Show the box of the volume alone."""
        self.frame.set_texts(tr("Volume"), self._extent)
        self.frame.view.draw(lambda plotter: show_grains(plotter, None, _NONE, self._size))

    def show(
        self, surface: LabelSurface, colours: NDArray[np.uint8], highlighted: Set[int] = frozenset()
    ) -> None:
        """Show grains.

        Parameters
        ----------
        colours
            RGBA for each label, shape (n_labels + 1, 4).
        highlighted
            Labels that are seen through all others; with none, all are opaque.
        """
        labels = np.minimum(surface.labels, len(colours) - 1)
        rgb = np.ascontiguousarray(colours[labels, :3])
        count = len(np.unique(surface.labels))
        self.frame.set_texts(tr_count(N_("1 grain"), N_("{count} grains"), count), self._extent)
        self.frame.view.draw(lambda plotter: show_grains(plotter, surface, rgb, self._size, highlighted))

    def release(self) -> None:
        """Give graphics memory back."""
        self.frame.view.release()
