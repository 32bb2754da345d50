"""Plots of a judgement side by side: measured particles and models over common axes (Figs. 4 to 6)."""

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QGridLayout, QLabel, QSizePolicy, QVBoxLayout, QWidget

from regolith_studio.descriptors.catalogue import CATALOGUE, powers
from regolith_studio.messages import N_
from regolith_studio.scene.palette import DESCRIPTOR_COLOURS
from regolith_studio.shape_models.models import MODELS
from regolith_studio.studies.population import PopulationStudy
from regolith_studio.studies.population_curves import CUT, MEASURED, PopulationCurve, PopulationPanel
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import plain_symbol, unbroken
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve

MIN_WIDTH, MIN_HEIGHT = 190, 180
"""Pixels of one plot; where a row has no room for all, there are more rows."""
AXES = {
    "number": ("", N_("Density by number")),
    "volume": ("", N_("Density by volume")),
    "quantiles": (N_("Measured {quantity}"), N_("Drawn")),
    "pairs": ("", ""),
    "components": (N_("Number of components"), N_("BIC above its minimum")),
}
"""Labels of what is no descriptor."""


class PanelGrid(QWidget):
    """The panels of one figure as plots in a grid, with one legend.

    Parameters
    ----------
    name
        Of the figure, a key of :data:`AXES`.
    """

    def __init__(self, name: str) -> None:
        super().__init__()
        self.setObjectName(f"model_figure_{name}")
        self._name = name
        self._panels: tuple[PopulationPanel, ...] = ()
        self._study: PopulationStudy | None = None
        self.plots: list[CurvePlot] = []
        self.legend = QLabel()
        self.legend.setTextFormat(Qt.TextFormat.RichText)
        self.legend.setWordWrap(True)
        self._grid = QGridLayout()
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 6, 8, 6)
        column.addWidget(self.legend)
        column.addLayout(self._grid, 1)

    def set_panels(self, panels: Sequence[PopulationPanel], study: PopulationStudy) -> None:
        """Draw other panels."""
        self._panels, self._study = tuple(panels), study
        while len(self.plots) < len(panels):
            plot = CurvePlot("", "", "")
            plot.legend.hide()
            plot.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Ignored)
            self.plots.append(plot)
        for plot in self.plots[len(panels) :]:
            plot.hide()
        self._place()
        self._draw()

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        for plot in self.plots:
            plot.set_theme(theme)
        self._draw()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._place()

    def _place(self) -> None:
        """As many plots in a row as there is room for."""
        shown = self.plots[: len(self._panels)]
        columns = max(1, min(len(shown), self.width() // MIN_WIDTH))
        for number, plot in enumerate(shown):
            plot.setMinimumHeight(MIN_HEIGHT)
            self._grid.addWidget(plot, number // columns, number % columns)
            plot.show()
        for column in range(self._grid.columnCount()):
            self._grid.setColumnStretch(column, int(column < columns))

    def _draw(self) -> None:
        study, entries = self._study, dict[str, str]()
        if study is None:
            return
        for plot, panel in zip(self.plots, self._panels, strict=False):
            plot.setAccessibleName(_axis(panel.x, study) or tr(AXES[self._name][1]))
            plot.set_labels(*self._labels(panel, study))
            plot.set_curves([self._curve(curve, study) for curve in panel.curves])
            entries |= {curve.label: curve.colour for curve in plot.curves}
        self.legend.setText(
            "&nbsp;&nbsp; ".join(
                f'<span style="color:{colour}">&#9632;</span>&nbsp;{unbroken(label)}'
                for label, colour in entries.items()
            )
        )

    def _curve(self, curve: PopulationCurve, study: PopulationStudy) -> PlotCurve:
        theme = current_theme()
        if curve.source == MEASURED:
            label, colour = tr("measured"), theme.text if self._name == "quantiles" else theme.particle
        elif curve.source == CUT:
            label, colour = tr("measured, cut at l = {degree}", degree=study.cut_degree), theme.muted
        else:
            place = [model.key for model in study.models].index(curve.source)
            label, colour = tr(MODELS[curve.source].label), DESCRIPTOR_COLOURS[place]
        dots = self._name == "quantiles" and curve.source != MEASURED
        return PlotCurve(
            label,
            colour,
            tuple(curve.x.tolist()),
            tuple(curve.y.tolist()),
            markers=dots or self._name == "components",
            dash=curve.source == CUT,
            line=not dots,
        )

    def _labels(self, panel: PopulationPanel, study: PopulationStudy) -> tuple[str, str]:
        x, y = AXES[self._name]
        across, up = _axis(panel.x, study), _axis(panel.y, study)
        if self._name == "quantiles":
            return tr(x, quantity=across), tr(y)
        return across or tr(x), up or tr(y)


def _axis(key: str, study: PopulationStudy) -> str:
    """Symbol and unit of a descriptor, or nothing."""
    if not key:
        return ""
    row = CATALOGUE[key]
    unit = "µm" if study.unit == "um" else study.unit
    suffix = f" [{unit}{powers(row.dimension)}]" if row.dimension else ""
    return f"{tr(row.label)} {plain_symbol(row.symbol)}{suffix}"
