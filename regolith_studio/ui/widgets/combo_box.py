"""Combo boxes that elide long labels, and a row that wraps the buttons behind one."""

from collections.abc import Mapping, Sequence

from PySide6.QtCore import QEvent, QRect, QSignalBlocker, QSize, Qt
from PySide6.QtGui import QPaintEvent, QResizeEvent
from PySide6.QtWidgets import (
    QAbstractButton,
    QComboBox,
    QGridLayout,
    QStyle,
    QStyleOptionComboBox,
    QStylePainter,
    QWidget,
)

from regolith_studio.ui.translation import tr

MARGIN = 2
"""Pixels between the frame and the text of a combo box."""


MOST_LETTERS = 38
"""Width in mean letters up to which a box asks for room for its longest label: own presets have any name."""


class ElidedComboBox(QComboBox):
    """A combo box that may be narrower than its labels, which are elided in the middle or at the end.

    With :attr:`prefers_whole` its size hint has room for the longest label, with :attr:`needs_whole`
    its minimum too.
    """

    prefers_whole = needs_whole = False

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
        return self._with_labels(super().sizeHint(), self.prefers_whole or self.needs_whole)

    def minimumSizeHint(self) -> QSize:
        return self._with_labels(super().minimumSizeHint(), self.needs_whole)

    def _with_labels(self, hint: QSize, wanted: bool) -> QSize:
        if not wanted:
            return hint
        most = MOST_LETTERS * self.fontMetrics().averageCharWidth()
        return QSize(max(hint.width(), min(self.whole_width(), most)), hint.height())

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


class ComboBoxRow(QWidget):
    """A combo box with buttons behind it, or below it where its labels would be elided.

    Parameters
    ----------
    box
        Stretches.
    buttons
        From left to right.
    spacing
        Pixels between two of them.
    """

    def __init__(self, box: QComboBox, buttons: Sequence[QAbstractButton], spacing: int = 4) -> None:
        super().__init__()
        self._box, self._buttons = box, tuple(buttons)
        self._folded: bool | None = None
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setSpacing(spacing)
        self._grid.setColumnStretch(0, 1)
        self._grid.setSizeConstraint(QGridLayout.SizeConstraint.SetNoConstraint)  # it folds when it is narrow
        self._needed = 0
        self.refold()

    def refold(self) -> None:
        """Compute the required width again, after labels or fonts have changed."""
        metrics = self._box.fontMetrics()
        labels = [self._box.itemText(row) for row in range(self._box.count())]
        widest = max(map(metrics.horizontalAdvance, labels), default=0)
        wide = (min(button.sizeHint().width(), button.maximumWidth()) for button in self._buttons)
        behind = sum(wide) + len(self._buttons) * self._grid.spacing()
        self._needed = widest + self._box.width() - text_room(self._box) + behind
        self._place()

    def minimumSizeHint(self) -> QSize:
        """The width of the box or of the buttons, which may stand below it."""
        least = [each.minimumSizeHint().width() for each in self._buttons]
        buttons = sum(least) + (len(least) - 1) * self._grid.spacing()
        return QSize(max(self._box.minimumSizeHint().width(), buttons), super().minimumSizeHint().height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._place()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self.refold()

    def _place(self) -> None:
        folded = self.width() < self._needed
        if folded != self._folded:
            self._folded = folded
            columns = len(self._buttons)
            self._grid.addWidget(self._box, 0, 0, 1, 1 + columns * folded)
            for column, button in enumerate(self._buttons, start=1):
                self._grid.addWidget(button, int(folded), column)


def text_room(box: QComboBox) -> int:
    """Width of the label of a combo box in pixels."""
    option = QStyleOptionComboBox()
    box.initStyleOption(option)
    option.rect = QRect(0, 0, box.width(), box.height())
    style, part = box.style(), QStyle.SubControl.SC_ComboBoxEditField
    return style.subControlRect(QStyle.ComplexControl.CC_ComboBox, option, part, box).width() - MARGIN
