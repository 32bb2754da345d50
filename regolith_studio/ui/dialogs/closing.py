"""Asks for confirmation before running jobs are stopped by closing the window."""

from collections.abc import Callable, Sequence

from PySide6.QtWidgets import QMessageBox, QWidget

from regolith_studio.session.tasks import Task
from regolith_studio.ui.translation import tr
from regolith_studio.ui.translation.plain_text import inert


def needs_confirmation(tasks: Sequence[Task], busy: Sequence[str]) -> list[str]:
    """What closing would stop, a sentence each, none of them twice; nothing of work that repeats itself."""
    titles = dict.fromkeys(tr(task.title) for task in tasks if not task.repeats)
    return [*(tr("{task} is running.", task=title) for title in titles), *busy]


def may_close(
    parent: QWidget, reasons: Sequence[str], unsaved: Sequence[str], save: Callable[[], bool]
) -> bool:
    """Ask whether to close although work would be lost, and whether to save first; yes where there is none.

    Parameters
    ----------
    reasons, unsaved
        What would be stopped, and what is not saved, in sentences.
    save
        Saves what is not; whether that was done.
    """
    if not reasons and not unsaved:
        return True
    title, lost = tr("Close Regolith Studio?"), "\n".join(map(inert, (*reasons, *unsaved)))
    box = QMessageBox(QMessageBox.Icon.Question, title, lost, parent=parent)
    box.setObjectName("closing")
    stay = box.addButton(tr("Cancel"), QMessageBox.ButtonRole.RejectRole)
    words = tr("Stop and close") if reasons else tr("Don't save")
    leave = box.addButton(words, QMessageBox.ButtonRole.DestructiveRole)
    kept = box.addButton(tr("Save"), QMessageBox.ButtonRole.AcceptRole) if unsaved else None
    if kept is not None:
        kept.setObjectName("closing_save")
    stay.setObjectName("closing_stay")
    leave.setObjectName("closing_leave")
    box.setDefaultButton(kept or stay)
    box.setEscapeButton(stay)
    box.exec()
    pressed = box.clickedButton()
    box.deleteLater()
    return pressed is leave or (pressed is kept is not None and save())
