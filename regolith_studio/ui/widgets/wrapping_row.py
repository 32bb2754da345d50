"""A row of controls that wraps onto a second line."""

from collections.abc import Sequence

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QBoxLayout, QComboBox, QHBoxLayout, QWidget


class WrappingRow(QWidget):
    """Two groups of controls in a row, or below each other where the row is too narrow.

    Parameters
    ----------
    first, last
        Combo boxes among them stretch.
    margins
        Left, top, right, bottom.
    """

    def __init__(
        self, first: Sequence[QWidget], last: Sequence[QWidget], margins: tuple[int, int, int, int]
    ) -> None:
        super().__init__()
        self._box = QBoxLayout(QBoxLayout.Direction.LeftToRight, self)
        self._box.setContentsMargins(*margins)
        self._parts = [QHBoxLayout(), QHBoxLayout()]
        for part, row in zip((first, last), self._parts, strict=True):
            for each in part:
                row.addWidget(each, int(isinstance(each, QComboBox)))
        self._box.addLayout(self._parts[0], 1)
        self._box.addLayout(self._parts[1])
        self._box.setAlignment(self._parts[1], Qt.AlignmentFlag.AlignLeft)

    def minimumSizeHint(self) -> QSize:
        least, margins = [part.minimumSize().width() for part in self._parts], self._box.contentsMargins()
        return QSize(max(least) + margins.left() + margins.right(), super().minimumSizeHint().height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        margins = self._box.contentsMargins()
        needed = sum(part.sizeHint().width() for part in self._parts) + self._box.spacing()
        narrow = self.width() < needed + margins.left() + margins.right()
        way = QBoxLayout.Direction
        self._box.setDirection(way.TopToBottom if narrow else way.LeftToRight)
