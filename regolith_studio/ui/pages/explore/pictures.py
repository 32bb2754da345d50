"""The views as files: a picture of what is seen, an animation of the fit through all degrees."""

from pathlib import Path

from PySide6.QtCore import QObject
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QSpinBox,
    QWidget,
)

from regolith_studio.jobs.events import Job
from regolith_studio.scene.animating import animate
from regolith_studio.scene.figure import three_views, view_titles
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.views.triptych import Triptych

LARGEST_SCALE = 6


class Pictures(QObject):
    """Asks for a file and draws into it.

    Parameters
    ----------
    context
        Of the page.
    triptych
        Whose camera is taken over.
    """

    def __init__(self, context: PageContext, triptych: Triptych, parent: QWidget) -> None:
        super().__init__(parent)
        self._context, self._triptych, self._window = context, triptych, parent

    def save_picture(self) -> None:
        """Ask for scale and file, and write the three views as they are seen."""
        results, entry = self._context.session.results, self._context.session.selected
        if entry is None or results.surface is None or results.coarsened is None:
            self._context.toast.problem("Wait until the three views are drawn.")
            return
        asked = PictureDialog(self._window)
        accepted = asked.exec() == QDialog.DialogCode.Accepted
        scale, transparent = asked.value()
        asked.deleteLater()
        name = self._ask("Save picture", f"{entry.id}.png", "Pictures (*.png)") if accepted else ""
        if not name:
            return
        titles = view_titles(results.surface_l_max, results.coarsened)
        pose = self._triptych.views["particle"].pose
        path = Path(name).with_suffix(".png")
        three_views(
            entry.particle.mesh,
            results.surface,
            results.coarsened,
            titles,
            path,
            scale=scale,
            pose=pose,
            transparent=transparent,
        )
        self._context.toast.note(f"The picture is in {path}.")

    def save_animation(self) -> None:
        """Ask for a file and write the fit growing from degree 0 to 30, in the background."""
        fit, entry = self._context.session.results.fit, self._context.session.selected
        if entry is None or fit is None:
            self._context.toast.problem("Wait until the particle is fitted.")
            return
        name = self._ask("Save animation", f"{entry.id}.gif", "Animations (*.gif)")
        if not name:
            return
        path = Path(name).with_suffix(".gif")
        degrees = tuple(range(fit.l_max + 1))
        job = Job(animate, (entry.particle.mesh, fit, degrees, path))
        told = f"The animation is in {path}."
        self._context.start("Drawing the animation", job, lambda _: self._context.toast.note(told))

    def _ask(self, title: str, name: str, kinds: str) -> str:
        start = str(Path(str(self._context.recall("pictures", Path.home()))) / name)
        chosen, _ = QFileDialog.getSaveFileName(self._window, title, start, kinds)
        if chosen:
            self._context.remember("pictures", str(Path(chosen).parent))
        return chosen


class PictureDialog(QDialog):
    """Asks how large a picture shall be, and whether its background is left out."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Save picture")
        self.setObjectName("picture_dialog")
        self.scale = QSpinBox()
        self.scale.setObjectName("picture_scale")
        self.scale.setAccessibleName("Scale of the picture")
        self.scale.setRange(1, LARGEST_SCALE)
        self.scale.setValue(2)
        self.transparent = QCheckBox("Transparent background")
        self.transparent.setObjectName("picture_transparent")
        buttons = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Save | QDialogButtonBox.StandardButton.Cancel
        )
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        form = QFormLayout(self)
        form.addRow("Scale (1 is 1860 × 560 pixels)", self.scale)
        form.addRow("", self.transparent)
        form.addRow(buttons)

    def value(self) -> tuple[int, bool]:
        """Scale, and whether the background is transparent."""
        return self.scale.value(), self.transparent.isChecked()
