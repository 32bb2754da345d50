"""What a command says while it works (stderr, only to a person) and when it is done (stdout)."""

import json
import sys
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    from regolith_studio.jobs.events import Steps
    from regolith_studio.studies.tables import Table


def follow(steps: "Steps") -> Any:
    """Drive a job to its result; on a terminal with a progress bar that disappears in the end."""
    if sys.stderr.isatty():
        return _with_bar(steps)
    while True:
        try:
            next(steps)
        except StopIteration as end:
            return end.value


def _with_bar(steps: "Steps") -> Any:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    from regolith_studio.jobs import events

    look = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        TextColumn("[dim]{task.fields[note]}"),
    )
    with Progress(*look, console=Console(stderr=True), transient=True) as bar:
        shown = bar.add_task("Working", total=None, note="")
        while True:
            try:
                step = next(steps)
            except StopIteration as end:
                return end.value
            match step:
                case events.Started(title, total):
                    bar.update(shown, description=title, total=total or None)
                case events.Progress(done, total, message):
                    bar.update(shown, completed=done, total=total or None, note=message)


def print_json(document: Any) -> None:
    """Indented JSON on stdout."""
    typer.echo(json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False))


def print_table(table: "Table") -> None:
    """A table on stdout, as wide as it needs to be where nobody looks at it."""
    from rich.console import Console
    from rich.table import Table as Drawn

    from regolith_studio.studies.tables import rows_as_text

    header, *rows = rows_as_text(table, digits=4)
    drawn = Drawn(title=table.title, title_justify="left")
    for name in header:
        drawn.add_column(name, overflow="fold")
    for row in rows:
        drawn.add_row(*row)
    Console(width=None if sys.stdout.isatty() else 400).print(drawn)


def complain(sentences: Iterable[str]) -> None:
    """One line each on stderr."""
    for sentence in sentences:
        typer.echo(sentence, err=True)
