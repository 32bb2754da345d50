"""What every plot has: axes, colours, the canvas, and saving as PNG, SVG, PDF or CSV."""

import html
import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import pyqtgraph as pg
from PySide6.QtCore import QBuffer, QEvent, QIODevice, QMarginsF, QPoint, QPointF, QSizeF, Qt
from PySide6.QtGui import (
    QColor,
    QContextMenuEvent,
    QFont,
    QFontMetrics,
    QFontMetricsF,
    QImage,
    QPageLayout,
    QPageSize,
    QPaintDevice,
    QPainter,
    QPdfWriter,
    QResizeEvent,
    QTextDocumentFragment,
)
from PySide6.QtSvg import QSvgGenerator
from PySide6.QtWidgets import (
    QFileDialog,
    QGraphicsGridLayout,
    QLabel,
    QMenu,
    QMessageBox,
    QSizePolicy,
    QStackedLayout,
    QToolTip,
    QWidget,
)

from regolith_studio.errors import InputError, RegolithError
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.tables import Column, Table, csv_text
from regolith_studio.ui.layout import hbox, named, vbox
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import inert, localized, tr
from regolith_studio.ui.widgets.labels import subscript, unbroken

_SUBSCRIPT = re.compile(r"<sub>(\w+)</sub>")

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
    """Rich text without tags; with the subscripts that Unicode has."""
    return QTextDocumentFragment.fromHtml(
        _SUBSCRIPT.sub(lambda match: subscript(match[1]), rich)
    ).toPlainText()


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


CANVAS_MARGIN = 1.0
"""Pixels around box and axes."""
MIN_LABEL_SCALE = 0.5
"""An axis label shrinks to this share of its font size; a longer one is elided."""
FONT_STEP = 0.5
"""Points between two font sizes that are tried."""
AXIS_LABEL_MARGIN = 8.0
"""Pixels around the text of an axis label, both sides together; pyqtgraph adds a blank behind it."""
DENSE_TICKS_HEIGHT = 14.0
"""Font height in pixels up to which ticks have the density that pyqtgraph chooses."""
MAX_DECADES = 300.0
"""Limit of a logarithmic axis in powers of ten: pyqtgraph computes ten to the power of its ends."""
_PLACES = {"bottom": (1, 1), "left": (0, 0)}
_BOX = (0, 1)


