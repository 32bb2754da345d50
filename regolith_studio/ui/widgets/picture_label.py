"""A picture that is shown as large as there is room, in its own proportions."""

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QPixmap
from PySide6.QtWidgets import QSizePolicy, QWidget

LEAST_HEIGHT = 80


class PictureLabel(QWidget):
    """Shows PNG bytes, or a sentence where there are none.

    Parameters
    ----------
    placeholder
        The sentence.
    least_scale
        Share of its own height below which a picture is not shrunk; for labels in a scroll area.
    """

    def __init__(self, placeholder: str, least_scale: float = 0.0) -> None:
        super().__init__()
        self._least_scale = least_scale
        self._placeholder = placeholder
        self._picture = QPixmap()
        self.setAccessibleName(placeholder)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(120, LEAST_HEIGHT)

    def set_picture(self, content: bytes | None) -> None:
        """Show this PNG instead, or the sentence."""
        self._picture = QPixmap()
        if content:
            self._picture.loadFromData(content)
        self.setMinimumHeight(max(LEAST_HEIGHT, int(self._least_scale * self._picture.height())))
        self.update()

    def is_empty(self) -> bool:
        """Whether the sentence is shown."""
        return self._picture.isNull()

    def sizeHint(self) -> QSize:
        return QSize(600, 360)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: ARG002
        painter = QPainter(self)
        if self._picture.isNull():
            painter.setPen(self.palette().placeholderText().color())
            flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
            painter.drawText(self.rect().adjusted(20, 10, -20, -10), int(flags), self._placeholder)
        else:
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
            size = self._picture.size().scaled(self.size(), Qt.AspectRatioMode.KeepAspectRatio)
            left, top = (self.width() - size.width()) / 2, (self.height() - size.height()) / 2
            place = QRectF(left, top, size.width(), size.height())
            painter.drawPixmap(place, self._picture, QRectF(self._picture.rect()))
        painter.end()
