"""``warm-up``: compile now what would otherwise be compiled when it is first used."""

import typer

from regolith_studio.cli.options import Jobs, Json


def warm_up(json: Json = False, jobs: Jobs = 0) -> None:
    """Compile all kernels in advance, so that the first use is as fast as later ones."""
    from regolith_studio.cli.terminal import print_json, run_with_progress
    from regolith_studio.jobs.compile_kernels import compile_kernels

    done = run_with_progress(compile_kernels(jobs))
    if json:
        print_json({"compiled": list(done)})
    else:
        typer.echo(f"Compiled: {', '.join(done)}.")
