"""Panels of a sweep of the coarsening and of the gallery: values, start and stop, plot or table."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Protocol

import numpy as np
from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QSize, Qt, Signal
from PySide6.QtGui import QAction, QIcon, QMouseEvent, QPixmap
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QLabel,
    QMenu,
    QPushButton,
    QStackedLayout,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTableWidget,
    QTableWidgetItem,
    QToolButton,
    QWidget,
)

from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.jobs.study_jobs import GalleryCell
from regolith_studio.messages import N_
from regolith_studio.scene.palette import DESCRIPTOR_COLOURS
from regolith_studio.session.choices import Choices
from regolith_studio.session.results import ParticleEntry
from regolith_studio.session.study_requests import loss_names
from regolith_studio.studies.coarsening import COLUMNS, MIN_PLOTTED, CoarseningStudy
from regolith_studio.studies.loss_variants import ALONE, PAPER_LOSSES, LossVariant
from regolith_studio.studies.sweeps import (
    GAIN,
    SWEEPS,
    descriptor_error,
    differences,
    format_difference,
    pareto_front,
    significant,
    sufficient_facets,
)
from regolith_studio.ui.layout import control_row, hbox, named
from regolith_studio.ui.pages.studies.plots import (
    BandPlot,
    SensitivityTable,
    Series,
    coarsening_record,
    study_card,
    study_panel,
)
from regolith_studio.ui.result_card import ResultRecord
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import inert, localized, number_text, tr, translate
from regolith_studio.ui.widgets.fields import ChoiceBox, NumbersLine
from regolith_studio.ui.widgets.heat_table import centred_hint
from regolith_studio.ui.widgets.labels import ElidedLabel, hint_label, plain_symbol, rich_symbol
from regolith_studio.ui.widgets.plots.curves import PlotCurve
from regolith_studio.ui.widgets.table import definition
from regolith_studio.ui.widgets.thumbnails import ThumbnailQueue, thumbnail

ARROW = "  ▾"
BOXES = {"exact": N_("exact minimum volume"), "trimesh": N_("trimesh's heuristic")}
BOX_TIP = N_(
    "Diameters and aspect ratio come from this box. The heuristic is no minimum; "
    "it is offered for comparison."
)


class LossSelector(QWidget):
    """The controls of the studies."""

    valueChanged = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("study_loss_selector")
        self._actions: dict[str, QAction] = {}
        self.rows = QToolButton()
        self.rows.setObjectName("study_rows")
        self.rows.setAccessibleName(tr("Losses of the studies"))
        self.rows.setToolTip(tr("Loss functions that are the rows of the studies"))
        self.menu = self._menu()
        self.rows.clicked.connect(self._open)
        self.box = named(ChoiceBox("study_box", tr("Bounding box of the diameters"), BOXES), tip=tr(BOX_TIP))
        self.box.prefers_whole = True
        self.box.setMinimumContentsLength(8)
        self.hint_label = named(ElidedLabel(role="hint"), "study_facets_hint")
        hbox(
            QLabel(tr("Loss functions")),
            self.rows,
            QLabel(tr("Bounding box")),
            self.box,
            (self.hint_label, 1),
            parent=self,
        )
        self.box.currentIndexChanged.connect(lambda _index: self.valueChanged.emit())
        self.set_names(PAPER_LOSSES)

    def names(self) -> tuple[str, ...]:
        """Keys of the selected losses in the order of the menu, at least one."""
        return tuple(name for name, action in self._actions.items() if action.isChecked())

    def set_names(self, names: Sequence[str]) -> None:
        """Select other losses; unknown ones are ignored, and none means those of Fig. 8."""
        known = [name for name in names if name in self._actions] or PAPER_LOSSES
        for wanted in (True, False):  # never none in between
            for name, action in self._actions.items():
                if (name in known) is wanted:
                    action.setChecked(wanted)
        self._update_text()

    def show_facets(self, choices: Choices) -> None:
        """Show the number of facets of the studies if polyhedra stop at an error."""
        stops = choices.stop_at == "error"
        words = tr("compared at {count} facets each", count=choices.facet_count)
        self.hint_label.setText(words if stops else "")

    def _menu(self) -> QMenu:
        menu = _StickyMenu(self)
        menu.setObjectName("study_rows_menu")
        for words, names in (
            (tr("Standard set"), PAPER_LOSSES),
            (tr("Each term alone"), ("overlap", *(name for name in loss_names() if name.startswith(ALONE)))),
        ):
            menu.addAction(words).triggered.connect(partial(self._choose, names))
        menu.addSeparator()
        for name, label in loss_names().items():
            action = menu.addAction(translate(label))
            action.setCheckable(True)
            action.toggled.connect(partial(self._toggled, name))
            self._actions[name] = action
        return menu

    def _open(self) -> None:
        """Show the menu without blocking, unlike the menu of a button."""
        self.menu.popup(self.rows.mapToGlobal(self.rows.rect().bottomLeft()))

    def _choose(self, names: Sequence[str], _checked: bool = False) -> None:
        self.set_names(names)
        self.valueChanged.emit()

    def _toggled(self, name: str, _on: bool) -> None:
        if not self.names():  # the last one stays
            self._actions[name].setChecked(True)
            return
        self._update_text()
        self.valueChanged.emit()

    def _update_text(self) -> None:
        names = self.names()
        words = tr("{count} losses", count=len(names))
        if names == tuple(name for name in self._actions if name in PAPER_LOSSES):
            words = tr("Standard set")
        elif len(names) == 1:
            words = self._actions[names[0]].text()
        self.rows.setText(words + ARROW)


class _StickyMenu(QMenu):
    """Stays open while its entries are checked, so that several can be chosen."""

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        action = self.actionAt(event.position().toPoint())
        if action is not None and action.isCheckable():
            action.trigger()
            return
        super().mouseReleaseEvent(event)


OVERLAP = "Jaccard"
ROW_COLOURS = (*DESCRIPTOR_COLOURS, "#8f5ec9")
"""One for each request of the exact method in the trade-off, and one for the compound."""
ON_AND_OFF = N_("The method meets descriptors exactly: each is requested or not, whatever its weight.")


class StudyView(Protocol):
    """A widget that shows the results of a sweep."""

    def show_study(self, study: CoarseningStudy | None) -> None: ...


class FacetsPlot(BandPlot):
    """A curve per descriptor against the number of facets."""

    def __init__(self) -> None:
        super().__init__(
            tr("Facets"),
            tr("RMSRE [%], at least {least:g}", least=MIN_PLOTTED),
            tr("Root mean squared relative error of each descriptor against the number of facets."),
            log_y=True,
        )

    def show_study(self, study: CoarseningStudy | None) -> None:
        """Draw a sweep of the number of facets, or nothing."""
        if study is None:
            self.set_series([])
            return
        x = tuple(float(row.n_facets) for row in study.rows)
        values, (low, high) = (each.clip(min=MIN_PLOTTED) for each in (100 * study.rmsre, 100 * study.bands))
        self.set_series(
            [
                Series(
                    tr("{name} (mean)", name=OVERLAP)
                    if key == JACCARD
                    else rich_symbol(CATALOGUE[key].symbol),
                    DESCRIPTOR_COLOURS[k % len(DESCRIPTOR_COLOURS)],
                    x,
                    tuple(values[:, k]),
                    tuple(low[:, k]),
                    tuple(high[:, k]),
                )
                for k, key in enumerate(COLUMNS)
            ]
        )
        self.legend.setToolTip("\n".join(map(definition, COLUMNS)))


class TradeoffPlot(BandPlot):
    """A point per loss, overlap against descriptor errors, and the Pareto front."""

    def __init__(self) -> None:
        super().__init__(
            tr("Mean Jaccard distance [%]"),
            tr("Mean RMSRE of six descriptors [%]"),
            tr("Mean error of the descriptors against mean Jaccard distance: lower left is better."),
        )

    def show_study(self, study: CoarseningStudy | None) -> None:
        """Draw a trade-off study, or nothing."""
        if study is None:
            self.set_series([])
            return
        x, (left, right) = 100 * study.rmsre[:, -1], 100 * study.bands[..., -1]
        y = 100 * descriptor_error(study.rmsre)
        low, high = 100 * study.band_of(descriptor_error(study.resampled))
        front = list(pareto_front(study))
        line = PlotCurve(tr("Pareto front"), self.theme.muted, tuple(x[front]), tuple(y[front]), dash=True)
        series = [
            Series(
                translate(row.label),
                ROW_COLOURS[r % len(ROW_COLOURS)],
                (float(x[r]),),
                (float(y[r]),),
                (float(low[r]),),
                (float(high[r]),),
                (float(left[r]),),
                (float(right[r]),),
                line=False,
            )
            for r, row in enumerate(study.rows)
        ]
        self.set_series(series, behind=[line])


def sensitivity_part() -> SensitivityTable:
    headers = (*(plain_symbol(CATALOGUE[key].symbol) for key in LOSS_KEYS), OVERLAP)
    return SensitivityTable(tr("Change of each error when one weight of the loss is changed."), headers)


PARTS: Mapping[str, Callable[[], QWidget]] = {
    "facets": FacetsPlot,
    "tradeoff": TradeoffPlot,
    "sensitivity": sensitivity_part,
}
"""View of each sweep, by key."""


CAPTIONS = {
    "facets": N_("Sufficient facets"),
    "tradeoff": N_("Losses on the Pareto front"),
    "sensitivity": N_("Largest change [pp]"),
}
"""Of the result of each sweep."""


class SweepPanel(QWidget):
    """Edits the values of a sweep and shows its results."""

    facetsChosen = Signal(int)  # noqa: N815

    def __init__(self, key: str) -> None:
        super().__init__()
        self.setObjectName(f"{key}_study")
        self._key, self._variation = key, SWEEPS[key]
        self.values = NumbersLine(", ".join(f"{value:g}" for value in self._variation.values))
        self.values.setObjectName(f"{key}_values")
        self.values.setAccessibleName(tr(self._variation.asks))
        self.values.setToolTip(tr("Numbers with commas between them; Return starts the study"))
        self.asked, self.note = QLabel(tr(self._variation.asks)), hint_label(tr(ON_AND_OFF))
        self.part = PARTS[key]()
        self.part.setAccessibleName(tr(self._variation.title))
        self.card = study_card(key, tr(CAPTIONS[key]))
        self.take = named(QPushButton(self), f"{key}_take")
        self.take.hide()
        self._enough = 0
        self.take.clicked.connect(lambda: self.facetsChosen.emit(self._enough))
        if key == "facets":
            self.card.add(self.take)
        self.note.hide()
        study_panel(self, self.card, control_row(self.asked, self.values), self.note, self.part)

    def show_method(self, method: str) -> None:
        """Show the field of values if the method uses them."""
        takes = self._variation.takes_values(method)
        for each in (self.asked, self.values):
            each.setVisible(takes)
        self.note.setVisible(not takes)

    def show_study(self, study: CoarseningStudy | None) -> None:
        """Show the results, or nothing."""
        shown: StudyView = self.part  # type: ignore[assignment]  # every part of PARTS is one
        shown.show_study(study)
        known = study is not None and len(study.rows) > 1
        self.take.setVisible(known and self._key == "facets")
        if study is not None and known:
            self._enough = sufficient_facets(study)
            self.take.setText(tr("Use {count} facets", count=self._enough))

    def record(self, study: CoarseningStudy, choices: Choices) -> ResultRecord:
        """The answer of the sweep, and what it was made from and with."""
        answers = {"facets": _facets_answer, "tradeoff": _front_answer, "sensitivity": _change_answer}
        value, note = answers[self._key](study)
        return coarsening_record(study, choices, (value,), note)


def _facets_answer(study: CoarseningStudy) -> tuple[str, str]:
    enough = sufficient_facets(study)
    if enough < max(row.n_facets for row in study.rows):
        return str(enough), tr("with more, no error falls by more than {gain:.1%}", gain=GAIN)
    return "–", tr("the errors still fall at {count} facets, the largest number here", count=enough)


def _front_answer(study: CoarseningStudy) -> tuple[str, str]:
    front = pareto_front(study)
    names = ", ".join(translate(study.rows[row].label) for row in front)
    return tr("{count} of {total}", count=len(front), total=len(study.rows)), names


def _change_answer(study: CoarseningStudy) -> tuple[str, str]:
    if len(study.rows) < 2 or not significant(study).any():
        return "0", tr("no change of a weight changes an error significantly")
    values = np.where(significant(study), differences(study)[0], 0.0)
    row, column = np.unravel_index(int(np.abs(values).argmax()), values.shape)
    symbol = OVERLAP if COLUMNS[column] == JACCARD else plain_symbol(CATALOGUE[COLUMNS[column]].symbol)
    change = localized(format_difference(100 * float(values[row, column])))
    return change, tr("{column} at {row}", column=symbol, row=translate(study.rows[row + 1].label))


SIZE = 120
FONT_SIZE = 22
"""Pixels below a picture."""
WAITING = N_(
    "Six particles from the selected one on, and below them their polyhedra, one row per loss function."
)
Index = QModelIndex | QPersistentModelIndex
MAX_PARTICLES = 6
"""Maximum number of columns."""


class GalleryPanel(QWidget):
    """A table of thumbnails that is filled while polyhedra are computed."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("solid_gallery")
        self._cells: tuple[GalleryCell, ...] = ()
        self._particles: tuple[ParticleEntry, ...] = ()
        self._theme = current_theme()
        self._pictures = ThumbnailQueue(SIZE, self)
        self.table = named(QTableWidget(), spoken=tr("Polyhedra by loss function and particle"))
        self.table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        self.table.setShowGrid(False)
        self.table.setItemDelegate(_PictureAbove(self.table))
        self.table.setIconSize(self.table.iconSize().expandedTo(picture_size()))
        self.table.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        self.table.verticalHeader().setDefaultSectionSize(SIZE + FONT_SIZE)
        self.table.verticalHeader().setMaximumWidth(190)
        self.table.verticalHeader().setDefaultAlignment(
            Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter | Qt.TextFlag.TextWordWrap
        )
        self._parts = QWidget()
        self._stack = QStackedLayout(self._parts)
        self._stack.addWidget(centred_hint(tr(WAITING)))
        self._stack.addWidget(self.table)
        self.card = study_card("solids", tr("Polyhedra"))
        study_panel(self, self.card, self._parts)

    def clear(self) -> None:
        self._cells, self._particles = (), ()
        self._pictures.stop()
        self._stack.setCurrentIndex(0)

    def begin(self, particles: Sequence[ParticleEntry], labels: Sequence[str]) -> None:
        """Show particles, and below them empty cells for each loss."""
        self._cells, self._particles = (), tuple(particles)
        self._stack.setCurrentWidget(self.table)
        self.table.clear()
        self.table.setRowCount(1 + len(labels))
        self.table.setColumnCount(len(particles))
        self.table.setVerticalHeaderLabels([tr("Particle"), *labels])
        self.table.setHorizontalHeaderLabels([entry.id for entry in particles])
        self._paint_particles()

    def show_cells(self, cells: Sequence[GalleryCell]) -> None:
        for cell in cells[len(self._cells) :]:
            self.table.setItem(cell.row + 1, cell.column, self._cell(cell))
        self._cells = tuple(cells)

    def value(self) -> tuple[GalleryCell, ...]:
        return self._cells

    @property
    def total(self) -> int:
        return len(self._particles) * (self.table.rowCount() - 1)

    def record(self, choices: Choices, rows: Sequence[LossVariant]) -> ResultRecord:
        """How many polyhedra there are, and what they were made from and with."""
        study = CoarseningStudy(tuple(rows), tuple(entry.id for entry in self._particles))
        return coarsening_record(study, choices, (f"{len(self._cells)} / {self.total}",))

    def set_theme(self, theme: Theme) -> None:
        if theme != self._theme:
            self._theme = theme
            for cell in self._cells:
                self.table.setItem(cell.row + 1, cell.column, self._cell(cell))
            self._paint_particles()

    def _paint_particles(self) -> None:
        self._pictures.paint(
            (entry.particle.mesh, self._theme.particle, partial(self._show_particle, column))
            for column, entry in enumerate(self._particles)
        )

    def _show_particle(self, column: int, picture: QPixmap) -> None:
        self.table.setItem(0, column, QTableWidgetItem(QIcon(picture), ""))

    def _cell(self, cell: GalleryCell) -> QTableWidgetItem:
        found = cell.outcome.coarsened
        item = QTableWidgetItem()
        item.setTextAlignment(Qt.AlignmentFlag.AlignCenter)
        if found is None:
            item.setText("–")
            item.setToolTip(inert(cell.outcome.problem or ""))
            return item
        item.setIcon(QIcon(thumbnail(found.mesh, self._theme.polyhedron, SIZE)))
        item.setText(f"Jaccard {number_text(found.jaccard_distance, '.1%')}")
        worst = "\n".join(
            f"{tr(CATALOGUE[key].label)}: {number_text(error, '.2%')}" for key, error in found.errors.items()
        )
        item.setToolTip(
            tr(
                "{count} facets, Jaccard distance {distance:.1%}, loss of this row {loss:.3g}",
                count=found.n_facets,
                distance=found.jaccard_distance,
                loss=found.loss,
            )
            + f"\n{worst}"
        )
        return item


class _PictureAbove(QStyledItemDelegate):
    """Places the text of a cell below its picture."""

    def initStyleOption(self, option: QStyleOptionViewItem, index: Index) -> None:
        super().initStyleOption(option, index)
        option.decorationPosition = QStyleOptionViewItem.Position.Top
        option.decorationAlignment = Qt.AlignmentFlag.AlignCenter
        option.displayAlignment = Qt.AlignmentFlag.AlignCenter


def picture_size() -> QSize:
    return QSize(SIZE, SIZE)
