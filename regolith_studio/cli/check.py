"""``check``: versions, OpenGL, display, engines, and what is missing."""

import typer

from regolith_studio.cli.options import Json


def check(json: Json = False) -> None:
    """Print versions, the OpenGL renderer, the display, the DEM engines found and what is missing."""
    from regolith_studio.cli.machine import examine_machine
    from regolith_studio.cli.terminal import print_json

    report = examine_machine()
    if json:
        print_json(report)
        return
    for title, content in report.items():
        typer.echo(title)
        lines = content.items() if isinstance(content, dict) else [("", each) for each in content]
        for key, value in lines:
            typer.echo(f"  {key:<24}{value}" if key else f"  {value}")
        if not content:
            typer.echo("  nothing")
