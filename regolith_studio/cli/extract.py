"""``extract``: particle meshes from volumes of grey values or labels."""

import csv
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer

from regolith_studio.cli.batch_options import Address, Runner, Tls, chosen_executor
from regolith_studio.cli.options import (
    Jobs,
    Json,
    OptionalFolder,
    claim_labels,
    usage_errors,
    with_dataclass_options,
)
from regolith_studio.cli.terminal import print_errors, print_result, print_table, run_with_progress
from regolith_studio.cli.volume_options import MAX_H, GrainOptions, VolumeOptions
from regolith_studio.errors import FileError, InputError
from regolith_studio.readers.error_messages import printable

if TYPE_CHECKING:
    from regolith_studio.jobs.executor import Executor
    from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput


_LARGEST = 16 * 2**20
_SCAN, _RECIPE = "scan", "recipe"
_TRUE, _FALSE = ("yes", "true", "1"), ("no", "false", "0")
_Options = TypeVar("_Options", VolumeOptions, GrainOptions)


@dataclass(frozen=True)
class ScanRow:
    """The options of one scan that its row names, by their names in Python, parsed; and its place."""

    table: str
    line: int
    scan: str
    options: dict[str, Any]

    @property
    def recipe(self) -> Path | None:
        """File that holds all settings of the grains."""
        path: Path | None = self.options.get(_RECIPE)
        return path

    @contextmanager
    def errors_named(self) -> Iterator[None]:
        """Name the table and the line where an option has a wrong value."""
        try:
            yield
        except (InputError, typer.BadParameter) as error:
            words = error.format_message() if isinstance(error, typer.BadParameter) else str(error)
            raise FileError(f"{self.table}, line {self.line}: {words}") from None

    def applied_to(self, options: _Options) -> _Options:
        """The options of all scans with those of this one in their place."""
        changed: _Options = _replaced(options, self.options)
        return changed


def read_scan_table(path: Path) -> tuple[ScanRow, ...]:
    """The rows of a CSV file whose columns are ``scan`` and options of ``extract``, such as ``h-maxima``.

    An empty cell leaves the option as it is for all scans. Files are looked up beside the table.
    """
    from regolith_studio.readers.sandbox.parent import read_bytes

    try:
        lines = read_bytes(path, _LARGEST).decode("utf-8-sig").splitlines()
        rows = csv.DictReader(lines, skipinitialspace=True, strict=True)
        names = [name.strip().lower().replace("-", "_") for name in rows.fieldnames or ()]
        _check_columns(path, names)
        rows.fieldnames = names
        return tuple(_row(path, rows.line_num, row) for row in rows)
    except UnicodeDecodeError:
        raise FileError(f"{path.name} is no table of settings: it is not text in UTF-8.") from None
    except csv.Error as error:
        raise FileError(f"{path.name} is no table of settings: {error}.") from None


def rows_of_scans(
    path: Path, rows: Sequence[ScanRow], scans: Sequence[Path], groups: Sequence[str]
) -> dict[Path, ScanRow]:
    """The row of each scan that has one, by the scan's path.

    A row names its scan by the file, the file without its suffix, the group, or the path from the table on.
    """
    by_scan: dict[Path, ScanRow] = {}
    for row in rows:
        meant = [
            scan
            for scan, group in zip(scans, groups, strict=True)
            if row.scan in (scan.name, scan.stem, group)
            or (path.parent / row.scan).absolute() == scan.absolute()
        ]
        where = f"{path.name}, line {row.line}"
        if len(meant) != 1:
            count = "none" if not meant else f"{len(meant)}"
            raise FileError(
                f"{where}: “{printable(row.scan)}” names {count} of the scans; write its path "
                "from the table on."
            )
        if meant[0] in by_scan:
            raise FileError(f"{where}: {meant[0].name} has a row already, line {by_scan[meant[0]].line}.")
        by_scan[meant[0]] = row
    return by_scan


def _check_columns(path: Path, names: list[str]) -> None:
    known = {_SCAN, *_parameters()}
    unknown = [name for name in names if name not in known]
    if _SCAN not in names or unknown:
        problem = (
            "it has no column “scan”" if _SCAN not in names else f"“{printable(unknown[0])}” is no option"
        )
        raise FileError(
            f"{path.name} is no table of settings: {problem}; its first line is “scan” and options of "
            "extract for volumes and grains, such as voxel-size and h-maxima, separated by commas."
        )
    twice = [name for name in names if names.count(name) > 1]
    if twice:
        raise FileError(f"{path.name} has two columns “{twice[0]}”.")


