"""Panel of a sweep of the coarsening: values, losses, start and stop, and its plot or table."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Protocol

from PySide6.QtCore import Signal
from PySide6.QtGui import QAction, QMouseEvent
from PySide6.QtWidgets import (
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QMenu,
    QPushButton,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.messages import N_
from regolith_studio.scene.palette import DESCRIPTOR_COLOURS
from regolith_studio.session.choices import Choices
from regolith_studio.session.study_requests import loss_names
from regolith_studio.studies.coarsening import COLUMNS, MIN_PLOTTED, CoarseningStudy
from regolith_studio.studies.loss_variants import ALONE, PAPER_LOSSES
from regolith_studio.studies.sweeps import GAIN, SWEEPS, descriptor_error, pareto_front, sufficient_facets
from regolith_studio.ui.pages.studies.plots import BandPlot, SensitivityTable, Series
from regolith_studio.ui.translation import tr, tr_count, translate
from regolith_studio.ui.widgets.combo_box import ChoiceBox
from regolith_studio.ui.widgets.labels import FixedHeightText, heading, hint_label, plain_symbol, rich_symbol
from regolith_studio.ui.widgets.numbers import NumbersLine
from regolith_studio.ui.widgets.plots.curves import PlotCurve
from regolith_studio.ui.widgets.study_frame import StudyFrame
from regolith_studio.ui.widgets.table import definition

ARROW = "  ▾"
BOXES = {"exact": N_("exact minimum volume"), "trimesh": N_("trimesh's heuristic")}
BOX_TIP = N_(
    "Diameters and aspect ratio come from this box. The heuristic is no minimum; "
    "it is offered for comparison."
)

EQUAL_TIP = N_("Losses can be compared at equal numbers of facets only; choose the number beside Facets n.")


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
        self.rows.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.menu = self._menu()
        self.rows.clicked.connect(self._open)
        self.box = ChoiceBox("study_box", tr("Bounding box of the diameters"), BOXES)
        self.box.setMinimumContentsLength(max(len(tr(each)) for each in BOXES.values()))
        self.box.setToolTip(tr(BOX_TIP))
        self.hint_label = hint_label()
        self.hint_label.setObjectName("study_facets_remark")
        self.hint_label.setToolTip(tr(EQUAL_TIP))
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        for part in (
            heading(tr("Loss functions")),
            self.rows,
            heading(tr("Bounding box")),
            self.box,
            FixedHeightText((self.hint_label,)),
        ):
            column.addWidget(part)
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
    """The table of a sensitivity study."""
    headers = (*(plain_symbol(CATALOGUE[key].symbol) for key in LOSS_KEYS), OVERLAP)
    return SensitivityTable(tr("Change of each error when one weight of the loss is changed."), headers)


PARTS: Mapping[str, Callable[[], QWidget]] = {
    "facets": FacetsPlot,
    "tradeoff": TradeoffPlot,
    "sensitivity": sensitivity_part,
}
"""View of each sweep, by key."""


class SweepPanel(QWidget):
    """Edits the values of a sweep and shows its results."""

    startRequested = Signal()  # noqa: N815
    facetsChosen = Signal(int)  # noqa: N815

    def __init__(self, key: str) -> None:
        super().__init__()
        self.setObjectName(f"{key}_study")
        self._key, self._enough = key, 0
        self._variation = SWEEPS[key]
        self.values = NumbersLine(", ".join(f"{value:g}" for value in self._variation.values))
        self.values.setObjectName(f"{key}_values")
        self.values.setAccessibleName(tr(self._variation.asks))
        self.values.setToolTip(tr("Numbers with commas between them; Return starts the study"))
        self.asked, self.note = QLabel(tr(self._variation.asks)), hint_label(tr(ON_AND_OFF))
        self.part = PARTS[key]()
        self.part.setAccessibleName(tr(self._variation.title))
        self.frame = StudyFrame(key, self.part)
        asking = QFormLayout()
        asking.setContentsMargins(8, 6, 8, 0)
        asking.setHorizontalSpacing(8)
        asking.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        asking.addRow(self.asked, self.values)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        asking.addRow(self.note)
        self.note.hide()
        layout.addLayout(asking)
        layout.addWidget(self._make_answer())
        layout.addWidget(self.frame, 1)
        self.values.returnPressed.connect(self.startRequested)
        self.frame.startRequested.connect(self.startRequested)

    def show_method(self, method: str) -> None:
        """Show the field of values if the method uses them."""
        takes = self._variation.takes_values(method)
        for each in (self.asked, self.values):
            each.setVisible(takes)
        self.note.setVisible(not takes)

    def show_study(self, study: CoarseningStudy | None, outdated: bool) -> None:
        """Show the results, or nothing."""
        shown: StudyView = self.part  # type: ignore[assignment]  # every part of PARTS is one
        shown.show_study(study)
        self._show_answer(study)
        self.frame.set_hint("" if study is None else summary_text(study, outdated))

    def _make_answer(self) -> QWidget:
        """The row with the number of facets from which on nothing is gained, and a button that takes it."""
        self.answer, self.take = QLabel(), QPushButton()
        self.answer.setObjectName(f"{self._key}_answer")
        self.answer.setWordWrap(True)
        self.take.setObjectName(f"{self._key}_take")
        self.take.clicked.connect(lambda: self.facetsChosen.emit(self._enough))
        self._answers = QWidget()
        self._answers.hide()
        row = QHBoxLayout(self._answers)
        row.setContentsMargins(8, 4, 8, 0)
        row.addWidget(self.answer, 1)
        row.addWidget(self.take)
        return self._answers

    def _show_answer(self, study: CoarseningStudy | None) -> None:
        if self._key != "facets":
            return
        self._answers.setVisible(study is not None and len(study.rows) > 1)
        if study is None:
            return
        self._enough = sufficient_facets(study)
        if self._enough < max(row.n_facets for row in study.rows):
            text = N_(
                "<b>{count} facets</b> are sufficient: with more, no error falls by more than {gain:.1%}."
            )
        else:
            text = N_("The errors still fall at <b>{count} facets</b>, the largest number here.")
        self.answer.setText(tr(text, count=self._enough, gain=GAIN))
        self.take.setText(tr("Use {count} facets", count=self._enough))


def summary_text(study: CoarseningStudy, outdated: bool) -> str:
    """Number of particles, box, unmet requests, and whether the choices have changed since."""
    words = [tr_count(N_("1 particle"), N_("{count} particles"), len(study.names))]
    if study.box_metric != "exact":
        words.append(tr("box of {name}", name=study.box_metric))
    if study.failures:
        words.append(tr("{count} left out", count=len(study.failures)))
    if unmet := sum(study.n_unmet):
        words.append(
            tr(
                "{unmet} of {total} requests not met exactly",
                unmet=unmet,
                total=len(study.names) * len(study.rows),
            )
        )
    return "; ".join([", ".join(words), *([tr("computed with other choices")] if outdated else [])])
