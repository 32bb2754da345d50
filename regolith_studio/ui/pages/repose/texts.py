"""Texts of the page: checks of a run, durations, result."""

from regolith_studio.dem.angle_of_repose import ReposeMeasurement
from regolith_studio.dem.run_io import RunSummary
from regolith_studio.ui.translation import tr


def checks_text(run: RunSummary) -> str:
    """Result of the checks of a run, or its problem or state."""
    checks = run.document.get("checks")
    if checks is None:
        return str(run.document.get("problem") or run.document["state"])
    if checks["problems"]:
        return " ".join(checks["problems"])
    overlap = 100 * checks["max_overlap"]
    return tr(
        "Checked: {count:,} particles, overlap at most {overlap:.1f} % of d",
        count=checks["particles_out"],
        overlap=overlap,
    )


def duration_text(seconds: float) -> str:
    """A duration in seconds, minutes or hours."""
    return (
        f"{seconds:.0f} s"
        if seconds < 100
        else f"{seconds / 60:.0f} min"
        if seconds < 6000
        else f"{seconds / 3600:.0f} h"
    )


def angle_text(measured: ReposeMeasurement) -> str:
    """The angle of repose as rich text."""
    low, high = measured.interval
    return (
        tr(
            "<b>Angle of repose {angle:.1f}°</b> ({low:.1f}° to {high:.1f}°, {count} sections); the paper's"
            " two sections: asymmetric {asymmetric:.1f}°, symmetric {symmetric:.1f}°.",
            angle=measured.angle,
            low=low,
            high=high,
            count=len(measured.sections),
            asymmetric=measured.paper_asymmetric.mean,
            symmetric=measured.paper_symmetric.mean,
        )
        + " "
        + " ".join(measured.warnings[:2])
    )
