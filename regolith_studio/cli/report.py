"""``report``: the figures and tables of the paper for a sample, as one page and as PDF."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from regolith_studio.cli.dataclass_options import with_dataclass_options
from regolith_studio.cli.inputs import ReadingOptions, exit_code
from regolith_studio.cli.options import Folder, Jobs, Json
from regolith_studio.cli.terminal import print_errors, print_json, run_with_progress
from regolith_studio.session.report.settings import ReportSettings

if TYPE_CHECKING:
    from regolith_studio.readers.particles import LoadedParticles
    from regolith_studio.session.report.write import WrittenReport

Samples = Annotated[
    list[Path],
    typer.Argument(
        metavar="SAMPLE...",
        help="Mesh files, tables of coefficients, folders of them; or one scan, or one recipe.",
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
    """Figs. 2 to 9 and Tables 1 and 2 of the paper for a sample: one HTML file, a PDF, and all tables.

    What cannot be made says so in its place.
    """
    from regolith_studio.session.report.write import PAGE, write_report

    loaded = _load(sample, reading, jobs)
    done: WrittenReport = run_with_progress(
        write_report(loaded.particles, output, settings, jobs), logged=True
    )
    print_errors(done.problems)
    if json:
        print_json({"folder": str(output), "files": list(done.files), "problems": list(done.problems)})
    else:
        typer.echo(f"{len(done.files)} files in {output}; begin with {output / PAGE}")
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