def _row(path: Path, line: int, cells: dict[str, Any]) -> ScanRow:
    if None in cells:
        raise FileError(f"{path.name}, line {line} has more cells than there are columns.")
    texts = {name: (text or "").strip() for name, text in cells.items()}
    scan = texts.pop(_SCAN)
    if not scan:
        raise FileError(f"{path.name}, line {line} names no scan.")
    with ScanRow(path.name, line, scan, {}).errors_named():
        options = {name: _parsed(name, text, path.parent) for name, text in texts.items() if text}
    grains = {_RECIPE, *(name for name in options if name in _names(GrainOptions))}
    if _RECIPE in options and len(grains & set(options)) > 1:
        raise FileError(f"{path.name}, line {line} has a recipe, which holds all settings of the grains.")
    return ScanRow(path.name, line, scan, options)


def _parsed(name: str, text: str, folder: Path) -> Any:
    """The value of a cell, as the option on the command line has it."""
    parameter = _parameters()[name]
    if parameter.is_flag:
        if text.lower() not in (*_TRUE, *_FALSE):
            raise typer.BadParameter(f"“{name}” is yes or no, got {text!r}.")
        return text.lower() in _TRUE
    with _command().make_context("", [parameter.opts[0], text]) as context:
        value = context.params[name]
    return folder / value if isinstance(value, Path) else value


@cache
def _command() -> Any:
    """A command with the options of a row, of which only their types are used."""

    @with_dataclass_options
    def row(
        *,
        contents: VolumeOptions,
        grains: GrainOptions,
        recipe: Path | None = None,
    ) -> None:
        pass

    app = typer.Typer(add_completion=False)
    app.command()(row)
    return typer.main.get_command(app)


def _parameters() -> dict[str, Any]:
    return {each.name: each for each in _command().params if each.name != "help"}


def _names(kind: Any) -> set[str]:
    """Names of the options in a group and in the groups within it."""
    with_groups = [(each.name, each.type) for each in fields(kind)]
    return {name for name, _ in with_groups} | {
        name for _, inner in with_groups if is_dataclass(inner) for name in _names(inner)
    }


def _replaced(group: Any, values: dict[str, Any]) -> Any:
    """The group with the values of its fields, also of those in groups within it."""
    changes = {
        each.name: _replaced(inner, values)
        if is_dataclass(inner := getattr(group, each.name))
        else values[each.name]
        for each in fields(group)
        if each.name in values or is_dataclass(getattr(group, each.name))
    }
    return replace(group, **changes)


def _heights(text: str) -> tuple[float, ...]:
    """Values of h from ``0.4,0.8,1.5``, or none."""
    try:
        heights = tuple(float(part) for part in text.split(",")) if text else ()
    except ValueError:
        heights = (-1.0,)
    if not all(0.0 <= each <= MAX_H for each in heights):
        raise typer.BadParameter(
            f"Values of h are numbers from 0 to {MAX_H:g}, as 0.4,0.8,1.5, got {text!r}."
        )
    return heights


def _print_counts(
    given: "VolumeInput", settings: "GrainSettings", heights: tuple[float, ...], as_json: bool
) -> None:
    """Print number and size of the grains that each h gives."""
    from regolith_studio.imaging.segmentation.segment import heights_table
    from regolith_studio.io.tables import json_text
    from regolith_studio.jobs.scan_jobs import count_over_heights, scratch_folder

    table = heights_table(run_with_progress(count_over_heights(given, settings, heights, scratch_folder())))
    if as_json:
        typer.echo(json_text(table), nl=False)
    else:
        print_table(table)


def _settings_of_scans(
    scans: Sequence[Path],
    contents: VolumeOptions,
    grains: GrainOptions,
    recipe: Path | None,
    table: Path | None,
) -> "list[tuple[VolumeInput, GrainSettings]]":
    """Each scan with the name of its group and its settings: those of all, and of its row in the table."""
    from regolith_studio.session.batch.scan_groups import group_names

    with usage_errors():
        names = group_names(scans)
    rows = rows_of_scans(table, read_scan_table(table), scans, names) if table else {}
    found = []
    for scan, name in zip(scans, names, strict=True):
        row = rows.get(scan)
        with row.errors_named() if row else usage_errors():
            here, how = (row.applied_to(contents), row.applied_to(grains)) if row else (contents, grains)
            settings = _settings(how, (row.recipe if row else None) or recipe)
            found.append((replace(here.of(scan), group=name), settings))
    return found


def _settings(grains: GrainOptions, recipe: Path | None) -> "GrainSettings":
    from regolith_studio.jobs.extraction_settings import read_grain_settings

    return read_grain_settings(recipe) if recipe else grains.recipe


