"""``extract``: particle meshes from a label volume."""

from pathlib import Path
from typing import Annotated

import typer

from regolith_studio.cli.options import Folder, Jobs, Json, Seed, as_bad_use


def extract(
    volume: Annotated[Path, typer.Argument(metavar="VOLUME", help="TIFF stack of labels.")],
    output: Folder,
    voxel_size: Annotated[
        float | None,
        typer.Option("--voxel-size", help="Edge of a voxel in the unit; else what the file says."),
    ] = None,
    unit: Annotated[str, typer.Option("--unit", help="Unit of the voxel size: um mm m nm cm.")] = "um",
    keep_border: Annotated[
        bool, typer.Option("--keep-border", help="Keep particles that the border of the volume cuts.")
    ] = False,
    min_diameter: Annotated[
        float, typer.Option("--min-diameter", help="Leave out what is smaller, in voxels.")
    ] = 8.0,
    json: Json = False,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Turn each label of a CT volume into a particle mesh (section 2.1)."""
    from regolith_studio.cli.terminal import follow, print_json
    from regolith_studio.imaging.extraction import ExtractionSettings
    from regolith_studio.jobs.examining import examine_sample
    from regolith_studio.jobs.extracting import extract_file
    from regolith_studio.readers.units import unit_factor
    from regolith_studio.session.outputs.descriptors import described
    from regolith_studio.session.outputs.particles import write_particles
    from regolith_studio.session.outputs.staging import staged_folder

    del seed  # taken by every command; nothing here is random
    with as_bad_use():
        settings = ExtractionSettings(exclude_border=not keep_border, min_diameter=min_diameter)
        edge = None if voxel_size is None else voxel_size * unit_factor(unit)
        if edge is not None and not edge > 0.0:
            raise typer.BadParameter(f"The voxel size must be positive, got {voxel_size}.")
    found = follow(extract_file(volume, edge, settings))
    facts = follow(examine_sample(found.particles, workers=jobs))
    with staged_folder(output) as stage:
        write_particles(stage, found.particles, facts, {"label": found.labels, "weight": found.weights})
    if json:
        particles = [described(p, each) for p, each in zip(found.particles, facts, strict=True)]
        print_json({"particles": particles, "border": list(found.border), "small": list(found.small)})
    else:
        typer.echo(f"{found.summary} Written to {output}.")
