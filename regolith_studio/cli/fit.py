"""``fit``: spherical-harmonics coefficients and power spectrum of a sample."""

from pathlib import Path
from typing import Annotated

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
    sample = FittedSample.of(loaded.particles, run_with_progress(fit_sample(loaded.particles, request, jobs)))
    print_errors(f"{name}: {sentence}" for name, sentence in sample.failed)
    holes: dict[str, str] = {}
    if sample.fits:
        holes = write_fits(output, sample, surfaces, level)
        print_errors(f"{name}: {sentence}" for name, sentence in holes.items())
        if json:
            print_json(fits_document(sample))
        else:
            typer.echo(f"{len(sample.fits)} fits up to l = {l_max} in {output}")
    raise typer.Exit(exit_code(loaded, len(sample.failed) + len(holes)))
