"""Table of the runs, a plot of their angles against a varied parameter, and the texts of a result."""

import hashlib
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QWidget

from regolith_studio.dataset.folder_io import DOCUMENT as DATASET
from regolith_studio.dem.run_io import DOCUMENT, RunSummary
from regolith_studio.messages import N_
from regolith_studio.ui.layout import vbox
from regolith_studio.ui.translation import localized, number_text, tr, translate
from regolith_studio.ui.widgets.fields import choice
from regolith_studio.ui.widgets.plots.curves import CurvePlot, PlotCurve
from regolith_studio.ui.widgets.text_table import TextTable

AGAINST: Mapping[str, tuple[str, ...]] = {
    N_("Static friction"): ("case", "contact", "static_friction"),
    N_("Facets per particle"): ("particles", "mean_facets"),
    N_("Rolling resistance"): ("case", "contact", "rolling_friction"),
    N_("Gravity [m/s²]"): ("case", "test", "gravity"),
    N_("Wall friction"): ("case", "test", "wall_friction"),
    N_("Lift speed [m/s]"): ("case", "test", "lift_speed"),
    N_("Speed of rotation [rpm]"): ("case", "drum", "rpm"),
    N_("Number of particles"): ("case", "n_particles"),
    N_("Seed"): ("case", "seed"),
}
"""Parameters that distinguish runs, and where a document has them."""
SHAPES = (N_("polyhedra"), N_("spheres"))
STATES = (
    *(N_("finished"), N_("stopped"), N_("failed")),
    *(N_("too few particles"), N_("layer"), N_("column stands"), N_("no flanks")),
    *(N_("concave"), N_("convex"), N_("scattered")),
    *(N_("too few moments"), N_("no surface")),
)
"""States of a run, and why a heap has no angle."""
HEADINGS = (
    N_("Name of the run"),
    N_("Angle"),
    N_("Interval"),
    "N",
    N_("Friction"),
    N_("Shapes"),
    N_("Gravity"),
    N_("Seed"),
    N_("Engine"),
    N_("Checks"),
)


class RunsPanel(QWidget):
    """Lists the runs and selects one."""

    chosen = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self._runs: list[RunSummary] = []
        self.table = TextTable("repose_runs", tr("Runs"), [tr(each) for each in HEADINGS])
        entries = [(path, label) for label, path in AGAINST.items()]
        self.against = choice("repose_against", tr("Compare the angle against"), entries)
        self.plot = CurvePlot(
            tr("Static friction"), tr("Angle [°]"), tr("Runs with an angle are compared here.")
        )
        right = QWidget()
        vbox(self.against, (self.plot, 1), parent=right, margins=(0, 4, 0, 0))
        vbox((self.table, 1), (right, 1), parent=self)
        self.table.chosen.connect(lambda row: self.chosen.emit(self._runs[row]))
        self.against.currentIndexChanged.connect(lambda *_: self._compare())

    def set_runs(self, runs: Sequence[RunSummary], chosen: Path | None = None) -> None:
        """List other runs and select one, without emitting a signal."""
        self._runs = list(runs)
        self.table.set_rows([_cells(run) for run in runs], [explanation(run) for run in runs])
        self.select(chosen)
        self._compare()

    def select(self, folder: Path | None) -> None:
        """Select a run, or none, without emitting a signal."""
        self.table.select(next((row for row, run in enumerate(self._runs) if run.folder == folder), None))

    def current(self) -> RunSummary | None:
        row = self.table.selected()
        return None if row is None else self._runs[row]

    def _compare(self) -> None:
        path = self.against.value()
        points = sorted(
            (
                float(value),
                run.angle,
                *run.document["measurement"]["interval_deg"],
                _kind(run.document["case"]),
            )
            for run in self._runs
            if run.angle is not None and (value := _at(run.document, path)) is not None
        )
        theme = self.plot.theme
        colours = {"polyhedra": theme.polyhedron, "spheres": theme.fit, "Rotating drum": theme.accent}
        self.plot.set_labels(self.against.currentText(), tr("Angle [°]"))
        curves = []
        for kind, colour in colours.items():
            chosen = [each for each in points if each[-1] == kind]
            x, angles = tuple(each[0] for each in chosen), tuple(each[1] for each in chosen)
            curves.append(PlotCurve(tr(kind) if chosen else "", colour, x, angles, markers=True))
            curves.append(interval_bars(colour, [(each[0], each[2], each[3]) for each in chosen]))
        self.plot.set_curves([each for each in curves if each.x])


