"""Room for a page: as much as there is, with scroll bars where the page needs more."""

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QFrame, QScrollArea, QWidget

SMALLEST = QSize(240, 160)
"""That the window grants a page, in pixels: a small screen must hold the whole window."""


class ScrollablePage(QScrollArea):
    """A page that is never squeezed, and never makes the window larger than its screen."""

    def __init__(self, page: QWidget) -> None:
        super().__init__()
        self.setObjectName("room")
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setWidgetResizable(True)
        self.setWidget(page)

    def minimumSizeHint(self) -> QSize:
        return SMALLEST
