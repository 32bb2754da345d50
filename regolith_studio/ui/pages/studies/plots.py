"""Bands, tables and curves of the studies."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QResizeEvent
from PySide6.QtWidgets import QLabel, QStackedLayout, QTableWidgetItem, QWidget

from regolith_studio.coarsening.methods import METHODS
from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.messages import N_
from regolith_studio.scene.palette import DESCRIPTOR_COLOURS
from regolith_studio.session.choices import Choices
from regolith_studio.studies.coarsening import COLUMNS, CoarseningStudy
from regolith_studio.studies.lmax import LmaxStudy
from regolith_studio.studies.sweeps import (
    best_row,
    descriptor_error,
    differences,
    format_difference,
    significant,
)
from regolith_studio.ui.layout import control_row, left_aligned, vbox
from regolith_studio.ui.result_card import ResultRecord, ResultView
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import localized, number_text, tr, tr_count, translate
from regolith_studio.ui.widgets.fields import decimal_field
from regolith_studio.ui.widgets.heat_table import (
    HeatTable,
    centred_hint,
    fit_to_font,
    numbers_table,
    set_head_tips,
)
from regolith_studio.ui.widgets.labels import plain_symbol, rich_symbol
from regolith_studio.ui.widgets.plots.base import Numbers, plain_text
from regolith_studio.ui.widgets.plots.curves import HOVER_DISTANCE, CurvePlot, PlotCurve
from regolith_studio.ui.widgets.table import definition
from regolith_studio.ui.widgets.text_table import FontRowHeight

Values = tuple[float, ...]


@dataclass(frozen=True)
class Series:
    """Points with intervals.

    - ``label``, ``colour``: for the legend; rich text and hexadecimal RGB.
    - ``x``, ``y``: the points.
    - ``low``, ``high``: ends of the interval of each y.
    - ``left``, ``right``: ends of the interval of each x; empty if x is not measured.
    - ``line``: whether the points are joined.
    """

    label: str
    colour: str
    x: Values
    y: Values
    low: Values
    high: Values
    left: Values = ()
    right: Values = ()
    line: bool = True


class BandPlot(CurvePlot):
    """Points with error bars; tool tips show values and intervals."""

    def __init__(self, x: str, y: str, placeholder: str, log_y: bool = False) -> None:
        self._series: tuple[Series, ...] = ()
        self._bars: list[pg.PlotDataItem] = []
        super().__init__(x, y, placeholder, log_y)

    @property
    def series(self) -> tuple[Series, ...]:
        return self._series

    def set_series(self, series: Sequence[Series], behind: Sequence[PlotCurve] = ()) -> None:
        """Draw other series, and curves behind them."""
        self._series = tuple(series)
        points = [PlotCurve(s.label, s.colour, s.x, s.y, markers=True, line=s.line) for s in self._series]
        self.set_curves([*behind, *points])

    def numbers(self) -> Numbers:
        x, y = self._labels
        rows: list[tuple[str | float, ...]] = [
            (plain_text(s.label), px, left, right, py, low, high)
            for s in self._series
            for px, left, right, py, low, high in zip(
                s.x, s.left or s.x, s.right or s.x, s.y, s.low, s.high, strict=True
            )
        ]
        return ("curve", x, f"{x}, low", f"{x}, high", y, f"{y}, low", f"{y}, high"), rows

    def redraw(self) -> None:
        super().redraw()
        while self._bars:
            self.canvas.removeItem(self._bars.pop())
        for s in self._series:
            self._draw_bars(s.colour, np.repeat(s.x, 2), np.column_stack([s.low, s.high]).ravel())
            if s.left:
                self._draw_bars(s.colour, np.column_stack([s.left, s.right]).ravel(), np.repeat(s.y, 2))

    def value_at(self, place: QPointF) -> str:
        """Values and intervals of the nearest point; empty if it is far."""
        best, words = HOVER_DISTANCE, ""
        for s in self._series:
            for number, (x, y) in enumerate(zip(s.x, s.y, strict=True)):
                seen = self.scene_position(x, y)
                away = float(np.hypot(seen.x() - place.x(), seen.y() - place.y()))
                if away < best:
                    best, words = away, self._words(s, number)
        return words

    def scene_position(self, x: float, y: float) -> QPointF:
        with np.errstate(divide="ignore", invalid="ignore"):
            high = float(np.log10(y)) if self._log_y else y
        place: QPointF = self.canvas.getViewBox().mapViewToScene(QPointF(x, high))
        return place

    def _words(self, s: Series, n: int) -> str:
        x, y = (plain_text(label) for label in self._labels)
        across = " " + _interval(s.left[n], s.right[n]) if s.left else ""
        return (
            f"{plain_text(s.label)}\n{x}: {number_text(s.x[n], '.4g')}{across}\n"
            f"{y}: {number_text(s.y[n], '.4g')} {_interval(s.low[n], s.high[n])}"
        )

    def _draw_bars(self, colour: str, x: "np.typing.NDArray[np.float64]", y: object) -> None:
        ends = (np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        self._bars.append(self.canvas.plot(*ends, connect="pairs", pen=self.pen(colour)))


def _interval(low: float, high: float) -> str:
    return tr("({low:.4g} to {high:.4g})", low=low, high=high)


class SensitivityTable(QWidget):
    """A table with a row per change and a column per descriptor, or a placeholder."""

    def __init__(self, placeholder: str, headers: tuple[str, ...]) -> None:
        super().__init__()
        self._theme, self._headers = current_theme(), headers
        self._study: CoarseningStudy | None = None
        self.table = numbers_table(tr("Changes of errors in percentage points"))
        self.table.setTextElideMode(Qt.TextElideMode.ElideNone)
        self.table.setWordWrap(False)
        self._rows = FontRowHeight(self.table, 10)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(centred_hint(placeholder))
        self._stack.addWidget(self.table)

    def show_study(self, study: CoarseningStudy | None) -> None:
        """Show the differences of a sensitivity study, or the placeholder."""
        self._study = study if study is not None and len(study.rows) > 1 else None
        self._stack.setCurrentIndex(1 if self._study else 0)
        self._fill()

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme
        self._fill()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        fit_to_font(self.table, self.width(), self._rows, 1)

    def _fill(self) -> None:
        study = self._study
        if study is None:
            self.table.setRowCount(0)
            return
        labels = [translate(row.label) for row in study.rows[1:]]
        values, (low, high) = (100 * each for each in differences(study))
        sure, given = significant(study), 100 * study.rmsre
        top = float(np.abs(values).max(initial=0.0)) or 1.0
        self.table.setRowCount(len(labels))
        self.table.setColumnCount(len(self._headers))
        self.table.setVerticalHeaderLabels(labels)
        self.table.setHorizontalHeaderLabels(list(self._headers))
        set_head_tips(self.table, [definition(key) for key in COLUMNS])
        for r, label in enumerate(labels):
            for k, header in enumerate(self._headers):
                value = float(values[r, k])
                text = localized(format_difference(value))
                item = QTableWidgetItem(text if sure[r, k] or text == "0" else f"({text})")
                item.setToolTip(
                    tr(
                        "{row}, {column}: {before:.3g} % becomes {after:.3g} %",
                        row=label,
                        column=header,
                        before=given[0, k],
                        after=given[r + 1, k],
                    )
                    + "\n"
                    + tr(
                        "{value:+.3g} percentage points ({low:+.3g} to {high:+.3g})",
                        value=value,
                        low=low[r, k],
                        high=high[r, k],
                    )
                    + ("" if sure[r, k] else "\n" + tr("Not significant."))
                )
                item.setTextAlignment(Qt.AlignmentFlag.AlignCenter)
                item.setBackground(self._ground(value / top))
                self.table.setItem(r, k, item)
        fit_to_font(self.table, self.width(), self._rows, 1)

    def _ground(self, share: float) -> QColor:
        colour = QColor(self._theme.bad if share > 0 else self._theme.fit)
        colour.setAlphaF(0.65 * min(1.0, abs(share)) ** 0.5 if abs(share) > 1e-3 else 0.0)
        return colour


COMPUTE, RECOMPUTE = N_("Compute"), N_("Recompute")


def study_card(name: str, *captions: str) -> ResultView:
    return ResultView(f"{name}_result", captions, tr(COMPUTE), tr(RECOMPUTE), lines=2)


def study_panel(panel: QWidget, *parts: QWidget) -> None:
    """Lay a panel out: card and controls above what takes the room that is left."""
    vbox(*parts[:-1], (parts[-1], 1), parent=panel, margins=(8, 8, 8, 4))


def particles_text(study: CoarseningStudy | LmaxStudy) -> str:
    """Number of particles of a study, and of those that were left out."""
    words = [tr_count(N_("1 particle"), N_("{count} particles"), len(study.names))]
    if study.failures:
        words.append(tr("{count} left out", count=len(study.failures)))
    return ", ".join(words)


def coarsening_record(
    study: CoarseningStudy, choices: Choices, values: tuple[str, ...], note: str = ""
) -> ResultRecord:
    """What a study of the coarsening was made from and with."""
    method = translate(METHODS[choices.method].label)
    target = tr("target: particle")
    if choices.target == "fit":
        target = tr("target: fit of degree {l_max}", l_max=choices.l_max)
    numbers = sorted({row.n_facets for row in study.rows})
    facets = " – ".join(str(each) for each in (numbers[0], numbers[-1])[: len(numbers)])
    words = [method, tr("n = {facets}", facets=facets), target, tr("seed {seed}", seed=choices.seed)]
    if study.box_metric != "exact":
        words.append(tr("box of {name}", name=study.box_metric))
    if unmet := sum(study.n_unmet):
        total = len(study.names) * len(study.rows)
        unmet_text = tr("{unmet} of {total} requests not met exactly", unmet=unmet, total=total)
        note = "; ".join(filter(None, (note, unmet_text)))
    return ResultRecord(values, particles_text(study), ", ".join(words), note=note)


LMAX_PLACEHOLDER = N_("Root mean squared relative error of each descriptor against l<sub>max</sub>.")


BEST_TIP = N_("The smallest mean RMSRE of the six descriptors; of equal ones, the smallest Jaccard distance")


class LmaxStudyPanel(QWidget):
    """A curve per descriptor, a marker at the chosen l_max, and the smallest l_max within a tolerance."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("lmax_study")
        self.plot = BandPlot(tr("Maximum degree l<sub>max</sub>"), "RMSRE [%]", tr(LMAX_PLACEHOLDER))
        self.card = study_card("lmax_study", tr("Smallest l<sub>max</sub>"))
        spoken = tr("Largest error in percent")
        self.tolerance = decimal_field("lmax_study_tolerance", spoken, 0.1, 100.0, 5.0, " %", decimals=1)
        asked = control_row(QLabel(tr("Smallest l<sub>max</sub> with every error below")), self.tolerance)
        study_panel(self, self.card, left_aligned(asked), self.plot)

    def show_study(self, study: LmaxStudy | None) -> None:
        """Draw a study, or nothing."""
        if study is None:
            self.plot.set_series([])
            return
        values, (low, high) = 100.0 * study.rmsre(), 100.0 * study.bands()
        degrees = tuple(float(degree) for degree in study.degrees)
        series = [
            Series(
                rich_symbol(CATALOGUE[key].symbol),
                DESCRIPTOR_COLOURS[number % len(DESCRIPTOR_COLOURS)],
                degrees,
                tuple(values[:, number].tolist()),
                tuple(low[:, number].tolist()),
                tuple(high[:, number].tolist()),
            )
            for number, key in enumerate(study.keys)
        ]
        self.plot.set_series(series)
        self.plot.legend.setToolTip("\n".join(map(definition, study.keys)))

    def record(self, study: LmaxStudy, choices: Choices) -> ResultRecord:  # noqa: ARG002
        """The smallest degree within the tolerance, and what the study was made from and with."""
        found = study.smallest_l_max(self.tolerance.value() / 100)
        note = "" if found is not None else tr("none of these")
        made_with = tr("degrees {first} to {last}", first=study.degrees[0], last=study.degrees[-1])
        values = ("–" if found is None else str(found),)
        return ResultRecord(values, particles_text(study), made_with, note=note)

    def show_l_max(self, l_max: int) -> None:
        self.plot.set_marker(float(l_max))


