"""Thumbnails of meshes by the painter's algorithm, without OpenGL."""

from collections import deque
from collections.abc import Callable, Generator, Iterable

import numpy as np
from PySide6.QtCore import QObject, QPointF, Qt, QTimer
from PySide6.QtGui import QColor, QImage, QPainter, QPixmap, QPolygonF

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.steps import result_of

OVERSAMPLING = 2
_VIEW = np.array([[0.88, 0.48, 0.0], [-0.24, 0.43, 0.87], [0.42, -0.76, 0.49]])
"""Rows: right, up and towards the eye; from above and in front."""
_LIGHT = np.array([-0.35, 0.55, 0.76])


TRIANGLES_PER_STEP = 300
"""Triangles that are drawn in one step, about 5 ms."""

Painting = Generator[None, None, QPixmap]


def thumbnail(mesh: Mesh, colour: str, size: int = 96) -> QPixmap:
    """Shaded picture of a mesh on a transparent background, `size` pixels wide and high."""
    return result_of(paint_thumbnail(mesh, colour, size))


def paint_thumbnail(mesh: Mesh, colour: str, size: int = 96) -> Painting:
    """:func:`thumbnail` step by step, so that events can be processed in between; returns the picture."""
    wide = size * OVERSAMPLING
    image = QImage(wide, wide, QImage.Format.Format_ARGB32_Premultiplied)
    image.fill(Qt.GlobalColor.transparent)
    corners, shades = _project(mesh)
    painter = QPainter()
    tones = [_tone(colour, level) for level in np.linspace(0.35, 1.15, 64)]
    places = np.clip(((shades + 1) / 2 * 63).astype(int), 0, 63)
    for first in range(0, len(places), TRIANGLES_PER_STEP):
        part = slice(first, first + TRIANGLES_PER_STEP)
        painter.begin(image)
        painter.setPen(Qt.PenStyle.NoPen)
        for triangle, place in zip(corners[part] * wide, places[part], strict=True):
            painter.setBrush(tones[place])
            painter.drawPolygon(QPolygonF([QPointF(x, y) for x, y in triangle]))
        painter.end()
        yield
    smooth = Qt.TransformationMode.SmoothTransformation
    return QPixmap.fromImage(image.scaled(size, size, Qt.AspectRatioMode.KeepAspectRatio, smooth))


Wanted = tuple[Mesh, str, Callable[[QPixmap], object]]
"""A mesh, its colour, and the function that is called with its picture."""


class ThumbnailQueue(QObject):
    """Paints thumbnails one after the other, in steps, as meshes may have many triangles."""

    def __init__(self, size: int, parent: QObject) -> None:
        super().__init__(parent)
        self._size, self._waiting = size, deque[Wanted]()
        self._painting: Painting | None = None
        self._timer = QTimer(self, interval=0)
        self._timer.timeout.connect(self._go_on)

    def paint(self, wanted: Iterable[Wanted]) -> None:
        """Paint these in place of what waits."""
        self.stop()
        self._waiting.extend(wanted)
        self._timer.start()

    def stop(self) -> None:
        self._timer.stop()
        self._waiting.clear()
        self._painting = None

    def _go_on(self) -> None:
        if not self._waiting:
            self.stop()
            return
        mesh, colour, show = self._waiting[0]
        self._painting = self._painting or paint_thumbnail(mesh, colour, self._size)
        try:
            next(self._painting)
        except StopIteration as end:
            self._painting = None
            self._waiting.popleft()
            show(end.value)


def _project(mesh: Mesh) -> tuple[FloatArray, FloatArray]:
    """Corners of the front-facing triangles, from 0 to 1 and back to front, and their brightness."""
    view = np.linalg.qr(_VIEW.T)[0].T
    view *= np.sign((view * _VIEW).sum(axis=1, keepdims=True))
    middle = mesh.bounds.mean(axis=0)
    turned = (mesh.triangles - middle) @ view.T
    normals = np.cross(turned[:, 1] - turned[:, 0], turned[:, 2] - turned[:, 0])
    length = np.linalg.norm(normals, axis=1)
    facing = (normals[:, 2] > 0.0) & (length > 0.0)
    turned, normals = turned[facing], normals[facing] / length[facing, None]
    order = np.argsort(turned[:, :, 2].mean(axis=1))
    reach = 1.08 * float(np.linalg.norm(mesh.vertices - middle, axis=1).max())
    flat = turned[order][:, :, :2] * [1.0, -1.0] / (2 * reach) + 0.5
    return flat, normals[order] @ (_LIGHT / np.linalg.norm(_LIGHT))


def _tone(colour: str, level: float) -> QColor:
    base = QColor(colour)
    return QColor.fromRgbF(
        *(float(min(1.0, part * level)) for part in (base.redF(), base.greenF(), base.blueF()))
    )
