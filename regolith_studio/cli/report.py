"""``gallery``, ``report``: the figures and tables of the paper for particles and for a sample."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from regolith_studio.cli.offscreen_process import draw_in_process
from regolith_studio.cli.options import (
    Degrees,
    Folder,
    Jobs,
    Json,
    Meshes,
    ReadingOptions,
    exit_code,
    mesh_path,
    usage_errors,
    whole_numbers,
    with_dataclass_options,
)
from regolith_studio.cli.terminal import print_errors, print_result, run_with_progress
from regolith_studio.harmonics.fit_options import FitOptions
from regolith_studio.session.report.settings import PAGE, ReportSettings

if TYPE_CHECKING:
    from regolith_studio.readers.particles import LoadedParticles
    from regolith_studio.session.report.write import WrittenReport

ANIMATION = "regolith_studio.scene.animation"
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
    from regolith_studio.harmonics.fit_options import FIT_DEGREE
    from regolith_studio.io.atomic import staged_folder
    from regolith_studio.io.file_names import file_stem
    from regolith_studio.jobs.particle_jobs import FitRequest, fit_sample

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
            draw_in_process(f"{ANIMATION}:degree_picture", (particle.mesh, fit, wanted), stage / names[0])
            if animation:
                names.append(f"{stem}_degrees.gif")
                draw_in_process(
                    f"{ANIMATION}:degree_animation",
                    (particle.mesh, fit, range(request.l_max + 1)),
                    stage / names[1],
                )
            drawn += names
    print_result({"folder": str(output), "files": drawn}, f"{len(drawn)} files in {output}", json)
    raise typer.Exit(exit_code(loaded, failed))


Samples = Annotated[
    list[Path],
    typer.Argument(
        metavar="SAMPLE...",
        help="Mesh files, tables of coefficients, folders of them; or one scan, or one recipe.",
        parser=mesh_path,
    ),
]


@with_dataclass_options
def report(
    *,
    sample: Samples,
    output: Folder,
    settings: ReportSettings,
    reading: ReadingOptions,
    json: Json = False,
    jobs: Jobs = 1,
) -> None:
    """Figs. 2 to 9 and Tables 1 and 2 of the paper for a sample: one HTML file and all tables.

    What cannot be made says so in its place.
    """
    from regolith_studio.session.report.write import write_report

    loaded = _load(sample, reading, jobs)
    done: WrittenReport = run_with_progress(
        write_report(loaded.particles, output, settings, jobs), logged=True
    )
    print_errors(done.problems)
    print_result(
        {"folder": str(output), "files": list(done.files), "problems": list(done.problems)},
        f"{len(done.files)} files in {output}; begin with {output / PAGE}",
        json,
    )
    raise typer.Exit(exit_code(loaded, len(done.problems)))


def _load(sample: list[Path], reading: ReadingOptions, jobs: int) -> "LoadedParticles":
    """The particles of meshes, of a scan as ``extract`` finds them by default, or of a recipe."""
    from regolith_studio.errors import InputError
    from regolith_studio.session.batch.inputs import load_recipe_particles
    from regolith_studio.session.file_kinds import FileKind, kind_of_all
    from regolith_studio.session.recipe import VolumeEntry, read_recipe, recipe_of

    match kind := kind_of_all(sample):
        case FileKind.PARTICLES:
            return reading.read(sample)
        case FileKind.VOLUME:
            recipe, base = recipe_of(volumes=[VolumeEntry(file=str(sample[0]))]), Path()
        case FileKind.RECIPE:
            recipe, base = read_recipe(sample[0]), sample[0].parent
        case _:
            raise InputError(f"{sample[0].name} ({kind}) holds no particles to report on.")
    loaded: LoadedParticles = run_with_progress(load_recipe_particles(recipe, base, jobs))
    print_errors(problem.with_path for problem in loaded.problems)
    return loaded
