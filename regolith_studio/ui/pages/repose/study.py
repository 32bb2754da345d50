"""Panel of a study: varied parameter, start and stop, and a plot that is updated after every run."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QAbstractItemView,
    QComboBox,
    QFormLayout,
    QHBoxLayout,
    QHeaderView,
    QPushButton,
    QSpinBox,
    QTableWidget,
    QTableWidgetItem,
    QWidget,
)

from regolith_studio.coarsening.weights import presets
from regolith_studio.dem.run_io import RunSummary
from regolith_studio.jobs.repose_study import SHAPE_KEYS, values_in
from regolith_studio.jobs.runners.process_pool import cores
from regolith_studio.messages import N_
from regolith_studio.studies.repose import ReposeStudy, ReposeStudyRun
from regolith_studio.ui.layout import task_columns
from regolith_studio.ui.pages.repose.runs import explanation
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import localized, number_text, tr
from regolith_studio.ui.widgets.labels import remark
from regolith_studio.ui.widgets.numbers import NumbersLine
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve

VARIED: Mapping[str, tuple[str, str]] = {
    "static_friction": (N_("Static friction"), "0.2, 0.4, 0.8"),
    "n_facets": (N_("Facets of the open particles"), "8, 20, 60"),
    "preset": (N_("Weights of the loss, open particles"), "overlap, size, all"),
    "rolling_friction": (N_("Rolling resistance"), "0, 0.1, 0.3"),
    "cohesion": (N_("Cohesion"), "none, scaled"),
    "shapes": (N_("Shapes"), "polyhedra, spheres"),
    "gravity": (N_("Gravity [m/s²]"), "1.62, 3.71, 9.81"),
    "plate_friction": (N_("Plate friction"), "0.3, 0.8"),
    "wall_friction": (N_("Wall friction"), "0, 0.3, 0.8"),
    "lift_speed": (N_("Lift speed [m/s]"), "0.01, 0.03, 0.1"),
    "n_particles": (N_("Number of particles"), "300, 1000, 2000"),
}
"""Parameters that can be varied: label and proposed values."""
HEADINGS = (N_("Value"), N_("Seed"), N_("Angle"), N_("Interval"))


class StudyPanel(QWidget):
    """Edits the request of a study and shows its runs."""

    startWanted = Signal()  # noqa: N815
    stopWanted = Signal()  # noqa: N815
    chosen = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("repose_study")
        self._study: ReposeStudy | None = None
        self.key = QComboBox()
        self.key.setObjectName("repose_study_key")
        self.key.setAccessibleName(tr("Varied quantity"))
        for name, (label, _) in VARIED.items():
            self.key.addItem(tr(label), name)
        self.values = NumbersLine(VARIED["static_friction"][1])
        self.values.setObjectName("repose_study_values")
        self.values.setAccessibleName(tr("Values, with commas between them"))
        self.repeats = QSpinBox()
        self.repeats.setObjectName("repose_study_repeats")
        self.repeats.setAccessibleName(tr("Runs per value, with different seeds"))
        self.repeats.setRange(1, 100)
        self.workers = QSpinBox()
        self.workers.setObjectName("repose_study_workers")
        self.workers.setAccessibleName(tr("Runs at the same time"))
        self.workers.setToolTip(tr("Each run takes one core, and the memory of a run"))
        self.workers.setRange(1, cores())
        self.start, self.stop = QPushButton(tr("Start or resume")), QPushButton(tr("Stop"))
        self.start.setObjectName("repose_study_start")
        self.start.setToolTip(tr("Finished runs are not repeated"))
        self.stop.setObjectName("repose_study_stop")
        self.table = self._table()
        self.plot = CurvePlot(tr("Static friction"), tr("Angle [°]"), tr("Each run adds a point."))
        self.status = remark()
        self.status.setObjectName("repose_study_status")
        self._place()
        self._connect()
        self.set_running(False)

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self.plot.set_theme(theme)
        self._draw()

    def request(self) -> tuple[str, tuple[float | str, ...], int, int]:
        """Varied parameter, values, number of repetitions, and runs at the same time.

        Raises
        ------
        InputError
            If a value is invalid.
        """
        key = str(self.key.currentData())
        return key, values_in(key, self.values.value()), self.repeats.value(), self.workers.value()

    def set_running(self, running: bool) -> None:
        """Set whether a study is running."""
        self.start.setVisible(not running)
        self.stop.setVisible(running)
        for each in (self.key, self.values, self.repeats, self.workers):
            each.setEnabled(not running)

    def show_status(self, text: str) -> None:
        """Show a status text."""
        self.status.setText(text)

    def show_study(self, study: ReposeStudy | None) -> None:
        """Show other runs."""
        self._study = study
        runs = study.runs if study is not None else ()
        self.table.setRowCount(len(runs))
        for row, run in enumerate(runs):
            for column, text in enumerate(_cells(run)):
                item = QTableWidgetItem(text)
                item.setToolTip(_why(run))
                item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
                self.table.setItem(row, column, item)
        self._draw()

    def state(self) -> dict[str, Any]:
        """The values as plain JSON."""
        return {
            "key": self.key.currentData(),
            "values": self.values.value(),
            "repeats": self.repeats.value(),
            "workers": self.workers.value(),
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Show what :meth:`state` returned; unknown values are ignored."""
        at = self.key.findData(state.get("key"))
        if at >= 0:
            self.key.setCurrentIndex(at)
            self.values.setValue(str(state.get("values", VARIED[self.key.currentData()][1])))
        for name, field in (("repeats", self.repeats), ("workers", self.workers)):
            if isinstance(number := state.get(name), int):
                field.setValue(number)

    def _draw(self) -> None:
        study = self._study
        if study is None or not study.runs:
            self.plot.set_curves([])
            return
        numeric = all(isinstance(value, int | float) for value in study.values)
        places = {value: float(value) if numeric else float(k) for k, value in enumerate(study.values, 1)}
        label = tr(VARIED[study.runs[0].varied][0])
        names = "" if numeric else ": " + ", ".join(f"{k} {value}" for k, value in enumerate(places, 1))
        self.plot.set_labels(label + names, tr("Angle [°]"))
        found = [(places[run.value], run.angle) for run in study.runs if run.angle is not None]
        means = sorted(
            (places[value], float(np.mean(study.angles(value))))
            for value in study.values
            if study.angles(value)
        )
        theme = self.plot.theme
        self.plot.set_curves(
            [
                PlotCurve(tr("mean"), theme.fit, *_columns(means), line=numeric),
                PlotCurve(tr("run"), theme.polyhedron, *_columns(found), markers=True, line=False),
            ]
            if found
            else []
        )

    def _table(self) -> QTableWidget:
        table = QTableWidget(0, len(HEADINGS))
        table.setObjectName("repose_study_runs")
        table.setAccessibleName(tr("Runs of the study"))
        table.setHorizontalHeaderLabels([tr(each) for each in HEADINGS])
        table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        table.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        table.setShowGrid(False)
        table.verticalHeader().hide()
        table.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        table.horizontalHeader().setStretchLastSection(True)
        return table

    def _place(self) -> None:
        form = QFormLayout()
        form.addRow(tr("Vary"), self.key)
        form.addRow(tr("Values"), self.values)
        form.addRow(tr("Runs per value"), self.repeats)
        form.addRow(tr("At the same time"), self.workers)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(
            task_columns(
                form, (self.start, self.stop), self.status, (self.plot, self.table), "repose_study_parts"
            )
        )

    def _connect(self) -> None:
        self.key.currentIndexChanged.connect(lambda *_: self._propose())
        self.start.clicked.connect(self.startWanted)
        self.stop.clicked.connect(self.stopWanted)
        self.table.itemSelectionChanged.connect(self._announce)

    def _propose(self) -> None:
        key = str(self.key.currentData())
        self.values.setValue(VARIED[key][1])
        tip = tr("Names of presets: {names}", names=", ".join(presets())) if key == "preset" else ""
        self.values.setToolTip(tip)
        self.show_status(
            tr("A dataset is built from the open particles for each value.") if key in SHAPE_KEYS else ""
        )

    def _announce(self) -> None:
        rows = self.table.selectionModel().selectedRows()
        if rows and self._study is not None and rows[0].row() < len(self._study.runs):
            self.chosen.emit(self._study.runs[rows[0].row()])


def _columns(points: list[tuple[float, float]]) -> tuple[tuple[float, ...], tuple[float, ...]]:
    return tuple(x for x, _ in points), tuple(y for _, y in points)


def _cells(run: ReposeStudyRun) -> tuple[str, ...]:
    measurement = run.document.get("measurement") or {"status": run.document["state"]}
    interval = measurement.get("interval_deg")
    value = number_text(run.value, "g") if isinstance(run.value, int | float) else run.value
    angle = tr(str(measurement["status"])) if run.angle is None else localized(f"{run.angle:.1f}°")
    return value, str(run.seed), angle, _interval(interval)


def _interval(ends: Sequence[float] | None) -> str:
    return tr("{low:.1f} to {high:.1f}", low=ends[0], high=ends[1]) if ends else ""


def _why(run: ReposeStudyRun) -> str:
    said = [explanation(RunSummary(Path(run.folder), run.document)), tr("Choose it to see the run.")]
    return "\n".join(each for each in said if each)
