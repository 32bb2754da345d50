"""Plots of the sample: two descriptors, their distributions, and the distance to other materials."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QColor, QPixmap, QResizeEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QFileDialog,
    QHeaderView,
    QLabel,
    QListWidget,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QToolButton,
    QWidget,
)

from regolith_studio.descriptors.catalogue import CATALOGUE
from regolith_studio.descriptors.distributions import THRESHOLD, WEIGHTINGS, Distribution
from regolith_studio.io.tables import Column, Table
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.matching_jobs import DrawnMatch, MatchRequest, draw_match
from regolith_studio.messages import N_
from regolith_studio.readers.settings import UNITS
from regolith_studio.scene.palette import DESCRIPTOR_COLOURS
from regolith_studio.session.results import ParticleEntry
from regolith_studio.session.sample_table import has_weights, statistics_distribution, statistics_table
from regolith_studio.shape_models.materials import materials
from regolith_studio.studies.matching import MatchedPart
from regolith_studio.ui.dialogs.files import LABELS, FolderDialog
from regolith_studio.ui.layout import control_row, hbox, named, stacked, vbox
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.result_card import ResultRecord, ResultState, ResultView, RunController
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import number_text, rich, tr, tr_count
from regolith_studio.ui.widgets.fields import ChoiceBox, choice
from regolith_studio.ui.widgets.forms import enter_values, field_values, on_change
from regolith_studio.ui.widgets.labels import hint_label, plain_symbol, rich_symbol, short_number
from regolith_studio.ui.widgets.plots.base import Plot
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve
from regolith_studio.ui.widgets.table import definition
from regolith_studio.ui.widgets.text_table import FontRowHeight, TextTable

ZINGG = ("flatness", "elongation")
SYMBOLS = ("o", "s", "t", "d", "star", "p", "h", "+")
_CORNERS = ((N_("blade"), 0, 0), (N_("rod"), 1, 0), (N_("disc"), 0, 1), (N_("equant"), 1, 1))
"""Zingg's form classes, and whether flatness and elongation exceed the threshold."""


