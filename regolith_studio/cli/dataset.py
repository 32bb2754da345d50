"""``dataset``: build, validate, list, sample, export, formats."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from regolith_studio.cli.batch_options import BatchOptions, check_fits_memory
from regolith_studio.cli.options import (
    CoarseningOptions,
    Folder,
    Jobs,
    Json,
    Meshes,
    Preset,
    ReadingOptions,
    Seed,
    StoppingOptions,
    claim_file,
    exit_code,
    output_option,
    usage_errors,
    values,
    with_dataclass_options,
    words,
)
from regolith_studio.cli.terminal import (
    command_group,
    print_errors,
    print_json,
    print_result,
    run_with_progress,
)
from regolith_studio.dataset.parameters import DatasetSettings, ExportSettings, RepresentativesSettings
from regolith_studio.settings import setting_of, settings_in

DRAW_BYTES, ROW_BYTES = 150, 1500
"""Memory that a drawn particle takes as numbers, and as an entry of JSON."""

DatasetFolder = Annotated[Path, typer.Argument(metavar="FOLDER", help="A dataset folder.")]


@dataclass(frozen=True)
class DatasetSelection(DatasetSettings):
    """Which particles are taken: all of them where nothing is said."""

    count: int = setting_of(DatasetSettings, "count", default=0)


app = command_group("Datasets for DEM programs (section 2.5).")


@app.command("build")
@with_dataclass_options
def build(
    *,
    meshes: Meshes,
    output: Folder,
    stopping: StoppingOptions,
    preset: Preset = "",
    how: CoarseningOptions,
    selection: DatasetSelection,
    quality_curve: Annotated[
        Path | None,
        typer.Option(
            "--quality-curve",
            help="CSV file for the error over the number of representatives.",
            metavar="FILE",
        ),
    ] = None,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Replace an existing dataset in the folder.")
    ] = False,
    by_group: Annotated[
        bool,
        typer.Option(
            "--by-group",
            help="Write one dataset for each group, such as a size fraction, of the meshes of an archive or "
            "folder, and a manifest with their hashes.",
        ),
    ] = False,
    reading: ReadingOptions,
    batch: BatchOptions,
    json: Json = False,
    jobs: Jobs = 1,
    seed: Seed = 0,
) -> None:
    """Coarsen the meshes, or N representatives of them, and write a dataset folder."""
    from regolith_studio.dataset.representatives import quality_table
    from regolith_studio.dataset.size_distributions import parse_sizes
    from regolith_studio.io.atomic import write_bytes
    from regolith_studio.io.tables import csv_text
    from regolith_studio.jobs.dataset_jobs import (
        DatasetOptions,
        RepresentativesRequest,
        build_dataset_folder,
        check_place,
        measure_population,
        measure_quality,
    )
    from regolith_studio.session.outputs.coarsening import coarsening_document, notes_on

    choices = how.choices(preset, seed=seed, **stopping.changes)
    with usage_errors():
        parse_sizes(selection.sizes)
    asked = settings_in(RepresentativesSettings, selection)
    chosen = RepresentativesRequest(**asked | {"count": selection.count or 10}, seed=seed)
    if by_group:
        from regolith_studio.session.recipe import Outputs

        if selection != DatasetSelection() or quality_curve is not None or overwrite:
            raise typer.BadParameter(
                "--by-group keeps every particle, so that it goes without --representatives, --sizes, "
                "--quality-curve, --name and --overwrite."
            )
        outputs = Outputs(descriptors=False, meshes=False, dataset_by_group=True, summary=False)
        batch.run(meshes, output, outputs, choices, reading, jobs, json)
    check_place(output, overwrite)
    check_fits_memory(meshes)
    loaded = reading.read(meshes)
    if quality_curve is not None:
        population = run_with_progress(measure_population(loaded.particles, jobs))
        curve = run_with_progress(measure_quality(population, chosen))
        write_bytes(quality_curve, csv_text(quality_table(curve)).encode("utf-8"))
    known = None if choices.preset_modified else choices.preset
    wanted = chosen if selection.count else None
    options = DatasetOptions(selection.name, known, overwrite, jobs, wanted, selection.sizes)
    built = run_with_progress(
        build_dataset_folder(loaded.particles, choices.coarsening_request, output, options)
    )
    failed = [each for each in built.outcomes if each.coarsened is None]
    print_errors(f"{each.name}: {note}" for each in loaded.particles for note in each.notes)
    print_errors(f"{each.name}: {each.problem}" for each in failed)
    if json:
        print_json({"folder": str(output)} | coarsening_document(choices.coarsening_request, built.outcomes))
    else:
        print_errors(notes_on(built.outcomes))
        count = len(loaded.particles) + len(loaded.problems)
        typer.echo(f"{len(built.dataset)} of {count} particles in the dataset {output}")
    raise typer.Exit(exit_code(loaded, len(failed)))


@app.command("validate")
def validate(
    folder: DatasetFolder,
    json: Json = False,
) -> None:
    """Validate a dataset folder and print its problems, one per line."""
    from regolith_studio.dataset.validation import validate_dataset

    problems = [str(problem) for problem in validate_dataset(folder)]
    print_result(
        {"folder": str(folder), "valid": not problems, "problems": problems},
        "\n".join(problems) or f"{folder} is a sound dataset.",
        json,
    )
    raise typer.Exit(1 if problems else 0)


@app.command("sample")
def sample(
    folder: DatasetFolder,
    count: Annotated[
        int,
        typer.Option(
            "--number", "-n", min=0, max=10_000_000, help="Number of particles to draw.", metavar="N"
        ),
    ],
    output: Annotated[
        Path | None, output_option("CSV file; printed to the terminal if omitted.", "FILE", claim_file)
    ] = None,
    json: Json = False,
    seed: Seed = 0,
) -> None:
    """Draw particles of a dataset: class, equivalent diameter and orientation."""
    from regolith_studio.dataset.folder_io import read_dataset
    from regolith_studio.dataset.sampling import drawn_csv, drawn_rows, sample_dataset
    from regolith_studio.io.atomic import staged_file
    from regolith_studio.io.machine_memory import check_memory

    check_memory(count * (ROW_BYTES if json else DRAW_BYTES), f"{count:,} drawn particles")
    dataset = read_dataset(folder)
    drawn = sample_dataset(dataset, count, seed)
    if output is not None:
        with staged_file(output) as stream:
            stream.writelines(drawn_csv(dataset, drawn))
    if json:
        print_json(drawn_rows(dataset, drawn))
    elif output is None:
        for block in drawn_csv(dataset, drawn):
            typer.echo(block.decode("utf-8"), nl=False)
    else:
        typer.echo(f"{count} particles in {output}")


@app.command("formats")
def formats(json: Json = False) -> None:
    """List the export formats, with what each keeps and loses."""
    from regolith_studio.dataset.exporters import EXPORTERS

    if json:
        names = ("key", "label", "units", "carries", "loses", "alters", "convex_only", "load_command")
        print_json([{name: getattr(each, name) for name in names} for each in EXPORTERS.values()])
        return
    for each in EXPORTERS.values():
        changed = f"\n  shapes are changed: {each.alters} Needs --lossy." if each.alters else ""
        typer.echo(
            f"{each.key}: {each.label}\n  units: {each.units}\n  carries: {'; '.join(each.carries)}"
            f"\n  loses: {'; '.join(each.loses)}{changed}"
            f"\n  compounds: {f'refused. {each.convex_only}' if each.convex_only else 'yes'}"
        )


@app.command("export")
@with_dataclass_options
def export(
    *,
    folder: DatasetFolder,
    output: Folder,
    to: Annotated[
        str,
        typer.Option(
            "--to", help="Formats, such as rocky,yade, or all; listed by `dataset formats`.", metavar="LIST"
        ),
    ],
    exports: ExportSettings,
    set_: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            help="A parameter of contact, cylinder or format, such as density; may be repeated.",
            metavar="KEY=VALUE",
        ),
    ] = None,
    lossy: Annotated[bool, typer.Option("--lossy", help="Allow formats that alter the shapes.")] = False,
    json: Json = False,
    seed: Seed = 0,
) -> None:
    """Export a dataset for DEM programs, one folder per format, and report what a format loses."""
    from regolith_studio.dataset.export import ExportOptions
    from regolith_studio.jobs.dataset_jobs import chosen_exporters, export_dataset_folder

    with usage_errors():
        keys = words(to)
        chosen = chosen_exporters(keys)
        changes: dict[str, object] = dict(values(set_, "setting"))
        settings = ExportOptions(**settings_in(ExportSettings, exports), seed=seed).replaced(**changes)
    done = run_with_progress(export_dataset_folder(folder, keys, output, settings, lossy))
    written = {one.key for one in done}
    for each in chosen:
        if each.key in written:
            print_errors(f"{each.label} does not carry: {lost}." for lost in each.loses)
        else:
            print_errors([f"{each.label} is left out, since it cannot hold compounds: {each.convex_only}"])
    if json:
        print_json(
            [
                {"key": one.key, "folder": str(one.folder), "files": one.files, "load": one.load_command}
                for one in done
            ]
        )
    else:
        for one in done:
            typer.echo(f"{one.key}: {one.folder}\n  {one.load_command}")
