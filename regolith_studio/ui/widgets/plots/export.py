"""Saving plots: the figure as PNG, SVG or PDF, its data as CSV."""

from collections.abc import Callable, Sequence
from pathlib import Path

import pyqtgraph as pg
from PySide6.QtCore import QBuffer, QIODevice, QMarginsF, QPoint, QSizeF
from PySide6.QtGui import (
    QImage,
    QPageLayout,
    QPageSize,
    QPaintDevice,
    QPainter,
    QPdfWriter,
    QTextDocumentFragment,
)
from PySide6.QtSvg import QSvgGenerator
from PySide6.QtWidgets import QWidget

from regolith_studio.errors import InputError
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.tables import Column, Table, csv_text

PIXELS = 3
"""Pixels of a PNG for each on the screen."""
POINTS_AN_INCH = 72


def save_figure(widget: QWidget, path: Path) -> None:
    """Write the widget as an image in the format of the file's suffix."""
    if path.suffix.lower() not in FIGURE_WRITERS:
        raise InputError(f"Figures are saved as {', '.join(FIGURE_WRITERS)}, not as {path.suffix or 'that'}.")
    write_bytes(path, FIGURE_WRITERS[path.suffix.lower()](widget))


def save_numbers(
    title: str, columns: Sequence[str], rows: Sequence[tuple[str | float, ...]], path: Path
) -> None:
    """Write a CSV file; column names may be rich text."""
    named = tuple(Column(plain_text(name)) for name in columns)
    write_bytes(path, csv_text(Table(title, named, tuple(rows))).encode("utf-8"))


def plain_text(rich: str) -> str:
    """Rich text without tags."""
    return QTextDocumentFragment.fromHtml(rich).toPlainText()


def png_of_image(image: QImage) -> bytes:
    with _Bytes() as device:
        image.save(device, "PNG")  # type: ignore[call-overload]  # the stubs know file names only
        return bytes(device.data().data())


def _png(widget: QWidget) -> bytes:
    image = QImage(widget.size() * PIXELS, QImage.Format.Format_RGB32)
    image.setDevicePixelRatio(PIXELS)
    _paint(widget, image)
    return png_of_image(image)


def _svg(widget: QWidget) -> bytes:
    with _Bytes() as device:
        picture = QSvgGenerator()
        picture.setOutputDevice(device)
        picture.setSize(widget.size())
        picture.setViewBox(widget.rect())
        _paint(widget, picture)
        return bytes(device.data().data())


def _pdf(widget: QWidget) -> bytes:
    with _Bytes() as device:
        writer = QPdfWriter(device)
        writer.setResolution(POINTS_AN_INCH)
        writer.setPageSize(QPageSize(QSizeF(widget.size()), QPageSize.Unit.Point))
        writer.setPageMargins(QMarginsF(0, 0, 0, 0), QPageLayout.Unit.Point)
        _paint(widget, writer)
        return bytes(device.data().data())


def _paint(widget: QWidget, device: QPaintDevice) -> None:
    """Draw the widget on its base colour, with symbols as vector shapes."""
    painter = QPainter(device)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.fillRect(widget.rect(), widget.palette().base())
    scattered = [
        item
        for view in widget.findChildren(pg.GraphicsView)
        for item in view.scene().items()
        if isinstance(item, pg.ScatterPlotItem)
    ]
    for item in scattered:
        item.setExportMode(True, {"antialias": True})
    try:
        widget.render(painter, QPoint(0, 0), renderFlags=QWidget.RenderFlag.DrawChildren)
    finally:
        for item in scattered:
            item.setExportMode(False)
        painter.end()


class _Bytes(QBuffer):
    """A buffer that a ``with`` statement opens and closes."""

    def __enter__(self) -> "_Bytes":
        self.open(QIODevice.OpenModeFlag.WriteOnly)
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()


FIGURE_WRITERS: dict[str, Callable[[QWidget], bytes]] = {".png": _png, ".svg": _svg, ".pdf": _pdf}
"""Function that encodes a widget, by file suffix."""