class ScatterPanel(QWidget):
    """A point per particle; a click selects it, with Ctrl it is added to the selection."""

    pointChosen = Signal(str, bool)  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("scatter")
        self._entries: tuple[ParticleEntry, ...] = ()
        self._chosen: frozenset[str] = frozenset()
        self._items: list[Any] = []
        self._corners: dict[tuple[int, int], pg.TextItem] = {}
        self.across = _descriptor_box("scatter_x", tr("Horizontal axis"))
        self.up = _descriptor_box("scatter_y", tr("Vertical axis"))
        for box in (self.across, self.up):
            box.setMinimumContentsLength(max(len(tr(CATALOGUE[key].label)) for key in ZINGG))
        self.log = named(QCheckBox(tr("Logarithmic")), "scatter_log")
        self.zingg = QToolButton()
        self.zingg.setObjectName("scatter_zingg")
        self.zingg.setToolTip(tr("Flatness against elongation, with Zingg's classes of form"))
        self.zingg.setText("Zingg")
        self.plot = Plot("", "", tr("The plot appears when the particles are measured."))
        self._arrange()
        self.set_axes(*ZINGG)

    def axes(self) -> tuple[str, str]:
        return self.across.value(), self.up.value()

    def set_axes(self, x: str, y: str) -> None:
        for box, key in ((self.across, x), (self.up, y)):
            box.setValue(key)
        if self.axes() == ZINGG:
            self.log.setChecked(False)
        self._draw()

    def show_entries(self, entries: Sequence[ParticleEntry], chosen: Sequence[str]) -> None:
        """Draw other particles and highlight the selected ones."""
        self._entries = tuple(entry for entry in entries if entry.descriptors)
        self._chosen = frozenset(chosen)
        self._draw()

    def set_theme(self, theme: Theme) -> None:  # noqa: ARG002
        self._draw()  # the names of Zingg's classes take the font of when they are drawn

    def _arrange(self) -> None:
        against = QLabel(tr("against"))
        vbox(
            control_row(self.up, against, self.across, self.log, self.zingg, margins=(8, 6, 8, 0)),
            (self.plot, 1),
            parent=self,
        )
        on_change((self.across, self.up, self.log), self._draw)
        self.zingg.clicked.connect(lambda: self.set_axes(*ZINGG))
        self.plot.canvas.getViewBox().sigResized.connect(self._place_zingg)

    def _draw(self) -> None:
        canvas = self.plot.canvas
        for item in self._items:
            canvas.removeItem(item)
        self._items, self._corners = [], {}
        self.plot.set_empty(not self._entries)
        if not self._entries:
            return
        x, y = self.axes()
        self.plot.set_labels(_axis_label(x), _axis_label(y))
        logarithmic = self.log.isChecked()
        canvas.setLogMode(x=logarithmic, y=logarithmic)
        if (x, y) == ZINGG:
            self._draw_zingg()
        groups = list(dict.fromkeys(entry.particle.group for entry in self._entries))
        for number, group in enumerate(groups):
            self._draw_group([e for e in self._entries if e.particle.group == group], number)
        named = [
            (DESCRIPTOR_COLOURS[n % len(DESCRIPTOR_COLOURS)], str(rich(g))) for n, g in enumerate(groups) if g
        ]
        self.plot.set_legend(named if len(groups) > 1 else [])
        count = len(self._entries)
        self.plot.set_hint(tr_count(N_("1 particle"), N_("{count} particles"), count))
        canvas.getViewBox().enableAutoRange()
        self._place_zingg()

    def _draw_group(self, members: Sequence[ParticleEntry], number: int) -> None:
        x, y = self.axes()
        values = [(each.descriptors[x], each.descriptors[y]) for each in members if each.descriptors]
        members = [each for each, pair in zip(members, values, strict=True) if np.isfinite(pair).all()]
        at = np.array([pair for pair in values if np.isfinite(pair).all()])
        if not members:
            return
        if self.log.isChecked():
            at = np.log10(np.maximum(at, 1e-300))
        colour = QColor(DESCRIPTOR_COLOURS[number % len(DESCRIPTOR_COLOURS)])
        ring = pg.mkPen(QColor(self.plot.theme.text), width=2)
        item = pg.ScatterPlotItem(
            hoverable=True, tip=lambda x, y, data: f"{data}\n{number_text(x, '.4g')}; {number_text(y, '.4g')}"
        )
        item.setData(
            pos=at,
            data=[entry.id for entry in members],
            symbol=SYMBOLS[number % len(SYMBOLS)],
            size=[13 if entry.id in self._chosen else 8 for entry in members],
            brush=colour,
            pen=[ring if entry.id in self._chosen else pg.mkPen(None) for entry in members],
            hoverSize=14,
        )
        item.sigClicked.connect(self._clicked)
        self.plot.canvas.addItem(item)
        self._items.append(item)

    def _draw_zingg(self) -> None:
        for angle in (0, 90):
            line = pg.InfiniteLine(
                THRESHOLD, angle=angle, pen=self.plot.pen(self.plot.theme.muted, dash=True)
            )
            self.plot.canvas.addItem(line, ignoreBounds=True)
            self._items.append(line)
        for name, right, upper in _CORNERS:
            word = pg.TextItem(tr(name), color=self.plot.theme.muted, anchor=(1, 1 - upper))
            self.plot.canvas.addItem(word, ignoreBounds=True)
            self._items.append(word)
            self._corners[right, upper] = word

    def _place_zingg(self, *_: object) -> None:
        """Give the names of Zingg's classes strips above and below all points."""
        if not self._corners:
            return
        known = [each.descriptors for each in self._entries if each.descriptors]
        places = [(each["flatness"], each["elongation"]) for each in known]
        left, bottom = np.nanmin([*places, (THRESHOLD - 0.1, THRESHOLD - 0.1)], axis=0)
        box = self.plot.canvas.getViewBox()
        letters = max(word.boundingRect().height() for word in self._corners.values())
        strip = (1.0 - bottom) * letters / max(box.height() - 2.0 * letters, letters)
        low, high = bottom - strip - 0.01, 1.0 + strip + 0.01
        self.plot.canvas.setRange(xRange=(left - 0.02, 1.02), yRange=(low, high), padding=0.0)
        for (right, upper), word in self._corners.items():
            word.setPos(1.02 if right else THRESHOLD - 0.01, high if upper else low)

    def _clicked(self, _item: Any, points: Sequence[Any], event: Any) -> None:
        if len(points):
            adding = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
            self.pointChosen.emit(str(points[0].data()), adding)


