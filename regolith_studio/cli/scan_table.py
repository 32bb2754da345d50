"""Settings of single scans in a table: a row a scan, a column an option of ``extract``."""

import csv
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import typer

from regolith_studio.cli.dataclass_options import with_dataclass_options
from regolith_studio.cli.volume_options import GrainOptions, VolumeOptions
from regolith_studio.errors import FileError, InputError
from regolith_studio.readers.error_messages import printable

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
        found: Path | None = self.options.get(_RECIPE)
        return found

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

    Raises
    ------
    FileError
        If it cannot be read, a column is no option, or a value is none of that option.
    """
    from regolith_studio.readers.file_bytes import read_bytes

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

    Raises
    ------
    FileError
        If a row names no scan or several, or a scan has two rows.
    """
    found: dict[Path, ScanRow] = {}
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
        if meant[0] in found:
            raise FileError(f"{where}: {meant[0].name} has a row already, line {found[meant[0]].line}.")
        found[meant[0]] = row
    return found


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
