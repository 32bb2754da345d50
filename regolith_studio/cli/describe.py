"""``describe``: descriptors and health of meshes."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from regolith_studio.cli.dataclass_options import with_dataclass_options
from regolith_studio.cli.inputs import ReadingOptions, exit_code
from regolith_studio.cli.options import Jobs, Json, Meshes, claim_file, output_path
from regolith_studio.cli.terminal import print_errors, print_json, print_table, run_with_progress
from regolith_studio.harmonics.fit_options import MAX_TABLE_DEGREE

if TYPE_CHECKING:
    from regolith_studio.io.tables import Table
    from regolith_studio.session.results import ParticleEntry

Statistics = Annotated[
    bool,
    typer.Option("--statistics", help="Print also the mean, standard deviation and quantiles of each group."),
]
Weighting = Annotated[
    str,
    typer.Option("--weighting", help="Weighting of the statistics: number or volume.", metavar="HOW"),
]
BorderWeights = Annotated[
    bool,
    typer.Option(
        "--border-weights/--no-border-weights",
        help="Correct the statistics for large grains that the border of a scan has cut off.",
    ),
]
TableDegree = Annotated[
    int | None,
    typer.Option(
        "--l-max",
        min=1,
        max=MAX_TABLE_DEGREE,
        help="Leave out the coefficients of tables above this degree.",
        metavar="L",
        show_default="all that the table has",
    ),
]
Csv = Annotated[
    Path | None,
    typer.Option(
        "--csv",
        help="CSV file for all descriptors with their units.",
        metavar="FILE",
        parser=output_path,
        callback=claim_file,
    ),
]


@with_dataclass_options
def describe(
    *,
    meshes: Meshes,
    statistics: Statistics = False,
    weighting: Weighting = "number",
    border_weights: BorderWeights = True,
    csv: Csv = None,
    l_max: TableDegree = None,
    reading: ReadingOptions,
    json: Json = False,
    jobs: Jobs = 1,
) -> None:
    """Measure particles: volume, area, sphericity, diameters ..., and the health of their meshes."""
    if weighting not in ("number", "volume"):
        raise typer.BadParameter(f"Particles weigh by number or by volume, not by {weighting!r}.")
    from regolith_studio.readers.sandbox.parent import shared_sandbox

    shared_sandbox().start_in_background()  # while this process still imports
    from regolith_studio.jobs.particle_jobs import measure_sample
    from regolith_studio.session.outputs.descriptors import described, short_table
    from regolith_studio.session.results import ParticleEntry

    loaded = reading.read(meshes, l_max)
    if l_max is not None and all(
        each.source is None or each.source.l_max is None for each in loaded.particles
    ):
        raise typer.BadParameter("--l-max is for tables of coefficients, and none of these files is one.")
    facts = run_with_progress(measure_sample(loaded.particles, workers=jobs))
    pairs = list(zip(loaded.particles, facts, strict=True))
    entries = [
        ParticleEntry(p.name, p, each.health, each.descriptors, visibility=each.visibility)
        for p, each in pairs
    ]
    if csv is not None:
        _write_csv(csv, entries)
    table = _statistics(entries, weighting, border_weights) if statistics else None
    if json:
        rows = [described(particle, each) for particle, each in pairs]
        print_json(rows if table is None else {"particles": rows, "statistics": _as_rows(table)})
    else:
        print_table(short_table(loaded.particles, facts))
        if table is not None:
            typer.echo()
            print_table(table)
        for particle, each in pairs:
            print_errors(f"{particle.name}: {note}" for note in (*particle.notes, each.problem) if note)
    raise typer.Exit(exit_code(loaded, sum(bool(each.problem) for each in facts)))


def _statistics(entries: "list[ParticleEntry]", weighting: str, border_weights: bool) -> "Table":
    from regolith_studio.descriptors.catalogue import LOSS_KEYS
    from regolith_studio.session.sample_table import statistics_of_keys

    keys = ["equivalent_radius", "surface_area", *LOSS_KEYS]
    return statistics_of_keys(entries, keys, weighting, border_weights)


def _as_rows(table: "Table") -> list[dict[str, Any]]:
    names = [column.name for column in table.columns]
    return [dict(zip(names, row, strict=True)) for row in table.rows]


def _write_csv(path: Path, entries: "list[ParticleEntry]") -> None:
    from regolith_studio.io.atomic import write_bytes
    from regolith_studio.io.tables import csv_text
    from regolith_studio.session.sample_table import sample_table

    write_bytes(path, csv_text(sample_table(entries)).encode("utf-8"))