def _descriptor_box(name: str, spoken: str) -> ChoiceBox:
    labels = {key: row.label for key, row in CATALOGUE.items() if not row.costly}
    box = ChoiceBox(name, spoken, labels, capital=False)
    for place, key in enumerate(labels):
        box.setItemData(place, definition(key), Qt.ItemDataRole.ToolTipRole)
    return box


def _axis_label(key: str) -> str:
    row = CATALOGUE[key]
    return f"{tr(row.label)} {rich_symbol(row.symbol)}{row.unit_suffix}"


_WEIGHTING_LABELS = {"number": N_("each counts once"), "volume": N_("weighted by volume")}
_SHORT = {
    "group": N_("group"),
    "count": N_("count"),
    "mean": N_("mean"),
    "standard deviation": N_("std. dev."),
}
QUANTILE = " quantile"
MIN_BINS, MAX_BINS = 8, 40
"""Numbers of bins of a histogram, twice the root of the number of particles in between."""
GROUPS = (N_("all"), N_("(no group)"))
"""Group names that are translated."""


class StatisticsPanel(QWidget):
    """Mean and median on a card above a table with a row per group; `distribution` is placed elsewhere.

    Attributes
    ----------
    distribution
        The choices of the statistics above a histogram and the cumulative distribution.
    """

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("statistics")
        self._entries: tuple[ParticleEntry, ...] = ()
        self.card = ResultView("statistics_result", (tr("Mean"), tr("Median")), lines=2)
        self.plot = CurvePlot(
            "", tr("Share [%]"), tr("The distribution appears when particles are measured.")
        )
        self.key = _descriptor_box("statistics_key", tr("Descriptor of the statistics"))
        self.key.prefers_whole = True
        weightings = {key: _WEIGHTING_LABELS[key] for key in WEIGHTINGS}
        self.weighting = choice("statistics_weighting", tr("Weighting of the statistics"), weightings)
        self.border = QCheckBox(tr("correct for border grains"))
        self.border.setObjectName("statistics_border")
        self.border.setToolTip(
            tr(
                "Grains cut by the border of the scan were left out, large ones more often than "
                "small ones. The others have larger weights in return (Miles-Lantuéjoul)."
            )
        )
        self.border.setChecked(True)
        self.border.hide()
        self.table = named(QTableWidget(), spoken=tr("Statistics of groups"))
        self.table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setShowGrid(False)
        self.table.verticalHeader().hide()
        FontRowHeight(self.table, 8)
        self.table.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        self.table.setFrameShape(self.table.Shape.NoFrame)
        vbox(self.card, (self.table, 1), parent=self, margins=(8, 8, 8, 4))
        self.distribution = QWidget()
        vbox(
            control_row(self.key, self.weighting),
            self.border,
            (self.plot, 1),
            parent=self.distribution,
            margins=(8, 6, 8, 0),
        )
        self._fields = {"key": self.key, "weighting": self.weighting, "border": self.border}
        on_change(self._fields.values(), self._fill)

    def show_entries(self, entries: Sequence[ParticleEntry]) -> None:
        self._entries = tuple(entries)
        self.border.setVisible(has_weights(entries))
        self._fill()

    def choices(self) -> dict[str, Any]:
        """Descriptor, weighting, and whether grains at the border are corrected for, as plain JSON."""
        return field_values(self._fields)

    def choose(self, choices: Mapping[str, Any]) -> None:
        """Take other :meth:`choices`; unknown ones are ignored."""
        enter_values(self._fields, choices)

    def set_theme(self, theme: Theme) -> None:  # noqa: ARG002
        self._fill()

    def value(self) -> Table:
        return statistics_table(self._entries, *self.choices().values())

    def _draw(self, spread: Distribution | None) -> None:
        """Draw the histogram and, in steps, the cumulative distribution."""
        if spread is None:
            self.plot.set_curves([])
            return
        bins = int(np.clip(np.sqrt(len(spread.values)) * 2, MIN_BINS, MAX_BINS))
        shares, edges = spread.histogram(bins)
        theme, values = self.plot.theme, spread.values.tolist()
        outline = np.concatenate([[0.0], np.repeat(100 * shares, 2), [0.0]]).tolist()
        cumulated = 100 * np.cumsum(spread.weights)
        steps = np.concatenate([[0.0], np.repeat(cumulated, 2)[:-1]]).tolist()
        self.plot.set_labels(_axis_label(self.key.value()), tr("Share [%]"))
        self.plot.set_curves(
            [
                PlotCurve(
                    tr("histogram"), theme.particle, tuple(np.repeat(edges, 2).tolist()), tuple(outline)
                ),
                PlotCurve(tr("cumulative"), theme.fit, tuple(np.repeat(values, 2).tolist()), tuple(steps)),
            ]
        )

    def _record(self, spread: Distribution | None) -> ResultRecord:
        known = 0 if spread is None else len(spread.values)
        waiting = sum(entry.descriptors is None for entry in self._entries)
        made_from = tr_count(N_("1 particle"), N_("{count} particles"), known)
        if waiting:
            made_from = tr("{count} of {total} particles measured", count=known, total=len(self._entries))
        words = [self.key.currentText(), self.weighting.currentText()]
        if self.border.isVisibleTo(self.distribution) and self.border.isChecked():
            words.append(tr("corrected for grains at the border"))
        state = ResultState.RUNNING if waiting else ResultState.CURRENT
        if spread is None:
            return ResultRecord(
                (), made_from if waiting else "", state=state if waiting else ResultState.NONE
            )
        unit = CATALOGUE[self.key.value()].unit_suffix
        values = tuple(short_number(each) for each in (spread.mean, float(spread.quantile(0.5))))
        for place, caption in enumerate((tr("Mean"), tr("Median"))):
            self.card.caption(place, caption + unit)
        return ResultRecord(values, made_from, ", ".join(words), state)

    def _fill(self) -> None:
        spread = statistics_distribution(self._entries, *self.choices().values())
        self._draw(spread)
        self.card.show_record(self._record(spread))
        shown = self.value()
        self.table.setColumnCount(len(shown.columns))
        self.table.setRowCount(len(shown.rows))
        self.table.setHorizontalHeaderLabels([_two_lines(each) for each in shown.columns])
        for at, row in enumerate(shown.rows):
            for column, cell in enumerate(row):
                item = QTableWidgetItem(short_number(cell) if isinstance(cell, float) else tr(str(cell)))
                if column:
                    item.setTextAlignment(Qt.AlignmentFlag.AlignCenter)
                self.table.setItem(at, column, item)


