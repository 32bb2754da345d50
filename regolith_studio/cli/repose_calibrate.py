"""``repose calibrate``: contact parameters that give a wanted angle of repose."""

from pathlib import Path
from typing import Annotated, Any

import typer

from regolith_studio.cli.options import (
    Folder,
    Jobs,
    Json,
    Seed,
    option_of,
    usage_errors,
    with_dataclass_options,
)
from regolith_studio.cli.repose_options import CaseOptions, Particles, check_results_folder, varied_values
from regolith_studio.cli.terminal import print_errors, print_json, print_table, run_with_progress
from regolith_studio.dataset.parameters import DrumRotation

RANGE_FORM = "a parameter and its range as KEY=LOW,HIGH"


@with_dataclass_options
def calibrate(
    *,
    datasets: Annotated[
        list[Path],
        typer.Argument(
            metavar="DATASET...", help="Dataset folders; with several the dataset is a parameter too."
        ),
    ],
    output: Folder,
    angle: Annotated[
        float,
        typer.Option("--angle", min=1.0, max=80.0, help="Wanted angle of repose in degrees.", metavar="A"),
    ],
    angle_error: Annotated[
        float,
        typer.Option(
            "--angle-error",
            min=0.0,
            max=45.0,
            help="Its standard error: of a mean, if of several.",
            metavar="E",
        ),
    ] = 1.0,
    bulk_density: Annotated[
        float | None,
        typer.Option(
            "--bulk-density",
            min=1.0,
            max=3e4,
            help="Wanted bulk density of the filled cylinder in kg/m^3.",
            metavar="D",
        ),
    ] = None,
    bulk_density_error: Annotated[
        float,
        typer.Option("--bulk-density-error", min=0.0, max=3e4, help="Its standard error.", metavar="E"),
    ] = 20.0,
    drum_angle: Annotated[
        float | None,
        typer.Option(
            "--drum-angle",
            min=1.0,
            max=80.0,
            help="Wanted dynamic angle of the usual rotating drum in degrees: every run turns one too.",
            metavar="A",
        ),
    ] = None,
    drum_angle_error: Annotated[
        float,
        typer.Option("--drum-angle-error", min=0.0, max=45.0, help="Its standard error.", metavar="E"),
    ] = 1.0,
    rpm: Annotated[
        float, option_of(DrumRotation, "rpm", tip="Of that drum, in a minute.")
    ] = DrumRotation.rpm,
    parameter: Annotated[
        list[str] | None,
        typer.Option(
            "--parameter",
            help="A parameter of Table 1 or 2 with its range in SI units; static_friction=0.05,1.2 if "
            "omitted; may be repeated.",
            metavar="KEY=LOW,HIGH",
        ),
    ] = None,
    runs: Annotated[
        int, typer.Option("--runs", min=1, max=99, help="Number of runs, with earlier ones.", metavar="N")
    ] = 12,
    particles: Particles = 1000,
    how: CaseOptions,
    json: Json = False,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Find contact parameters that give a wanted angle of repose; resumes a stopped calibration."""
    from dataclasses import replace

    from regolith_studio.jobs.repose_calibration import (
        DEFAULT_RANGES,
        ReposeCalibrationRequest,
        calibration_steps,
    )
    from regolith_studio.jobs.runners.process_pool import cores
    from regolith_studio.studies.repose_calibration import (
        angle_target,
        calibration_document,
        calibration_table,
        density_target,
        drum_target,
    )

    check_results_folder(output, datasets)
    targets = [angle_target(angle, angle_error)]
    if bulk_density is not None:
        targets.append(density_target(bulk_density, bulk_density_error))
    turning = None
    if drum_angle is not None:
        targets.append(drum_target(drum_angle, drum_angle_error))
        with usage_errors():
            turning = DrumRotation(rpm)
    base = replace(how.request(n_particles=particles, seed=seed), threads=jobs or cores())
    with usage_errors():
        request = ReposeCalibrationRequest(
            tuple(datasets), _ranges(parameter) or DEFAULT_RANGES, tuple(targets), base, runs, turning
        )
    done = run_with_progress(calibration_steps(request, output))
    document = calibration_document(done)
    print_errors(done.warnings)
    if json:
        print_json(document)
    else:
        print_table(calibration_table(done))
        typer.echo(calibration_in_words(document))


def _ranges(entries: list[str] | None) -> dict[str, tuple[float, float]]:
    """Ranges of ``KEY=LOW,HIGH`` entries."""
    ranges = {}
    for entry in entries or ():
        key, ends = varied_values(entry, RANGE_FORM)
        if len(ends) != 2 or not all(type(end) in (int, float) for end in ends):
            raise typer.BadParameter(f"Write {RANGE_FORM}, got {entry!r}.")
        if key in ranges:
            raise typer.BadParameter(f"The range of {key} is given twice.")
        ranges[key] = (float(ends[0]), float(ends[1]))
    return ranges


def calibration_in_words(document: dict[str, Any]) -> str:
    """The result of a calibration."""
    lines = []
    known = document["n_usable_runs"] > 0
    for each in document["parameters"]:
        if not each["informed"]:
            continue
        if "choices" in each:
            chances = ", ".join(f"{name} {100 * p:.0f} %" for name, p in each["probabilities"].items())
            lines.append(f"{each['name']:20} {each['best']} (probabilities: {chances})")
            continue
        low, high = each["interval"]
        lines.append(
            f"{each['name']:20} {each['best']:.4g} ({low:.4g} to {high:.4g}, "
            f"{100 * document['confidence']:g} % interval, {100 * each['relative_width']:.0f} % of the width "
            f"before any run; range {each['low']:g} to {each['high']:g})"
        )
    for each in document["targets"] if known else ():
        lines.append(
            f"{each['name'].replace('_', ' '):20} {each['predicted']:.4g} ± "
            f"{each['predicted_standard_error']:.2g} {each['unit']} predicted, {each['value']:g} ± "
            f"{each['standard_error']:g} wanted"
        )
    proposed = ", ".join(
        f"{name} {value if isinstance(value, str) else format(value, 'g')}"
        for name, value in document["next_run"].items()
    )
    points = f"{document['effective_points']:.0f} of {document['n_points']} values in the range"
    runs = f"{document['n_usable_runs']} of {document['n_runs']} runs usable; as many as {points} remain"
    return "\n".join([*lines, f"{'next run':20} {proposed}", f"{'data':20} {runs}"])
