"""``demo``: all steps for the shipped sample, without a screen."""

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from regolith_studio.cli.offscreen_process import draw_three_views
from regolith_studio.cli.options import Folder, Jobs, Json, Seed
from regolith_studio.cli.terminal import print_errors, print_json, run_with_progress

if TYPE_CHECKING:
    from regolith_studio.session.run_recipe import RecipeRun

PICTURE = "three-views.png"


def demo(
    output: Folder = Path("regolith-demo"),
    json: Json = False,
    jobs: Jobs = 0,
    seed: Seed = 0,
) -> None:
    """Run the whole chain on the shipped particles: dataset, picture, Fig. 3, Fig. 8, summary page."""
    from regolith_studio.session.outputs.summary import write_summary
    from regolith_studio.session.recipe import Outputs, recipe_of
    from regolith_studio.session.run_recipe import run_recipe

    everything = Outputs(fits=True, lmax_study=True, coarsening_study=True, summary=False)
    done = run_with_progress(run_recipe(recipe_of(seed=seed, outputs=everything), Path(), output, jobs))
    done.summary.pictures = _pictures(done)
    write_summary(output, done.recipe, done.summary, done.studies, done.problems)
    print_errors(done.problems)
    if json:
        print_json({"folder": str(output), "files": done.files, "problems": list(done.problems)})
    else:
        typer.echo(f"{len(done.files)} files in {output}; begin with {output / 'summary.html'}")
    raise typer.Exit(1 if done.problems else 0)


def _pictures(done: "RecipeRun") -> tuple[tuple[str, str], ...]:
    """The three views of the first particle; where nothing can be drawn, a sentence in their place."""
    from regolith_studio.errors import RegolithError
    from regolith_studio.jobs.coarsening_jobs import coarsen_particle

    index = done.tally.first_coarse
    if index is None:
        return ()
    particle = done.items.members[index].particle()
    first = run_with_progress(coarsen_particle(particle, done.choices.coarsening_request, index))
    try:
        draw_three_views(particle, first, done.choices, done.folder / PICTURE)
    except RegolithError as error:
        done.problems.append(str(error))
        return ()
    caption = f"{first.name}: synthetic particle, its spherical-harmonics fit and coarsened polyhedron"
    return ((PICTURE, caption),)
