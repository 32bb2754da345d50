"""``gallery``: one particle at several degrees of its expansion (Fig. 2)."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from regolith_studio.cli.dataclass_options import with_dataclass_options
from regolith_studio.cli.inputs import ReadingOptions, exit_code
from regolith_studio.cli.offscreen_process import draw_in_process
from regolith_studio.cli.options import (
    Degrees,
    Folder,
    Json,
    Meshes,
    usage_errors,
    whole_numbers,
)
from regolith_studio.cli.terminal import print_errors, print_json, run_with_progress
from regolith_studio.harmonics.fit_options import FitOptions

if TYPE_CHECKING:
    from regolith_studio.geometry.mesh import Mesh
    from regolith_studio.harmonics.fit import HarmonicFit

Animation = Annotated[
    bool,
    typer.Option(
        "--animation/--no-animation", help="Write also an animated GIF of l_max from 0 to the highest degree."
    ),
]


@with_dataclass_options
def gallery(
    *,
    meshes: Meshes,
    output: Folder,
    degrees: Degrees = "0,1,2,5,10,20,30",
    animation: Animation = True,
    radii: FitOptions,
    reading: ReadingOptions,
    json: Json = False,
) -> None:
    """Draw each particle and its fits at several values of l_max (Fig. 2)."""
    from regolith_studio.harmonics.fit import HarmonicFit
    from regolith_studio.io.atomic import staged_folder
    from regolith_studio.io.file_names import file_stem
    from regolith_studio.jobs.particle_jobs import FIT_DEGREE, FitRequest, fit_sample

    wanted = whole_numbers(degrees, 0, FIT_DEGREE)
    with usage_errors():
        request = FitRequest(max(wanted), radii)
    loaded = reading.read(meshes)
    fits = run_with_progress(fit_sample(loaded.particles, request))
    drawn: list[str] = []
    failed = 0
    with staged_folder(output, "gallery") as stage:
        for particle, fit in zip(loaded.particles, fits, strict=True):
            if not isinstance(fit, HarmonicFit):
                print_errors([f"{particle.name}: {fit}"])
                failed += 1
                continue
            stem = file_stem(particle.name)
            names = [f"{stem}_degrees.png"]
            draw_in_process(_draw_picture, (particle.mesh, fit, wanted), stage / names[0])
            if animation:
                names.append(f"{stem}_degrees.gif")
                draw_in_process(
                    _draw_animation, (particle.mesh, fit, range(request.l_max + 1)), stage / names[1]
                )
            drawn += names
    if json:
        print_json({"folder": str(output), "files": drawn})
    else:
        typer.echo(f"{len(drawn)} files in {output}")
    raise typer.Exit(exit_code(loaded, failed))


def _draw_picture(particle: "Mesh", fit: "HarmonicFit", degrees: tuple[int, ...], path: Path) -> None:
    from regolith_studio.scene.degrees import degree_picture

    degree_picture(particle, fit, degrees, path)


def _draw_animation(particle: "Mesh", fit: "HarmonicFit", degrees: range, path: Path) -> None:
    from regolith_studio.scene.degrees import degree_animation

    degree_animation(particle, fit, degrees, path)
