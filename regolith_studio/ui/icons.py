"""The program's own icons: line drawings that take the colour of the letters around them."""

from functools import lru_cache

from PySide6.QtCore import QByteArray, QRectF, Qt
from PySide6.QtGui import QIcon, QPainter, QPixmap
from PySide6.QtSvg import QSvgRenderer

from regolith_studio.resources import resource

SIZES = (16, 20, 24, 32, 48)


def icon(name: str, colour: str, faint: str | None = None) -> QIcon:
    """The icon ``resources/icons/<name>.svg`` drawn in one colour, and in a fainter one when disabled.

    Raises
    ------
    EnvironmentProblem
        If there is no such icon.
    """
    made = QIcon()
    for size in SIZES:
        made.addPixmap(pixmap(name, colour, size))
        if faint:
            made.addPixmap(pixmap(name, faint, size), QIcon.Mode.Disabled)
    return made


def pixmap(name: str, colour: str, size: int) -> QPixmap:
    """The icon as a square picture of `size` pixels.

    Raises
    ------
    EnvironmentProblem
        If there is no such icon.
    """
    picture = QPixmap(size, size)
    picture.fill(Qt.GlobalColor.transparent)
    painter = QPainter(picture)
    drawing = _drawing(name).replace("currentColor", colour)
    QSvgRenderer(QByteArray(drawing.encode())).render(painter, QRectF(0, 0, size, size))
    painter.end()
    return picture


@lru_cache(maxsize=64)
def _drawing(name: str) -> str:
    return resource("icons", f"{name}.svg").read_text(encoding="utf-8")
