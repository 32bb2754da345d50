"""Panels of a study of a parameter and of a calibration, with what they share."""

import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFormLayout, QWidget

from regolith_studio.coarsening.weights import presets
from regolith_studio.dem.run_io import RunSummary
from regolith_studio.errors import InputError, RegolithError
from regolith_studio.io.file_names import MAX_NAME_BYTES, cut_name, file_stem
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.repose_calibration import (
    ReposeCalibrationRequest,
    calibration_steps,
    kept_calibration,
)
from regolith_studio.jobs.repose_jobs import ReposeRequest
from regolith_studio.jobs.repose_study import (
    SHAPE_KEYS,
    ReposeStudyRequest,
    run_repose_study,
    study_place,
    values_in,
)
from regolith_studio.jobs.runners.process_pool import cores
from regolith_studio.messages import N_
from regolith_studio.studies.calibration import CONFIDENCE, density_of
from regolith_studio.studies.repose import ReposeStudy, ReposeStudyRun
from regolith_studio.studies.repose_calibration import ANGLE, ReposeCalibration, angle_target, density_target
from regolith_studio.ui.layout import equal_parts, scrolled, vbox
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.repose.runs import explanation, interval_bars
from regolith_studio.ui.pages.repose.setup import SetupPanel
from regolith_studio.ui.result_card import ResultRecord, ResultState, ResultView, RunController
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import localized, number_text, tr, tr_count, translate
from regolith_studio.ui.widgets.fields import NumbersLine, choice, decimal_field, whole_field
from regolith_studio.ui.widgets.forms import enter_values, field_values
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve
from regolith_studio.ui.widgets.text_table import TextTable


class RunPanel(QWidget):
    """The form of a series of runs below the card of its result, and views beside it.

    Parameters
    ----------
    name
        Object name.
    fields
        Label and field, by the name in project files.
    """

    def __init__(
        self,
        name: str,
        card: ResultView,
        fields: Mapping[str, tuple[str, QWidget]],
        views: Sequence[QWidget],
    ) -> None:
        super().__init__()
        self.setObjectName(name)
        self.card, self._fields = card, {key: field for key, (_, field) in fields.items()}
        form = QFormLayout()
        form.setContentsMargins(8, 6, 0, 0)
        form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        for label, field in fields.values():
            form.addRow(label, field)
        left = QWidget()
        left.setLayout(form)
        row = equal_parts(Qt.Orientation.Horizontal, (scrolled(left, whole_width=True), *views))
        row.setObjectName(f"{name}_parts")
        vbox(card, (row, 1), parent=self, margins=(4, 4, 4, 4))

    def set_running(self, running: bool) -> None:
        """Set whether it is running: the form is not edited then."""
        for field in self._fields.values():
            field.setEnabled(not running)

    def value(self) -> dict[str, Any]:
        """The values as plain JSON."""
        return field_values(self._fields)

    def setValue(self, value: Mapping[str, Any]) -> None:
        """Show what :meth:`value` returned; unknown values are ignored."""
        enter_values(self._fields, value)


class SeriesController:
    """Starts and resumes the runs of a panel, which are kept; `stopping` says what closing would stop."""

    def __init__(self, context: PageContext, panel: RunPanel, queue: str, stopping: str) -> None:
        self._context = context
        self.run = RunController(
            context,
            panel.card,
            queue,
            self.start,
            tr("Finished runs are kept, and the button resumes."),
            stopping,
            panel.set_running,
        )

    def start(self) -> None:
        if self.run.running:
            return
        try:
            self._start()
        except RegolithError as error:
            self._context.toast.problem(tr(str(error)))

    def _start(self) -> None:
        raise NotImplementedError


def _labels(entries: Mapping[str, tuple[str, str]]) -> dict[str, str]:
    return {key: label for key, (label, _) in entries.items()}


PARAMETERS: Mapping[str, tuple[str, str]] = {
    "static_friction": (N_("Static friction"), "0.05, 1.2"),
    "rolling_friction": (N_("Rolling resistance"), "0, 0.3"),
    "plate_friction": (N_("Plate friction"), "0.05, 1.2"),
}
"""Parameters that can be found: label and proposed range."""
DENSITY_ERROR = 0.01
"""Standard error of a wanted bulk density relative to its value."""


