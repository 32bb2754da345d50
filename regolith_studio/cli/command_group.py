"""Lists of commands whose lines of help are wrapped, not cut."""

import inspect
from typing import Any

from typer.core import TyperGroup


class CommandGroup(TyperGroup):
    """A group that shows the first paragraph of each command's help whole."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write name and help of every command."""
        commands = {name: self.get_command(ctx, name) for name in self.list_commands(ctx)}
        rows = [(name, _first_paragraph(command.help)) for name, command in commands.items() if command]
        with formatter.section("Commands"):
            formatter.write_dl(rows)


def _first_paragraph(text: str | None) -> str:
    paragraph = inspect.cleandoc(text or "").partition("\n\n")[0]
    return " ".join(paragraph.split()).removesuffix(".")
