"""Plots, tables and sections below the views."""

import math
from collections.abc import Mapping, Sequence
from itertools import accumulate, chain, pairwise

import numpy as np
from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QSplitter,
    QTableWidgetItem,
    QWidget,
)

from regolith_studio.coarsening.lower_bounds import bounds_in_force
from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.cross_section import CrossSection
from regolith_studio.harmonics.coefficients import power_spectrum
from regolith_studio.messages import N_
from regolith_studio.scene.clipping import DIRECTIONS
from regolith_studio.scene.shapes import LABELS, NAMES, PARTICLE
from regolith_studio.session.choices import Choices
from regolith_studio.session.results import Results
from regolith_studio.session.session import Session
from regolith_studio.ui.bindings import Bindings
from regolith_studio.ui.layout import STRETCH, hbox, named, tabs, vbox
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import number_text, tr, translate
from regolith_studio.ui.views.three_views import ThreeViews
from regolith_studio.ui.widgets.fields import ChoiceBox, NumberSlider, NumberSpec
from regolith_studio.ui.widgets.heat_table import numbers_table
from regolith_studio.ui.widgets.labels import grouped_number, plain_symbol, short_number
from regolith_studio.ui.widgets.plots.bars import AmplitudePlot, BarPlot, BarSeries
from regolith_studio.ui.widgets.plots.base import Numbers
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve
from regolith_studio.ui.widgets.table import definition
from regolith_studio.ui.widgets.text_table import FontRowHeight

COLUMNS = (N_("Particle"), N_("Fit"), N_("Polyhedron"))
NARROW_COLUMNS = (N_("Particle"), N_("Fit"), N_("Solid"))
_MIN_LABEL_WIDTH = 490
_NARROW_DIGITS = 44
"""Width in digits below which headers and numbers are short."""
_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
DIGITS, NARROW_DIGITS = 4, 3
"""Significant digits of the numbers; tool tips have six."""


