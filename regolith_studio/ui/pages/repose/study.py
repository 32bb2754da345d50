"""Panel of a study: varied parameter, start and stop, and a plot that is updated after every run."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from PySide6.QtCore import Signal

from regolith_studio.coarsening.weights import presets
from regolith_studio.dem.run_io import RunSummary
from regolith_studio.errors import RegolithError
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.repose_study import (
    SHAPE_KEYS,
    ReposeStudyRequest,
    run_repose_study,
    study_place,
    values_in,
)
from regolith_studio.jobs.runners.process_pool import cores
from regolith_studio.messages import N_
from regolith_studio.studies.repose import ReposeStudy, ReposeStudyRun
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.repose.run_panel import Field, RunPanel, count_box, keys_box
from regolith_studio.ui.pages.repose.runs import explanation, interval_bars
from regolith_studio.ui.pages.repose.setup import SetupPanel
from regolith_studio.ui.run_controller import RunController
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import localized, number_text, tr, tr_count
from regolith_studio.ui.widgets.numbers import NumbersLine
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve
from regolith_studio.ui.widgets.result_view import ResultRecord, ResultView
from regolith_studio.ui.widgets.text_table import TextTable

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


class StudyPanel(RunPanel):
    """Edits the request of a study and shows its runs."""

    chosen = Signal(object)

    def __init__(self) -> None:
        self._study: ReposeStudy | None = None
        self.key = keys_box(VARIED, "repose_study_key", tr("Varied quantity"))
        self.values = NumbersLine(VARIED["static_friction"][1])
        self.values.setObjectName("repose_study_values")
        self.values.setAccessibleName(tr("Values, with commas between them"))
        self.repeats = count_box("repose_study_repeats", tr("Runs per value, with different seeds"), 100)
        self.workers = count_box("repose_study_workers", tr("Runs at the same time"), cores())
        self.workers.setToolTip(tr("Each run takes one core, and the memory of a run"))
        self.table = TextTable("repose_study_runs", tr("Runs of the study"), [tr(each) for each in HEADINGS])
        self.plot = CurvePlot(tr("Static friction"), tr("Angle [°]"), tr("Each run adds a point."))
        card = ResultView("repose_study_result", (tr("Angles"),), tr("Start"), tr("Resume"))
        fields: dict[str, tuple[str, Field]] = {
            "key": (tr("Vary"), self.key),
            "values": (tr("Values"), self.values),
            "repeats": (tr("Runs per value"), self.repeats),
            "workers": (tr("At the same time"), self.workers),
        }
        super().__init__("repose_study", card, fields, (self.plot, self.table))
        self.key.currentIndexChanged.connect(lambda *_: self._propose())
        self.table.chosen.connect(self._announce)

    def set_theme(self, theme: Theme) -> None:  # noqa: ARG002
        """Take the colours of a theme."""
        self._draw()

    def request(self) -> tuple[str, tuple[float | str, ...], int, int]:
        """Varied parameter, values, number of repetitions, and runs at the same time."""
        key = str(self.key.currentData())
        return key, values_in(key, self.values.value()), self.repeats.value(), self.workers.value()

    def show_study(self, study: ReposeStudy | None) -> ResultRecord:
        """Show other runs; returns the record of the card."""
        self._study = study
        runs = study.runs if study is not None else ()
        self.table.set_rows([_cells(run) for run in runs], [_why(run) for run in runs])
        self._draw()
        if not runs:
            return ResultRecord()
        angles = [run.angle for run in runs if run.angle is not None]
        values = tr("{low:.1f}° to {high:.1f}°", low=min(angles), high=max(angles)) if angles else "–"
        return ResultRecord(
            (values,), tr_count(N_("1 run"), N_("{count} runs"), len(runs)), tr(VARIED[runs[0].varied][0])
        )

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
        intervals = [
            (places[run.value], *run.document["measurement"]["interval_deg"])
            for run in study.runs
            if run.angle is not None
        ]
        self.plot.set_curves(
            [
                PlotCurve(tr("mean"), theme.fit, *_columns(means), line=numeric),
                PlotCurve(tr("run"), theme.polyhedron, *_columns(found), markers=True, line=False),
                interval_bars(theme.polyhedron, intervals),
            ]
            if found
            else []
        )

    def _propose(self) -> None:
        key = str(self.key.currentData())
        self.values.setValue(VARIED[key][1])
        tip = tr("Names of presets: {names}", names=", ".join(presets())) if key == "preset" else ""
        self.values.setToolTip(tip)
        note = tr("A dataset is built from the open particles for each value.") if key in SHAPE_KEYS else ""
        self.card.show_record(ResultRecord(note=note))

    def _announce(self, row: int) -> None:
        if self._study is not None and row < len(self._study.runs):
            self.chosen.emit(self._study.runs[row])


class StudyController:
    """Starts and resumes the study of a panel; `folder` tells where runs are kept."""

    def __init__(
        self, context: PageContext, panel: StudyPanel, setup: SetupPanel, folder: Callable[[], Path]
    ) -> None:
        self._context, self._panel, self._setup, self._folder = context, panel, setup, folder
        self._place = folder()
        self.run = RunController(
            context,
            panel.card,
            "study",
            self.start,
            tr("Finished runs are kept, and the button resumes."),
            tr("A study of the angle of repose would be stopped; it can be resumed later."),
            panel.set_running,
        )

    def start(self) -> None:
        """Start or resume the study."""
        if self.run.running:
            return
        try:
            request = self._request()
        except RegolithError as error:
            self._context.toast.problem(str(error))
            return
        name = "open-particles" if request.dataset is None else request.dataset.name
        folder = self._place = self._folder() / "studies" / f"{request.key}-{name}"
        note = tr("Runs, tables and figure are kept in {folder}.", folder=folder)
        self._panel.show_study(None)
        self.run.start(
            tr("Angle of repose: study"),
            Job(run_repose_study, (request, folder)),
            lambda study: replace(self._panel.show_study(study), note=note),
            note,
        )

    def summary(self, run: ReposeStudyRun) -> RunSummary:
        """A run of the study with its folder."""
        return RunSummary(study_place(self._place, run.folder), run.document)

    def _request(self) -> ReposeStudyRequest:
        key, values, repeats, workers = self._panel.request()
        session, request = self._context.session, replace(self._setup.request(), filling=None)
        if key not in SHAPE_KEYS:
            return ReposeStudyRequest(key, values, request, self._setup.dataset, repeats, workers=workers)
        particles = tuple(entry.particle for entry in session.particles)
        coarsening = session.choices.coarsening_request
        return ReposeStudyRequest(key, values, request, None, repeats, particles, coarsening, workers)


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
