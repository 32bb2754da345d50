"""Fields that several forms of this page have."""

from collections.abc import Sequence
from typing import Any

from PySide6.QtWidgets import QComboBox

from regolith_studio.ui.translation import tr


def choice(name: str, words: str, rows: Sequence[tuple[Any, str]]) -> QComboBox:
    """A choice among rows of value and label, with an object name and words for screen readers.

    Labels are translated here, words where they stand.
    """
    box = QComboBox()
    box.setObjectName(name)
    box.setAccessibleName(words)
    for key, label in rows:
        box.addItem(tr(label), key)
    return box
