"""The plots below the views in two groups of tabs: errors and descriptors, loss and spectrum."""

from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QSplitter

from regolith_studio.session.session import Session
from regolith_studio.ui.bindings import Bindings
from regolith_studio.ui.layout import tabs
from regolith_studio.ui.pages.explore.section_panel import SectionPanel
from regolith_studio.ui.panels.descriptor_table import DescriptorTablePanel
from regolith_studio.ui.panels.error_bars import ErrorBarsPanel
from regolith_studio.ui.panels.loss_curve import LossCurvePanel
from regolith_studio.ui.panels.spectrum import SpectrumPanel
from regolith_studio.ui.translation import tr
from regolith_studio.ui.views.three_views import ThreeViews

LINES = 9
"""Minimum height in lines of text."""
LETTERS = 84
"""Width in digits below which both groups become one."""


class PlotArea(QSplitter):
    """Two groups of tabs side by side, or one group in narrow windows."""

    def __init__(self, three_views: ThreeViews) -> None:
        super().__init__(Qt.Orientation.Horizontal)
        self.setChildrenCollapsible(False)
        self.setHandleWidth(7)
        self.error_bars, self.table = ErrorBarsPanel(), DescriptorTablePanel()
        self.loss_curve, self.spectrum = LossCurvePanel(), SpectrumPanel()
        self.section = SectionPanel(three_views)
        self.left = tabs(
            "plots_left",
            [(self.error_bars, tr("Errors")), (self.table, tr("Descriptors")), (self.section, tr("Section"))],
        )
        self._second = [(self.loss_curve, tr("Loss")), (self.spectrum, tr("Spectrum"))]
        self.right = tabs("plots_right", self._second)
        self._before = 0
        for number, group in enumerate((self.left, self.right)):
            self.addWidget(group)
            self.setStretchFactor(number, 1)
        self.setSizes([1000, 1000])
        self._keep_readable()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._group()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._group()
            self._keep_readable()

    def _keep_readable(self) -> None:
        for group in (self.left, self.right):
            group.setMinimumHeight(max(120, LINES * self.fontMetrics().height()))

    def _group(self) -> None:
        """Show two groups if there is room for two plots with legends, else one."""
        narrow = self.width() < LETTERS * self.fontMetrics().horizontalAdvance("0")
        if narrow == self.right.isHidden():
            return
        shown = (self.left.currentWidget(), self.right.currentWidget())
        group = self.left if narrow else self.right
        for panel, title in self._second:
            group.addTab(panel, title)
        self.right.setHidden(narrow)
        for now, panel in zip((self.left, self.right), shown, strict=True):
            if now.indexOf(panel) >= 0:
                now.setCurrentWidget(panel)

    def show_section(self, shown: bool) -> None:
        """Show the tab of the cross-section, or the previous one."""
        if shown:
            self._before = self.left.currentIndex()
            self.left.setCurrentWidget(self.section)
        elif self.left.currentWidget() is self.section:
            self.left.setCurrentIndex(self._before)

    def wire(self, session: Session, bindings: Bindings) -> None:
        """Connect the plots with the results of the session."""

        def errors() -> None:
            self.error_bars.show_results(session.results, session.choices)

        def spectrum() -> None:
            self.spectrum.show_results(session.results, session.choices)

        bindings.refresh(
            "descriptors coarsening comparison choices", errors, ("selected", "target"), slow=True
        )
        bindings.refresh(
            "descriptors coarsening", lambda: self.table.show_results(session.results), slow=True
        )
        bindings.refresh("coarsening", lambda: self.loss_curve.show_results(session.results), slow=True)
        bindings.refresh("fit choices", spectrum, ("l_max",), slow=True)
