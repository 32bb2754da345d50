"""The particle drawn from the edited spectrum, and a gallery of measured and drawn particles."""

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.messages import N_
from regolith_studio.scene import surfaces
from regolith_studio.scene.cameras import framing_pose
from regolith_studio.scene.gallery import gallery_pose, show_gallery
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import tr
from regolith_studio.ui.views.protocol import SceneView
from regolith_studio.ui.views.view_frame import ViewFrame
from regolith_studio.ui.widgets.plots.spectrum_editor import SpectrumEditor

NO_MODEL = N_("The spectrum appears when a model is fitted.")


class LiveShape(QWidget):
    """Spectrum editor and a view of one drawn particle."""

    def __init__(self, view: SceneView) -> None:
        super().__init__()
        self.spectrum = SpectrumEditor(tr(NO_MODEL))
        self.spectrum.setObjectName("model_spectrum")
        self.frame = ViewFrame(view, "drawn")
        self.reset, self.another = QPushButton(tr("Reset the spectrum")), QPushButton(tr("Another particle"))
        self.reset.setObjectName("model_reset_spectrum")
        self.another.setObjectName("model_another")
        buttons = QHBoxLayout()
        buttons.setContentsMargins(8, 0, 8, 6)
        buttons.addWidget(self.reset)
        buttons.addStretch(1)
        buttons.addWidget(self.another)
        left = QVBoxLayout()
        left.addWidget(self.spectrum, 1)
        left.addLayout(buttons)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addLayout(left, 3)
        layout.addWidget(self.frame, 2)
        self._framed = False
        self.show_mesh(None)

    def show_mesh(self, mesh: Mesh | None, detail: str = "", again: bool = False) -> None:
        """Show a drawn particle.

        Parameters
        ----------
        detail
            Second line of the view's title.
        again
            Whether to fit the view, because it is another particle.
        """
        self.another.setEnabled(mesh is not None)
        self.reset.setEnabled(self.spectrum.is_changed())
        self.frame.set_texts(tr("A drawn particle"), detail)
        view = self.frame.view
        if mesh is None:
            view.draw(surfaces.clear)
            self._framed = False
            return
        view.draw(lambda plotter: surfaces.show_fit(plotter, mesh))
        if again or not self._framed:
            size = view.widget.size()
            view.set_pose(framing_pose(mesh.vertices, "isometric", size.width() / max(size.height(), 1)))
            self._framed = True

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self.spectrum.set_theme(theme)
        self.frame.view.set_surroundings(theme.surroundings)
        self.frame.set_colour(theme.fit)


class ShapeGallery(QWidget):
    """Measured particles above drawn ones."""

    def __init__(self, view: SceneView) -> None:
        super().__init__()
        self.frame = ViewFrame(view, "gallery")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.frame)
        self._shown: tuple[tuple[Mesh, ...], tuple[Mesh, ...]] = ((), ())
        self.show_shapes((), ())

    def show_shapes(self, measured: tuple[Mesh, ...], drawn: tuple[Mesh, ...]) -> None:
        """Show both rows at the same scale."""
        words = {
            (True, True): tr("measured above, drawn below"),
            (True, False): tr("measured; draw particles to compare"),
            (False, True): tr("drawn; the source holds no measured particles"),
            (False, False): tr("empty until a model is fitted"),
        }
        self.frame.set_texts(tr("Gallery"), words[bool(measured), bool(drawn)])
        self._shown = (measured, drawn)
        self.frame.view.draw(lambda plotter: show_gallery(plotter, measured, drawn))
        self._frame()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._frame()

    def _frame(self) -> None:
        view = self.frame.view
        width, height = view.widget.width(), view.widget.height()
        view.set_pose(gallery_pose(*self._shown, width / max(height, 1)))

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self.frame.view.set_surroundings(theme.surroundings)
        self.frame.set_colour(theme.particle)
