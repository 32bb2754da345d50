"""Panel of a calibration: what is wanted, start and stop, the prediction and the posterior as it narrows."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QComboBox,
    QFormLayout,
    QHBoxLayout,
    QPushButton,
    QSpinBox,
    QWidget,
)

from regolith_studio.errors import InputError
from regolith_studio.jobs.repose_calibration import ReposeCalibrationRequest
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
from regolith_studio.ui.layout import task_columns
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.widgets.labels import remark
from regolith_studio.ui.widgets.numbers import DecimalField, NumbersLine
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve

PARAMETERS: Mapping[str, tuple[str, str]] = {
    "static_friction": (N_("Static friction"), "0.05, 1.2"),
    "rolling_friction": (N_("Rolling resistance"), "0, 0.3"),
    "plate_friction": (N_("Plate friction"), "0.05, 1.2"),
}
"""Parameters that can be found: label and proposed range."""
DENSITY_ERROR = 0.01
"""Standard error of a wanted bulk density relative to its value."""


class CalibrationPanel(QWidget):
    """Edits the request of a calibration and shows what is known so far."""

    startWanted = Signal()  # noqa: N815
    stopWanted = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("repose_calibration")
        self._calibration: ReposeCalibration | None = None
        self.angle = _number("repose_wanted_angle", tr("Wanted angle of repose"), 1.0, 80.0, 30.0, " °")
        self.error = _number(
            "repose_angle_error", tr("Standard error of the wanted angle"), 0.1, 45.0, 1.0, " °"
        )
        self.density = _number("repose_wanted_density", tr("Wanted bulk density"), 0.0, 30.0, 0.0, " g/cm³")
        self.density.setSpecialValueText(tr("not given"))
        self.density.setToolTip(tr("Of the filled cylinder; its standard error is taken as 1 %"))
        self.key = QComboBox()
        self.key.setObjectName("repose_calibration_key")
        self.key.setAccessibleName(tr("Parameter"))
        for name, (label, _) in PARAMETERS.items():
            self.key.addItem(tr(label), name)
        self.range = NumbersLine(PARAMETERS["static_friction"][1])
        self.range.setObjectName("repose_calibration_range")
        self.range.setAccessibleName(tr("Lowest and highest value, with a comma between them"))
        self.runs = QSpinBox()
        self.runs.setObjectName("repose_calibration_runs")
        self.runs.setAccessibleName(tr("Number of runs"))
        self.runs.setRange(1, 99)
        self.runs.setValue(12)
        self.start, self.stop = QPushButton(tr("Start or resume")), QPushButton(tr("Stop"))
        self.start.setObjectName("repose_calibration_start")
        self.start.setToolTip(tr("Finished runs are not repeated"))
        self.stop.setObjectName("repose_calibration_stop")
        self.prediction = CurvePlot(tr("Static friction"), tr("Angle [°]"), tr("Each run adds a point."))
        self.posterior = CurvePlot(
            tr("Static friction"),
            tr("Posterior / prior"),
            tr("The probability density of the parameter appears after the first usable run."),
        )
        self.status = remark()
        self.status.setObjectName("repose_calibration_status")
        self._place()
        self._connect()
        self.set_running(False)

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        for plot in (self.prediction, self.posterior):
            plot.set_theme(theme)
        self._draw()

    def request(self, dataset: Path | None, request: ReposeRequest) -> ReposeCalibrationRequest:
        """The request of the panel, with the dataset and all other values of a run.

        Raises
        ------
        InputError
            If a value is invalid, or there is no dataset.
        """
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

    def set_running(self, running: bool) -> None:
        """Set whether a calibration is running."""
        self.start.setVisible(not running)
        self.stop.setVisible(running)
        for each in (self.angle, self.error, self.density, self.key, self.range, self.runs):
            each.setEnabled(not running)

    def show_status(self, text: str) -> None:
        """Show a status text."""
        self.status.setText(text)

    def show_calibration(self, calibration: ReposeCalibration | None) -> None:
        """Show what is known after other runs."""
        self._calibration = calibration
        if calibration is not None and calibration.runs:
            self.show_status(_in_words(calibration))
        self._draw()

    def state(self) -> dict[str, Any]:
        """The values as plain JSON."""
        return {
            "angle": self.angle.value(),
            "error": self.error.value(),
            "density": self.density.value(),
            "key": self.key.currentData(),
            "range": self.range.value(),
            "runs": self.runs.value(),
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Show what :meth:`state` returned; unknown values are ignored."""
        at = self.key.findData(state.get("key"))
        if at >= 0:
            self.key.setCurrentIndex(at)
            self.range.setValue(str(state.get("range", PARAMETERS[self.key.currentData()][1])))
        for name, field in (("angle", self.angle), ("error", self.error), ("density", self.density)):
            if isinstance(state.get(name), int | float):
                field.setValue(state[name])
        if isinstance(state.get("runs"), int):
            self.runs.setValue(state["runs"])

    def _draw(self) -> None:
        calibration = self._calibration
        if calibration is None or not calibration.usable_runs:
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

    def _place(self) -> None:
        form = QFormLayout()
        form.addRow(tr("Wanted angle"), self.angle)
        form.addRow(tr("Standard error"), self.error)
        form.addRow(tr("Bulk density"), self.density)
        form.addRow(tr("Parameter"), self.key)
        form.addRow(tr("Range"), self.range)
        form.addRow(tr("Runs"), self.runs)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(
            task_columns(
                form,
                (self.start, self.stop),
                self.status,
                (self.prediction, self.posterior),
                "repose_calibration_parts",
            )
        )

    def _connect(self) -> None:
        self.key.currentIndexChanged.connect(
            lambda *_: self.range.setValue(PARAMETERS[str(self.key.currentData())][1])
        )
        self.start.clicked.connect(self.startWanted)
        self.stop.clicked.connect(self.stopWanted)


def _number(name: str, accessible: str, low: float, high: float, value: float, unit: str) -> DecimalField:
    field = DecimalField()
    field.setObjectName(name)
    field.setAccessibleName(accessible)
    field.setRange(low, high)
    field.setSingleStep(0.1)
    field.setSuffix(unit)
    field.setValue(value)
    return field


def _in_words(calibration: ReposeCalibration) -> str:
    """What is known of the parameter, the next run, and warnings."""
    warnings = list(map(translate, calibration.warnings))
    if not calibration.usable_runs:
        return "\n".join([*warnings, tr("Next run at {next:.3g}.", next=calibration.next_values[0])])
    posterior, parameter = calibration.posterior, calibration.parameters[0]
    low, high = posterior.intervals[0]
    found = tr(
        "{name}: {best:.3g} ({low:.3g} to {high:.3g}, {share:.0%} interval) after {count} runs; next run "
        "at {next:.3g}.",
        name=tr(PARAMETERS[parameter.name][0]),
        best=float(posterior.best[0]),
        low=float(low),
        high=float(high),
        share=CONFIDENCE,
        count=len(calibration.usable_runs),
        next=calibration.next_values[0],
    )
    return "\n".join([found, *warnings])


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
