"""``coarsen``: convex polyhedra with few facets."""

import typer

from regolith_studio.cli.dataclass_options import with_dataclass_options
from regolith_studio.cli.inputs import ReadingOptions, exit_code
from regolith_studio.cli.options import (
    CoarseningOptions,
    Folder,
    Jobs,
    Json,
    Meshes,
    Preset,
    Seed,
    StoppingOptions,
)
from regolith_studio.cli.terminal import print_errors, print_json, print_table, run_with_progress


@with_dataclass_options
def coarsen(
    *,
    meshes: Meshes,
    output: Folder,
    stopping: StoppingOptions,
    preset: Preset = "",
    how: CoarseningOptions,
    reading: ReadingOptions,
    json: Json = False,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Coarsen meshes to convex polyhedra that keep the chosen descriptors (section 2.4)."""
    from regolith_studio.io.atomic import staged_folder
    from regolith_studio.jobs.coarsening_jobs import coarsen_sample
    from regolith_studio.session.outputs.coarsening import (
        coarsening_document,
        error_table,
        remarks,
        write_coarsening,
    )

    choices = how.choices(preset, seed=seed, **stopping.changes)
    request = choices.coarsening_request
    loaded = reading.read(meshes)
    done = run_with_progress(coarsen_sample(loaded.particles, request, jobs))
    with staged_folder(output, "coarsen") as stage:
        write_coarsening(stage, request, done)
    failed = [each for each in done if each.coarsened is None]
    print_errors(f"{each.name}: {note}" for each in loaded.particles for note in each.notes)
    print_errors(f"{each.name}: {each.problem}" for each in failed)
    if json:
        print_json(coarsening_document(request, done))
    else:
        if len(done) > len(failed):
            print_table(error_table(done))
        print_errors(remarks(done))
        typer.echo(
            f"{len(done) - len(failed)} of {len(done) + len(loaded.problems)} particles coarsened in {output}"
        )
    raise typer.Exit(exit_code(loaded, len(failed)))
