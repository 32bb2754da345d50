"""``repose``: the angle of repose of simulated or imported particles (sections 2.6 and 3.3)."""

from pathlib import Path
from typing import Annotated, Any

import typer

from regolith_studio.cli import repose_runs
from regolith_studio.cli.options import Jobs, Json, Seed, Settings, as_bad_use, usable
from regolith_studio.cli.repose_options import evaluation_settings
from regolith_studio.cli.whole_help import WholeHelp

app = typer.Typer(
    cls=WholeHelp,
    help="The angle of repose: simulate a lifting cylinder, measure a pile.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
app.command("run")(repose_runs.run)
app.command("study")(repose_runs.study)
Figures = Annotated[
    Path | None,
    typer.Option("--output", "-o", help="Folder for the JSON and Fig. 9.", metavar="DIR", callback=usable),
]
PositionUnit = Annotated[
    str, typer.Option("--unit", help="Length unit of files that have none: m mm um cm nm.", metavar="U")
]
Diameter = Annotated[
    float, typer.Option("--diameter", help="Of all particles, where the file has none.", metavar="D")
]


@app.command("engines")
def engines(json: Json = False, jobs: Jobs = 1, seed: Seed = 0) -> None:
    """What each engine represents of the paper's contact model, and whether it is here."""
    del jobs, seed  # taken by every command
    from regolith_studio.cli.terminal import print_json
    from regolith_studio.dem.engines import CAPABILITY_LABELS, engine_rows

    rows = engine_rows()
    if json:
        print_json(rows)
        return
    for row in rows:
        typer.echo(f"{row['label']} ({row['key']}, {row['licence']}): {row['version'] or row['problem']}")
        for key, heading in CAPABILITY_LABELS.items():
            typer.echo(f"  {heading.lower():17}{row[key]}")


@app.command("measure")
def measure(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="Positions: final.npz, CSV, XYZ, LAMMPS dump, VTK.")
    ],
    output: Figures = None,
    set_: Settings = None,
    diameter: Diameter = 0.0,
    unit: PositionUnit = "m",
    json: Json = False,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Measure the angle of repose of a pile: both sections and both models of the paper."""
    from regolith_studio.cli.repose_words import in_words
    from regolith_studio.cli.terminal import complain, print_json
    from regolith_studio.dem.angle_of_repose import measure_repose, measurement_document

    del jobs  # taken by every command
    settings = evaluation_settings([f"seed={seed}", *(set_ or ())])
    points, diameters = positions_in(file, unit, diameter)
    measurement = measure_repose(points, diameters, settings)
    document = {"file": str(file), "length_unit": "m"} | measurement_document(measurement)
    if output is not None:
        from regolith_studio.io.atomic import staged_folder
        from regolith_studio.io.json_text import json_bytes
        from regolith_studio.studies.repose_figures import write_section_figure

        with staged_folder(output) as stage:
            (stage / "repose.json").write_bytes(json_bytes(document))
            write_section_figure(points, diameters, measurement, stage)
    complain(measurement.warnings)
    if json:
        print_json(document)
    else:
        typer.echo(in_words(document))


def positions_in(file: Path, unit: str, diameter: float) -> tuple[Any, Any]:
    """Points (n, 3) and diameters (n,) in metres.

    Raises
    ------
    FileError
        If the file holds no positions, or no diameters and none is given.
    """
    from regolith_studio.cli.terminal import complain
    from regolith_studio.dem.snapshot import read_particle_state
    from regolith_studio.errors import FileError
    from regolith_studio.readers.positions import read_positions
    from regolith_studio.readers.units import unit_factor

    if file.suffix.lower() == ".npz":
        pile = read_particle_state(file)
        return pile.points, pile.diameters
    with as_bad_use():
        metres = unit_factor(unit) * 1e-6
    found = read_positions(file, unit)
    complain(found.notes)
    if diameter > 0.0:
        return found.points, diameter * metres
    if found.diameters is None:
        raise FileError(f"{file.name} holds no diameters; name one for all particles with --diameter.")
    return found.points, found.diameters
