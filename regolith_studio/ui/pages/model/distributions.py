"""Distributions of a descriptor, of drawn and of measured particles."""

import numpy as np
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.descriptors.distributions import Distribution, kolmogorov_smirnov_distance, wasserstein_1
from regolith_studio.jobs.model_evaluation import DistributionComparison
from regolith_studio.messages import N_
from regolith_studio.studies.population import KEYS
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.combo_box import ChoiceBox
from regolith_studio.ui.widgets.labels import ElidedLabel, rich_symbol, short_number
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve

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
        self.words = ElidedLabel(role="remark")
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
        below = QHBoxLayout()
        below.setContentsMargins(8, 0, 8, 0)
        below.addWidget(self.words)
        layout.addLayout(below)
        layout.addWidget(self.plot, 1)
        for box in (self.key, self.weighting):
            box.currentIndexChanged.connect(lambda _: self._show())
        self._show()

    def show_compared(self, compared: DistributionComparison | None) -> None:
        """Draw other distributions, or none."""
        self._compared = compared if compared is not None and len(compared.drawn) else None
        self._show()

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self.plot.set_theme(theme)
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
