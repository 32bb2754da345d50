"""Player of a lesson, and lessons two and three: the fit degree by degree (Eq. 4), and a random field."""

from collections.abc import Callable, Sequence

import numpy as np
from PySide6.QtCore import QEvent, QObject, Signal
from PySide6.QtWidgets import QLabel, QPushButton, QSplitter, QWidget

from regolith_studio.descriptors.catalogue import LOSS_KEYS
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.lecture_jobs import DegreeStep, DrawnField, draw_field_later
from regolith_studio.messages import N_
from regolith_studio.scene import surfaces
from regolith_studio.scene.lecture_scenes import show_field
from regolith_studio.scene.palette import DESCRIPTOR_COLOURS
from regolith_studio.shape_models.materials import materials
from regolith_studio.ui.layout import STRETCH, control_row, hbox, named, scrolled, side_by_side, stacked, vbox
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.lecture import texts
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import Markup, number_text, tr, tr_count
from regolith_studio.ui.views.image_view import make_view
from regolith_studio.ui.views.view import CameraLink, ViewFrame
from regolith_studio.ui.widgets.fields import ChoiceBox, NumberSlider, NumberSpec, StepPlayer
from regolith_studio.ui.widgets.formula import FormulaLabel, prepare
from regolith_studio.ui.widgets.labels import hint_label
from regolith_studio.ui.widgets.plots.bars import SpectrumEditor
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve

SPEED = NumberSpec(
    N_("Speed"),
    N_("Steps per second"),
    0.5,
    20.0,
    0.5,
    suffix=" /s",
    tip=N_("Steps per second during playback."),
)
USUAL_SPEED = 2.0


