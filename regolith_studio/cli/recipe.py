"""``run``: a recipe, as the window saves it."""

from pathlib import Path
from typing import Annotated

import typer

from regolith_studio.cli.options import Folder, Jobs, Json


def run(
    recipe: Annotated[Path, typer.Argument(metavar="RECIPE.json", help="A recipe, as the window saves it.")],
    output: Folder = Path("regolith-results"),
    json: Json = False,
    jobs: Jobs = 1,
    seed: Annotated[
        int | None, typer.Option("--seed", help="Seed in place of the recipe's.", metavar="N")
    ] = None,
) -> None:
    """Do all that a recipe asks for: descriptors, fits, meshes, dataset, studies, summary."""
    from regolith_studio.cli.terminal import complain, follow, print_json
    from regolith_studio.session.performing import perform
    from regolith_studio.session.recipe import read_recipe

    wish = read_recipe(recipe)
    if seed is not None:
        wish = wish.model_copy(update={"seed": seed})
    done = follow(perform(wish, recipe.parent, output, jobs))
    complain(done.problems)
    if json:
        print_json({"folder": str(output), "files": done.files, "problems": list(done.problems)})
    else:
        typer.echo(f"{len(done.files)} files in {output}")
    raise typer.Exit(1 if done.problems else 0)
