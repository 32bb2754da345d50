"""Ctrl+Z in a number box is the window's, unless a number is being typed that counts for nothing yet."""

from typing import cast

import shiboken6
from PySide6.QtCore import QEvent, QObject
from PySide6.QtGui import QKeyEvent, QKeySequence
from PySide6.QtWidgets import QAbstractSpinBox, QApplication, QDoubleSpinBox, QSpinBox, QWidget

_KEYS = (QKeySequence.StandardKey.Undo, QKeySequence.StandardKey.Redo)


class UndoKeys(QObject):
    """Watches the number box that has the focus.

    Its line would take the keys for itself, also where it has nothing to undo, and undo of the window would
    not be reached from where its choices are made.
    """

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._box: QWidget | None = None
        cast(QApplication, QApplication.instance()).focusChanged.connect(self._move)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(watched, QAbstractSpinBox):
            wanted = any(cast(QKeyEvent, event).matches(key) for key in _KEYS)
            if wanted and not is_being_typed(watched):
                event.ignore()
                return True
        return super().eventFilter(watched, event)

    def _move(self, _old: QWidget | None, now: QWidget | None) -> None:
        if self._box is not None and shiboken6.isValid(self._box):
            self._box.removeEventFilter(self)
        self._box = now if isinstance(now, QAbstractSpinBox) else None
        if self._box is not None:
            self._box.installEventFilter(self)


def is_being_typed(box: QAbstractSpinBox) -> bool:
    """Whether a box shows another text than that of its value."""
    if not isinstance(box, QSpinBox | QDoubleSpinBox):
        return False
    number = box.textFromValue(box.value())  # type: ignore[arg-type]
    usual = f"{box.prefix()}{number}{box.suffix()}"
    if box.value() == box.minimum():
        usual = box.specialValueText() or usual
    return box.text() != usual
