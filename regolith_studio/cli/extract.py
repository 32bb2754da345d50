"""``extract``: particle meshes from a volume of grey values or labels."""

from pathlib import Path
from typing import Annotated

import typer

from regolith_studio.cli.dataclass_options import with_dataclass_options
from regolith_studio.cli.options import Folder, Jobs, Json, Seed, usage_errors
from regolith_studio.cli.volume_options import GrainOptions, VolumeOptions


@with_dataclass_options
def extract(
    *,
    volume: Annotated[
        Path,
        typer.Argument(
            metavar="VOLUME", help="TIFF stack, folder of slices, HDF5, NRRD, MetaImage, NIfTI, NPY or raw."
        ),
    ],
    output: Folder,
    contents: VolumeOptions,
    grains: GrainOptions,
    recipe: Annotated[
        Path | None,
        typer.Option("--recipe", help="Take all settings from an extraction.json instead.", metavar="FILE"),
    ] = None,
    json: Json = False,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Turn the grains of a CT volume into particle meshes (section 2.1).

    Writes one STL a particle, particles.csv and extraction.json with all settings.
    """
    from regolith_studio.cli.terminal import print_json, run_with_progress
    from regolith_studio.io.atomic import staged_folder
    from regolith_studio.jobs.extraction_settings import read_grain_settings
    from regolith_studio.jobs.volume_jobs import extract_measured
    from regolith_studio.session.outputs.particles import ExtractionFolder

    del seed  # taken by every command; nothing here is random
    with usage_errors():
        given = contents.of(volume)
        settings = read_grain_settings(recipe) if recipe else grains.recipe
    with staged_folder(output, "extract") as stage:
        folder = ExtractionFolder(stage)
        done = run_with_progress(extract_measured(given, settings, output.parent, folder.add, jobs))
        document = folder.finish(given, settings, done)
    if json:
        print_json(document)
    else:
        typer.echo(f"{done.extraction.summary} Written to {output}.")
