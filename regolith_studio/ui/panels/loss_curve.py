"""Plot of the loss (Eq. 9) against the steps of the coarsening, updated while it runs."""

import math
from collections.abc import Sequence
from itertools import accumulate, chain, pairwise

from PySide6.QtWidgets import QVBoxLayout, QWidget

from regolith_studio.session.results import Results
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve


class LossCurvePanel(QWidget):
    """Current and best loss of the coarsening."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("loss_curve")
        self.plot = CurvePlot(tr("Step"), tr("Loss"), tr("The loss appears when the coarsening begins."))
        self.plot.canvas.setLimits(xMin=-0.5)  # there is no step before the first
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.plot)
        self._results: Results | None = None

    def show_results(self, results: Results) -> None:
        """Draw the history of these results."""
        self._results = results
        history = results.loss_history
        if not history:
            if results.best is None:  # of another particle, or of none
                self.plot.set_curves([])
                self.plot.set_remark("")
            return
        best = accumulate((loss for _, loss in history), min)
        rows = [(*each, low) for each, low in zip(history, best, strict=True)]
        steps, losses, lowest = _broken_at_starts(rows)
        theme = self.plot.theme
        curves = [
            PlotCurve(tr("current"), theme.polyhedron, steps, losses, markers=len(steps) < 40),
            PlotCurve(tr("best so far"), theme.muted, steps, lowest, dash=True),
        ]
        if (done := results.coarsened) is not None:
            if done.loss > 1.0000001 * rows[-1][2]:
                del curves[1]  # of a step that did not meet the conditions
            end = (steps[-1:], (done.loss,))
            curves.append(PlotCurve(tr("result"), theme.text, *end, markers=True, line=False))
        self.plot.set_curves(curves)
        progress = results.coarsening_progress
        running = results.coarsened is None and progress is not None
        self.plot.set_remark(
            tr("step {at} of {total}", at=progress.step, total=progress.steps) if running and progress else ""
        )

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self.plot.set_theme(theme)
        if self._results:
            self.show_results(self._results)


def _broken_at_starts(rows: Sequence[tuple[float, float, float]]) -> tuple[tuple[float, ...], ...]:
    """Columns of rows of step, loss and lowest loss, with a row of NaN where another start begins."""
    gap = (math.nan,) * 3
    parts = [(gap, row) if row[0] <= before[0] else (row,) for before, row in pairwise(rows)]
    return tuple(zip(rows[0], *chain.from_iterable(parts), strict=True))
