"""Output of commands: help, progress (stderr, on a terminal only), tables, JSON and errors."""

import inspect
import json
import math
import sys
import time
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import typer
from typer.core import TyperGroup

from regolith_studio.errors import check_not_stopped
from regolith_studio.readers.error_messages import printable

if TYPE_CHECKING:
    from regolith_studio.io.tables import Table
    from regolith_studio.jobs.events import Steps


_LINE_INTERVAL = 30.0
"""Seconds between two lines of progress where there is no terminal."""


def run_with_progress(steps: "Steps", logged: bool = False) -> Any:
    """Drive a job to its result; on a terminal with a progress bar that disappears in the end.

    ``logged``: whether to write a line now and then where there is no terminal, as long batches do.
    """
    if sys.stderr.isatty():
        return _with_bar(steps)
    return _with_lines(steps, _LINE_INTERVAL if logged else math.inf)


def _with_lines(steps: "Steps", interval: float) -> Any:
    """Print a line of progress, at most one in `interval` seconds."""
    from regolith_studio.jobs import events

    last_line, title = time.monotonic(), ""
    while True:
        try:
            step = next(steps)
        except StopIteration as end:
            return end.value
        if isinstance(step, events.Started):
            title = step.title
        elif isinstance(step, events.Progress) and time.monotonic() - last_line > interval:
            last_line = time.monotonic()
            message = f", {step.message}" if step.message else ""
            print_errors([f"{title}: {step.done:,} of {step.total:,}{message}"])


def _with_bar(steps: "Steps") -> Any:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    from regolith_studio.jobs import events

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        TextColumn("[dim]{task.fields[note]}"),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("Working", total=None, note="")
        while True:
            try:
                step = next(steps)
            except StopIteration as end:
                return end.value
            match step:
                case events.Started(title, total):
                    bar.update(task, description=title, total=total or None)
                case events.Progress(done, total, message):
                    bar.update(task, completed=done, total=total or None, note=message)


def print_json(document: Any) -> None:
    """Indented JSON on stdout."""
    typer.echo(json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False))


def print_result(document: Any, text: str, as_json: bool) -> None:
    """The result of a command on stdout, as JSON or in words."""
    if as_json:
        print_json(document)
    else:
        typer.echo(text)


def print_table(table: "Table") -> None:
    """A table on stdout: words to the left, numbers to the right, two spaces between."""
    from regolith_studio.io.tables import rows_as_text

    lines = rows_as_text(table, digits=4)
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    words = [any(isinstance(cell, str) for cell in table.column(column.name)) for column in table.columns]
    for line in lines:
        cells = zip(line, widths, words, strict=True)
        row = "  ".join(cell.ljust(width) if word else cell.rjust(width) for cell, width, word in cells)
        typer.echo(row.rstrip())


def print_errors(sentences: Iterable[str]) -> None:
    """One line each on stderr."""
    for sentence in sentences:
        check_not_stopped()
        typer.echo(printable(sentence), err=True)


class CommandGroup(TyperGroup):
    """A group that shows the first paragraph of each command's help whole."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write name and help of every command."""
        commands = {name: self.get_command(ctx, name) for name in self.list_commands(ctx)}
        rows = [(name, _first_paragraph(command.help)) for name, command in commands.items() if command]
        with formatter.section("Commands"):
            formatter.write_dl(rows)


def command_group(text: str) -> typer.Typer:
    """A group of commands with this line of help."""
    return typer.Typer(cls=CommandGroup, help=text, no_args_is_help=True, rich_markup_mode=None)


def _first_paragraph(text: str | None) -> str:
    paragraph = inspect.cleandoc(text or "").partition("\n\n")[0]
    return " ".join(paragraph.split()).removesuffix(".")
