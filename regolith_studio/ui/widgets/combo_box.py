"""Combo boxes that elide long labels."""

from collections.abc import Mapping

from PySide6.QtCore import QRect, QSignalBlocker, QSize, Qt
from PySide6.QtGui import QPaintEvent
from PySide6.QtWidgets import (
    QComboBox,
    QStyle,
    QStyleOptionComboBox,
    QStylePainter,
)

from regolith_studio.ui.translation import tr

MARGIN = 2
"""Pixels between the frame and the text of a combo box."""


MOST_LETTERS = 38
"""Width in mean letters up to which a box asks for room for its longest label: own presets have any name."""


class ElidedComboBox(QComboBox):
    """A combo box that may be narrower than its labels, which are elided in the middle or at the end.

    With :attr:`prefers_whole` its size hint has room for the longest label.
    """

    prefers_whole = False

    def __init__(self, elide: Qt.TextElideMode = Qt.TextElideMode.ElideRight) -> None:
        super().__init__()
        self._elide = elide
        self.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.setMinimumContentsLength(12)

    def whole_width(self) -> int:
        """Width at which no label is elided."""
        labels = (self.itemText(row) for row in range(self.count()))
        widest = max(map(self.fontMetrics().horizontalAdvance, labels), default=0)
        return widest + self.width() - text_room(self)

    def sizeHint(self) -> QSize:
        hint = super().sizeHint()
        most = MOST_LETTERS * self.fontMetrics().averageCharWidth()
        return hint.expandedTo(QSize(min(self.whole_width(), most), 0)) if self.prefers_whole else hint

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: ARG002
        option = QStyleOptionComboBox()
        self.initStyleOption(option)
        option.currentText = self.fontMetrics().elidedText(self.currentText(), self._elide, text_room(self))
        painter = QStylePainter(self)
        painter.drawComplexControl(QStyle.ComplexControl.CC_ComboBox, option)
        painter.drawControl(QStyle.ControlElement.CE_ComboBoxLabel, option)
        painter.end()


class ChoiceBox(ElidedComboBox):
    """Selects one key of `entries`, a mapping of keys to labels, which are translated."""

    def __init__(self, name: str, accessible: str, entries: Mapping[str, str]) -> None:
        super().__init__()
        self.setObjectName(name)
        self.setAccessibleName(accessible)
        for key, label in entries.items():
            words = tr(label)
            self.addItem(words[:1].upper() + words[1:], key)

    def value(self) -> str:
        """The selected key."""
        key: str = self.currentData()
        return key

    def setValue(self, key: str) -> None:
        """Select a key without emitting a signal."""
        with QSignalBlocker(self):
            self.setCurrentIndex(self.findData(key))


def text_room(box: QComboBox) -> int:
    """Width of the label of a combo box in pixels."""
    option = QStyleOptionComboBox()
    box.initStyleOption(option)
    option.rect = QRect(0, 0, box.width(), box.height())
    style, part = box.style(), QStyle.SubControl.SC_ComboBoxEditField
    return style.subControlRect(QStyle.ComplexControl.CC_ComboBox, option, part, box).width() - MARGIN
