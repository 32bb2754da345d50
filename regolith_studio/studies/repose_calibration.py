"""Calibration with lifting-cylinder tests: results of the runs, posterior after each, table, document."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import norm
from scipy.stats import t as student_t

from regolith_studio.dem.angle_of_repose import NEIGHBOURHOOD
from regolith_studio.io.tables import Cell, Column, Table
from regolith_studio.messages import N_, Message, Number
from regolith_studio.studies.calibration import (
    CONFIDENCE,
    CalibrationParameter,
    CalibrationPosterior,
    CalibrationRuns,
    WantedResult,
    calibrate,
    density_of,
    relative_width,
)
from regolith_studio.version import __version__

ANGLE, DRUM_ANGLE, BULK_DENSITY = "angle", "drum_angle", "bulk_density"
UNITS = {ANGLE: "deg", DRUM_ANGLE: "deg", BULK_DENSITY: "kg/m^3"}
DATASET = "dataset"
"""Parameter that is one of several datasets, by their names."""
MAX_RELATIVE_WIDTH = 0.9
"""Of an interval, in widths of the prior's, above which the runs have not moved the posterior."""
MAX_MISFIT = 2.0
"""Standard deviations between the predicted and the wanted results above which these are out of reach."""


def angle_target(angle: float, error: float) -> WantedResult:
    """A wanted angle of repose and its standard error, in degrees."""
    return WantedResult(ANGLE, angle, error, scale=5.0, noise=1.7)


def drum_target(angle: float, error: float) -> WantedResult:
    """A wanted dynamic angle of a rotating drum and its standard error, in degrees."""
    return WantedResult(DRUM_ANGLE, angle, error, scale=5.0, noise=1.7)


def density_target(density: float, error: float) -> WantedResult:
    """A wanted bulk density of the filled cylinder and its standard error, in kg/m^3."""
    return WantedResult(BULK_DENSITY, density, error, scale=0.05 * density, noise=0.01 * density)


@dataclass(frozen=True)
class CalibrationRun:
    """A run: its folder, the values of the parameters, its ``repose.json``, and that of its drum, if any."""

    folder: str
    values: tuple[float, ...]
    document: dict[str, Any]
    drum: dict[str, Any] | None = None

    @property
    def measurement(self) -> dict[str, Any]:
        return self.document.get("measurement") or {"status": self.document["state"]}

    @property
    def drum_measurement(self) -> dict[str, Any]:
        return (self.drum or {}).get("measurement") or {}

    def result(self, name: str) -> float:
        """An angle in degrees or the bulk density of the filled cylinder in kg/m^3; NaN if there is none."""
        if name != BULK_DENSITY:
            angle = (self.measurement if name == ANGLE else self.drum_measurement).get("angle_deg")
            return np.nan if angle is None else float(angle)
        density = (self.document.get("packing") or {}).get("filled_bulk_density")
        return np.nan if density is None else float(density)

    def error(self, name: str) -> float:
        """Standard deviation of a result, from the interval of the angle; NaN where a run states none."""
        if name == DRUM_ANGLE and (ends := self.drum_measurement.get("interval_deg")):
            return float((ends[1] - ends[0]) / 2 / norm.ppf(0.5 + self.drum_measurement["confidence"] / 2))
        interval = self.measurement.get("interval_deg")
        if name != ANGLE or interval is None:
            return np.nan
        confidence = self.measurement["settings"]["confidence"]
        quantile = student_t.ppf((1.0 + confidence) / 2, 360.0 / NEIGHBOURHOOD - 1)
        return float((interval[1] - interval[0]) / 2 / quantile)


