"""``warm-up``: compile now what would otherwise be compiled when it is first used."""

import typer

from regolith_studio.cli.options import Json


def warm_up(json: Json = False) -> None:
    """Compile fitting, measuring and coarsening ahead, so that the first use is as fast as the second."""
    from regolith_studio.cli.terminal import print_json, run_with_progress
    from regolith_studio.errors import RegolithError
    from regolith_studio.jobs.compile_kernels import TASKS, compile_first, is_compiled

    run_with_progress(compile_first(*TASKS))
    if failed := [task for task in TASKS if not is_compiled(task)]:
        raise RegolithError(f"Not compiled: {', '.join(failed)}. It is compiled when it is first used.")
    if json:
        print_json({"compiled": list(TASKS)})
    else:
        typer.echo(f"Compiled: {', '.join(TASKS)}.")
