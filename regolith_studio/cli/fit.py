"""``fit``: spherical-harmonics coefficients and power spectrum of a sample."""

from pathlib import Path
from typing import Annotated

import typer

from regolith_studio.cli.dataclass_options import with_dataclass_options
from regolith_studio.cli.inputs import ReadingOptions
from regolith_studio.cli.options import (
    Jobs,
    Json,
    Level,
    LMax,
    Meshes,
    Seed,
    check_writable,
    check_writable_file,
    usage_errors,
)
from regolith_studio.harmonics.fit_options import FitOptions

Stem = Annotated[
    Path,
    typer.Option(
        "--output",
        "-o",
        help="Stem of the files to write: FIT.json and FIT.npz.",
        metavar="FIT",
        show_default=False,
        callback=check_writable_file,
    ),
]
Surfaces = Annotated[
    Path | None,
    typer.Option(
        "--surfaces",
        help="Folder for the surface of each fit as STL.",
        metavar="DIR",
        callback=check_writable,
    ),
]


@with_dataclass_options
def fit(
    *,
    meshes: Meshes,
    output: Stem,
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
    from regolith_studio.cli.inputs import exit_code
    from regolith_studio.cli.terminal import print_errors, print_json, run_with_progress
    from regolith_studio.jobs.particle_jobs import FitRequest, fit_sample
    from regolith_studio.session.choices import Choices
    from regolith_studio.session.outputs.fits import FittedSample, fits_document, write_fits, write_surfaces

    with usage_errors():
        Choices(l_max=l_max, seed=seed, level=level)
        order = FitRequest(l_max, radii)
    stem = output.with_suffix("") if output.suffix in (".json", ".npz") else output
    loaded = reading.read(meshes)
    sample = FittedSample.of(loaded.particles, run_with_progress(fit_sample(loaded.particles, order, jobs)))
    print_errors(f"{name}: {sentence}" for name, sentence in sample.failed)
    holes: dict[str, str] = {}
    if sample.fits:
        paths = write_fits(stem, sample)
        if surfaces is not None:
            holes = write_surfaces(surfaces, sample, level)
            print_errors(f"{name}: {sentence}" for name, sentence in holes.items())
        if json:
            print_json(fits_document(sample) | {"arrays": paths[1].name})
        else:
            typer.echo(f"{len(sample.fits)} fits up to l = {l_max} in {paths[0]} and {paths[1]}")
    raise typer.Exit(exit_code(meshes, loaded, len(sample.failed) + len(holes)))