class CalibrationPanel(RunPanel):
    """Edits the request of a calibration and shows what is known so far."""

    def __init__(self) -> None:
        self._calibration: ReposeCalibration | None = None
        self.angle = decimal_field("repose_wanted_angle", tr("Wanted angle of repose"), 1.0, 80.0, 30.0, " °")
        self.error = decimal_field(
            "repose_angle_error", tr("Standard error of the wanted angle"), 0.1, 45.0, 1.0, " °"
        )
        self.density = decimal_field(
            "repose_wanted_density", tr("Wanted bulk density"), 0.0, 30.0, 0.0, " g/cm³"
        )
        for field in (self.angle, self.error, self.density):
            field.setSingleStep(0.1)
        self.density.setSpecialValueText(tr("not given"))
        self.density.setToolTip(tr("Of the filled cylinder; its standard error is taken as 1 %"))
        self.key = choice("repose_calibration_key", tr("Parameter"), _labels(PARAMETERS))
        self.range = NumbersLine(PARAMETERS["static_friction"][1])
        self.range.setObjectName("repose_calibration_range")
        self.range.setAccessibleName(tr("Lowest and highest value, with a comma between them"))
        self.runs = whole_field("repose_calibration_runs", tr("Number of runs"), 1, 99, 12)
        self.prediction = CurvePlot(tr("Static friction"), tr("Angle [°]"), tr("Each run adds a point."))
        self.posterior = CurvePlot(
            tr("Static friction"),
            tr("Posterior / prior"),
            tr("Each usable run narrows it."),
        )
        interval = tr("{share:.0%} interval", share=CONFIDENCE)
        captions = (tr("Static friction"), interval)
        card = ResultView("repose_calibration_result", captions, tr("Start"), tr("Resume"))
        fields: dict[str, tuple[str, QWidget]] = {
            "angle": (tr("Wanted angle"), self.angle),
            "error": (tr("Standard error"), self.error),
            "density": (tr("Bulk density"), self.density),
            "key": (tr("Parameter"), self.key),
            "range": (tr("Range"), self.range),
            "runs": (tr("Runs"), self.runs),
        }
        super().__init__("repose_calibration", card, fields, (self.prediction, self.posterior))
        self.key.currentIndexChanged.connect(lambda *_: self.range.setValue(PARAMETERS[self.key.value()][1]))

    def set_theme(self, theme: Theme) -> None:  # noqa: ARG002
        self._draw()

    def request(self, dataset: Path | None, request: ReposeRequest) -> ReposeCalibrationRequest:
        """The request of the panel, with the dataset and all other values of a run."""
        if dataset is None:
            raise InputError(N_("There is no dataset yet: open or build one first."))
        key = self.key.value()
        ends = [float(end) for end in values_in(key, self.range.value())]
        if len(ends) != 2:
            raise InputError(
                N_("Write the range as its lowest and highest value, with a comma between them.")
            )
        targets = [angle_target(self.angle.value(), self.error.value())]
        if density := 1000.0 * self.density.value():
            targets.append(density_target(density, DENSITY_ERROR * density))
        return ReposeCalibrationRequest(
            (dataset,), {key: (ends[0], ends[1])}, tuple(targets), request, self.runs.value()
        )

    @property
    def has_runs(self) -> bool:
        return self._calibration is not None and bool(self._calibration.runs)

    def show_calibration(
        self, calibration: ReposeCalibration | None, request: ReposeCalibrationRequest | None = None
    ) -> ResultRecord:
        """Show what is known after other runs of a request; returns the record of the card."""
        self._calibration = calibration
        self._draw()
        if calibration is None:
            return ResultRecord()
        self.card.caption(0, tr(PARAMETERS[calibration.parameters[0].name][0]))
        return _record(calibration, request)

    def _draw(self) -> None:
        calibration = self._calibration
        self.posterior.set_marker(None)
        if calibration is None or not calibration.usable_runs:
            self.prediction.set_curves([])
            self.posterior.set_curves([])
            return
        label = tr(PARAMETERS[calibration.parameters[0].name][0])
        self.prediction.set_labels(label, tr("Angle [°]"))
        self.posterior.set_labels(label, tr("Posterior / prior"))
        self.prediction.set_curves(_prediction_curves(calibration, self.prediction.theme))
        informed = calibration.is_informed(0)
        self.posterior.set_curves(_posterior_curves(calibration, self.posterior.theme) if informed else [])
        if informed:
            self.posterior.set_marker(calibration.next_values[0])


