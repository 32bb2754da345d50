"""One command as a row: where it stands in the menus, its shortcut, its place in the tool bar."""

from dataclasses import dataclass

from regolith_studio.messages import N_


@dataclass(frozen=True)
class ActionSpec:
    """One row.

    Parameters
    ----------
    menu
        Title of its menu; those of :data:`regolith_studio.ui.actions.WITHIN_VIEW` are menus within View.
    name
        Of the command that it runs, and its object name.
    text
        In the menu; "&" marks the letter.
    icon
        File in ``resources/icons``; empty for none.
    shortcut
        Empty for none.
    tip
        In the tool bar; the text if empty.
    checked
        ``True`` or ``False`` for a switch, ``None`` for a command.
    bar
        Its place in the tool bar: ``words`` with its text, ``icon`` without, empty for none.
    """

    menu: str
    name: str
    text: str
    icon: str = ""
    shortcut: str = ""
    tip: str = ""
    checked: bool | None = None
    bar: str = ""


BREAK = "-"
PAGE_MENU = N_("&Page")
"""Menu of the commands of the page that is seen."""
