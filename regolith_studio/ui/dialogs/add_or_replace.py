"""Asks whether opened particles are added to those that are open, or replace them."""

from PySide6.QtWidgets import QCheckBox, QMessageBox, QWidget

from regolith_studio.messages import N_
from regolith_studio.session.preferences import Preferences
from regolith_studio.ui.translation import tr, tr_count

SETTING = "on_opening"
"""In the preferences of the window: ``add`` or ``replace``, if it is not to be asked."""
ADD, REPLACE = "add", "replace"


def ask_add_or_replace(preferences: Preferences, count: int, parent: QWidget) -> str | None:
    """``add`` or ``replace``, as remembered or as answered now; ``None`` to open nothing.

    Parameters
    ----------
    count
        Of the particles that are open.
    """
    kept = preferences.window.get(SETTING)
    if kept in (ADD, REPLACE):
        return str(kept)
    box = QMessageBox(parent)
    box.setObjectName("add_or_replace")
    box.setWindowTitle(tr("Open particles"))
    box.setText(tr_count(N_("1 particle is open."), N_("{count} particles are open."), count))
    box.setInformativeText(tr("Add the new ones to them, or replace them? Undo restores replaced ones."))
    add = box.addButton(tr("Add"), QMessageBox.ButtonRole.AcceptRole)
    replace = box.addButton(tr("Replace"), QMessageBox.ButtonRole.DestructiveRole)
    cancel = box.addButton(QMessageBox.StandardButton.Cancel)
    for button, name in ((add, "opening_add"), (replace, "opening_replace"), (cancel, "opening_cancel")):
        button.setObjectName(name)
    box.setDefaultButton(add)
    remember = QCheckBox(tr("Do not ask again"))
    remember.setObjectName("opening_remember")
    box.setCheckBox(remember)
    box.exec()
    pressed = box.clickedButton()
    answer = ADD if pressed is add else REPLACE if pressed is replace else None
    if answer and remember.isChecked():
        preferences.window = preferences.window | {SETTING: answer}
    box.deleteLater()
    return answer
