"""Icons: line drawings in the text colour of the theme."""

from functools import lru_cache

from PySide6.QtCore import QByteArray, QRectF, Qt
from PySide6.QtGui import QColor, QIcon, QImage, QPainter, QPixmap
from PySide6.QtSvg import QSvgRenderer

from regolith_studio.resources import resource

SIZES = (16, 20, 24, 32, 48)


def icon(name: str, colour: str, faint: str | None = None) -> QIcon:
    """The icon ``resources/icons/<name>.svg`` drawn in one colour, and in a fainter one when disabled."""
    made = QIcon()
    for size in SIZES:
        made.addPixmap(pixmap(name, colour, size))
        if faint:
            made.addPixmap(pixmap(name, faint, size), QIcon.Mode.Disabled)
    return made


def pixmap(name: str, colour: str, size: int) -> QPixmap:
    """The icon as a square picture of `size` pixels."""
    coloured, drawing = _drawing(name, size)
    picture = QImage(drawing)
    if not coloured:
        painter = QPainter(picture)
        painter.setCompositionMode(QPainter.CompositionMode.CompositionMode_SourceIn)
        painter.fillRect(0, 0, size, size, QColor(colour))
        painter.end()
    return QPixmap.fromImage(picture)


@lru_cache(maxsize=512)
def _drawing(name: str, size: int) -> tuple[bool, QImage]:
    """Whether the icon has colours of its own, and its picture; in black where it has not."""
    words = resource("icons", f"{name}.svg").read_text(encoding="utf-8")
    picture = QImage(size, size, QImage.Format.Format_ARGB32_Premultiplied)
    picture.fill(Qt.GlobalColor.transparent)
    painter = QPainter(picture)
    QSvgRenderer(QByteArray(words.encode())).render(painter, QRectF(0, 0, size, size))
    painter.end()
    return "currentColor" not in words, picture
