"""``match``: which simulant, or which mixture of sieved fractions, is nearest to a soil."""

from typing import Annotated

import typer

from regolith_studio.cli.options import Jobs, Json, OptionalFolder, Seed, usage_errors
from regolith_studio.cli.terminal import print_errors, print_json, print_table, run_with_progress

KINDS = "Meshes (folder or ZIP archive), a table of descriptors or of length, width and thickness, or a card"


def match(
    target: Annotated[str, typer.Argument(metavar="TARGET", help=f"{KINDS}.")],
    candidates: Annotated[
        list[str],
        typer.Argument(metavar="CANDIDATE...", help=f"{KINDS}; each group of meshes is one fraction."),
    ],
    output: OptionalFolder = None,
    mass: Annotated[
        float, typer.Option("--mass", min=1e-9, max=1e12, help="Grams of the mixture.", metavar="G")
    ] = 100.0,
    weighting: Annotated[
        str, typer.Option("--weighting", help="How particles count: number or volume.", metavar="HOW")
    ] = "number",
    most: Annotated[
        int,
        typer.Option(
            "--most", min=20, max=100_000, help="Meshes of a group that are measured, at random.", metavar="N"
        ),
    ] = 1000,
    unit: Annotated[
        str,
        typer.Option("--unit", help="Length unit of files without one: um, mm, m, nm or cm.", metavar="U"),
    ] = "um",
    json: Json = False,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Say how near simulants are to a soil, and which mixture of them is nearest, in grams."""
    from regolith_studio.jobs.events import result_of
    from regolith_studio.jobs.matching_jobs import MatchRequest, match_materials
    from regolith_studio.readers.settings import unit_factor

    with usage_errors():
        unit_factor(unit)
        if weighting not in ("number", "volume"):
            raise typer.BadParameter(f"Particles count by number or by volume, not by {weighting!r}.")
    request = MatchRequest(unit, most, weighting, seed)
    found = run_with_progress(match_materials(target, candidates, request, jobs))
    table = found.match.table(mass)
    if output is not None:
        result_of(found.written(output, mass))
    print_errors(problem.with_path for problem in found.problems)
    if json:
        names = [column.name for column in table.columns]
        print_json(
            {"target": target, "materials": [dict(zip(names, row, strict=True)) for row in table.rows]}
        )
    else:
        print_table(table)
        typer.echo(f"Nearest by itself: {found.match.nearest.name}. {table.notes[0]}")
    raise typer.Exit(1 if found.problems else 0)