class PlotCanvas(pg.GraphicsView):  # type: ignore[misc]
    """Items in a view box with an axis at the left and one below, without mouse interaction or menus.

    Replaces :class:`pyqtgraph.PlotWidget`, whose form of options costs 10 ms and 0.3 MB for each plot, and
    has dozens of widgets that are polished again at every change of the style sheet.

    ``axes``: the axes "left" and "bottom".
    """

    def __init__(self, axes: Mapping[str, pg.AxisItem]) -> None:
        self._axes = dict(axes)
        self._items: list[Any] = []
        self._log = (False, False)
        super().__init__(background=None)
        self.setCacheMode(self.CacheModeFlag.CacheNone)  # the ground is plain, a picture of it holds memory
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setFrameShape(self.Shape.NoFrame)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.NoContextMenu)
        self._whole = pg.GraphicsWidget()
        self._box = pg.ViewBox(parent=self._whole, enableMenu=False, enableMouse=False)
        self._arrange()
        self.setCentralItem(self._whole)

    def _arrange(self) -> None:
        grid = QGraphicsGridLayout()
        grid.setContentsMargins(CANVAS_MARGIN, CANVAS_MARGIN, LAST_LABEL, CANVAS_MARGIN)
        grid.setSpacing(0)
        grid.addItem(self._box, *_BOX)
        for side, place in _PLACES.items():
            axis = self._axes[side]
            axis.linkToView(self._box)
            grid.addItem(axis, *place)
            axis.setZValue(0.5)  # above pictures, below what is set higher
            axis.setFlag(axis.GraphicsItemFlag.ItemNegativeZStacksBehindParent)
        grid.setRowStretchFactor(_BOX[0], 100)
        grid.setColumnStretchFactor(_BOX[1], 100)
        self._whole.setLayout(grid)

    def getViewBox(self) -> pg.ViewBox:
        """The view box, which maps between coordinates of items and of the scene."""
        return self._box

    def getAxis(self, side: str) -> pg.AxisItem:
        return self._axes[side]

    def addItem(self, item: Any, ignoreBounds: bool = False) -> None:
        """Add an item; with `ignoreBounds` it does not change the range of the axes."""
        self._items.append(item)
        self._box.addItem(item, ignoreBounds=ignoreBounds)
        if hasattr(item, "setLogMode"):
            item.setLogMode(*self._log)

    def removeItem(self, item: Any) -> None:
        """Remove an item, if it is there."""
        if item in self._items:
            self._items.remove(item)
            self._box.removeItem(item)

    def plot(self, *data: Any, **options: Any) -> pg.PlotDataItem:
        """Draw a curve with these data and options of :class:`pyqtgraph.PlotDataItem`."""
        curve = pg.PlotDataItem(*data, **options)
        self.addItem(curve)
        return curve

    def setLogMode(self, x: bool, y: bool) -> None:
        """Make the axes logarithmic or linear, with all present and later items.

        A logarithmic axis cannot be dragged to where numbers overflow.
        """
        if (x, y) == self._log:
            return
        self._log = (x, y)
        for item in self._items:
            if hasattr(item, "setLogMode"):
                item.setLogMode(x, y)
        for axis in self._axes.values():
            axis.setLogMode(x, y)
        right, top = MAX_DECADES if x else None, MAX_DECADES if y else None
        self._box.setLimits(xMin=right and -right, xMax=right, yMin=top and -top, yMax=top)
        self._box.enableAutoRange()

    def setRange(self, *ranges: Any, **options: Any) -> None:
        """Set the visible range, see :meth:`pyqtgraph.ViewBox.setRange`."""
        self._box.setRange(*ranges, **options)


DIGITS = (((2, 3, 4, 5, 6, 7, 8, 9), math.log10(10 / 9)), ((2, 5), math.log10(2)), ((3,), math.log10(3)))
"""Leading digits of the numbers at a logarithmic axis, and their smallest distance in decades."""
WIDER = (1, 2, 4, 10)
"""Multiples of the distance of ticks, until their labels have room."""


LAST_LABEL = 12
"""Pixels that the label of the last tick may be behind the end of its axis."""


