"""Plot of the loss (Eq. 9) against the steps of the coarsening, updated while it runs."""

from itertools import accumulate

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
            return
        steps, losses = zip(*history, strict=True)
        best = tuple(accumulate(losses, min))
        theme = self.plot.theme
        curves = [
            PlotCurve(tr("present"), theme.polyhedron, steps, losses, markers=len(steps) < 40),
            PlotCurve(tr("best so far"), theme.muted, steps, best, dash=True),
        ]
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
