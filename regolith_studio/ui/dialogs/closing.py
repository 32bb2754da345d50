"""Asks for confirmation before running jobs are stopped by closing the window."""

from collections.abc import Sequence

from PySide6.QtWidgets import QMessageBox, QWidget

from regolith_studio.session.tasks import Task
from regolith_studio.ui.translation import tr
from regolith_studio.ui.translation.plain_text import inert


def needs_confirmation(tasks: Sequence[Task], busy: Sequence[str]) -> list[str]:
    """What closing would stop, a sentence each, none of them twice; nothing of work that repeats itself."""
    titles = dict.fromkeys(tr(task.title) for task in tasks if not task.repeats)
    return [*(tr("{task} is running.", task=title) for title in titles), *busy]


def may_close(parent: QWidget, reasons: Sequence[str]) -> bool:
    """Ask whether to close although work would be lost; yes where there is none."""
    if not reasons:
        return True
    title = tr("Close Regolith Studio?")
    box = QMessageBox(QMessageBox.Icon.Question, title, "\n".join(map(inert, reasons)), parent=parent)
    box.setObjectName("closing")
    box.setInformativeText(tr("Closing the window stops or discards this."))
    stay = box.addButton(tr("Keep working"), QMessageBox.ButtonRole.RejectRole)
    leave = box.addButton(tr("Stop and close"), QMessageBox.ButtonRole.DestructiveRole)
    stay.setObjectName("closing_stay")
    leave.setObjectName("closing_leave")
    box.setDefaultButton(stay)
    box.setEscapeButton(stay)
    box.exec()
    decided = box.clickedButton() is leave
    box.deleteLater()
    return decided
