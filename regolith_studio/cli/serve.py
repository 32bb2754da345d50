"""``serve``: the three views in a browser."""

import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from regolith_studio.cli.options import (
    FACETS,
    Facets,
    Json,
    LMax,
    ReadingOptions,
    mesh_path,
    option_of,
    usage_errors,
    with_dataclass_options,
)
from regolith_studio.cli.terminal import print_result
from regolith_studio.coarsening.settings import DEFAULT_METHOD, CoarseningSettings

if TYPE_CHECKING:
    from regolith_studio.geometry.particle import Particle

Shown = Annotated[
    list[Path] | None,
    typer.Argument(
        metavar="MESH...",
        help="Mesh files, or folders that hold some; else the shipped sample.",
        parser=mesh_path,
    ),
]
Host = Annotated[
    str, typer.Option("--host", help="Address to listen to; 0.0.0.0 for all of this machine.", metavar="IP")
]
Port = Annotated[
    int, typer.Option("--port", min=0, max=65535, help="Port to listen to; 0 for a free one.", metavar="N")
]
OpenBrowser = Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page in a browser.")]

Method = Annotated[str, option_of(CoarseningSettings, "method")]


@with_dataclass_options
def serve(
    *,
    meshes: Shown = None,
    host: Host = "127.0.0.1",
    port: Port = 0,
    browser: OpenBrowser = True,
    l_max: LMax = 10,
    facets: Facets = FACETS,
    method: Method = DEFAULT_METHOD,
    reading: ReadingOptions,
    json: Json = False,
) -> None:
    """Show particle, fit and polyhedron in a browser, until Ctrl+C.

    The address that is printed holds a token, without which nothing is served. The page is for this machine
    only unless --host says otherwise; then the connection is not encrypted.
    """
    import asyncio

    from regolith_studio.session.choices import Choices
    from regolith_studio.web.server import ViewServer

    with usage_errors():
        choices = Choices(target="fit").replaced(l_max=l_max, n_facets=facets, method=method)
    server = ViewServer(_particles(meshes, reading), choices, host, port)

    def report() -> None:
        print_result({"url": server.url}, f"The three views are at {server.url} until Ctrl+C.", json)
        if browser:
            webbrowser.open(server.url)

    asyncio.run(server.run(report))


def _particles(meshes: list[Path] | None, reading: ReadingOptions) -> "tuple[Particle, ...]":
    if meshes:
        return reading.read(meshes).particles
    from regolith_studio.readers.particles import sample_particles

    return tuple(sample_particles())