def _two_lines(column: Column) -> str:
    """Header with the unit on a second line."""
    name = tr(_SHORT.get(column.name, column.name))
    if column.name.endswith(QUANTILE):
        name = tr("{share} quant.", share=column.name.removesuffix(QUANTILE))
    unit = column.unit
    for plain, sign in (("um", "µm"), ("^2", "²"), ("^3", "³"), ("^5", "⁵")):
        unit = unit.replace(plain, sign)
    return f"{name}\n[{unit}]" if unit else name


FILTER = N_("Meshes and tables (*.stl *.ply *.obj *.zip *.csv *.tsv *.txt)")
NOISE = N_(
    "Energy distance to the sample over its noise, which one of twenty samples of the same material exceeds; "
    "a material below 1 cannot be distinguished from the sample"
)


class MatchPanel(QWidget):
    """Candidates in a list, the card of the comparison with its button, a table and a picture."""

    def __init__(self, context: PageContext) -> None:
        super().__init__()
        self.setObjectName("match")
        self._context = context
        self._found: DrawnMatch | None = None
        self._picture = QPixmap()
        captions = tr("Nearest / noise"), tr("Mixture / noise")
        self.card = ResultView("match_card", captions, start=tr("Match"), again=tr("Match again"))
        for place, caption in enumerate(captions):
            self.card.caption(place, caption, tr(NOISE))
        spoken = tr("Materials that are compared with the sample")
        self.candidates = named(QListWidget(), "match_candidates", spoken)
        labels = {"": N_("Add a card")} | {name: card.label for name, card in materials().items()}
        self.cards = ChoiceBox("match_cards", tr("Add a material card"), labels, capital=False)
        spoken = tr("Length unit of files without one")
        units = {key: LABELS[key] for key in UNITS if key != "voxel"}
        self.unit = choice("match_unit", spoken, units)
        self.unit.setToolTip(spoken)
        self.table = TextTable("match_table", tr("Distances and masses"), _headings())
        self.picture = hint_label(
            tr(
                "How near other materials are to the sample, and how many grams of each make the mixture "
                "that is nearest."
            )
        )
        self.picture.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.picture.setMinimumSize(QSize(120, 60))
        self.picture.setAccessibleName(tr("Distances, masses of the mixture, and sizes"))
        self._place()
        self.run = RunController(context, self.card, "match", self.start)
        context.bindings.refresh("particles", lambda: self.run.set_outdated(True))

    @property
    def found(self) -> DrawnMatch | None:
        """The last comparison."""
        return self._found

    def names(self) -> list[str]:
        """Paths, or names of material cards."""
        return [self.candidates.item(row).text() for row in range(self.candidates.count())]

    def add(self, names: Sequence[str]) -> None:
        """Add candidates that the list does not hold yet."""
        self.candidates.addItems([name for name in names if name and name not in self.names()])
        self.card.set_startable("" if self.names() else tr("Add the materials to compare with first."))

    def ask_files(self) -> None:
        """Ask for files of meshes, archives and tables."""
        start = str(self._context.recall("folder", str(Path.home())))
        self.add(QFileDialog.getOpenFileNames(self, tr("Materials to compare with"), start, tr(FILTER))[0])

    def start(self) -> None:
        """Compare the open sample with the candidates."""
        sample = tuple(self._context.session.open_particles)
        request = MatchRequest(self.unit.value())
        self.run.start(tr("Match"), Job(draw_match, (sample, self.names(), request)), self._show)

    def save(self) -> None:
        """Ask for a folder and write table and picture."""
        assert self._found is not None, "its button waits for a result"
        start = str(self._context.recall("folder", str(Path.home())))
        if name := FolderDialog.ask(self, tr("Folder of table and picture"), start):
            self._context.remember("folder", name)
            self._context.start(tr("Saving"), Job(self._found.written, (Path(name),)), self._saved)

    def _saved(self, folder: Path) -> None:
        self._context.toast.note(tr("Table and picture are in {folder}.", folder=folder))

    def _show(self, found: DrawnMatch) -> ResultRecord:
        self._found = found
        self._saving.setEnabled(True)
        match = found.match
        self.table.rows.setHorizontalHeaderLabels(_headings(match.keys))
        self.table.rows.setColumnCount(len(_headings(match.keys)))
        parts = (*sorted(match.parts, key=lambda part: part.energy), match.mixture)
        self.table.set_rows([_cells(part) for part in parts], [_shape_distances(part) for part in parts])
        self._picture.loadFromData(found.picture)
        self._scale()
        for note in found.notes:
            self._context.toast.note(note)
        for problem in found.problems:
            self._context.toast.problem(problem.with_path)
        note = "" if match.is_reached else tr("No mixture matches the sample; grams are of the nearest one.")
        values = tuple(_over_noise(part) for part in (match.nearest, match.mixture))
        return ResultRecord(values, match.nearest.name, note=note)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._scale()

    def _scale(self) -> None:
        if not self._picture.isNull():
            modes = Qt.AspectRatioMode.KeepAspectRatio, Qt.TransformationMode.SmoothTransformation
            self.picture.setPixmap(self._picture.scaled(self.picture.size(), *modes))

    def _place(self) -> None:
        self.cards.activated.connect(self._add_card)
        buttons = []
        for name, text, act in (
            ("match_files", tr("Add files …"), self.ask_files),
            ("match_folder", tr("Add folder …"), self._ask_folder),
            ("match_remove", tr("Remove"), self._remove),
            ("match_save", tr("Save …"), self.save),
        ):
            buttons.append(named(QPushButton(text), name))
            buttons[-1].clicked.connect(act)
        self._saving = buttons[-1]
        self._saving.setEnabled(False)
        controls, materials_row = QWidget(), QWidget()
        vbox(control_row(self.cards, self.unit), control_row(*buttons[:3]), parent=controls).addStretch(1)
        hbox((self.candidates, 1), (controls, 1), parent=materials_row)
        parts = [materials_row, self.table, self.picture]
        vbox(self.card, (stacked(parts, [60, 150, 130], stretch=2), 1), parent=self, margins=(4, 4, 4, 4))
        self.card.add(self._saving)
        self.add([])

    def _ask_folder(self) -> None:
        start = str(self._context.recall("folder", str(Path.home())))
        self.add([QFileDialog.getExistingDirectory(self, tr("Folder of meshes"), start)])

    def _add_card(self) -> None:
        self.add([str(self.cards.currentData())])
        self.cards.setCurrentIndex(0)

    def _remove(self) -> None:
        for item in self.candidates.selectedItems():
            self.candidates.takeItem(self.candidates.row(item))
        self.add([])


