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
    from regolith_studio.session.report.write import WrittenReport

Samples = Annotated[
    list[Path],
    typer.Argument(metavar="SAMPLE...", help="Mesh files, tables of coefficients, or folders of them."),
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

    loaded = reading.read(sample)
    done: WrittenReport = run_with_progress(
        write_report(loaded.particles, output, settings, jobs), logged=True
    )
    print_errors(done.problems)
    if json:
        print_json({"folder": str(output), "files": list(done.files), "problems": list(done.problems)})
    else:
        typer.echo(f"{len(done.files)} files in {output}; begin with {output / PAGE}")
    raise typer.Exit(exit_code(sample, loaded, len(done.problems)))
