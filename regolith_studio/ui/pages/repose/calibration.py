"""Panel of a calibration: what is wanted, start and stop, the prediction and the posterior as it narrows."""

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from regolith_studio.errors import InputError, RegolithError
from regolith_studio.io.file_names import MAX_NAME_BYTES, cut_name, file_stem
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.repose_calibration import ReposeCalibrationRequest, locked_calibration
from regolith_studio.jobs.repose_jobs import ReposeRequest
from regolith_studio.jobs.repose_study import values_in
from regolith_studio.messages import N_
from regolith_studio.studies.calibration import CONFIDENCE, density_of
from regolith_studio.studies.repose_calibration import (
    ANGLE,
    ReposeCalibration,
    angle_target,
    density_target,
)
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.pages.repose.run_panel import Field, RunPanel, count_box, keys_box
from regolith_studio.ui.pages.repose.setup import SetupPanel
from regolith_studio.ui.run_controller import RunController
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import number_text, tr, tr_count, translate
from regolith_studio.ui.widgets.numbers import DecimalField, NumbersLine
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve
from regolith_studio.ui.widgets.result_view import ResultRecord, ResultView

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
        self.angle = _number("repose_wanted_angle", tr("Wanted angle of repose"), 1.0, 80.0, 30.0, " °")
        self.error = _number(
            "repose_angle_error", tr("Standard error of the wanted angle"), 0.1, 45.0, 1.0, " °"
        )
        self.density = _number("repose_wanted_density", tr("Wanted bulk density"), 0.0, 30.0, 0.0, " g/cm³")
        self.density.setSpecialValueText(tr("not given"))
        self.density.setToolTip(tr("Of the filled cylinder; its standard error is taken as 1 %"))
        self.key = keys_box(PARAMETERS, "repose_calibration_key", tr("Parameter"))
        self.range = NumbersLine(PARAMETERS["static_friction"][1])
        self.range.setObjectName("repose_calibration_range")
        self.range.setAccessibleName(tr("Lowest and highest value, with a comma between them"))
        self.runs = count_box("repose_calibration_runs", tr("Number of runs"), 99)
        self.runs.setValue(12)
        self.prediction = CurvePlot(tr("Static friction"), tr("Angle [°]"), tr("Each run adds a point."))
        self.posterior = CurvePlot(
            tr("Static friction"),
            tr("Posterior / prior"),
            tr("The probability density of the parameter appears after the first usable run."),
        )
        interval = tr("{share:.0%} interval", share=CONFIDENCE)
        captions = (tr("Static friction"), interval)
        card = ResultView("repose_calibration_result", captions, tr("Start"), tr("Resume"))
        fields: dict[str, tuple[str, Field]] = {
            "angle": (tr("Wanted angle"), self.angle),
            "error": (tr("Standard error"), self.error),
            "density": (tr("Bulk density"), self.density),
            "key": (tr("Parameter"), self.key),
            "range": (tr("Range"), self.range),
            "runs": (tr("Runs"), self.runs),
        }
        super().__init__("repose_calibration", card, fields, (self.prediction, self.posterior))
        self.key.currentIndexChanged.connect(
            lambda *_: self.range.setValue(PARAMETERS[str(self.key.currentData())][1])
        )

    def set_theme(self, theme: Theme) -> None:  # noqa: ARG002
        """Take the colours of a theme."""
        self._draw()

    def request(self, dataset: Path | None, request: ReposeRequest) -> ReposeCalibrationRequest:
        """The request of the panel, with the dataset and all other values of a run."""
        if dataset is None:
            raise InputError(N_("There is no dataset yet: open or build one first."))
        key = str(self.key.currentData())
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

    def show_calibration(self, calibration: ReposeCalibration | None) -> ResultRecord:
        """Show what is known after other runs; returns the record of the card."""
        self._calibration = calibration
        self._draw()
        if calibration is None:
            return ResultRecord()
        self.card.caption(0, tr(PARAMETERS[calibration.parameters[0].name][0]))
        return _record(calibration)

    def _draw(self) -> None:
        calibration = self._calibration
        if calibration is None or not calibration.is_informed(0):
            self.prediction.set_curves([])
            self.posterior.set_curves([])
            self.posterior.set_marker(None)
            return
        label = tr(PARAMETERS[calibration.parameters[0].name][0])
        self.prediction.set_labels(label, tr("Angle [°]"))
        self.posterior.set_labels(label, tr("Posterior / prior"))
        self.prediction.set_curves(_prediction_curves(calibration, self.prediction.theme))
        self.posterior.set_curves(_posterior_curves(calibration, self.posterior.theme))
        self.posterior.set_marker(calibration.next_values[0])


