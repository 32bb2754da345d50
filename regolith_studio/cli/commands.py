"""All commands, each with its line of help; ``open`` is the window."""

from pathlib import Path
from typing import Annotated

import typer

from regolith_studio.cli import (
    check,
    classify,
    dataset,
    extract,
    generate,
    particles,
    recipe,
    report,
    repose,
    serve,
    study,
)
from regolith_studio.cli.terminal import CommandGroup


def open_files(
    files: Annotated[
        list[Path] | None, typer.Argument(metavar="FILE...", help="Meshes, folders or a recipe.")
    ] = None,
    unit: Annotated[
        str | None,
        typer.Option("--unit", help="Length unit of files without one: um, mm, m, nm, cm or voxel:SIZE."),
    ] = None,
) -> None:
    """Open files in the window."""
    open_window(files or [], unit)


def open_window(paths: list[Path], unit: str | None) -> None:
    """Run the window until it is closed, and end with its exit code."""
    from regolith_studio.ui.startup import run

    raise typer.Exit(run(paths, unit) or 0)


app = typer.Typer(
    cls=CommandGroup,
    name="regolith-studio",
    help="From X-ray micro-CT to DEM-ready regolith particles whose geometry is right.",
    epilog="Without a command the window opens. Lengths are in micrometres unless a unit is given.",
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


@app.callback(invoke_without_command=True)
def _without_command(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version and stop.")] = False,
) -> None:
    if version:
        from regolith_studio.version import __version__

        typer.echo(__version__)
        raise typer.Exit
    if context.invoked_subcommand is None:
        open_window([], None)


app.command("open")(open_files)
app.command("describe")(particles.describe)
app.command("fit")(particles.fit)
app.command("gallery")(report.gallery)
app.command("generate")(generate.generate)
app.command("card")(generate.card)
app.command("match")(generate.match)
app.command("coarsen")(particles.coarsen)
app.command("extract")(extract.extract)
app.command("run")(recipe.run)
app.command("demo")(recipe.demo)
app.command("report")(report.report)
app.command("uncertainty")(study.uncertainty)
app.command("serve")(serve.serve)
app.command("check")(check.check)
app.command("forget")(check.forget)
app.command("install-desktop")(check.install_desktop)
app.command("warm-up")(check.warm_up)
app.add_typer(classify.app, name="classify")
app.add_typer(study.app, name="study")
app.add_typer(dataset.app, name="dataset")
app.add_typer(repose.app, name="repose")
