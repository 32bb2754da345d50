"""Bar plot of the relative errors of fit and polyhedron (Eq. 8)."""

import math

from PySide6.QtWidgets import QVBoxLayout, QWidget

from regolith_studio.coarsening.lower_bounds import bounds_in_force
from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.session.choices import Choices
from regolith_studio.session.results import Results
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.widgets.definitions import definition
from regolith_studio.ui.widgets.labels import plain_symbol
from regolith_studio.ui.widgets.plots.bars import BarPlot, BarSeries

KEYS = (*LOSS_KEYS, JACCARD)
CHAIN = "#aa4499"
"""Colour of the whole chain, from particle to polyhedron; of Tol's palette for colour-blind readers."""


class ErrorBarsPanel(QWidget):
    """Errors per descriptor with their lower bounds; faint while the polyhedron is being replaced."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("error_bars")
        self.plot = BarPlot(
            tr("Descriptor"), tr("Relative error [%]"), tr("The errors appear when the fit is measured.")
        )
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.plot)
        self._shown: tuple[Results, Choices] | None = None
        self._polyhedron: dict[str, float] = {}
        self._bounds: dict[str, float] = {}
        self._against_particle: dict[str, float] = {}
        self._polyhedron_of = ""

    def show_results(self, results: Results, choices: Choices) -> None:
        """Draw the errors of these results."""
        self._shown = (results, choices)
        if choices.selected != self._polyhedron_of:
            self._polyhedron, self._bounds, self._against_particle = {}, {}, {}
            self._polyhedron_of = choices.selected
        done = results.coarsened
        if "coarsening" in results.failures:
            self._polyhedron, self._bounds, self._against_particle = {}, {}, {}
        if done is not None:
            self._polyhedron = {**done.errors, JACCARD: done.jaccard_distance}
            self._bounds = bounds_in_force(done.bounds, done.errors)
        if found := results.against_particle:
            self._against_particle = {**found.errors, JACCARD: found.jaccard_distance}
        theme = self.plot.theme
        imitating_fit = choices.target == "fit"
        series = [
            BarSeries(tr("Fit vs. particle"), theme.fit, _percent(results.fit_errors)),
            BarSeries(
                tr("Polyhedron vs. fit") if imitating_fit else tr("Polyhedron vs. particle"),
                theme.polyhedron,
                _percent(self._polyhedron),
                done is None,
                _percent(self._bounds) if self._bounds else (),
            ),
        ]
        if imitating_fit:
            label = tr("Polyhedron vs. particle")
            stale = results.against_particle is None
            series.append(BarSeries(label, CHAIN, _percent(self._against_particle), stale))
        symbols = [plain_symbol(CATALOGUE[key].symbol) for key in LOSS_KEYS]
        tips = [definition(key) for key in (*LOSS_KEYS, JACCARD)]
        self.plot.set_bars([*symbols, "Jaccard"], series, short=[*symbols, "J"], tips=tips)
        failure = translate(results.failures.get("descriptors", ""))
        if self.plot.is_empty():
            self.plot.set_empty(True, failure or tr("The errors appear when the fit is measured."))

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self.plot.set_theme(theme)
        if self._shown:
            self.show_results(*self._shown)


def _percent(errors: object) -> tuple[float, ...]:
    values = dict(errors)  # type: ignore[call-overload]
    return tuple(100.0 * values.get(key, math.nan) for key in KEYS)
