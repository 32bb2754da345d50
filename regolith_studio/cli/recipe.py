"""``run``: a recipe, as the window saves it."""

from pathlib import Path
from typing import Annotated

import typer

from regolith_studio.cli.executor_options import Address, Runner, Tls, chosen_executor
from regolith_studio.cli.options import MAX_SEED, Folder, Jobs, Json
from regolith_studio.cli.terminal import print_errors, print_json, run_with_progress


def run(
    recipe: Annotated[
        Path, typer.Argument(metavar="RECIPE.json", help="A recipe file, as the window saves it.")
    ],
    output: Folder = Path("regolith-results"),
    json: Json = False,
    jobs: Jobs = 1,
    resume: Annotated[
        bool, typer.Option("--resume", help="Resume an interrupted run in the output folder.")
    ] = False,
    chunk: Annotated[
        int | None,
        typer.Option(
            "--chunk",
            min=1,
            max=1_000_000,
            help="Particles per chunk; by default 1, and 25 to 200 in batches of 200 or more.",
            metavar="N",
            show_default=False,
        ),
    ] = None,
    runner: Runner = "processes",
    address: Address = "",
    tls: Tls = None,
    seed: Annotated[
        int | None,
        typer.Option(
            "--seed",
            min=0,
            max=MAX_SEED,
            help="Seed of the random numbers, instead of that of the recipe.",
            metavar="N",
        ),
    ] = None,
) -> None:
    """Run a recipe: descriptors, fits, meshes, dataset, studies and summary."""
    from regolith_studio.session.recipe import read_recipe
    from regolith_studio.session.run_recipe import run_recipe

    wish = read_recipe(recipe)
    if seed is not None:
        wish = wish.model_copy(update={"seed": seed})
    with chosen_executor(runner, jobs, address, tls) as executor:
        done = run_with_progress(
            run_recipe(wish, recipe.parent, output, executor, resume, chunk), logged=True
        )
    print_errors(done.problems)
    if json:
        print_json({"folder": str(output), "files": done.files, "problems": list(done.problems)})
    else:
        typer.echo(f"{len(done.files)} files in {output}")
    raise typer.Exit(1 if done.problems else 0)