class CalibrationController(SeriesController):
    def __init__(
        self, context: PageContext, panel: CalibrationPanel, setup: SetupPanel, folder: Callable[[], Path]
    ) -> None:
        stopping = tr("A calibration would be stopped; it can be resumed later.")
        super().__init__(context, panel, "calibration", stopping)
        self._panel, self._setup, self._folder = panel, setup, folder

    def _start(self) -> None:
        wanted, folder = self._request()
        self._panel.show_calibration(None)
        note = tr("Every run is kept in {folder}.", folder=folder)

        def show(calibration: ReposeCalibration) -> ResultRecord:
            record = self._panel.show_calibration(calibration, wanted)
            return replace(record, note=record.note or note)

        job = Job(calibration_steps, (wanted, folder))
        self.run.start(tr("Angle of repose: calibration"), job, show, note)

    def show_kept(self) -> None:
        """Show what the runs that are kept from an earlier session say."""
        try:
            wanted, folder = self._request()
        except RegolithError:
            return  # its dataset is gone, and the runs are of no other

        def show(calibration: ReposeCalibration) -> None:
            record = self._panel.show_calibration(calibration, wanted)
            state = ResultState.CURRENT if len(calibration.runs) == wanted.max_runs else ResultState.STOPPED
            self._panel.card.show_record(replace(record, state=state))

        self._panel.card.show_record(ResultRecord(note=tr("The kept runs are being read.")))
        job = Job(kept_calibration, (wanted, folder))
        self._context.start(tr("Angle of repose: calibration"), job, show, queue="calibration")

    def _request(self) -> tuple[ReposeCalibrationRequest, Path]:
        """What the form asks for, and the folder of its runs."""
        wanted = self._panel.request(self._setup.dataset, self._setup.request_of_series())
        return wanted, self._folder() / "studies" / folder_name(wanted)


def _record(calibration: ReposeCalibration, request: ReposeCalibrationRequest | None) -> ResultRecord:
    """What is known of the parameter, from which runs, what is wanted, the next run, and warnings."""
    runs = len(calibration.runs)
    following = tr("next run at {next:.3g}", next=calibration.next_values[0])
    counted = tr_count(N_("1 run"), N_("{count} runs"), runs)
    if request is not None and runs < request.max_runs:
        counted = tr("{count} of {total} runs", count=runs, total=request.max_runs)
    angle = next(each for each in calibration.targets if each.name == ANGLE)
    wanted = tr("{angle:.1f}° ± {error:.1f}° wanted", angle=angle.value, error=angle.error)
    made_from = "; ".join((counted, following, wanted))
    values: tuple[str, ...] = ()
    if calibration.is_informed(0):
        low, high = calibration.posterior.intervals[0]
        interval = tr("{low:.3g} to {high:.3g}", low=float(low), high=float(high))
        values = (number_text(float(calibration.posterior.best[0]), ".3g"), interval)
    return ResultRecord(values, made_from, note="\n".join(map(translate, calibration.warnings)))


