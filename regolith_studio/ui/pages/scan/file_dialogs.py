"""File dialogs of the page, which begin in the folder that was used last."""

from pathlib import Path

from PySide6.QtWidgets import QFileDialog, QWidget

from regolith_studio.messages import N_
from regolith_studio.ui.page import PageContext
from regolith_studio.ui.translation import tr

VOLUMES = N_("Volumes ({suffixes});;All files (*)")
CLASSIFIERS = N_("Classifiers (*.json);;All files (*)")
SETTINGS = N_("Settings (*.json);;All files (*)")


def last_folder(context: PageContext) -> Path:
    """The folder that was used last, or the user's own."""
    return Path(str(context.recall("folder", str(Path.home()))))


def ask_to_open(parent: QWidget, context: PageContext, title: str, kinds: str) -> Path | None:
    """A file that the user chooses, or ``None``."""
    name, _ = QFileDialog.getOpenFileName(parent, title, str(last_folder(context)), kinds)
    return Path(name) if name else None


def ask_to_save(parent: QWidget, context: PageContext, title: str, proposed: str, kinds: str) -> Path | None:
    """A file that the user wants written, or ``None``; `proposed` is its name at first."""
    name, _ = QFileDialog.getSaveFileName(parent, title, str(last_folder(context) / proposed), kinds)
    return Path(name) if name else None


def note_command(context: PageContext, command: str) -> None:
    """Say with which command a file that was written is used."""
    context.toast.note(tr("Saved; use it with: {command}", command=command))