@dataclass(frozen=True, eq=False)
class ReposeCalibration:
    """Runs of a calibration, and the posterior before the first and after each of them."""

    parameters: tuple[CalibrationParameter, ...]
    targets: tuple[WantedResult, ...]
    runs: tuple[CalibrationRun, ...]
    posteriors: tuple[CalibrationPosterior, ...]

    @classmethod
    def begin(
        cls, parameters: Sequence[CalibrationParameter], targets: Sequence[WantedResult]
    ) -> "ReposeCalibration":
        """Before the first run."""
        return cls(tuple(parameters), tuple(targets), (), ())._extended(())

    def with_run(self, run: CalibrationRun) -> "ReposeCalibration":
        """With one more run."""
        return self._extended((*self.runs, run))

    @property
    def posterior(self) -> CalibrationPosterior:
        """After the last run."""
        return self.posteriors[-1]

    @property
    def next_values(self) -> tuple[float, ...]:
        """Of the parameters in the run that is proposed, rounded to four digits."""
        return tuple(four_digits(value) for value in self.posterior.next_values)

    @property
    def usable_runs(self) -> tuple[CalibrationRun, ...]:
        """Runs with at least one of the wanted results; without any the posterior is the prior."""
        names = [each.name for each in self.targets]
        return tuple(run for run in self.runs if not np.isnan([run.result(name) for name in names]).all())

    def is_informed(self, index: int) -> bool:
        """Whether the runs have narrowed a parameter, so that its posterior is more than the prior."""
        width = relative_width(self.posterior, self.parameters[index], index)
        return bool(self.usable_runs) and width <= MAX_RELATIVE_WIDTH

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences on what the calibration could not find."""
        sentences: list[str] = []
        if failed := sum(bool(np.isnan(run.result(ANGLE))) for run in self.runs):
            template = N_("{count} of {total} runs formed a heap without a measurable angle.")
            sentences.append(Message(template, count=failed, total=len(self.runs)))
        if self.runs and not self.usable_runs:
            template = N_("No run can be used, so that there is no value: take 1,000 particles or more.")
            sentences.append(Message(template))
        for k, each in enumerate(self.parameters):
            if self.usable_runs and not self.is_informed(k):
                template = N_("The runs say next to nothing of {name}: no value is given.")
                sentences.append(Message(template, name=each.name.replace("_", " ")))
        if self.usable_runs and self.posterior.misfit > MAX_MISFIT:
            template = N_(
                "No values in the range give the wanted results: the nearest prediction is {count} "
                "standard deviations away. Take a wider range, other parameters or other particles."
            )
            sentences.append(Message(template, count=Number(self.posterior.misfit, ".1f")))
        return tuple(sentences)

    def _extended(self, runs: tuple[CalibrationRun, ...]) -> "ReposeCalibration":
        names = [each.name for each in self.targets]
        extended = CalibrationRuns.of(
            [run.values for run in runs],
            [[run.result(name) for name in names] for run in runs],
            [[run.error(name) for name in names] for run in runs],
            len(self.parameters),
            len(self.targets),
        )
        posterior = calibrate(self.parameters, self.targets, extended)
        return ReposeCalibration(self.parameters, self.targets, runs, (*self.posteriors, posterior))


def four_digits(value: float) -> float:
    """A value rounded to four significant digits."""
    return float(f"{value:.4g}")


def values_of(parameters: Sequence[CalibrationParameter], values: Sequence[float]) -> dict[str, float | str]:
    """Values of the parameters by their names; of a choice the name of the chosen."""
    pairs = zip(parameters, values, strict=True)
    return {each.name: each.choices[int(value)] if each.choices else value for each, value in pairs}


def calibration_table(calibration: ReposeCalibration) -> Table:
    """One row a run: what it was, and what it gave."""
    columns = (
        Column("run"),
        Column("seed"),
        *(Column(each.name) for each in calibration.parameters),
        Column("status"),
        Column("angle", "deg"),
        Column("interval_low", "deg"),
        Column("interval_high", "deg"),
        Column(BULK_DENSITY, UNITS[BULK_DENSITY]),
        *(Column(each.name, "deg") for each in calibration.targets if each.name == DRUM_ANGLE),
    )
    return Table(N_("Calibration"), columns, tuple(_row(run, calibration) for run in calibration.runs))


def _row(run: CalibrationRun, calibration: ReposeCalibration) -> tuple[Cell, ...]:
    return (
        run.folder,
        run.document["case"]["seed"],
        *values_of(calibration.parameters, run.values).values(),
        run.measurement["status"],
        run.result(ANGLE),
        *run.measurement.get("interval_deg", (None, None)),
        run.result(BULK_DENSITY),
        *(run.result(each.name) for each in calibration.targets if each.name == DRUM_ANGLE),
    )


def calibration_document(calibration: ReposeCalibration) -> dict[str, Any]:
    """The calibration as plain JSON."""
    posterior = calibration.posterior
    return {
        "format": "regolith-studio-repose-calibration",
        "schema_version": 2,
        "software": {"regolith-studio": __version__},
        "confidence": CONFIDENCE,
        "n_runs": len(calibration.runs),
        "n_usable_runs": len(calibration.usable_runs),
        "targets": [_target(calibration, k) for k in range(len(calibration.targets))],
        "parameters": [_parameter(calibration, k) for k in range(len(calibration.parameters))],
        "effective_points": posterior.effective_points,
        "n_points": len(posterior.points),
        "misfit": posterior.misfit,
        "next_run": values_of(calibration.parameters, calibration.next_values),
        "runs": [_run(run, calibration) for run in calibration.runs],
        "warnings": list(calibration.warnings),
    }


def _target(calibration: ReposeCalibration, k: int) -> dict[str, Any]:
    target, posterior = calibration.targets[k], calibration.posterior
    known, best = bool(calibration.usable_runs), posterior.best_index
    return {
        "name": target.name,
        "unit": UNITS[target.name],
        "value": target.value,
        "standard_error": target.error,
        "predicted": float(posterior.predicted[best, k]) if known else None,
        "predicted_standard_error": float(posterior.deviations[best, k]) if known else None,
    }


def _parameter(calibration: ReposeCalibration, k: int) -> dict[str, Any]:
    parameter, posterior = calibration.parameters[k], calibration.posterior
    known = calibration.is_informed(k)
    moved = {"relative_width": relative_width(posterior, parameter, k), "informed": known}
    if parameter.choices:
        probabilities = [probabilities_of(each, parameter, k) for each in calibration.posteriors]
        return {
            "name": parameter.name,
            **moved,
            "choices": list(parameter.choices),
            "best": parameter.choices[int(posterior.best[k])] if known else None,
            "probabilities": probabilities[-1] if known else None,
            "probabilities_after_each_run": probabilities,
        }
    values, density = density_of(posterior, parameter, k)
    return {
        "name": parameter.name,
        **moved,
        "low": parameter.low,
        "high": parameter.high,
        "best": float(posterior.best[k]) if known else None,
        "interval": posterior.intervals[k].tolist() if known else None,
        "density": {"values": values.tolist(), "relative_to_prior": density.tolist()} if known else None,
        "intervals_after_each_run": [each.intervals[k].tolist() for each in calibration.posteriors],
    }


def probabilities_of(
    posterior: CalibrationPosterior, parameter: CalibrationParameter, index: int
) -> dict[str, float]:
    """Of each choice."""
    _, density = density_of(posterior, parameter, index)
    return dict(zip(parameter.choices, (density / len(density)).tolist(), strict=True))


def _run(run: CalibrationRun, calibration: ReposeCalibration) -> dict[str, Any]:
    results = {each.name: run.result(each.name) for each in calibration.targets}
    return {
        "folder": run.folder,
        "seed": run.document["case"]["seed"],
        "status": run.measurement["status"],
        **values_of(calibration.parameters, run.values),
        **{name: None if np.isnan(value) else value for name, value in results.items()},
    }
