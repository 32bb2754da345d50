"""Texts of changing length in a fixed height, so that the controls below do not move."""

from collections.abc import Sequence

from PySide6.QtCore import QEvent, QSize, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QLabel, QScrollArea, QSizePolicy, QVBoxLayout, QWidget

from regolith_studio.ui.translation import tr


class FixedHeightText(QScrollArea):
    """Labels in a scroll area with the height of a fixed number of lines.

    Further lines are scrolled by the mouse or, with the focus, by the arrow keys.

    Parameters
    ----------
    texts
        From top to bottom; hidden ones take no space.
    lines
        Visible at once.
    max_lines
        Visible where a column is high enough for them, see
        :func:`~regolith_studio.ui.layout.scrolled_column`.
    """

    def __init__(self, texts: Sequence[QLabel], lines: int, max_lines: int = 0) -> None:
        super().__init__()
        self._lines, self._spare, self._max_lines = lines, 0, max(lines, max_lines)
        self._inside = QWidget()
        column = QVBoxLayout(self._inside)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(2)
        for text in texts:
            text.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
            column.addWidget(text)
        column.addStretch(1)
        self.setProperty("role", "texts")
        self.setWidgetResizable(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setAccessibleName(tr("Remarks"))
        self.setWidget(self._inside)
        self.verticalScrollBar().rangeChanged.connect(self._update_focus_policy)

    @property
    def line(self) -> int:
        """Height of one line."""
        return self.fontMetrics().lineSpacing()

    def take_spare_lines(self, lines: int) -> int:
        """Show up to so many more lines; returns how many are used."""
        taken = max(0, min(lines, self._max_lines - self._lines))
        if taken != self._spare:
            self._spare = taken
            self.updateGeometry()
        return taken

    def sizeHint(self) -> QSize:
        lines = (self._lines + self._spare) * self.line
        return QSize(super().sizeHint().width(), lines + 2 * self.frameWidth())

    def minimumSizeHint(self) -> QSize:
        bar = self.verticalScrollBar().sizeHint().width()
        return QSize(self._inside.minimumSizeHint().width() + bar, self.sizeHint().height())

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self.updateGeometry()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._update_focus_policy()

    def _update_focus_policy(self, *_range: int) -> None:
        """Accept the focus by Tab only if there is something to scroll."""
        more = self.verticalScrollBar().maximum() > 0
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus if more else Qt.FocusPolicy.NoFocus)