def interval_bars(colour: str, intervals: Sequence[tuple[float, float, float]]) -> PlotCurve:
    """Vertical bars: place, lower and upper end of each."""
    x = tuple(place for place, _, _ in intervals for _ in range(3))
    return PlotCurve("", colour, x, tuple(y for _, low, high in intervals for y in (low, high, math.nan)))


def _kind(case: Mapping[str, Any]) -> str:
    """Angles of one kind are compared with each other: of heaps by their shapes, or dynamic ones of drums."""
    return "Rotating drum" if case.get("drum") else str(case["shapes"])


def _cells(run: RunSummary) -> tuple[str, ...]:
    case, document = run.document["case"], run.document
    measurement = document.get("measurement") or {}
    interval = measurement.get("interval_deg")
    checks = document.get("checks")
    angle = (
        localized(f"{run.angle:.1f}°")
        if run.angle is not None
        else tr(str(measurement.get("status", document["state"])))
    )
    return (
        run.folder.name,
        angle,
        tr("{low:.1f} to {high:.1f}", low=interval[0], high=interval[1]) if interval else "",
        number_text(case["n_particles"], ","),
        number_text(case["contact"]["static_friction"], "g"),
        tr(_kind(case)),
        number_text(case["test"]["gravity"], "g"),
        str(case["seed"]),
        str(document["engine"]["label"]),
        "" if checks is None else tr("passed") if checks["passed"] else tr("see tool tip"),
    )


def explanation(run: RunSummary) -> str:
    """Why there is no angle, the problems of the checks, and what is to be known of the engine."""
    measurement = run.document.get("measurement") or {}
    checks = run.document.get("checks") or {}
    notes = (run.document.get("run") or {}).get("notes") or ()
    problems = [run.document.get("problem"), measurement.get("reason"), *checks.get("problems", ()), *notes]
    return "\n".join(translate(run.message(each)) for each in problems if each)


def _at(document: Mapping[str, Any], path: tuple[str, ...]) -> Any:
    found: Any = document
    for key in path:
        found = found.get(key) if isinstance(found, Mapping) else None
    return found


def checks_text(run: RunSummary) -> str:
    """Result of the checks of a run, or its problem or state."""
    checks = run.document.get("checks")
    if checks is None:
        return tr(str(run.document.get("problem") or run.document["state"]))
    if checks["problems"]:
        return " ".join(translate(run.message(each)) for each in checks["problems"])
    overlap = 100 * checks["max_overlap"]
    count = checks["particles_out"]
    if run.document.get("case", {}).get("drum"):  # has no plate
        checked = tr("{count:,} particles, overlap ≤ {overlap:.1f} % d", count=count, overlap=overlap)
    else:
        checked = tr(
            "{count:,} particles, overlap ≤ {overlap:.1f} % d, with the plate ≤ {plate:.1f} % d",
            count=count,
            overlap=overlap,
            plate=100 * checks["plate_depth"],
        )
    heap = (run.document.get("packing") or {}).get("heap")
    if heap is None:
        return checked
    inside = tr(
        "inside the heap {density:.2f} g/cm³, {contacts:.1f} contacts a particle",
        density=heap["bulk_density"] / 1000.0,
        contacts=heap["coordination_number"],
    )
    return f"{checked}; {inside}"


def duration_text(seconds: float) -> str:
    """A duration in seconds, minutes or hours."""
    return (
        f"{seconds:.0f} s"
        if seconds < 100
        else f"{seconds / 60:.0f} min"
        if seconds < 6000
        else f"{seconds / 3600:.0f} h"
    )


def time_note(seconds: float) -> str:
    """How long a run of the set-up would take."""
    return tr(
        "Not run yet with these values: about {time} on one core, up to {longer} while other work runs.",
        time=duration_text(seconds),
        longer=duration_text(2 * seconds),
    )


def new_folder(folder: Path, stem: str) -> Path:
    """The first numbered folder of this name that is not there yet."""
    number = 1
    while (folder / f"{stem}-{number:03d}").exists():
        number += 1
    return folder / f"{stem}-{number:03d}"


def time_written(folder: Path) -> int:
    """When the dataset in a folder was written, in nanoseconds; 0 where there is none."""
    try:
        return (folder / DATASET).stat().st_mtime_ns
    except OSError:
        return 0


def hash_of_run(folder: Path) -> str:
    """Of the document of a run; empty if it cannot be read."""
    try:
        return hashlib.sha256((folder / DOCUMENT).read_bytes()).hexdigest()
    except OSError:
        return ""
