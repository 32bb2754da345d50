"""Lesson two: the fit from a sphere to the particle, degree by degree (Eq. 4)."""

from PySide6.QtWidgets import QVBoxLayout, QWidget

from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.jobs.lecture_jobs import DegreeStep
from regolith_studio.messages import N_
from regolith_studio.scene import surfaces
from regolith_studio.scene.palette import DESCRIPTOR_COLOURS
from regolith_studio.ui.pages.lecture import texts
from regolith_studio.ui.pages.lecture.arrangement import lesson_columns
from regolith_studio.ui.pages.lecture.playback_bar import PlaybackBar
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import tr, tr_count
from regolith_studio.ui.translation.plain_text import Markup
from regolith_studio.ui.views.camera_link import CameraLink
from regolith_studio.ui.views.factory import make_view
from regolith_studio.ui.views.view_frame import ViewFrame
from regolith_studio.ui.widgets.formula import FormulaLabel, prepare
from regolith_studio.ui.widgets.labels import remark
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve

WAIT = N_("Fitting the particle …")


class DegreesView(QWidget):
    """Particle and fit, text and series at a degree, and the errors up to it.

    Parameters
    ----------
    kind
        ``live`` or ``image``, of the views.
    """

    def __init__(self, kind: str) -> None:
        super().__init__()
        self.setObjectName("lesson_degrees")
        self._theme = current_theme()
        self._particle: Mesh | None = None
        self._steps: tuple[DegreeStep, ...] = ()
        self._kind = kind

    def build(self) -> None:
        """Make the parts, right after construction."""
        self.frames: dict[str, ViewFrame] = {}
        for name in ("particle", "fit"):
            self.frames[name] = ViewFrame(make_view(self._kind, self._theme.surroundings), f"degrees_{name}")
        self.link = CameraLink([frame.view for frame in self.frames.values()])
        self.sentence = remark(tr(WAIT), role="")
        self.sentence.setObjectName("degrees_sentence")
        self.formula = FormulaLabel(tr("The series with its numbers"))
        self.errors = CurvePlot(tr("Degree l<sub>max</sub>"), tr("Error [%]"), tr(WAIT), log_y=True)
        self.errors.setObjectName("degrees_errors")
        self.errors.keep_readable()
        self.playback = PlaybackBar("degrees", N_("degree"), self._is_ready)
        self.playback.stepChanged.connect(self._show_step)
        self._arrange()

    def show_particle(self, mesh: Mesh, title: str) -> None:
        """Show a particle under this title; its steps follow."""
        self._particle, self._steps = mesh, ()
        self.playback.pause()
        self.playback.set_count(0)
        self.frames["particle"].set_texts(title)
        self.frames["fit"].set_texts(tr("Spherical-harmonics fit"))
        self.frames["particle"].view.draw(lambda plotter: surfaces.show_particle(plotter, mesh))
        self.frames["fit"].view.draw(surfaces.clear)
        self.sentence.setText(tr(WAIT))
        self.link.frame(mesh.vertices)

    def show_steps(self, steps: tuple[DegreeStep, ...]) -> None:
        """Show the degrees that are computed so far."""
        first = not self._steps
        self._steps = steps
        self.playback.extend(len(steps))
        if first or self.playback.step == len(steps) - 1:
            self._show_step(self.playback.step)
        else:
            self._plot()

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self._theme = theme
        for name, frame in self.frames.items():
            frame.view.set_surroundings(theme.surroundings)
            frame.set_colour(getattr(theme, name))
        self.errors.set_theme(theme)

    def release(self) -> None:
        """Stop, and release graphics memory."""
        self.playback.pause()
        for frame in self.frames.values():
            frame.view.release()

    def _is_ready(self, number: int) -> bool:
        """Whether the formulas of a degree are set."""
        return number >= len(self._steps) or prepare(texts.degree_lines(self._steps[number]))

    def _show_step(self, number: int) -> None:
        if number >= len(self._steps):
            return
        step = self._steps[number]
        mesh = step.mesh
        self.sentence.setText(texts.degree_sentence(step))
        self.formula.set_lines(*texts.degree_lines(step))
        count = (step.l_max + 1) ** 2
        degree = Markup(f"l<sub>max</sub>&nbsp;=&nbsp;{step.l_max}")
        self.frames["fit"].set_texts(
            tr("Spherical-harmonics fit, {degree}", degree=degree),
            tr_count(N_("1 coefficient"), N_("{count:,} coefficients"), count),
            tr("Fit, {degree}", degree=degree),
        )
        if mesh is None:
            self.frames["fit"].view.draw(surfaces.clear)
        else:
            self.frames["fit"].view.draw(lambda plotter: surfaces.show_fit(plotter, mesh))
        self._plot()

    def _plot(self) -> None:
        known = [step for step in self._steps[: self.playback.step + 1] if step.errors]
        x = tuple(float(step.l_max) for step in known)
        curves = [
            PlotCurve(
                texts.plain(key),
                DESCRIPTOR_COLOURS[place],
                x,
                tuple(max(100 * step.errors[key], 1e-4) for step in known),
                markers=True,
            )
            for place, key in enumerate(LOSS_KEYS)
        ]
        radial = tuple(max(100 * step.radial_error, 1e-4) for step in known)
        curves.append(PlotCurve(tr("radius (rms)"), self._theme.particle, x, radial, markers=True))
        self.errors.set_curves(curves)
        self.errors.canvas.setXRange(0, max(len(self._steps) - 1, 1), padding=0.02)

    def _arrange(self) -> None:
        views, texts = list(self.frames.values()), [self.sentence, self.formula]
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(lesson_columns("lecture_degrees", views, [self.errors], texts), 1)
        layout.addWidget(self.playback)