class PlaybackBar(StepPlayer):
    """Selects one of several steps, manually or by a timer.

    - ``name``: prefix of the object names.
    - ``noun``: what one step is called, such as ``step``.
    - ``is_ready``: whether a step can be shown at once; while it plays, it waits for that.
    """

    def __init__(self, name: str, noun: str, is_ready: Callable[[int], bool] = lambda _step: True) -> None:
        self._noun = noun
        super().__init__(f"{name}_step", tr("Number of the {noun}", noun=tr(noun)), 0, is_ready)
        self.first, self.back, self.forward = QPushButton("|◀"), QPushButton("◀"), QPushButton("▶")
        for button, key, words in (
            (self.first, "first", tr("To the beginning")),
            (self.back, "back", tr("One step back")),
            (self.play, "play", tr("Play or pause")),
            (self.forward, "forward", tr("One step")),
        ):
            named(button, f"{name}_{key}", words, words)
        self.speed = named(NumberSlider(SPEED), f"{name}_speed")
        self.speed.setMaximumWidth(300)
        self.clock = QLabel()
        self.clock.installEventFilter(self)
        self._arrange()
        self.first.clicked.connect(lambda: self.go(0))
        self.back.clicked.connect(lambda: self.go(self.step - 1))
        self.forward.clicked.connect(lambda: self.go(self.step + 1))
        self.stepChanged.connect(lambda _: self._show_position())
        self.speed.valueChanged.connect(lambda _: self._set_speed())
        self.speed.setValue(USUAL_SPEED)
        self._set_speed()
        self.set_count(0)

    def set_count(self, count: int, at: int = 0) -> None:
        super().set_count(count, at)
        for part in (self.first, self.back, self.forward):
            part.setEnabled(count > 1)
        self._reserve_width()
        self._show_position()

    def extend(self, count: int) -> None:
        """Set a larger number of steps; the current one stays."""
        self.set_count(count, self.step)

    def go(self, step: int) -> None:
        self.pause()
        self.slider.setValue(step)

    def _set_speed(self) -> None:
        self._timer.setInterval(round(1000 / max(float(self.speed.value()), 0.1)))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Follow the font of the clock, which may change after that of the bar."""
        if watched is self.clock and event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._reserve_width()
        return super().eventFilter(watched, event)

    def _reserve_width(self) -> None:
        """Reserve width for the longest texts, so that the slider does not move."""
        last = self.slider.maximum()
        widest = self._words("0" * len(str(last)))
        self.clock.setMinimumWidth(self.clock.fontMetrics().horizontalAdvance(widest) + 4)
        metrics, now = self.play.fontMetrics(), self.play.text()
        longest = max(metrics.horizontalAdvance(text) for text in (tr("Play"), tr("Pause")))
        self.play.setMinimumWidth(self.play.sizeHint().width() - metrics.horizontalAdvance(now) + longest)
        for button in (self.first, self.back, self.forward):
            button.setMinimumWidth(metrics.horizontalAdvance(button.text()) + 2 * metrics.height())

    def _show_position(self) -> None:
        self.clock.setText(self._words(self.step))

    def _words(self, at: object) -> str:
        return tr("{noun} {at} of {last}", noun=tr(self._noun), at=at, last=self.slider.maximum())

    def _arrange(self) -> None:
        hbox(
            self.first,
            self.back,
            self.play,
            self.forward,
            (self.slider, 1),
            self.clock,
            self.speed,
            parent=self,
            margins=(8, 4, 8, 4),
            spacing=8,
        )


VIEWS, PLOTS = 560, 240
"""Initial heights in pixels."""
PICTURES, TEXTS = 1000, 560
"""Initial widths in pixels."""


def lesson_columns(
    name: str,
    views: Sequence[QWidget],
    plots: Sequence[QWidget],
    texts: Sequence[QWidget],
    under_texts: QWidget | None = None,
) -> QSplitter:
    """All plots stay in sight; only texts are scrolled where they are too long.

    ``name``: of the borders in the preferences. ``under_texts``: a plot below the texts.
    """
    column_of_texts = QWidget()
    vbox(*texts, STRETCH, parent=column_of_texts, margins=(10, 6, 6, 6), spacing=6)
    pictures = stacked([_row(views), _row(plots)], [VIEWS, PLOTS], stretch=0)
    right: QWidget = scrolled(column_of_texts)
    if under_texts is not None:
        both = right = stacked([right, under_texts], [VIEWS, PLOTS], stretch=0)
        both.setObjectName(f"{name}_texts")
    pictures.setObjectName(f"{name}_rows")
    columns = side_by_side([pictures, right], [PICTURES, TEXTS], stretch=0)
    columns.setObjectName(f"{name}_columns")
    columns.setStretchFactor(1, 1)
    return columns


def _row(parts: Sequence[QWidget]) -> QSplitter:
    row = side_by_side(parts, [500] * len(parts), stretch=0)
    for place in range(row.count()):
        row.setStretchFactor(place, 1)
    return row


WAIT = N_("Fitting the particle …")


class DegreesView(QWidget):
    """Particle and fit, text and series at a degree, and the errors up to it.

    ``kind``: ``live`` or ``image``, of the views.
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
            self.frames[name] = ViewFrame(make_view(self._kind), f"degrees_{name}", colour=name)
        self.link = CameraLink([frame.view for frame in self.frames.values()])
        self.sentence = hint_label(tr(WAIT), role="")
        self.sentence.setObjectName("degrees_sentence")
        self.formula = FormulaLabel(tr("The series with its numbers"))
        self.errors = CurvePlot(tr("Degree l<sub>max</sub>"), tr("Error [%]"), tr(WAIT), log_y=True)
        self.errors.setObjectName("degrees_errors")
        self.errors.fit_to_font()
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
        first = not self._steps
        self._steps = steps
        self.playback.extend(len(steps))
        if first or self.playback.step == len(steps) - 1:
            self._show_step(self.playback.step)
        else:
            self._plot()

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme

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
        self.errors.canvas.getViewBox().setXRange(0, max(len(self._steps) - 1, 1), padding=0.02)

    def _arrange(self) -> None:
        views, texts = list(self.frames.values()), [self.sentence, self.formula]
        vbox((lesson_columns("lecture_degrees", views, [self.errors], texts), 1), self.playback, parent=self)


DEGREE = 10