def _prediction_curves(calibration: ReposeCalibration, theme: Theme) -> list[PlotCurve]:
    """The wanted angle and the runs; the predicted angle with its standard deviation where they know one."""
    posterior, parameter = calibration.posterior, calibration.parameters[0]
    wanted = next(each.value for each in calibration.targets if each.name == ANGLE)
    runs = [(run.values[0], run.result(ANGLE)) for run in calibration.runs]
    seen = [
        PlotCurve(tr("wanted"), theme.particle, (parameter.low, parameter.high), (wanted, wanted), dash=True),
        PlotCurve(tr("run"), theme.polyhedron, *_numbers_of(runs), markers=True, line=False),
    ]
    if not calibration.is_informed(0):
        return seen
    order = np.argsort(posterior.points[:, 0])[:: len(posterior.points) // 64]
    x = _numbers(posterior.points[order, 0])
    mean, spread = posterior.predicted[order, 0], posterior.deviations[order, 0]
    return [
        PlotCurve(tr("predicted"), theme.fit, x, _numbers(mean)),
        PlotCurve(tr("standard deviation"), theme.fit, x, _numbers(mean - spread), dash=True),
        PlotCurve("", theme.fit, x, _numbers(mean + spread), dash=True),
        *seen,
    ]


def _posterior_curves(calibration: ReposeCalibration, theme: Theme) -> list[PlotCurve]:
    """The density after the last run, and after half of the runs; that of the prior is 1."""
    parameter, count = calibration.parameters[0], len(calibration.runs)
    after = [(tr("runs: {count}", count=count), theme.polyhedron, calibration.posterior)]
    if count > 1:
        half = calibration.posteriors[count // 2]
        after.append((tr("runs: {count}", count=count // 2), theme.muted, half))
    curves = [(label, colour, density_of(posterior, parameter, 0)) for label, colour, posterior in after]
    return [PlotCurve(label, colour, _numbers(x), _numbers(y)) for label, colour, (x, y) in curves]


def _numbers(array: Any) -> tuple[float, ...]:
    return tuple(map(float, array))


def _numbers_of(points: list[tuple[float, float]]) -> tuple[tuple[float, ...], tuple[float, ...]]:
    return tuple(x for x, _ in points), tuple(y for _, y in points)


def folder_name(request: ReposeCalibrationRequest) -> str:
    """One name for all calibrations whose runs can serve each other."""
    same = repr((request.datasets, sorted(request.ranges), request.request))
    name = cut_name(request.datasets[0].name, MAX_NAME_BYTES - 21)
    return f"calibration-{file_stem(name)}-{hashlib.sha256(same.encode()).hexdigest()[:8]}"


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
        self.key = choice("repose_study_key", tr("Varied quantity"), _labels(VARIED))
        self.values = NumbersLine(VARIED["static_friction"][1])
        self.values.setObjectName("repose_study_values")
        self.values.setAccessibleName(tr("Values, with commas between them"))
        spoken = tr("Runs per value, with different seeds")
        self.repeats = whole_field("repose_study_repeats", spoken, 1, 100)
        self.workers = whole_field("repose_study_workers", tr("Runs at the same time"), 1, cores())
        self.workers.setToolTip(tr("Each run takes one core, and the memory of a run"))
        self.table = TextTable("repose_study_runs", tr("Runs of the study"), [tr(each) for each in HEADINGS])
        self.plot = CurvePlot(tr("Static friction"), tr("Angle [°]"), tr("Each run adds a point."))
        card = ResultView("repose_study_result", (tr("Angles"),), tr("Start"), tr("Resume"))
        fields: dict[str, tuple[str, QWidget]] = {
            "key": (tr("Vary"), self.key),
            "values": (tr("Values"), self.values),
            "repeats": (tr("Runs per value"), self.repeats),
            "workers": (tr("At the same time"), self.workers),
        }
        super().__init__("repose_study", card, fields, (self.plot, self.table))
        self.key.currentIndexChanged.connect(lambda *_: self._propose())
        self.table.chosen.connect(self._announce)

    def set_theme(self, theme: Theme) -> None:  # noqa: ARG002
        self._draw()

    def request(self) -> tuple[str, tuple[float | str, ...], int, int]:
        """Varied parameter, values, number of repetitions, and runs at the same time."""
        key = self.key.value()
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
                PlotCurve(tr("mean"), theme.fit, *_numbers_of(means), line=numeric),
                PlotCurve(tr("run"), theme.polyhedron, *_numbers_of(found), markers=True, line=False),
                interval_bars(theme.polyhedron, intervals),
            ]
            if found
            else []
        )

    def _propose(self) -> None:
        key = self.key.value()
        self.values.setValue(VARIED[key][1])
        tip = tr("Names of presets: {names}", names=", ".join(presets())) if key == "preset" else ""
        self.values.setToolTip(tip)
        note = tr("A dataset is built from the open particles for each value.") if key in SHAPE_KEYS else ""
        self.card.show_record(ResultRecord(note=note))

    def _announce(self, row: int) -> None:
        if self._study is not None and row < len(self._study.runs):
            self.chosen.emit(self._study.runs[row])


class StudyController(SeriesController):
    def __init__(
        self, context: PageContext, panel: StudyPanel, setup: SetupPanel, folder: Callable[[], Path]
    ) -> None:
        stopping = tr("A study of the angle of repose would be stopped; it can be resumed later.")
        super().__init__(context, panel, "study", stopping)
        self._panel, self._setup, self._folder = panel, setup, folder
        self._place = folder()

    def _start(self) -> None:
        request = self._request()
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
        return RunSummary(study_place(self._place, run.folder), run.document)

    def _request(self) -> ReposeStudyRequest:
        key, values, repeats, workers = self._panel.request()
        session, request = self._context.session, self._setup.request_of_series()
        if key not in SHAPE_KEYS:
            return ReposeStudyRequest(key, values, request, self._setup.dataset, repeats, workers=workers)
        particles = tuple(entry.particle for entry in session.particles)
        coarsening = session.choices.coarsening_request
        return ReposeStudyRequest(key, values, request, None, repeats, particles, coarsening, workers)


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
