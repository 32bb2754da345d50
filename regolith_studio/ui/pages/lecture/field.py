"""Lesson three: a random field on the sphere, its editable spectrum, and the resulting particle."""

import numpy as np
from PySide6.QtCore import Signal
from PySide6.QtWidgets import QPushButton, QVBoxLayout, QWidget

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.lecture_jobs import DrawnField, draw_field_later
from regolith_studio.scene.lecture_scenes import show_field
from regolith_studio.shape_models.materials import materials
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.lecture import texts
from regolith_studio.ui.pages.lecture.arrangement import lesson_columns
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import tr
from regolith_studio.ui.views.camera_link import CameraLink
from regolith_studio.ui.views.factory import make_view
from regolith_studio.ui.views.view_frame import ViewFrame
from regolith_studio.ui.widgets.combo_box import ChoiceBox, ComboBoxRow
from regolith_studio.ui.widgets.formula import FormulaLabel
from regolith_studio.ui.widgets.labels import remark
from regolith_studio.ui.widgets.plots.spectrum_editor import SpectrumEditor

DEGREE = 10


class FieldView(QWidget):
    """Sphere and particle coloured by the field, and the spectrum editor.

    Parameters
    ----------
    context
        Of the page; what the spectrum makes is drawn while it is dragged.
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
            self.frames[name] = ViewFrame(
                make_view(self._context.views, self._theme.surroundings), f"field_{name}"
            )
        self.link = CameraLink([frame.view for frame in self.frames.values()])
        self.sentence = remark("", role="")
        self.sentence.setObjectName("field_sentence")
        self.formula = FormulaLabel(tr("The field with its amplitudes"))
        self.material = ChoiceBox(
            "field_material", tr("Material"), {key: card.label for key, card in materials().items()}
        )
        self.spectrum = SpectrumEditor(tr("No material is chosen."))
        self.spectrum.setObjectName("field_spectrum")
        self.spectrum.keep_readable()
        self.reset, self.another = QPushButton(tr("Reset the spectrum")), QPushButton(tr("Draw again"))
        self.reset.setObjectName("field_reset")
        self.another.setObjectName("field_another")
        self._arrange()
        self.material.currentIndexChanged.connect(lambda _: self.take_material())
        self.spectrum.valueChanged.connect(lambda _: self.redraw())
        self.reset.clicked.connect(self.spectrum.reset)
        self.another.clicked.connect(self.draw_another)

    def take_material(self) -> None:
        """Show the spectrum of the selected material."""
        card = materials()[self.material.value()]
        self.spectrum.setValue(np.array(card.relative_amplitudes[: min(DEGREE, card.l_max)]))
        self.redraw(again=True)

    def draw_another(self) -> None:
        """Use the next seed."""
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
            lane="field",
            repeats=True,
            after_running=True,
        )

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self._theme = theme
        for frame in self.frames.values():
            frame.view.set_surroundings(theme.surroundings)
            frame.set_colour(theme.fit)
        self.spectrum.set_theme(theme)
        if self.drawn is not None:
            self._show(self.drawn, False)

    def release(self) -> None:
        """Release graphics memory."""
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
            lambda plotter: show_field(plotter, sphere, drawn.values, span, ink, "%.2g")
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
        choices = ComboBoxRow(self.material, (self.reset, self.another), spacing=10)
        views, texts = list(self.frames.values()), [choices, self.sentence, self.formula]
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(lesson_columns("lecture_field", views, [self.spectrum], texts), 1)


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
