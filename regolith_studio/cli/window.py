"""``open``: the window."""

from pathlib import Path
from typing import Annotated

import typer


def open_files(
    files: Annotated[list[Path], typer.Argument(metavar="FILE...", help="Meshes, folders or a recipe.")],
    unit: Annotated[
        str | None,
        typer.Option("--unit", help="Length unit of files without one: um, mm, m, nm, cm or voxel:SIZE."),
    ] = None,
) -> None:
    """Open files in the window."""
    open_window(files, unit)


def open_window(paths: list[Path], unit: str | None) -> None:
    """Run the window until it is closed, and end with its exit code."""
    from regolith_studio.ui.startup import run

    raise typer.Exit(run(paths, unit) or 0)