class FieldView(QWidget):
    """Sphere and particle coloured by the field, and the spectrum editor.

    ``context``: of the page; what the spectrum makes is drawn while it is dragged.
    """

    seedChanged = Signal(int)  # noqa: N815

    def __init__(self, context: PageContext) -> None:
        super().__init__()
        self.setObjectName("lesson_field")
        self._theme = current_theme()
        self.seed = 0
        self.drawn: DrawnField | None = None
        self._context = context
        self._unframed = True

    def build(self) -> None:
        """Make the parts, right after construction."""
        self.frames: dict[str, ViewFrame] = {}
        for name in ("sphere", "grain"):
            self.frames[name] = ViewFrame(make_view(self._context.views), f"field_{name}", colour="fit")
        self.link = CameraLink([frame.view for frame in self.frames.values()])
        self.sentence = hint_label("", role="")
        self.sentence.setObjectName("field_sentence")
        self.formula = FormulaLabel(tr("The field with its amplitudes"))
        self.material = ChoiceBox(
            "field_material", tr("Material"), {key: card.label for key, card in materials().items()}
        )
        self.spectrum = named(SpectrumEditor(tr("No material is chosen.")), "field_spectrum")
        self.spectrum.fit_to_font()
        self.reset, self.another = QPushButton(tr("Reset the spectrum")), QPushButton(tr("Draw again"))
        self.reset.setObjectName("field_reset")
        self.another.setObjectName("field_another")
        self._arrange()
        self.material.currentIndexChanged.connect(lambda _: self.take_material())
        self.spectrum.valueChanged.connect(lambda _: self.redraw())
        self.reset.clicked.connect(self.spectrum.reset)
        self.another.clicked.connect(self.draw_another)

    def take_material(self) -> None:
        card = materials()[self.material.value()]
        self.spectrum.setValue(np.array(card.relative_amplitudes[: min(DEGREE, card.l_max)]))
        self.redraw(again=True)

    def draw_another(self) -> None:
        self.seed += 1
        self.redraw(again=True)
        self.seedChanged.emit(self.seed)

    def redraw(self, again: bool = False) -> None:
        """Draw field and particle of the present spectrum; fit the view if it is another particle."""
        amplitudes = self.spectrum.value()
        self.reset.setEnabled(self.spectrum.is_changed())
        if not len(amplitudes):
            return
        self.formula.set_lines(*texts.field_lines(amplitudes.tolist()))
        self._unframed |= again
        seed = self.seed
        self._context.start(
            tr("Drawing particles"),
            Job(draw_field_later, (self.material.value(), amplitudes, seed)),
            lambda drawn: self._take(drawn, amplitudes, seed),
            failed=lambda failure: self.sentence.setText(failure.sentence),
            queue="field",
            repeats=True,
            after_running=True,
        )

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme
        if self.drawn is not None:
            self._show(self.drawn, False)

    def release(self) -> None:
        for frame in self.frames.values():
            frame.view.release()

    def _take(self, drawn: DrawnField, amplitudes: FloatArray, seed: int) -> None:
        self.drawn = drawn
        again, self._unframed = self._unframed, False
        self._show(drawn, again)
        self.sentence.setText(_sentence(drawn, amplitudes, seed))

    def _show(self, drawn: DrawnField, again: bool) -> None:
        span = float(np.abs(drawn.values).max(initial=0.0))
        ink = self._theme.surroundings
        radius = float(np.cbrt(3 * drawn.mesh.volume / (4 * np.pi)))
        sphere = drawn.sphere.moved(scale=radius)
        self.frames["sphere"].view.draw(
            lambda plotter: show_field(
                plotter, sphere, drawn.values, span, ink, lambda x: number_text(x, ".2g")
            )
        )
        self.frames["grain"].view.draw(
            lambda plotter: show_field(plotter, drawn.mesh, drawn.values, span, ink)
        )
        self.frames["sphere"].set_texts(
            tr("The field on the sphere"), tr("ln(r / mean), blue inwards, red outwards")
        )
        self.frames["grain"].set_texts(
            tr("The particle"), tr("equivalent radius {radius:.3g} µm", radius=radius)
        )
        if again:
            self.link.frame(drawn.mesh.vertices)

    def _arrange(self) -> None:
        buttons = control_row(self.reset, self.another)
        views = list(self.frames.values())
        texts = [self.material, buttons, self.sentence, self.formula]
        vbox((lesson_columns("lecture_field", views, [self.spectrum], texts), 1), parent=self)


def _sentence(drawn: DrawnField, amplitudes: FloatArray, seed: int) -> str:
    loudest = int(amplitudes.argmax()) + 1
    expected = float(np.sqrt(((2 * np.arange(1, len(amplitudes) + 1) + 1) * amplitudes**2).sum()))
    return tr(
        "Draw {number}. The radius deviates by {found:.1%} from its mean; {expected:.1%} is expected"
        " over many draws. Degree {loudest} is the strongest: {share:.2g} %.",
        number=seed + 1,
        found=float(drawn.values.std()),
        expected=expected,
        loudest=loudest,
        share=100 * amplitudes[loudest - 1],
    )