class FittedAxis(pg.AxisItem):  # type: ignore[misc]
    """An axis whose label fits its length: with a smaller font or elided where the axis is short."""

    _label = ("", "", QFont())
    _shown: tuple[str, float] | None = None
    _tick_font = QFont()

    def __init__(self, orientation: str) -> None:
        super().__init__(orientation)
        self.autoSIPrefix = False
        if orientation == "bottom":
            self.setStyle(hideOverlappingLabels=LAST_LABEL)

    def set_label_text(self, text: str, colour: str, font: QFont) -> None:
        """Label the axis with rich text in a colour, in this font where there is room."""
        self._label, self._shown = (text, colour, font), None
        self._fit()

    def set_tick_font(self, font: QFont) -> None:
        """Font of the tick labels; there are fewer of them if it is large."""
        self._tick_font = font
        self.setTickFont(font)
        self.setTickDensity(min(1.0, DENSE_TICKS_HEIGHT / QFontMetricsF(font).height()))

    def resizeEvent(self, event: QResizeEvent | None = None) -> None:
        self._fit()
        super().resizeEvent(event)

    def updateAutoSIPrefix(self) -> None:
        """Disabled: pyqtgraph multiplies numbers below one by a thousand even if `autoSIPrefix` is off."""

    def tickSpacing(self, low: float, high: float, length: float) -> list[tuple[float, float]]:
        """Spacings and offsets of major and minor ticks, so far apart that labels do not touch."""
        levels: list[tuple[float, float]] = super().tickSpacing(low, high, length)
        if self.orientation in ("left", "right") or self.logMode or not levels or high <= low:
            return levels
        widest = QFontMetricsF(self._tick_font).horizontalAdvance(f"{high:.4g} 0")
        wanted = widest * (high - low) / max(length, 1.0)
        step = next((f for f in WIDER if f * levels[0][0] >= wanted), WIDER[-1])
        return [(step * levels[0][0], levels[0][1]), *levels[1:]]

    def _fit(self) -> None:
        text, colour, font = self._label
        if not text:
            return
        rich, points = fit_text(text, font, self._length() - AXIS_LABEL_MARGIN)
        if (rich, points) != self._shown:
            self._shown = (rich, points)
            self.setLabel(rich, color=colour, **{"font-size": f"{points:.1f}pt"})

    def tickStrings(self, values: Sequence[float], scale: float, spacing: float | None) -> list[str]:
        plain = super().tickStrings(values, scale, spacing)
        if not self.logMode and any("e" in each for each in plain):  # of pyqtgraph: 800000 beside 1e+06
            plain = [_with_exponent(value * scale) for value in values]
        words = [localized(each) for each in plain]
        if not self.logMode or spacing is not None:
            return words
        shown = self._digits_with_room()
        return [
            word if round(10 ** (value % 1.0)) in (1, 10, *shown) else ""
            for word, value in zip(words, values, strict=True)
        ]

    def _digits_with_room(self) -> tuple[int, ...]:
        """Leading digits whose numbers do not touch within a decade of a logarithmic axis."""
        letters = QFontMetricsF(self._tick_font)
        upright = self.orientation in ("left", "right")
        needed = letters.height() if upright else letters.horizontalAdvance("0.0005")
        low, high = self.range
        decade = self._length() / max(high - low, 1e-9)
        return next((digits for digits, gap in DIGITS if gap * decade >= needed), ())

    def _length(self) -> float:
        size = self.size()
        return float(size.height() if self.orientation in ("left", "right") else size.width())


class CountAxis(FittedAxis):
    """An axis with ticks at integers only while :attr:`whole` is set."""

    whole = False

    def tickSpacing(self, low: float, high: float, length: float) -> list[tuple[float, float]]:
        """Spacings and offsets of major and minor ticks, none below one while :attr:`whole` is set."""
        levels: list[tuple[float, float]] = super().tickSpacing(low, high, length)
        if not (self.whole and levels):
            return levels
        return [level for level in levels if level[0] >= 1.0] or [(1.0, 0.0)]


def _with_exponent(value: float) -> str:
    """A number as tables have it: 1.5e6."""
    digits, exponent = f"{value:.5e}".split("e")
    digits = digits.rstrip("0").rstrip(".")
    return f"{digits}e{int(exponent)}" if value else "0"


def fit_text(text: str, font: QFont, width: float) -> tuple[str, float]:
    """Rich text and its size in points, so that it is at most `width` pixels wide if possible.

    A label of which two thirds have no room even in the smallest font becomes its unit in brackets.
    """
    plain, size = plain_text(text), font.pointSizeF()
    smaller = QFont(font)
    while (letters := QFontMetricsF(smaller)).horizontalAdvance(plain + " ") > width:
        if smaller.pointSizeF() - FONT_STEP < MIN_LABEL_SCALE * size:
            left = max(width - letters.horizontalAdvance(" "), 0.0)
            dotted = letters.elidedText(plain, Qt.TextElideMode.ElideRight, left)
            unit = text[text.rfind("[") :] if plain.endswith("]") and 3 * len(dotted) < 2 * len(plain) else ""
            if unit and letters.horizontalAdvance(plain_text(unit) + " ") <= width:
                return fit_text(unit, font, width)
            return html.escape(dotted), smaller.pointSizeF()
        smaller.setPointSizeF(smaller.pointSizeF() - FONT_STEP)
    return text, smaller.pointSizeF()