LOSS_PLACEHOLDER = N_("Root mean squared relative error of each descriptor, one row per loss function.")
HEADERS = (*(plain_symbol(CATALOGUE[key].symbol) for key in LOSS_KEYS), "Jaccard")
KEYS = (*LOSS_KEYS, JACCARD)


class CoarseningStudyPanel(QWidget):
    """A table with a row per loss function and a column per descriptor, in per cent."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("coarsening_study")
        self._study: CoarseningStudy | None = None
        self.table = HeatTable(tr(LOSS_PLACEHOLDER))
        self.card = study_card("coarsening_study", tr("RMSRE of the best row"), tr("Its Jaccard distance"))
        self.card.caption(0, tr("RMSRE of the best row"), tr(BEST_TIP))
        study_panel(self, self.card, self.table)

    def show_study(self, study: CoarseningStudy | None) -> None:
        """Show a study, or nothing."""
        self._study = study if study is not None and study.names else None
        if self._study is None:
            self.table.set_values([], HEADERS, [])
            return
        labels, ends = [translate(row.label) for row in self._study.rows], self._study.bands.tolist()
        tips = [definition(key) for key in KEYS]
        self.table.set_values(labels, HEADERS, self._study.rmsre.tolist(), (ends[0], ends[1]), tips)
        self.table.mark_row(best_row(self._study), tr(BEST_TIP))
        self._set_tool_tips()

    def record(self, study: CoarseningStudy, choices: Choices) -> ResultRecord:
        """The best row, and what the study was made from and with."""
        best = best_row(study)
        values = tuple(
            number_text(float(each), ".1%")
            for each in (descriptor_error(study.rmsre)[best], study.rmsre[best, -1])
        )
        notes = [tr("best: {row}", row=translate(study.rows[best].label))]
        if len(study.names) > 1:
            notes.append(
                tr("below each RMSRE [%] its {share:.0%} bootstrap interval", share=study.confidence)
            )
        return coarsening_record(study, choices, values, "; ".join(notes))

    def set_theme(self, theme: Theme) -> None:  # noqa: ARG002
        self._set_tool_tips()

    def _set_tool_tips(self) -> None:
        """Set the tool tips of the cells: values with bootstrap intervals."""
        study = self._study
        if study is None or len(self.table.values()) != len(study.rows):
            return
        low, high = 100 * study.bands
        for r, row in enumerate(study.rows):
            for k, header in enumerate(HEADERS):
                item = self.table.table.item(r, k)
                if item is not None:
                    item.setToolTip(
                        tr(
                            "{row}, {column}: {value:.3g} % ({low:.3g} to {high:.3g}; {share:.0%} bootstrap"
                            " interval)",
                            row=translate(row.label),
                            column=header,
                            value=100 * study.rmsre[r, k],
                            low=low[r, k],
                            high=high[r, k],
                            share=study.confidence,
                        )
                    )