def _headings(keys: Sequence[str] = ()) -> list[str]:
    """Of the columns; `keys` are those of the descriptors."""
    shapes = [f"{plain_symbol(CATALOGUE[key].symbol)} [%]" for key in keys]
    first = tr("Material"), tr("g in 100 g"), tr("Distance"), tr("Distance / noise")
    return [*first, *shapes, tr("Particles")]


def _cells(part: MatchedPart) -> tuple[str, ...]:
    low, high = part.mass_interval
    mass, *ends = (number_text(100 * share, ".0f") for share in (part.mass_share, low, high))
    grams = mass if low == high else f"{mass} ({ends[0]} – {ends[1]})"
    # The unbiased estimate scatters about zero for the same material.
    distance = number_text(max(part.energy, 0.0), ".3f")
    shapes = (number_text(100 * value, ".1f") for value in part.wasserstein.values())
    return part.name, grams, distance, _over_noise(part), *shapes, number_text(part.n_particles, ",")


def _over_noise(part: MatchedPart) -> str:
    ratio = part.energy / part.energy_floor
    return "< 1" if ratio <= 1 else number_text(ratio, ".1f")


def _shape_distances(part: MatchedPart) -> str:
    """Wasserstein distances in each descriptor, in percent of the mean of the sample."""
    return "\n".join(
        f"{tr(CATALOGUE[key].label)}: {number_text(100 * value, '.1f')} %"
        for key, value in part.wasserstein.items()
    )