def legend_text(entries: Iterable[tuple[str, str]]) -> str:
    """A square in each colour and what it stands for, rich text."""
    return "&nbsp;&nbsp; ".join(
        f'<span style="color:{colour}">&#9632;</span>&nbsp;{unbroken(text)}' for colour, text in entries
    )


Numbers = tuple[tuple[str, ...], list[tuple[str | float, ...]]]
"""Column names, and rows."""
READABLE_LINES = 11
"""Height in lines of text below which the numbers of an axis touch."""


class Plot(QWidget):
    """Axes, grid, legend and placeholder; subclasses draw into ``self.canvas``.

    The context menu saves the figure, and its numbers if :meth:`numbers` has any.

    ``x``, ``y``: axis labels with their units. ``placeholder``: shown instead of an empty plot.
    """

    def __init__(self, x: str, y: str, placeholder: str) -> None:
        super().__init__()
        self.theme: Theme = current_theme()
        self._painted: Theme | None = None
        self._labels = (x, y)
        self._point_size, self._min_lines = 0.0, 0
        self._legend_entries: list[tuple[str, str]] = []
        self.count_axis = CountAxis("bottom")
        self.axes = {"bottom": self.count_axis, "left": FittedAxis("left")}
        self.canvas = PlotCanvas(self.axes)
        self.legend = QLabel()
        self.legend.setTextFormat(Qt.TextFormat.RichText)
        self.legend.setWordWrap(True)
        self.hint_label = named(QLabel(), role="hint")
        self._placeholder = named(QLabel(placeholder), role="hint")
        self._placeholder.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._placeholder.setWordWrap(True)
        self._placeholder.setMargin(12)
        self.canvas.scene().sigMouseMoved.connect(self._show_tip)
        self._arrange()
        self.set_theme(self.theme)
        self.set_empty(True)

    def _arrange(self) -> None:
        page = QWidget()
        self._page = page
        vbox(
            hbox((self.legend, 1), self.hint_label, margins=(8, 4, 8, 0), spacing=16),
            (self.canvas, 1),
            parent=page,
            margins=(2, 2, 8, 2),
            spacing=0,
        )
        self._stack = QStackedLayout(self)
        self._stack.addWidget(self._placeholder)
        self._stack.addWidget(page)

    def set_empty(self, empty: bool, placeholder: str = "") -> None:
        """Show the placeholder, with another text if one is given, or the plot."""
        if placeholder:
            self._placeholder.setText(placeholder)
        self._stack.setCurrentIndex(0 if empty else 1)

    def set_hint(self, text: str) -> None:
        """Set the text at the right of the legend, which is hidden where it does not fit."""
        self.hint_label.setText(text)
        self._make_room()

    def hasHeightForWidth(self) -> bool:
        """False: layouts would shrink the widgets beside a plot when its legend wraps."""
        return False

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._make_room()

    def _make_room(self) -> None:
        needed = self._legend_width() + self.hint_label.sizeHint().width() + 40
        self.hint_label.setVisible(needed <= self.width())

    def _legend_width(self) -> int:
        """Width of the legend on a single line; it wraps between entries."""
        metrics = self.legend.fontMetrics()
        words = [plain_text(text) for _, text in self._legend_entries]
        return sum(metrics.horizontalAdvance(f"MM {text}") for text in words)

    def is_empty(self) -> bool:
        return self._stack.currentIndex() == 0

    def set_legend(self, entries: list[tuple[str, str]]) -> None:
        """Set the entries of the legend, pairs of colour and rich text."""
        self._legend_entries = entries
        self.legend.setText(legend_text(entries))
        self._make_room()

    def set_labels(self, x: str, y: str) -> None:
        self._labels = (x, y)
        font = QFont(self.font())
        font.setPointSizeF(font.pointSizeF() - 0.5)
        for side, text in zip(("bottom", "left"), self._labels, strict=True):
            self.axes[side].set_label_text(text, self.theme.muted, font)

    def small_font(self) -> QFont:
        small = QFont(self.font())
        small.setPointSizeF(max(6.0, self.font().pointSizeF() - 1.0))
        return small

    def set_theme(self, theme: Theme) -> None:
        if theme == self._painted:
            return
        self.theme = self._painted = theme
        self.canvas.setBackground(theme.base)
        for axis in self.axes.values():
            axis.setPen(pg.mkPen(theme.border))
            axis.setTextPen(pg.mkPen(theme.muted))
        self.axes["left"].setGrid(70 if theme.dark else 55)
        self._set_fonts()
        self.redraw()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange and self.font().pointSizeF() != self._point_size:
            self._set_fonts()
            self.redraw()

    def fit_to_font(self) -> None:
        """Be at least as high as :data:`READABLE_LINES`, in letters of any size."""
        self._min_lines = READABLE_LINES
        self._set_fonts()

    def _set_fonts(self) -> None:
        """Set the fonts of the axes and the minimum height from the font of the plot."""
        if self._min_lines:
            self.setMinimumHeight(self._min_lines * self.fontMetrics().height())
        self._point_size = self.font().pointSizeF()
        small = self.small_font()
        for axis in self.axes.values():
            axis.set_tick_font(small)
        metrics = QFontMetrics(small)
        self.axes["left"].setWidth(metrics.horizontalAdvance("00.0000") + metrics.height())
        self.set_labels(*self._labels)

    def value_at(self, place: QPointF) -> str:  # noqa: ARG002
        """Tool tip at a position of the scene; empty for none."""
        return ""

    def _show_tip(self, place: QPointF) -> None:
        words = self.value_at(place)
        if self.canvas.toolTip() != words:
            QToolTip.hideText()
            self.canvas.setToolTip(inert(words))

    def redraw(self) -> None:
        """Draw everything again, after the theme has changed."""

    def numbers(self) -> Numbers:
        """The data as a table; no columns if a plot has none."""
        return (), []

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Show :meth:`menu`, unless the plot is empty."""
        if not self.is_empty():
            self.menu().popup(event.globalPos())

    def menu(self) -> QMenu:
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.addAction(
            tr("Save &figure …"), lambda: self._save(tr("Save figure"), FIGURE_WRITERS, self.save_figure)
        )
        if self.numbers()[0]:
            menu.addAction(
                tr("Save &numbers …"), lambda: self._save(tr("Save numbers"), (".csv",), self.save_numbers)
            )
        return menu

    def save_figure(self, path: Path) -> None:
        """Write legend and plot as a PNG, SVG or PDF file."""
        save_figure(self._page, path)

    def save_numbers(self, path: Path) -> None:
        save_numbers(self.accessibleName() or self.objectName(), *self.numbers(), path)

    def _save(self, title: str, endings: Iterable[str], write: Callable[[Path], None]) -> None:
        known = tuple(endings)
        kinds = ";;".join(f"{ending[1:].upper()} (*{ending})" for ending in known)
        name, kind = QFileDialog.getSaveFileName(self, title, str(Path.home() / f"plot{known[0]}"), kinds)
        if not name:
            return
        path = Path(name)
        if path.suffix.lower() not in known:
            path = path.with_name(path.name + "." + kind.partition(" ")[0].lower())
        try:
            write(path)
        except RegolithError as error:
            QMessageBox.warning(self, title, inert(str(error)))

    def pen(self, colour: str, width: float = 1.0, dash: bool = False) -> object:
        style = Qt.PenStyle.DashLine if dash else Qt.PenStyle.SolidLine
        return pg.mkPen(QColor(colour), width=width, style=style)
