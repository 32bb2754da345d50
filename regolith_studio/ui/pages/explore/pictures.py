"""Saving the views: screenshot, figure of the three views, turntable, animation of the fit."""

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QObject
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QCheckBox, QDialog, QDialogButtonBox, QFileDialog, QFormLayout, QWidget

from regolith_studio.errors import FileError
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.file_names import file_stem
from regolith_studio.jobs.events import Job
from regolith_studio.messages import N_
from regolith_studio.scene.animation import animate, draw_figure, turn
from regolith_studio.scene.figure import view_titles
from regolith_studio.ui.layout import dialog_buttons, named
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.translation import tr
from regolith_studio.ui.views.three_views import ThreeViews
from regolith_studio.ui.widgets.fields import ChoiceBox, whole_field
from regolith_studio.ui.widgets.plots.export import png_of_image

MAX_SCALE = 6
SCREENSHOT, FIGURE = "screenshot", "figure"
KINDS = {
    SCREENSHOT: N_("The views as they are seen"),
    FIGURE: N_("A figure on white, 1860 × 560 times the scale"),
}
ANIMATION_FILTERS = ("GIF (*.gif)", "WebP (*.webp)", N_("Sequence of PNG files (*.png)"))
SUFFIXES = (".gif", ".webp", ".png")
SAVED = {
    "figure": N_("The picture is in {path}."),
    "turntable": N_("The turntable is in {path}."),
    "animation": N_("The animation is in {path}."),
}


class PictureExport(QObject):
    """Asks for a file and saves views or an animation.

    ``context``: of the page. ``three_views``: the views.
    """

    def __init__(self, context: PageContext, three_views: ThreeViews, parent: QWidget) -> None:
        super().__init__(parent)
        self._context, self._three_views, self._window = context, three_views, parent
        self._kind = ""

    def save_picture(self) -> None:
        """Ask for kind, scale and file, and write the three views."""
        results, entry = self._context.session.results, self._context.session.selected
        if entry is None or results.surface is None or results.coarsened is None:
            self._context.toast.problem(tr("Wait until the three views are drawn."))
            return
        dialog = PictureDialog(self._window)
        accepted = dialog.exec() == QDialog.DialogCode.Accepted
        kind, scale, transparent = dialog.value()
        dialog.deleteLater()
        kinds = tr("Pictures (*.png)")
        name = self._ask(tr("Save picture"), f"{file_stem(entry.id)}.png", kinds) if accepted else ""
        if not name:
            return
        path = Path(name).with_suffix(".png")
        if kind == SCREENSHOT:
            self._write(self._three_views.snapshot(scale, transparent), path)
            return
        titles = view_titles(entry.particle.name, results.surface_l_max, results.coarsened)
        pose = self._three_views.views["particle"].pose
        surfaces = (entry.particle.mesh, results.surface, results.coarsened)
        job = Job(draw_figure, (*surfaces, titles, path, scale, pose, transparent))
        self._context.start(tr("Drawing the figure"), job, self._saved_note("figure", path))

    def save_turntable(self) -> None:
        """Ask for a file and save an animation of one rotation, in the background."""
        entry = self._context.session.selected
        if entry is None or not self._three_views.shapes:
            self._context.toast.problem(tr("Wait until the views are drawn."))
            return
        name, suffix = self._ask_animation(tr("Save turntable"), f"{file_stem(entry.id)}-turning")
        if name:
            path = Path(name).with_suffix(suffix)
            job = Job(turn, (self._three_views.shapes, self._three_views.views["particle"].pose, path))
            title = tr("Drawing the turntable")
            self._context.start(title, job, self._saved_note("turntable", path), queue="turntable")

    def save_animation(self) -> None:
        """Ask for a file and save an animation of the fit from degree 0 on, in the background."""
        fit, entry = self._context.session.results.fit, self._context.session.selected
        if entry is None or fit is None:
            self._context.toast.problem(tr("Wait until the particle is fitted."))
            return
        name, suffix = self._ask_animation(tr("Save animation"), file_stem(entry.id))
        if name:
            path = Path(name).with_suffix(suffix)
            job = Job(animate, (entry.particle.mesh, fit, tuple(range(fit.l_max + 1)), path))
            title = tr("Drawing the animation")
            self._context.start(title, job, self._saved_note("animation", path), queue="animation")

    def _saved_note(self, what: str, path: Path) -> Callable[[object], None]:
        first = path.with_name(f"{path.stem}-000.png") if path.suffix == ".png" and what != "figure" else path
        return lambda _: self._context.toast.note(tr(SAVED[what], path=first))

    def _write(self, picture: QImage, path: Path) -> None:
        try:
            write_bytes(path, png_of_image(picture))
        except FileError as error:
            self._context.toast.problem(str(error))
        else:
            self._context.toast.note(tr(SAVED["figure"], path=path))

    def _ask_animation(self, title: str, name: str) -> tuple[str, str]:
        kinds = [tr(kind) for kind in ANIMATION_FILTERS]
        chosen = self._ask(title, f"{name}{SUFFIXES[0]}", ";;".join(kinds))
        return chosen, _suffix(chosen, kinds.index(self._kind) if self._kind in kinds else 0)

    def _ask(self, title: str, name: str, kinds: str) -> str:
        start = str(Path(str(self._context.recall("pictures", Path.home()))) / name)
        chosen, self._kind = QFileDialog.getSaveFileName(self._window, title, start, kinds)
        if chosen:
            self._context.remember("pictures", str(Path(chosen).parent))
        return chosen


def _suffix(name: str, kind: int) -> str:
    """The suffix that was typed or, if it is the suggested one, that of the selected filter."""
    typed = Path(name).suffix.lower()
    return typed if typed in SUFFIXES[1:] else SUFFIXES[kind]


class PictureDialog(QDialog):
    """Asks for the kind of picture, its scale, and whether the background is transparent."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Save picture"))
        self.setObjectName("picture_dialog")
        self.kind = ChoiceBox("picture_kind", tr("Kind of picture"), KINDS)
        self.kind.setMinimumContentsLength(30)
        self.scale = whole_field("picture_scale", tr("Scale of the picture"), 1, MAX_SCALE, 2)
        self.transparent = named(QCheckBox(tr("Transparent background")), "picture_transparent")
        form = QFormLayout(self)
        form.addRow(tr("Picture"), self.kind)
        form.addRow(tr("Scale"), self.scale)
        form.addRow("", self.transparent)
        form.addRow(dialog_buttons(self, QDialogButtonBox.StandardButton.Save))

    def value(self) -> tuple[str, int, bool]:
        """Kind of picture, scale, and whether the background is transparent."""
        return self.kind.value(), self.scale.value(), self.transparent.isChecked()
