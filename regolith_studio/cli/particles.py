"""``describe``, ``fit``, ``coarsen``: descriptors, spherical harmonics and polyhedra of meshes."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from regolith_studio.cli.batch_options import BatchOptions, check_fits_memory
from regolith_studio.cli.options import (
    CoarseningOptions,
    Folder,
    Jobs,
    Json,
    Level,
    LMax,
    Meshes,
    OptionalFolder,
    Preset,
    ReadingOptions,
    Seed,
    StoppingOptions,
    claim_file,
    claim_folder,
    claim_json,
    exit_code,
    output_option,
    usage_errors,
    with_dataclass_options,
)
from regolith_studio.cli.terminal import (
    print_errors,
    print_json,
    print_result,
    print_table,
    run_with_progress,
)
from regolith_studio.harmonics.fit_options import MAX_TABLE_DEGREE, FitOptions

if TYPE_CHECKING:
    from regolith_studio.geometry.particle import Particle
    from regolith_studio.harmonics.fit import HarmonicFit
    from regolith_studio.io.tables import Table
    from regolith_studio.jobs.particle_jobs import FitRequest
    from regolith_studio.session.results import ParticleEntry


Statistics = Annotated[
    bool,
    typer.Option("--statistics", help="Print also the mean, standard deviation and quantiles of each group."),
]
Weighting = Annotated[
    str,
    typer.Option("--weighting", help="Weighting of the statistics: number or volume.", metavar="HOW"),
]
Chords = Annotated[
    bool,
    typer.Option(
        "--chords",
        help="Measure also width and thickness by chords, and Zingg's ratios of length, width and thickness.",
    ),
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
    Path | None, output_option("CSV file for all descriptors with their units.", "FILE", claim_file, "--csv")
]


@with_dataclass_options
def describe(
    *,
    meshes: Meshes,
    statistics: Statistics = False,
    weighting: Weighting = "number",
    border_weights: BorderWeights = True,
    chords: Chords = False,
    csv: Csv = None,
    output: OptionalFolder = None,
    l_max: TableDegree = None,
    reading: ReadingOptions,
    batch: BatchOptions,
    json: Json = False,
    jobs: Jobs = 1,
) -> None:
    """Measure particles: volume, area, sphericity, diameters ..., and the health of their meshes.

    With --output, which large archives need, meshes are read and measured one by one; the folder gets
    descriptors.csv, and failed.csv where something failed.
    """
    if weighting not in ("number", "volume"):
        raise typer.BadParameter(f"Particles weigh by number or by volume, not by {weighting!r}.")
    from regolith_studio.readers.sandbox.parent import shared_sandbox

    shared_sandbox().start_in_background()  # while this process still imports
    if output is not None:
        from regolith_studio.session.choices import Choices
        from regolith_studio.session.recipe import Outputs

        if statistics or csv is not None or l_max is not None:
            raise typer.BadParameter("--output goes without --statistics, --csv and --l-max.")
        outputs = Outputs(chords=chords, meshes=False, dataset=False, summary=False)
        batch.run(meshes, output, outputs, Choices(), reading, jobs, json)
    elif batch.resume or batch.runner != "processes":
        raise typer.BadParameter("--resume and --runner need a folder for the results: --output DIR.")
    check_fits_memory(meshes)
    from regolith_studio.descriptors.catalogue import CHORD_KEYS, DEFAULT_KEYS
    from regolith_studio.jobs.particle_jobs import measure_sample
    from regolith_studio.session.outputs.measurements import described, short_table
    from regolith_studio.session.results import ParticleEntry

    loaded = reading.read(meshes, l_max)
    if l_max is not None and all(
        each.source is None or each.source.l_max is None for each in loaded.particles
    ):
        raise typer.BadParameter("--l-max is for tables of coefficients, and none of these files is one.")
    keys = (*DEFAULT_KEYS, *CHORD_KEYS) if chords else DEFAULT_KEYS
    facts = run_with_progress(measure_sample(loaded.particles, jobs, keys))
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
        print_json(rows if table is None else {"particles": rows, "statistics": table.records})
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


def _write_csv(path: Path, entries: "list[ParticleEntry]") -> None:
    from regolith_studio.io.atomic import write_bytes
    from regolith_studio.io.tables import csv_text
    from regolith_studio.session.sample_table import sample_table

    write_bytes(path, csv_text(sample_table(entries)).encode("utf-8"))


_MOST_LINES = 5
"""Fits that are far off that are named one by one."""
FitFile = Annotated[Path, output_option("JSON file of the fits to write.", "FIT.json", claim_json)]
Surfaces = Annotated[
    Path | None,
    output_option("Folder for the surface of each fit as STL.", "DIR", claim_folder, "--surfaces"),
]


@with_dataclass_options
def fit(
    *,
    meshes: Meshes,
    output: FitFile,
    l_max: LMax = 30,
    radii: FitOptions,
    surfaces: Surfaces = None,
    level: Level = 4,
    reading: ReadingOptions,
    json: Json = False,
    jobs: Jobs = 1,
) -> None:
    """Fit spherical harmonics to meshes; write coefficients and spectrum."""
    from regolith_studio.jobs.particle_jobs import FitRequest, fit_sample
    from regolith_studio.session.choices import Choices
    from regolith_studio.session.outputs.measurements import FittedSample, fits_document, write_fits

    with usage_errors():
        Choices(l_max=l_max, level=level)
        request = FitRequest(l_max, radii)
    loaded = reading.read(meshes)
    fitted = run_with_progress(fit_sample(loaded.particles, request, jobs))
    sample = FittedSample.of(loaded.particles, fitted)
    print_errors(f"{name}: {sentence}" for name, sentence in sample.failed)
    holes: dict[str, str] = {}
    if sample.fits:
        holes = write_fits(output, sample, surfaces, level)
        print_errors(f"{name}: {sentence}" for name, sentence in holes.items())
        _print_far_fits(loaded.particles, fitted, request, jobs)
        print_result(fits_document(sample), f"{len(sample.fits)} fits up to l = {l_max} in {output}", json)
    raise typer.Exit(exit_code(loaded, len(sample.failed) + len(holes)))


def _print_far_fits(
    particles: "Sequence[Particle]", fitted: "Sequence[HarmonicFit | str]", request: "FitRequest", jobs: int
) -> None:
    """Print which fits are far off, the first few in full."""
    from regolith_studio.jobs.particle_jobs import check_fits

    fits = [(each, fit) for each, fit in zip(particles, fitted, strict=True) if not isinstance(fit, str)]
    steps = check_fits([each for each, _ in fits], [fit for _, fit in fits], request, jobs)
    said = zip(fits, run_with_progress(steps), strict=True)
    lines = [f"{each.name}: {sentence}" for (each, _), sentence in said if sentence]
    more = len(lines) - _MOST_LINES
    print_errors(lines[:_MOST_LINES] + ([f"{more} more fits are as far off."] if more > 0 else []))


@with_dataclass_options
def coarsen(
    *,
    meshes: Meshes,
    output: Folder,
    stopping: StoppingOptions,
    preset: Preset = "",
    how: CoarseningOptions,
    reading: ReadingOptions,
    json: Json = False,
    batch: BatchOptions,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Coarsen meshes to convex polyhedra that keep the chosen descriptors (section 2.4).

    Meshes of an archive are read and coarsened one by one; the polyhedra are in the folder "meshes".
    """
    from regolith_studio.io.atomic import staged_folder
    from regolith_studio.jobs.coarsening_jobs import coarsen_sample
    from regolith_studio.session.outputs.coarsening import (
        coarsening_document,
        error_table,
        notes_on,
        write_coarsening,
    )
    from regolith_studio.session.recipe import Outputs

    choices = how.choices(preset, seed=seed, **stopping.changes)
    if batch.asked(meshes):
        outputs = Outputs(descriptors=False, dataset=False, summary=False)
        batch.run(meshes, output, outputs, choices, reading, jobs, json)
    request = choices.coarsening_request
    loaded = reading.read(meshes)
    done = run_with_progress(coarsen_sample(loaded.particles, request, jobs))
    with staged_folder(output, "coarsen") as stage:
        write_coarsening(stage, request, done)
    failed = [each for each in done if each.coarsened is None]
    print_errors(f"{each.name}: {note}" for each in loaded.particles for note in each.notes)
    print_errors(f"{each.name}: {each.problem}" for each in failed)
    if json:
        print_json(coarsening_document(request, done))
    else:
        if len(done) > len(failed):
            print_table(error_table(done))
        print_errors(notes_on(done))
        typer.echo(
            f"{len(done) - len(failed)} of {len(done) + len(loaded.problems)} particles coarsened in {output}"
        )
    raise typer.Exit(exit_code(loaded, len(failed)))
