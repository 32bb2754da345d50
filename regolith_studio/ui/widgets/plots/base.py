"""Base class of plots: labelled axes, legend, placeholder, and a menu that saves figure and numbers."""

from collections.abc import Callable, Iterable
from pathlib import Path

import pyqtgraph as pg
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QColor, QContextMenuEvent, QFont, QFontMetrics, QResizeEvent
from PySide6.QtWidgets import (
    QFileDialog,
    QHBoxLayout,
    QLabel,
    QMenu,
    QMessageBox,
    QStackedLayout,
    QToolTip,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.errors import RegolithError
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import tr
from regolith_studio.ui.translation.plain_text import inert
from regolith_studio.ui.widgets.labels import unbroken
from regolith_studio.ui.widgets.plots.canvas import CountAxis, FittedAxis, PlotCanvas
from regolith_studio.ui.widgets.plots.export import FIGURE_WRITERS, plain_text, save_figure, save_numbers

Numbers = tuple[tuple[str, ...], list[tuple[str | float, ...]]]
"""Column names, and rows."""
READABLE_LINES = 11
"""Height in lines of text below which the numbers of an axis touch."""


class Plot(QWidget):
    """Axes, grid, legend and placeholder; subclasses draw into ``self.canvas``.

    The context menu saves the figure, and its numbers if :meth:`numbers` has any.

    Parameters
    ----------
    x, y
        Axis labels with their units.
    placeholder
        Shown instead of an empty plot.
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
        self.remark = QLabel()
        self.remark.setProperty("role", "remark")
        self._placeholder = QLabel(placeholder)
        self._placeholder.setProperty("role", "remark")
        self._placeholder.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._placeholder.setWordWrap(True)
        self._placeholder.setMargin(12)
        self.canvas.scene().sigMouseMoved.connect(self._show_tip)
        self._arrange()
        self.set_theme(self.theme)
        self.set_empty(True)

    def _arrange(self) -> None:
        top = QHBoxLayout()
        top.setContentsMargins(8, 4, 8, 0)
        top.setSpacing(16)
        top.addWidget(self.legend, 1)
        top.addWidget(self.remark)
        page = QWidget()
        self._page = page
        column = QVBoxLayout(page)
        column.setContentsMargins(2, 2, 8, 2)
        column.setSpacing(0)
        column.addLayout(top)
        column.addWidget(self.canvas, 1)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(self._placeholder)
        self._stack.addWidget(page)

    def set_empty(self, empty: bool, placeholder: str = "") -> None:
        """Show the placeholder, with another text if one is given, or the plot."""
        if placeholder:
            self._placeholder.setText(placeholder)
        self._stack.setCurrentIndex(0 if empty else 1)

    def set_remark(self, text: str) -> None:
        """Set the text at the right of the legend, which is hidden where it does not fit."""
        self.remark.setText(text)
        self._make_room()

    def hasHeightForWidth(self) -> bool:
        """False: layouts would shrink the widgets beside a plot when its legend wraps."""
        return False

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._make_room()

    def _make_room(self) -> None:
        needed = self._legend_width() + self.remark.sizeHint().width() + 40
        self.remark.setVisible(needed <= self.width())

    def _legend_width(self) -> int:
        """Width of the legend on a single line; it wraps between entries."""
        metrics = self.legend.fontMetrics()
        words = [plain_text(text) for _, text in self._legend_entries]
        return sum(metrics.horizontalAdvance(f"MM {text}") for text in words)

    def is_empty(self) -> bool:
        """Whether the placeholder is shown."""
        return self._stack.currentIndex() == 0

    def set_legend(self, entries: list[tuple[str, str]]) -> None:
        """Set the entries of the legend, pairs of colour and rich text."""
        self._legend_entries = entries
        self.legend.setText(
            "&nbsp;&nbsp; ".join(
                f'<span style="color:{colour}">&#9632;</span>&nbsp;{unbroken(text)}'
                for colour, text in entries
            )
        )
        self._make_room()

    def set_labels(self, x: str, y: str) -> None:
        """Set the labels of the axes."""
        self._labels = (x, y)
        font = QFont(self.font())
        font.setPointSizeF(font.pointSizeF() - 0.5)
        for side, text in zip(("bottom", "left"), self._labels, strict=True):
            self.axes[side].set_label_text(text, self.theme.muted, font)

    def small_font(self) -> QFont:
        """Font of the tick labels."""
        small = QFont(self.font())
        small.setPointSizeF(max(6.0, self.font().pointSizeF() - 1.0))
        return small

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
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

    def keep_readable(self) -> None:
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
        """The context menu."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.addAction(tr("Save &figure …"), self._choose_figure_file)
        if self.numbers()[0]:
            menu.addAction(tr("Save &numbers …"), self._choose_numbers_file)
        return menu

    def save_figure(self, path: Path) -> None:
        """Write legend and plot as a PNG, SVG or PDF file.

        Raises
        ------
        InputError
            If the suffix is another.
        FileError
            If the file cannot be written.
        """
        save_figure(self._page, path)

    def save_numbers(self, path: Path) -> None:
        """Write the data as a CSV file.

        Raises
        ------
        FileError
            If the file cannot be written.
        """
        save_numbers(self.accessibleName() or self.objectName(), *self.numbers(), path)

    def _choose_figure_file(self) -> None:
        self._save(tr("Save figure"), FIGURE_WRITERS, self.save_figure)

    def _choose_numbers_file(self) -> None:
        self._save(tr("Save numbers"), (".csv",), self.save_numbers)

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
        """A solid or dashed pen."""
        style = Qt.PenStyle.DashLine if dash else Qt.PenStyle.SolidLine
        return pg.mkPen(QColor(colour), width=width, style=style)