def _extract_groups(
    scans: "Sequence[tuple[VolumeInput, GrainSettings]]", output: Path, executor: "Executor", as_json: bool
) -> None:
    """Extract several volumes, each into a folder of its own, and print what became of them."""
    from regolith_studio.io.tables import json_text
    from regolith_studio.session.batch.scan_groups import extract_groups

    output.mkdir(parents=True, exist_ok=True)
    done = run_with_progress(extract_groups(scans, output, executor), logged=True)
    print_errors(f"{group}: {note}" for group, note in done.notes)
    print_errors(sentence for _, sentence in done.problems)
    if done.comparison is not None and as_json:
        typer.echo(json_text(done.comparison), nl=False)
    elif done.comparison is not None:
        counts = f"extracted: {len(done.extracted)}, kept from an earlier run: {len(done.kept)}"
        typer.echo(f"Volumes {counts}. Written to {output}.")
    if done.problems:
        raise typer.Exit(1)


@with_dataclass_options
def extract(
    *,
    volumes: Annotated[
        list[Path],
        typer.Argument(
            metavar="VOLUME...",
            help="TIFF stack, folder of slices, TXM, DICOM, OME-Zarr, Amira, HDF5, NRRD, MetaImage, NIfTI, "
            "NPY, raw, or the header of a scanner beside its voxels; or folders that hold several of these.",
        ),
    ],
    output: OptionalFolder = None,
    contents: VolumeOptions,
    grains: GrainOptions,
    labels: Annotated[
        Path | None,
        typer.Option(
            "--labels",
            help="File for the volume of labels, as TIFF, NRRD or HDF5 by its suffix; a table of "
            "the labels is written beside it as CSV.",
            metavar="FILE",
            callback=claim_labels,
        ),
    ] = None,
    preview_h: Annotated[
        str,
        typer.Option(
            "--preview-h",
            help="Write nothing; print how many grains each of these values of --h-maxima gives, such as "
            "0.4,0.8,1.5,2.5.",
            metavar="LIST",
        ),
    ] = "",
    recipe: Annotated[
        Path | None,
        typer.Option("--recipe", help="Take all settings from an extraction.json instead.", metavar="FILE"),
    ] = None,
    settings: Annotated[
        Path | None,
        typer.Option(
            "--settings",
            help="CSV table of settings that differ between several volumes: a column scan and columns named "
            "as options, such as voxel-size and h-maxima; an empty cell keeps what holds for all.",
            metavar="TABLE",
        ),
    ] = None,
    json: Json = False,
    jobs: Jobs = 1,
    runner: Runner = "processes",
    address: Address = "",
    tls: Tls = None,
) -> None:
    """Turn the grains of a CT volume into particle meshes (section 2.1).

    Writes one STL a particle, particles.csv and extraction.json with all settings. With --preview-h it prints
    how many grains several values of --h-maxima give, and writes nothing. Of several volumes each has a
    folder in the output folder; particles.csv holds all particles, and groups.csv compares the volumes.
    Volumes that an earlier run has finished are not extracted again.
    """
    from regolith_studio.io.atomic import staged_folder
    from regolith_studio.jobs.extraction_jobs import unfinished_file
    from regolith_studio.session.batch.scan_groups import find_scans
    from regolith_studio.session.outputs.particles import ExtractionFolder

    with usage_errors():
        given = contents.of(volumes[0])
        chosen = _settings(grains, recipe)
        heights = _heights(preview_h)
    scans = find_scans(volumes)
    given = replace(given, path=scans[0])
    several = list(scans) != volumes or len(scans) > 1 or settings is not None
    if several and (heights or labels is not None):
        raise typer.BadParameter("--preview-h and --labels take one volume at a time, without a table.")
    if heights:
        _print_counts(given, chosen, heights, json)
        return
    if output is None:
        raise typer.BadParameter("Name a folder to write with -o, or values for --preview-h.")
    with chosen_executor(runner, jobs, address, tls) as executor:
        if several:
            groups = _settings_of_scans(scans, contents, grains, recipe, settings)
            _extract_groups(groups, output, executor, json)
            return
        with staged_folder(output, "extract") as stage:
            folder = ExtractionFolder(stage)
            kept = unfinished_file(output)
            done = run_with_progress(folder.extract(given, chosen, output.parent, executor, labels, kept))
            document = folder.finish(given, chosen, done)
    print_errors(f"{given.path.name}: {note}" for note in done.notes)
    print_result(document, f"{done.extraction.summary} Written to {output}.", json)
