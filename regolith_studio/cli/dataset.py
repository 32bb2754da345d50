"""``dataset``: build, validate."""

from pathlib import Path
from typing import Annotated

import typer

from regolith_studio.cli.coarsen import choices_from
from regolith_studio.cli.options import (
    Faces,
    Folder,
    Jobs,
    Json,
    LMax,
    Meshes,
    Method,
    Preset,
    Seed,
    Settings,
    Target,
    Unit,
    Weights,
)

app = typer.Typer(
    help="Datasets for DEM programs (section 2.5).", no_args_is_help=True, rich_markup_mode=None
)


@app.command("build")
def build(
    meshes: Meshes,
    output: Folder,
    faces: Faces = 20,
    method: Method = "",
    preset: Preset = "",
    weight: Weights = None,
    set_: Settings = None,
    target: Target = "fit",
    l_max: LMax = 10,
    name: Annotated[str, typer.Option("--name", help="Name of the dataset; the folder's if left out.")] = "",
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace what is in the folder.")] = False,
    unit: Unit = "um",
    json: Json = False,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Coarsen the meshes and write them as a dataset folder."""
    from regolith_studio.cli.inputs import exit_code, read_inputs
    from regolith_studio.cli.terminal import complain, follow, print_json
    from regolith_studio.jobs.building import DatasetOptions, build_dataset_folder, check_place
    from regolith_studio.session.outputs.coarsening import coarsening_document

    wish = choices_from(faces, method, preset, weight, set_, target, l_max, seed)
    check_place(output, overwrite)
    loaded = read_inputs(meshes, unit)
    known = None if wish.preset_modified else wish.preset
    options = DatasetOptions(name, known, overwrite, jobs)
    built = follow(build_dataset_folder(loaded.particles, wish.order, output, options))
    failed = [each for each in built.outcomes if each.coarsened is None]
    complain(f"{each.name}: {each.problem}" for each in failed)
    if json:
        print_json({"folder": str(output)} | coarsening_document(wish.order, built.outcomes))
    else:
        typer.echo(f"{len(built.dataset)} of {len(built.outcomes)} particles in the dataset {output}")
    raise typer.Exit(exit_code(meshes, loaded, len(failed)))


@app.command("validate")
def validate(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="A dataset folder.")],
    json: Json = False,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Read a dataset back and check everything in it; problems are printed, one a line."""
    from regolith_studio.cli.terminal import print_json
    from regolith_studio.dataset.validation import validate_dataset

    del jobs, seed  # taken by every command
    problems = [str(problem) for problem in validate_dataset(folder)]
    if json:
        print_json({"folder": str(folder), "valid": not problems, "problems": problems})
    else:
        typer.echo("\n".join(problems) or f"{folder} is a sound dataset.")
    raise typer.Exit(1 if problems else 0)
