"""The plots below the views: errors and descriptors on the left, what is computed on the right."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QSplitter, QWidget

from regolith_studio.session.plan import Kind
from regolith_studio.session.session import Session
from regolith_studio.ui.commands import Commands
from regolith_studio.ui.layout import tabs
from regolith_studio.ui.panels.coarsening_study import CoarseningStudyPanel
from regolith_studio.ui.panels.descriptor_table import DescriptorTablePanel
from regolith_studio.ui.panels.error_bars import ErrorBarsPanel
from regolith_studio.ui.panels.lmax_study import LmaxStudyPanel
from regolith_studio.ui.panels.loss_curve import LossCurvePanel
from regolith_studio.ui.panels.spectrum import SpectrumPanel
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.wiring import Wiring


class PlotArea(QSplitter):
    """Two groups of pages side by side."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(Qt.Orientation.Horizontal, parent)
        self.setChildrenCollapsible(False)
        self.setHandleWidth(7)
        self.error_bars, self.table = ErrorBarsPanel(), DescriptorTablePanel()
        self.loss_curve, self.spectrum = LossCurvePanel(), SpectrumPanel()
        self.lmax_study, self.coarsening_study = LmaxStudyPanel(), CoarseningStudyPanel()
        self.left = tabs("plots_left", [(self.error_bars, "Errors"), (self.table, "Descriptors")])
        self.right = tabs(
            "plots_right",
            [
                (self.loss_curve, "Loss"),
                (self.spectrum, "Spectrum"),
                (self.lmax_study, "Study: l_max"),
                (self.coarsening_study, "Study: losses"),
            ],
        )
        for number, group in enumerate((self.left, self.right)):
            self.addWidget(group)
            self.setStretchFactor(number, 1)
        self.setSizes([1000, 1000])

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        live = (self.error_bars, self.loss_curve, self.spectrum)
        for panel in (*live, self.lmax_study, self.coarsening_study):
            panel.set_theme(theme)

    def wire(self, session: Session, wiring: Wiring, commands: Commands) -> None:
        """Show what the session computes, from now on."""

        def errors() -> None:
            self.error_bars.show_results(session.results, session.choices)

        def spectrum() -> None:
            self.spectrum.show_results(session.results, session.choices)
            self.lmax_study.show_l_max(session.choices.l_max)

        wiring.refresh("descriptors coarsening choices", errors, slow=True)
        wiring.refresh("descriptors coarsening", lambda: self.table.show_results(session.results), slow=True)
        wiring.refresh("coarsening", lambda: self.loss_curve.show_results(session.results), slow=True)
        wiring.refresh("fit choices", spectrum, slow=True)
        self._wire_study(session, wiring, commands, Kind.LMAX_STUDY, self.lmax_study)
        self._wire_study(session, wiring, commands, Kind.COARSENING_STUDY, self.coarsening_study)

    def _wire_study(
        self,
        session: Session,
        wiring: Wiring,
        commands: Commands,
        kind: Kind,
        panel: LmaxStudyPanel | CoarseningStudyPanel,
    ) -> None:
        def show() -> None:
            panel.show_study(getattr(session.results, kind.value), kind.value in session.results.outdated)

        def tasks() -> None:
            panel.frame.show_task(next((task for task in session.tasks if task.lane == kind), None))

        panel.frame.startRequested.connect(lambda: commands.start_study(kind))
        panel.frame.cancelRequested.connect(commands.stop)
        wiring.refresh(kind.value, show, slow=True)
        wiring.refresh("tasks", tasks, slow=True)
        wiring.refresh("particles", lambda: panel.frame.set_count(len(session.particles)))
