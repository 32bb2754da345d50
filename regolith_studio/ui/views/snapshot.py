"""The views with their titles as one picture of any size."""

from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, QSizeF, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPen, QPolygonF, QTextDocument

from regolith_studio.scene.annotations import bar_length, length_text
from regolith_studio.scene.cameras import Projection
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation.plain_text import rich
from regolith_studio.ui.views.protocol import Picture
from regolith_studio.ui.views.view_frame import ViewFrame

GAP = 8


def snapshot(
    frames: Sequence[ViewFrame],
    theme: Theme,
    scale: int = 1,
    transparent: bool = False,
    lines: Sequence[float | None] = (),
) -> QImage:
    """The frames that are not hidden side by side, `scale` times as large as on the screen.

    What they show is drawn anew at that size, not enlarged.

    Parameters
    ----------
    lines
        For each frame the share of its width at which the line of a wipe stands, ``None`` for no line.
    """
    standing = dict(zip(frames, lines, strict=True)) if lines else {}
    seen = [frame for frame in frames if not frame.isHidden()]
    pictures = [frame.view.shot(scale, transparent) for frame in seen]
    headings = [
        _heading(frame, theme, picture.shape[1] / scale)
        for frame, picture in zip(seen, pictures, strict=True)
    ]
    top = max(heading.size().height() for heading in headings)
    width = sum(picture.shape[1] for picture in pictures) + GAP * scale * (len(pictures) - 1)
    height = max(picture.shape[0] for picture in pictures) + round(top * scale)
    image = QImage(width, height, QImage.Format.Format_ARGB32)
    image.fill(Qt.GlobalColor.transparent if transparent else theme.base)
    painter = QPainter(image)
    left = 0
    for frame, heading, picture in zip(seen, headings, pictures, strict=True):
        painter.save()
        painter.translate(left, 0)
        painter.scale(scale, scale)
        heading.drawContents(painter, QRectF(0, 0, picture.shape[1] / scale, top))
        painter.restore()
        painter.drawImage(left, round(top * scale), _image(picture))
        painter.save()
        painter.translate(left, round(top * scale))
        _draw_over(painter, frame, theme, picture, scale, standing.get(frame))
        painter.restore()
        left += picture.shape[1] + GAP * scale
    painter.end()
    return image


def _heading(frame: ViewFrame, theme: Theme, width: float) -> QTextDocument:
    made = QTextDocument()
    made.setDefaultFont(frame.font())
    made.setDocumentMargin(4)
    made.setHtml(
        f'<div style="color:{theme.text}"><b>{frame.title}</b></div>'
        f'<div style="color:{theme.muted}">{rich(frame.detail.text())}</div>'
    )
    made.setPageSize(QSizeF(width, -1))
    made.setTextWidth(width)
    return made


def _draw_over(
    painter: QPainter, frame: ViewFrame, theme: Theme, picture: Picture, scale: int, line: float | None
) -> None:
    """Scale bar, and the line of the wipe if there is one; the origin is the picture's upper left."""
    height, width = picture.shape[:2]
    sight = Projection(frame.view.pose, width, height)
    length = bar_length(width * sight.per_pixel)
    painter.setPen(QPen(QColor(theme.surroundings.ink), 2.0 * scale))
    if line is not None:
        painter.drawLine(QLineF(line * width, 0, line * width, height))
    if not length:
        return
    left, low, tick = 16.0 * scale, height - 14.0 * scale, 5.0 * scale
    right = left + length / sight.per_pixel
    points = [(left, low - tick), (left, low), (right, low), (right, low - tick)]
    painter.drawPolyline(QPolygonF([QPointF(x, y) for x, y in points]))
    font = painter.font()
    font.setPixelSize(12 * scale)
    painter.setFont(font)
    place = QRectF((left + right) / 2 - 100 * scale, low - 24 * scale, 200 * scale, 18 * scale)
    painter.drawText(place, Qt.AlignmentFlag.AlignCenter, length_text(length))


def _image(picture: Picture) -> QImage:
    pixels = np.ascontiguousarray(picture)
    height, width, channels = pixels.shape
    kind = QImage.Format.Format_RGBA8888 if channels == 4 else QImage.Format.Format_RGB888
    return QImage(pixels.data, width, height, channels * width, kind).copy()
