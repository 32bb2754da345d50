"""``fit``: spherical-harmonics coefficients and power spectrum of a sample."""

from pathlib import Path
from typing import Annotated

import typer

from regolith_studio.cli.options import Jobs, Json, LMax, Meshes, Seed, Unit, as_bad_use

Stem = Annotated[
    Path,
    typer.Option("--output", "-o", help="Writes FIT.json and FIT.npz.", metavar="FIT", show_default=False),
]


def fit(
    meshes: Meshes,
    output: Stem,
    l_max: LMax = 30,
    unit: Unit = "um",
    json: Json = False,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Fit spherical harmonics to meshes; write coefficients and spectrum."""
    from regolith_studio.cli.inputs import exit_code, read_inputs
    from regolith_studio.cli.terminal import complain, follow, print_json
    from regolith_studio.jobs.fitting import fit_sample
    from regolith_studio.session.choices import Choices
    from regolith_studio.session.outputs.fits import FittedSample, fits_document, write_fits

    with as_bad_use():
        Choices(l_max=l_max, seed=seed)
    stem = output.with_suffix("") if output.suffix in (".json", ".npz") else output
    loaded = read_inputs(meshes, unit)
    sample = FittedSample.of(loaded.particles, follow(fit_sample(loaded.particles, l_max, jobs)))
    complain(f"{name}: {sentence}" for name, sentence in sample.failed)
    if sample.fits:
        paths = write_fits(stem, sample)
        if json:
            print_json(fits_document(sample) | {"arrays": paths[1].name})
        else:
            typer.echo(f"{len(sample.fits)} fits up to l = {l_max} in {paths[0]} and {paths[1]}")
    raise typer.Exit(exit_code(meshes, loaded, len(sample.failed)))
