"""``fit``: spherical-harmonics coefficients and power spectrum of a sample."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from regolith_studio.cli.dataclass_options import with_dataclass_options
from regolith_studio.cli.inputs import ReadingOptions, exit_code
from regolith_studio.cli.options import (
    Jobs,
    Json,
    Level,
    LMax,
    Meshes,
    Seed,
    claim_folder,
    claim_json,
    output_path,
    usage_errors,
)
from regolith_studio.cli.terminal import print_errors, print_json, run_with_progress
from regolith_studio.harmonics.fit_options import FitOptions

if TYPE_CHECKING:
    from regolith_studio.geometry.particle import Particle
    from regolith_studio.harmonics.fit import HarmonicFit
    from regolith_studio.jobs.particle_jobs import FitRequest

_MOST_LINES = 5
"""Fits that are far off that are named one by one."""
FitFile = Annotated[
    Path,
    typer.Option(
        "--output",
        "-o",
        help="JSON file of the fits to write.",
        metavar="FIT.json",
        show_default=False,
        parser=output_path,
        callback=claim_json,
    ),
]
Surfaces = Annotated[
    Path | None,
    typer.Option(
        "--surfaces",
        help="Folder for the surface of each fit as STL.",
        metavar="DIR",
        parser=output_path,
        callback=claim_folder,
    ),
]


@with_dataclass_options
def fit(
    *,
    meshes: Meshes,
    output: FitFile,
    l_max: LMax = 30,
    radii: FitOptions,
    surfaces: Surfaces = None,
    level: Level = 4,
    reading: ReadingOptions,
    json: Json = False,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Fit spherical harmonics to meshes; write coefficients and spectrum."""
    from regolith_studio.jobs.particle_jobs import FitRequest, fit_sample
    from regolith_studio.session.choices import Choices
    from regolith_studio.session.outputs.fits import FittedSample, fits_document, write_fits

    with usage_errors():
        Choices(l_max=l_max, seed=seed, level=level)
        request = FitRequest(l_max, radii)
    loaded = reading.read(meshes)
    fitted = run_with_progress(fit_sample(loaded.particles, request, jobs))
    sample = FittedSample.of(loaded.particles, fitted)
    print_errors(f"{name}: {sentence}" for name, sentence in sample.failed)
    holes: dict[str, str] = {}
    if sample.fits:
        holes = write_fits(output, sample, surfaces, level)
        print_errors(f"{name}: {sentence}" for name, sentence in holes.items())
        _print_far_fits(loaded.particles, fitted, request, jobs)
        if json:
            print_json(fits_document(sample))
        else:
            typer.echo(f"{len(sample.fits)} fits up to l = {l_max} in {output}")
    raise typer.Exit(exit_code(loaded, len(sample.failed) + len(holes)))


def _print_far_fits(
    particles: "Sequence[Particle]", fitted: "Sequence[HarmonicFit | str]", request: "FitRequest", jobs: int
) -> None:
    """Print which fits are far off, the first few in full."""
    from regolith_studio.jobs.fit_checks import check_fits

    found = [(each, fit) for each, fit in zip(particles, fitted, strict=True) if not isinstance(fit, str)]
    steps = check_fits([each for each, _ in found], [fit for _, fit in found], request, jobs)
    said = zip(found, run_with_progress(steps), strict=True)
    lines = [f"{each.name}: {sentence}" for (each, _), sentence in said if sentence]
    more = len(lines) - _MOST_LINES
    print_errors(lines[:_MOST_LINES] + ([f"{more} more fits are as far off."] if more > 0 else []))
