"""The particle drawn from the edited spectrum, a gallery of measured and drawn particles, distributions."""

import numpy as np
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.descriptors.distributions import Distribution, kolmogorov_smirnov_distance, wasserstein_1
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.messages import N_
from regolith_studio.scene import surfaces
from regolith_studio.scene.cameras import framing_pose
from regolith_studio.scene.gallery import gallery_pose, show_gallery
from regolith_studio.studies.population import KEYS
from regolith_studio.studies.population_distances import DistributionComparison
from regolith_studio.ui.layout import side_by_side
from regolith_studio.ui.pages.model.evaluation import StudyTableView
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.views.view import SceneView
from regolith_studio.ui.views.view_frame import ViewFrame
from regolith_studio.ui.widgets.combo_box import ChoiceBox
from regolith_studio.ui.widgets.labels import ElidedLabel, rich_symbol, short_number
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve
from regolith_studio.ui.widgets.plots.spectrum_editor import SpectrumEditor

WEIGHTINGS = {
    "number": N_("Each particle counts equally"),
    "volume": N_("Particles count by their volume"),
}
WAITING = N_("Draw particles: their distributions appear here, over those of the measured ones.")
SHARE = N_("Share at or below [%]")


class DistributionsPanel(QWidget):
    """Cumulative distributions as step functions."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("model_distributions")
        self.key = ChoiceBox("model_distribution_of", tr("Descriptor"), {k: CATALOGUE[k].label for k in KEYS})
        self.weighting = ChoiceBox(
            "model_distribution_weighting", tr("Weighting of the particles"), WEIGHTINGS
        )
        self.plot = CurvePlot("", tr(SHARE), tr(WAITING))
        self.words, self.assessment = ElidedLabel(role="hint"), ElidedLabel(role="hint")
        self.table = StudyTableView("model_draws_in_noise", tr("Distances of the draws"))
        self.weighting.setMinimumContentsLength(26)
        self._compared: DistributionComparison | None = None
        row = QHBoxLayout()
        row.setContentsMargins(8, 6, 8, 0)
        row.setSpacing(10)
        row.addWidget(self.key)
        row.addWidget(self.weighting)
        row.addStretch(1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addLayout(row)
        for label in (self.words, self.assessment):
            below = QHBoxLayout()
            below.setContentsMargins(8, 0, 8, 0)
            below.addWidget(label)
            layout.addLayout(below)
        parts = side_by_side([self.plot, self.table], [500, 400], stretch=0)
        parts.setObjectName("model_distribution_parts")
        layout.addWidget(parts, 1)
        for box in (self.key, self.weighting):
            box.currentIndexChanged.connect(lambda _: self._show())
        self.show_compared(None)

    def show_compared(self, compared: DistributionComparison | None) -> None:
        """Draw other distributions, or none."""
        self._compared = compared = compared if compared is not None and len(compared.drawn) else None
        measured = compared is not None and len(compared.measured) > 0
        self.assessment.setText(translate(compared.assessment()) if compared is not None and measured else "")
        comparable = compared is not None and compared.comparable
        self.table.setVisible(comparable)
        if compared is not None and comparable:
            self.table.show_table(compared.table())
        self._show()

    def set_theme(self, theme: Theme) -> None:  # noqa: ARG002
        """Take the colours of a theme."""
        self._show()

    def _show(self) -> None:
        row = CATALOGUE[self.key.value()]
        symbol = rich_symbol(row.symbol)
        self.plot.set_labels(f"{tr(row.label)} {symbol}{row.unit_suffix}", tr(SHARE))
        if self._compared is None:
            self.plot.set_curves([])
            self.words.setText("")
            return
        measured, drawn = self._compared.distributions(self.key.value(), self.weighting.value())
        theme = self.plot.theme
        curves = [_step_curve(tr("{count:,} drawn", count=len(drawn.values)), theme.fit, drawn)]
        if measured is not None:
            label = tr("{count:,} measured", count=len(measured.values))
            curves.insert(0, _step_curve(label, theme.particle, measured))
        self.plot.set_curves(curves)
        self.words.setText(distance_text(measured, drawn, row.unit_symbol))


def distance_text(measured: Distribution | None, drawn: Distribution, unit: str = "") -> str:
    """Distances and means of two distributions as text, with values in `unit`."""
    if measured is None:
        return tr("The source holds no measured particles.")
    apart = wasserstein_1(measured, drawn) / measured.mean
    return tr(
        "Wasserstein distance {apart:.1%} of the mean, Kolmogorov-Smirnov distance {gap:.2f}; "
        "means {measured} measured, {drawn} drawn",
        apart=apart,
        gap=kolmogorov_smirnov_distance(measured, drawn),
        measured=f"{short_number(measured.mean)} {unit}".rstrip(),
        drawn=f"{short_number(drawn.mean)} {unit}".rstrip(),
    )


def _step_curve(label: str, colour: str, spread: Distribution) -> PlotCurve:
    x = np.repeat(spread.values, 2)
    y = np.concatenate([[0.0], np.repeat(np.cumsum(spread.weights), 2)[:-1]])
    return PlotCurve(label, colour, tuple(x), tuple(100.0 * y))


NO_MODEL = N_("The spectrum appears when a model is fitted.")


class LiveShape(QWidget):
    """Spectrum editor and a view of one drawn particle."""

    def __init__(self, view: SceneView) -> None:
        super().__init__()
        self.spectrum = SpectrumEditor(tr(NO_MODEL))
        self.spectrum.setObjectName("model_spectrum")
        self.frame = ViewFrame(view, "drawn", colour="fit")
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

        ``detail``: second line of the view's title. ``again``: whether to fit the view, because it is
        another particle.
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


class ShapeGallery(QWidget):
    """Measured particles above drawn ones."""

    def __init__(self, view: SceneView) -> None:
        super().__init__()
        self.frame = ViewFrame(view, "gallery", colour="particle")
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