class DescriptorTablePanel(QWidget):
    """A table with a row per descriptor of the catalogue."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("descriptor_table")
        self._keys = [key for key, row in CATALOGUE.items() if not row.costly]
        self.table = numbers_table(tr("Descriptors"))
        self.table.setRowCount(len(self._keys))
        self.table.setColumnCount(len(COLUMNS))
        self.table.horizontalHeader().setDefaultAlignment(_RIGHT)
        FontRowHeight(self.table, 9)
        vbox(self.table, parent=self)
        self._values: tuple[Mapping[str, float] | None, ...] = (None,) * len(COLUMNS)
        self._name_rows()

    def show_results(self, results: Results) -> None:
        achieved = results.best.achieved if results.best and results.best.achieved else None
        self._values = (results.particle_descriptors, results.fit_descriptors, achieved)
        self._fill()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._name_rows()
        self._fill()

    @property
    def _narrow(self) -> bool:
        return self.width() < self.fontMetrics().horizontalAdvance("0" * _NARROW_DIGITS)

    def _fill(self) -> None:
        digits = NARROW_DIGITS if self._narrow else DIGITS
        for column, values in enumerate(self._values):
            for row, key in enumerate(self._keys):
                self.table.setItem(row, column, _cell(values, key, digits))

    def _name_rows(self) -> None:
        for column, name in enumerate(NARROW_COLUMNS if self._narrow else COLUMNS):
            head = QTableWidgetItem(tr(name))
            head.setToolTip(tr(COLUMNS[column]))
            head.setTextAlignment(_RIGHT)
            self.table.setHorizontalHeaderItem(column, head)
        for number, key in enumerate(self._keys):
            row = CATALOGUE[key]
            short = plain_symbol(row.symbol) + row.unit_suffix
            item = QTableWidgetItem(f"{tr(row.label)} {short}" if self.width() > _MIN_LABEL_WIDTH else short)
            item.setToolTip(definition(key))
            self.table.setVerticalHeaderItem(number, item)


def _cell(values: Mapping[str, float] | None, key: str, digits: int) -> QTableWidgetItem:
    known = values is not None and key in values
    item = QTableWidgetItem(short_number(values[key], digits) if values is not None and known else "–")
    if values is not None and known:
        item.setToolTip(number_text(values[key], ".6g"))
    item.setTextAlignment(_RIGHT)
    return item


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
        vbox(self.plot, parent=self)
        self._shown: tuple[Results, Choices] | None = None
        self._polyhedron: dict[str, float] = {}
        self._bounds: dict[str, float] = {}
        self._against_particle: dict[str, float] = {}
        self._polyhedron_of = ""

    def show_results(self, results: Results, choices: Choices) -> None:
        self._shown = (results, choices)
        if choices.selected != self._polyhedron_of:
            self._polyhedron, self._bounds, self._against_particle = {}, {}, {}
            self._polyhedron_of = choices.selected
        done = results.coarsened
        if "coarsening" in results.failures:
            self._polyhedron, self._bounds, self._against_particle = {}, {}, {}
        if results.best is not None and results.best.errors:  # of a step too, while a weight is moved
            self._polyhedron = {**results.best.errors, JACCARD: results.best.jaccard_distance}
        if done is not None:
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

    def set_theme(self, theme: Theme) -> None:  # noqa: ARG002
        if self._shown:
            self.show_results(*self._shown)


def _percent(errors: object) -> tuple[float, ...]:
    values = dict(errors)  # type: ignore[call-overload]
    return tuple(100.0 * values.get(key, math.nan) for key in KEYS)


class LossCurvePanel(QWidget):
    """Current and best loss of the coarsening."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("loss_curve")
        self.plot = CurvePlot(tr("Step"), tr("Loss"), tr("The loss appears when the coarsening begins."))
        self.plot.canvas.getViewBox().setLimits(xMin=-0.5)  # there is no step before the first
        vbox(self.plot, parent=self)
        self._results: Results | None = None

    def show_results(self, results: Results) -> None:
        self._results = results
        history, done = results.loss_history, results.coarsened
        if not history and done is not None:  # of a method that has taken no step
            history = ((0, done.loss),)
        if not history:
            if results.best is None:  # of another particle, or of none
                self.plot.set_curves([])
                self.plot.set_hint("")
            return
        best = accumulate((loss for _, loss in history), min)
        rows = [(*each, low) for each, low in zip(history, best, strict=True)]
        steps, losses, lowest = _broken_at_starts(rows)
        theme = self.plot.theme
        curves = [
            PlotCurve(tr("current"), theme.polyhedron, steps, losses, markers=len(steps) < 40),
            PlotCurve(tr("best so far"), theme.muted, steps, lowest, dash=True),
        ]
        if done is not None:
            if done.loss > 1.0000001 * rows[-1][2]:
                del curves[1]  # of a step that did not meet the conditions
            end = (steps[-1:], (done.loss,))
            curves.append(PlotCurve(tr("result"), theme.text, *end, markers=True, line=False))
        self.plot.set_curves(curves)
        progress = results.coarsening_progress
        running = done is None and progress is not None
        self.plot.set_hint(
            tr("step {at} of {total}", at=progress.step, total=progress.steps) if running and progress else ""
        )

    def set_theme(self, theme: Theme) -> None:  # noqa: ARG002
        if self._results:
            self.show_results(self._results)


def _broken_at_starts(rows: Sequence[tuple[float, float, float]]) -> tuple[tuple[float, ...], ...]:
    """Columns of rows of step, loss and lowest loss, with a row of NaN where another start begins."""
    gap = (math.nan,) * 3
    parts = [(gap, row) if row[0] <= before[0] else (row,) for before, row in pairwise(rows)]
    return tuple(zip(rows[0], *chain.from_iterable(parts), strict=True))


DECADES = 6.5
"""Range of the axis below the highest bar."""


