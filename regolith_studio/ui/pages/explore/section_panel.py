"""Plot of a cross-section: outlines of particle, fit and polyhedron with their areas."""

from PySide6.QtWidgets import QCheckBox, QHBoxLayout, QVBoxLayout, QWidget

from regolith_studio.geometry.cross_section import CrossSection
from regolith_studio.messages import N_
from regolith_studio.scene.clipping import DIRECTIONS
from regolith_studio.scene.shapes import LABELS, NAMES, PARTICLE
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import tr
from regolith_studio.ui.translation.numbers import number_text
from regolith_studio.ui.views.three_views import ThreeViews
from regolith_studio.ui.widgets.combo_box import ChoiceBox
from regolith_studio.ui.widgets.labels import grouped_number
from regolith_studio.ui.widgets.number_slider import NumberSlider, NumberSpec
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve

AXES = {"x": ("y", "z"), "y": ("x", "z"), "z": ("x", "y")}
"""Names of the horizontal and vertical axis, by direction of the section."""
PLACE = NumberSpec(
    "",
    N_("Place of the section"),
    -100,
    100,
    0.1,
    suffix=" µm",
    tip=N_("Distance from the middle of the particle; the frame in the views can be dragged as well."),
)


class SectionPanel(QWidget):
    """Controls of the section plane, and the outlines below."""

    def __init__(self, three_views: ThreeViews) -> None:
        super().__init__()
        self.setObjectName("section")
        self._three_views, self._sections = three_views, three_views.sections
        self._theme = current_theme()
        self.direction = ChoiceBox("section_direction", tr("Direction of the section"), DIRECTIONS)
        self.direction.setMinimumContentsLength(7)
        self.direction.prefers_whole = True
        self.flipped = QCheckBox(tr("Flip"))
        self.flipped.setObjectName("section_flipped")
        self.flipped.setToolTip(tr("Show the other half"))
        self.place = NumberSlider(PLACE)
        self.place.setObjectName("section_place")
        self.plot = CurvePlot("y [µm]", "z [µm]", tr("Turn on Section in the tool bar."))
        self.plot.setAccessibleName(tr("Cross-section"))
        self.plot.canvas.setAspectLocked(True)
        self._place()
        self.direction.currentIndexChanged.connect(lambda _: three_views.cut_across(self.direction.value()))
        self.flipped.toggled.connect(self._sections.set_flipped)
        self.place.valueChanged.connect(self._sections.set_position)
        self._sections.changed.connect(self.refresh)
        self.refresh()

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self._theme = theme
        self.plot.set_theme(theme)
        self.refresh()

    def refresh(self) -> None:
        """Show the present plane and sections."""
        sections = self._sections
        for part in (self.direction, self.flipped, self.place):
            part.setEnabled(sections.shown)
        self.direction.setValue(sections.direction)
        self.flipped.blockSignals(True)
        self.flipped.setChecked(sections.flipped)
        self.flipped.blockSignals(False)
        self.place.set_range(-sections.half_length, sections.half_length)
        if not self.place.slider.isSliderDown():
            self.place.setValue(sections.position)
        self._draw(sections.cuts())

    def _draw(self, cuts: dict[str, CrossSection]) -> None:
        right, up = AXES.get(self._sections.direction, (tr("across"), tr("up")))
        mirrored = bool(cuts) and _mirrored(next(iter(cuts.values())), self._sections.direction)
        self.plot.set_labels(f"{'-' if mirrored else ''}{right} [µm]", f"{up} [µm]")
        whole = cuts[PARTICLE].area if PARTICLE in cuts else 0.0
        curves = []
        for name in NAMES:
            if name in cuts:
                x, y = cuts[name].outline().T
                label = f"{tr(LABELS[name])} {_area_text(cuts[name].area, whole, name)}"
                curves.append(PlotCurve(label, getattr(self._theme, name), tuple(x), tuple(y)))
        self.plot.set_curves(curves)

    def _place(self) -> None:
        row = QHBoxLayout()
        row.setContentsMargins(8, 6, 8, 0)
        row.setSpacing(10)
        row.addWidget(self.direction)
        row.addWidget(self.flipped)
        row.addStretch(1)
        below = QHBoxLayout()
        below.setContentsMargins(8, 0, 8, 0)
        below.addWidget(self.place)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addLayout(row)
        column.addLayout(below)
        column.addWidget(self.plot, 1)


def _mirrored(cut: CrossSection, direction: str) -> bool:
    """Whether the horizontal axis points in the negative direction."""
    if direction not in AXES:
        return False
    return bool(cut.normal["xyz".index(direction)] * (-1.0 if direction == "y" else 1.0) < 0.0)


def _area_text(area: float, whole: float, name: str) -> str:
    words = f"{grouped_number(area)} µm²"
    return words if name == PARTICLE or not whole else f"{words} ({number_text(area / whole - 1, '+.1%')})"
