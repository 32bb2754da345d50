"""Evaluation of shape models against measured particles: ranking, figures and tables of a study."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QGridLayout,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QSizePolicy,
    QSpinBox,
    QStackedLayout,
    QTableWidget,
    QTableWidgetItem,
    QWidget,
)

from regolith_studio.descriptors.catalogue import CATALOGUE, powers
from regolith_studio.io.tables import Cell, Table
from regolith_studio.jobs.model_jobs import ModelEvaluationResult
from regolith_studio.messages import N_
from regolith_studio.scene.palette import DESCRIPTOR_COLOURS
from regolith_studio.shape_models.models import MODELS
from regolith_studio.studies.population import PopulationStudy
from regolith_studio.studies.population_tables import (
    CUT,
    MEASURED,
    PopulationCurve,
    PopulationPanel,
    distance_table,
    pair_table,
    ranking_table,
    target_table,
)
from regolith_studio.ui.layout import scrolled, tabs, vbox
from regolith_studio.ui.result_card import ResultRecord, ResultView
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import localized, number_text, tr, translate
from regolith_studio.ui.widgets.forms import enter_values, field_values
from regolith_studio.ui.widgets.heat_table import centred_hint
from regolith_studio.ui.widgets.labels import hint_label, plain_symbol, with_subscripts
from regolith_studio.ui.widgets.plots.base import legend_text
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

    ``name``: of the figure, a key of :data:`AXES`.
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
        vbox(self.legend, (self._grid, 1), parent=self, margins=(8, 6, 8, 6))

    def set_panels(self, panels: Sequence[PopulationPanel], study: PopulationStudy) -> None:
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

    def set_theme(self, theme: Theme) -> None:  # noqa: ARG002
        self._draw()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._place()

    def _place(self) -> None:
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
        self.legend.setText(legend_text((colour, label) for label, colour in entries.items()))

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


WORDS = {
    "wasserstein": "W",
    "wasserstein_low": N_("from"),
    "wasserstein_high": N_("to"),
    "floor": N_("Noise"),
    "floor_p5": N_("5th"),
    "floor_p95": N_("95th"),
    "kolmogorov_smirnov": "KS",
    "kolmogorov_smirnov_low": N_("KS from"),
    "kolmogorov_smirnov_high": N_("KS to"),
    "kolmogorov_smirnov_floor": N_("KS noise"),
    "wasserstein_in_floors": N_("W / noise"),
    "kolmogorov_smirnov_in_floors": N_("KS / noise"),
    "energy_distance": N_("Energy distance"),
}
"""Short headers; tool tips have the long ones."""
OTHER_WORDS = (
    *(N_("Model"), N_("Weighting"), N_("Descriptor"), N_("First"), N_("Second")),
    *(N_("Target"), N_("Value"), N_("Requested"), N_("Reached"), N_("Measured"), N_("Drawn")),
)
"""Headers that equal the names of their columns, marked for translation."""
COLUMN_NAMES = (
    *(N_("model"), N_("weighting"), N_("descriptor"), N_("first"), N_("second")),
    *(N_("target"), N_("value"), N_("wanted"), N_("reached"), N_("measured"), N_("drawn")),
    *(N_("wasserstein"), N_("wasserstein low"), N_("wasserstein high")),
    *(N_("floor"), N_("floor p5"), N_("floor p95")),
    *(N_("kolmogorov smirnov"), N_("kolmogorov smirnov low"), N_("kolmogorov smirnov high")),
    *(N_("kolmogorov smirnov floor"), N_("wasserstein in floors")),
    *(N_("kolmogorov smirnov in floors"), N_("energy distance")),
)
"""Names of all columns, marked for translation."""


class StudyTableView(QTableWidget):
    """Shows a :class:`~regolith_studio.io.tables.Table` with labels for keys of models and descriptors."""

    def __init__(self, name: str, spoken: str) -> None:
        super().__init__()
        self.setObjectName(name)
        self.setAccessibleName(spoken)
        self.setShowGrid(False)
        self.verticalHeader().hide()
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)

    def show_table(self, table: Table) -> None:
        self.setColumnCount(len(table.columns))
        self.setRowCount(len(table.rows))
        for at, column in enumerate(table.columns):
            unit = f" [{column.unit}]" if column.unit else ""
            words = WORDS.get(column.name, column.name.replace("_", " ").capitalize())
            item = QTableWidgetItem(f"{tr(words)}{unit}")
            item.setToolTip(f"{tr(column.name.replace('_', ' '))}{unit}")
            self.setHorizontalHeaderItem(at, item)
        for row, cells in enumerate(table.rows):
            for at, cell in enumerate(cells):
                self.setItem(row, at, _item(cell))
        self.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)


TEXTS = (*(N_("yes"), N_("no"), N_("number"), N_("volume")), *(N_("measured particles"), N_("figures")))
"""Cells of the tables that are translated."""


def _item(cell: Cell) -> QTableWidgetItem:
    if isinstance(cell, str):
        known = {key: model.label for key, model in MODELS.items()}
        descriptor = CATALOGUE.get(cell)
        return QTableWidgetItem(translate(known.get(cell, descriptor.label if descriptor else cell)))
    item = QTableWidgetItem("" if cell is None else number_text(cell, ".3g"))
    item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
    return item


WAITING = N_(
    "Models are fitted to one half of the sample and evaluated on the other, compared with sampling noise."
)
FIGURES = {
    "number": N_("By number"),
    "volume": N_("By volume"),
    "pairs": N_("Pairs (plot)"),
    "quantiles": N_("Quantiles"),
    "components": N_("Components"),
}
TABLES: dict[str, tuple[str, Callable[[PopulationStudy], Table]]] = {
    "targets": (N_("Targets"), target_table),
    "distances": (N_("Distances"), distance_table),
    "energies": (N_("Pairs (table)"), pair_table),
}
HEADERS = (
    N_("Model"),
    N_("W / noise"),
    N_("KS / noise"),
    N_("Energy"),
    N_("Classifier"),
    N_("Novelty"),
    N_("Rejected"),
)
TIPS = (
    N_("Sorted by distance to the sample"),
    N_(
        "Mean Wasserstein distance to the half that was held out, over that between random halves: 1 is noise"
    ),
    N_("The same for the Kolmogorov-Smirnov distance"),
    N_("Mean energy distance of pairs of descriptors: 0 for equal distributions"),
    N_("Accuracy of a classifier of drawn and measured particles: at 0.5 they are indistinguishable"),
    N_("Median distance to the nearest measured particle, over that between measured ones: 0 is a copy"),
    N_("Rejected draws"),
)
NOISE = 1.2
"""Distance over the noise of sampling up to which a model counts as indistinguishable from the sample."""
TOLD_APART = 0.6
"""Share that a classifier may tell right of an indistinguishable model; half of them is chance."""
NUMBERS = Qt.AlignmentFlag.AlignCenter


class EvaluationPanel(QWidget):
    """Starts a study and shows its results so far."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("model_judgement")
        self.all_models = QCheckBox(tr("all models"))
        self.splits, self.repeats = QSpinBox(), QSpinBox()
        self._fields = {"all_models": self.all_models, "splits": self.splits, "repeats": self.repeats}
        self.ranking = QTableWidget(0, len(HEADERS))
        self.notes = hint_label()
        captions = (tr("W / noise"), tr("Classifier accuracy"))
        self.card = ResultView("model_judge", captions, tr("Evaluate"), tr("Evaluate"))
        for place, tip in enumerate((TIPS[1], TIPS[4])):
            self.card.caption(place, captions[place], tr(tip))
        self.figures = {name: PanelGrid(name) for name in FIGURES}
        self.places = {name: scrolled(grid) for name, grid in self.figures.items()}
        self.tabs = tabs("model_figures", [(self._ranked(), tr("Ranking"))])
        self.tables = {
            name: StudyTableView(f"model_{name}", tr(title)) for name, (title, _) in TABLES.items()
        }
        for name, (title, _) in TABLES.items():
            self.tabs.addTab(self.tables[name], tr(title))
        for name, title in FIGURES.items():
            self.tabs.addTab(self.places[name], tr(title))
        vbox(self.card, self._options(), (self.tabs, 1), parent=self, margins=(8, 6, 8, 0))

    def value(self) -> dict[str, Any]:
        """All models or only the selected one, number of splits, and draws from each fit."""
        return field_values(self._fields)

    def setValue(self, value: Mapping[str, Any]) -> None:
        enter_values(self._fields, value)

    def show_evaluated(self, evaluated: ModelEvaluationResult | None) -> ResultRecord:
        """Show a study, complete or not, or nothing; returns the record of the card."""
        for name, grid in self.figures.items():
            if evaluated is not None:
                grid.set_panels(evaluated.panels[name], evaluated.study)
            at = self.tabs.indexOf(self.places[name])
            self.tabs.setTabVisible(at, evaluated is not None and bool(evaluated.panels[name]))
        for name, view in self.tables.items():
            self.tabs.setTabVisible(self.tabs.indexOf(view), evaluated is not None)
            if evaluated is not None:
                view.show_table(TABLES[name][1](evaluated.study))
        self._stack.setCurrentIndex(1 if evaluated else 0)
        if evaluated is None:
            return ResultRecord()
        table = ranking_table(evaluated.study)
        self.ranking.setRowCount(len(table.rows))
        for row, cells in enumerate(table.rows):
            key, near, gap, energy, accuracy, novelty, rejected, _ = cells
            words = (
                tr(MODELS[str(key)].label),
                localized(f"{near:.2f}"),
                localized(f"{gap:.2f}"),
                localized(f"{energy:.2f} %"),
                localized(f"{accuracy:.3f}"),
                localized(f"{novelty:.2f}"),
                localized(f"{rejected:.1f} %"),
            )
            for column, text in enumerate(words):
                item = QTableWidgetItem(text)
                if column:
                    item.setTextAlignment(NUMBERS)
                self.ranking.setItem(row, column, item)
        self.notes.setText(with_subscripts(translate(table.notes[0])))
        return self._answer(*table.rows[0][:5])

    def _answer(self, key: Cell, near: Cell, _gap: Cell, _energy: Cell, told: Cell) -> ResultRecord:
        """The assessment on the model that is nearest to the sample."""
        model = tr(MODELS[str(key)].label)
        if float(str(near)) <= NOISE and float(str(told)) <= TOLD_APART:
            sentence = tr("{model}: indistinguishable from the sample in size and form.", model=model)
        else:
            sentence = tr(
                "{model}: {near:.2g} times as far from the sample as two halves of it are from each other.",
                model=model,
                near=float(str(near)),
            )
        values = (number_text(float(str(near)), ".2f"), number_text(float(str(told)), ".0%"))
        return ResultRecord(values, note=sentence)

    def _options(self) -> QHBoxLayout:
        row = QHBoxLayout()
        for name, field, words in (
            ("splits", self.splits, tr("splits")),
            ("repeats", self.repeats, tr("draws from each fit")),
        ):
            field.setRange(1, 50)
            field.setValue(5 if name == "splits" else 1)
            field.setObjectName(f"model_{name}")
            field.setAccessibleName(words[:1].upper() + words[1:])
            row.addWidget(field)
            row.addWidget(QLabel(words))
        self.all_models.setObjectName("model_all_models")
        self.all_models.setToolTip(tr("Evaluate every model, not only the chosen one."))
        row.addWidget(self.all_models)
        row.addStretch(1)
        return row

    def _ranked(self) -> QWidget:
        self.ranking.setObjectName("model_ranking")
        self.ranking.setAccessibleName(tr("Ranking of the models"))
        for at, (words, tip) in enumerate(zip(HEADERS, TIPS, strict=True)):
            item = QTableWidgetItem(tr(words))
            item.setToolTip(tr(tip))
            self.ranking.setHorizontalHeaderItem(at, item)
        self.ranking.verticalHeader().hide()
        self.ranking.setShowGrid(False)
        self.ranking.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.ranking.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        header = self.ranking.horizontalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        filled = QWidget()
        vbox((self.ranking, 1), self.notes, parent=filled, margins=(8, 6, 8, 6))
        page = QWidget()
        self._stack = QStackedLayout(page)
        self._stack.addWidget(centred_hint(tr(WAITING)))
        self._stack.addWidget(filled)
        return page
