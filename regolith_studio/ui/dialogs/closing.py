"""Asks before work in progress is thrown away."""

from collections.abc import Sequence

from PySide6.QtWidgets import QMessageBox, QWidget

from regolith_studio.session.plan import LIVE
from regolith_studio.session.tasks import Task

SHORT = {*(str(kind) for kind in LIVE), "load", "inspect", "warm-up"}
"""Lanes whose work is repeated by itself when the file is opened again."""


def worth_asking(tasks: Sequence[Task], busy: Sequence[str]) -> list[str]:
    """What closing would stop, a sentence each."""
    return [f"{task.title} is running." for task in tasks if task.lane not in SHORT] + list(busy)


def may_close(parent: QWidget, reasons: Sequence[str]) -> bool:
    """Ask whether to close although work would be lost; yes where there is none."""
    if not reasons:
        return True
    box = QMessageBox(QMessageBox.Icon.Question, "Close Regolith Studio?", "\n".join(reasons), parent=parent)
    box.setObjectName("closing")
    box.setInformativeText("Closing the window stops it.")
    stay = box.addButton("Keep working", QMessageBox.ButtonRole.RejectRole)
    leave = box.addButton("Stop and close", QMessageBox.ButtonRole.DestructiveRole)
    stay.setObjectName("closing_stay")
    leave.setObjectName("closing_leave")
    box.setDefaultButton(stay)
    box.setEscapeButton(stay)
    box.exec()
    decided = box.clickedButton() is leave
    box.deleteLater()
    return decided
