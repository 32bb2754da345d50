"""A box that offers some keys by their labels."""

from collections.abc import Mapping

from PySide6.QtCore import QSignalBlocker
from PySide6.QtWidgets import QComboBox

from regolith_studio.ui.translation import tr


class ChoiceBox(QComboBox):
    """One of `entries`, which map keys to labels that are translated; may be narrower than the longest."""

    def __init__(self, name: str, accessible: str, entries: Mapping[str, str]) -> None:
        super().__init__()
        self.setObjectName(name)
        self.setAccessibleName(accessible)
        self.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.setMinimumContentsLength(12)
        for key, label in entries.items():
            words = tr(label)
            self.addItem(words[:1].upper() + words[1:], key)

    def value(self) -> str:
        """The key that is chosen."""
        key: str = self.currentData()
        return key

    def setValue(self, key: str) -> None:
        """Show another key, and tell nobody."""
        with QSignalBlocker(self):
            self.setCurrentIndex(self.findData(key))