class SpectrumPlot(AmplitudePlot):
    """Amplitudes of a fit."""

    percents: FloatArray = np.empty(0)

    def numbers(self) -> Numbers:
        return ("l", tr("amplitude [%]")), list(enumerate(self.percents.tolist(), start=1))


class SpectrumPanel(QWidget):
    """sqrt(A_l) relative to the mean radius, on a logarithmic scale."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("spectrum")
        self.plot = SpectrumPlot(
            tr("Amplitude √A<sub>l</sub> / c<sub>00</sub> [%]"),
            tr("The spectrum appears when the particle is fitted."),
        )
        vbox(self.plot, parent=self)
        self._shown: tuple[Results, Choices] | None = None

    def show_results(self, results: Results, choices: Choices) -> None:
        self._shown = (results, choices)
        self.plot.set_empty(results.fit is None)
        if results.fit is None:
            return
        shares = self.plot.percents = 100.0 * power_spectrum(results.fit.coefficients).relative_amplitudes[1:]
        theme, known = self.plot.theme, np.arange(1, len(shares) + 1) <= choices.l_max
        logs = np.log10(np.maximum(shares, 1e-12))
        top = math.ceil(float(logs.max()) * 2 + 0.2) / 2
        floor = max(top - DECADES, math.floor(float(logs.min())))
        parts = [(np.where(known, shares, np.nan), 0.72, theme.fit)]
        parts.append((np.where(known, np.nan, shares), 0.72, theme.border))
        self.plot.draw_bars(parts, floor, top)
        kept = tr("up to l<sub>max</sub> = {l_max}", l_max=choices.l_max)
        self.plot.set_legend([(theme.fit, kept), (theme.border, tr("above l<sub>max</sub>"))])

    def set_theme(self, theme: Theme) -> None:  # noqa: ARG002
        if self._shown:
            self.show_results(*self._shown)


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
        self.flipped = named(QCheckBox(tr("Flip")), "section_flipped", tip=tr("Show the other half"))
        self.place = named(NumberSlider(PLACE), "section_place")
        self.plot = CurvePlot("y [µm]", "z [µm]", tr("Turn on Section in the tool bar."))
        self.plot.setAccessibleName(tr("Cross-section"))
        self.plot.canvas.getViewBox().setAspectLocked(True)
        self._place()
        self.direction.currentIndexChanged.connect(lambda _: three_views.cut_across(self.direction.value()))
        self.flipped.toggled.connect(self._sections.set_flipped)
        self.place.valueChanged.connect(self._sections.set_position)
        self._sections.changed.connect(self.refresh)
        self.refresh()

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme
        self.refresh()

    def refresh(self) -> None:
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
        vbox(
            hbox(self.direction, self.flipped, STRETCH, margins=(8, 6, 8, 0), spacing=10),
            hbox(self.place, margins=(8, 0, 8, 0)),
            (self.plot, 1),
            parent=self,
        )


def _mirrored(cut: CrossSection, direction: str) -> bool:
    """Whether the horizontal axis points in the negative direction."""
    if direction not in AXES:
        return False
    return bool(cut.normal["xyz".index(direction)] * (-1.0 if direction == "y" else 1.0) < 0.0)


def _area_text(area: float, whole: float, name: str) -> str:
    words = f"{grouped_number(area)} µm²"
    return words if name == PARTICLE or not whole else f"{words} ({number_text(area / whole - 1, '+.1%')})"


LINES = 9
"""Minimum height in lines of text."""
FONT_SIZE = 84
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
        self._fit_to_font()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._group()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._group()
            self._fit_to_font()

    def _fit_to_font(self) -> None:
        for group in (self.left, self.right):
            group.setMinimumHeight(max(120, LINES * self.fontMetrics().height()))

    def _group(self) -> None:
        """Show two groups if there is room for two plots with legends, else one."""
        narrow = self.width() < FONT_SIZE * self.fontMetrics().horizontalAdvance("0")
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