class CalibrationController:
    """Starts and resumes the calibration of a panel; `folder` tells where runs are kept."""

    def __init__(
        self, context: PageContext, panel: CalibrationPanel, setup: SetupPanel, folder: Callable[[], Path]
    ) -> None:
        self._context, self._panel, self._setup, self._folder = context, panel, setup, folder
        self.run = RunController(
            context,
            panel.card,
            "calibration",
            self.start,
            tr("Finished runs are kept, and the button resumes."),
            tr("A calibration would be stopped; it can be resumed later."),
            panel.set_running,
        )

    def start(self) -> None:
        """Start or resume the calibration."""
        if self.run.running:
            return
        try:
            request = replace(self._setup.request(), filling=None)
            wanted = self._panel.request(self._setup.dataset, request)
        except RegolithError as error:
            self._context.toast.problem(tr(str(error)))
            return
        folder = self._folder() / "studies" / folder_name(wanted)
        self._panel.show_calibration(None)
        self.run.start(
            tr("Angle of repose: calibration"),
            Job(locked_calibration, (wanted, folder)),
            self._panel.show_calibration,
            tr("Every run is kept in {folder}.", folder=folder),
        )


def _number(name: str, accessible: str, low: float, high: float, value: float, unit: str) -> DecimalField:
    field = DecimalField()
    field.setObjectName(name)
    field.setAccessibleName(accessible)
    field.setRange(low, high)
    field.setSingleStep(0.1)
    field.setSuffix(unit)
    field.setValue(value)
    return field


def _record(calibration: ReposeCalibration) -> ResultRecord:
    """What is known of the parameter, the next run, and warnings."""
    runs = len(calibration.runs)
    following = tr("next run at {next:.3g}", next=calibration.next_values[0])
    counted = tr_count(N_("1 run"), N_("{count} runs"), runs)
    made_from = f"{counted}; {following}" if runs else ""
    values: tuple[str, ...] = ()
    if calibration.is_informed(0):
        low, high = calibration.posterior.intervals[0]
        interval = tr("{low:.3g} to {high:.3g}", low=float(low), high=float(high))
        values = (number_text(float(calibration.posterior.best[0]), ".3g"), interval)
    return ResultRecord(values, made_from, note="\n".join(map(translate, calibration.warnings)))


def _prediction_curves(calibration: ReposeCalibration, theme: Theme) -> list[PlotCurve]:
    """Predicted angle with its standard deviation, the wanted angle, and the runs."""
    posterior, parameter = calibration.posterior, calibration.parameters[0]
    order = np.argsort(posterior.points[:, 0])[:: len(posterior.points) // 64]
    x = _numbers(posterior.points[order, 0])
    mean, spread = posterior.predicted[order, 0], posterior.deviations[order, 0]
    wanted = next(each.value for each in calibration.targets if each.name == ANGLE)
    runs = [(run.values[0], run.result(ANGLE)) for run in calibration.runs]
    return [
        PlotCurve(tr("predicted"), theme.fit, x, _numbers(mean)),
        PlotCurve(tr("standard deviation"), theme.fit, x, _numbers(mean - spread), dash=True),
        PlotCurve("", theme.fit, x, _numbers(mean + spread), dash=True),
        PlotCurve(tr("wanted"), theme.particle, (parameter.low, parameter.high), (wanted, wanted), dash=True),
        PlotCurve(tr("run"), theme.polyhedron, *_numbers_of(runs), markers=True, line=False),
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
