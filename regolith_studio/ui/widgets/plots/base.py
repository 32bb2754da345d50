"""A plot with a legend above it, labelled axes, and a sentence where there is nothing to show yet."""

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
from regolith_studio.ui.widgets.labels import unbroken
from regolith_studio.ui.widgets.plots.canvas import CountAxis, FittedAxis, PlotCanvas
from regolith_studio.ui.widgets.plots.export import DRAWN, plain_text, save_figure, save_numbers

Numbers = tuple[tuple[str, ...], list[tuple[str | float, ...]]]
"""Names of columns, and rows."""


class Plot(QWidget):
    """Axes, grid, legend and placeholder; subclasses draw into ``self.canvas``.

    A click with the right button offers to save the figure, and its numbers where :meth:`numbers` has any.

    Parameters
    ----------
    x, y
        Axis labels with their units.
    placeholder
        Shown instead of an empty plot.
    """

    def __init__(self, x: str, y: str, placeholder: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.theme: Theme = current_theme()
        self._painted: Theme | None = None
        self._labels = (x, y)
        self._letters = 0.0
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
        self.canvas.scene().sigMouseMoved.connect(self._point)
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

    def set_empty(self, empty: bool, sentence: str = "") -> None:
        """Show the placeholder, with another sentence if one is given, or the plot."""
        if sentence:
            self._placeholder.setText(sentence)
        self._stack.setCurrentIndex(0 if empty else 1)

    def set_remark(self, text: str) -> None:
        """A few words at the right of the legend; left out where there is no room for them."""
        self.remark.setText(text)
        self._make_room()

    def hasHeightForWidth(self) -> bool:
        """No: its legend wraps, but what stands beside it must not be squeezed for that."""
        return False

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._make_room()

    def _make_room(self) -> None:
        needed = self._legend_width() + self.remark.sizeHint().width() + 40
        self.remark.setVisible(needed <= self.width())

    def _legend_width(self) -> int:
        """Of the legend on one line; it wraps between entries where there is less."""
        metrics = self.legend.fontMetrics()
        words = [plain_text(text) for _, text in self._legend_entries]
        return sum(metrics.horizontalAdvance(f"MM {text}") for text in words)

    def is_empty(self) -> bool:
        """Whether the placeholder is shown."""
        return self._stack.currentIndex() == 0

    def set_legend(self, entries: list[tuple[str, str]]) -> None:
        """Pairs of colour and rich text."""
        self._legend_entries = entries
        self.legend.setText(
            "&nbsp;&nbsp; ".join(
                f'<span style="color:{colour}">&#9632;</span>&nbsp;{unbroken(text)}'
                for colour, text in entries
            )
        )
        self._make_room()

    def set_labels(self, x: str, y: str) -> None:
        """Name the axes anew."""
        self._labels = (x, y)
        font = QFont(self.font())
        font.setPointSizeF(font.pointSizeF() - 0.5)
        for side, text in zip(("bottom", "left"), self._labels, strict=True):
            self.axes[side].set_label_text(text, self.theme.muted, font)

    def small_font(self) -> QFont:
        """Of the numbers at the axes."""
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
        self._take_letters()
        self.redraw()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange and self.font().pointSizeF() != self._letters:
            self._take_letters()
            self.redraw()

    def _take_letters(self) -> None:
        """At the axes, in the size that the plot has."""
        self._letters = self.font().pointSizeF()
        small = self.small_font()
        for axis in self.axes.values():
            axis.set_tick_font(small)
        metrics = QFontMetrics(small)
        self.axes["left"].setWidth(metrics.horizontalAdvance("00.0000") + metrics.height())
        self.set_labels(*self._labels)

    def value_at(self, place: QPointF) -> str:  # noqa: ARG002
        """What is drawn at a place of the scene, in words; empty where there is nothing."""
        return ""

    def _point(self, place: QPointF) -> None:
        words = self.value_at(place)
        if self.canvas.toolTip() != words:
            QToolTip.hideText()
            self.canvas.setToolTip(words)

    def redraw(self) -> None:
        """Draw everything again, because the colours have changed."""

    def numbers(self) -> Numbers:
        """What is drawn, as a table; no columns where a plot cannot say it in numbers."""
        return (), []

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Offer the figure and its numbers as files."""
        if not self.is_empty():
            self.menu().popup(event.globalPos())

    def menu(self) -> QMenu:
        """What can be done with the plot."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.addAction(tr("Save &figure …"), self._ask_for_figure)
        if self.numbers()[0]:
            menu.addAction(tr("Save &numbers …"), self._ask_for_numbers)
        return menu

    def save_figure(self, path: Path) -> None:
        """Write legend and plot as a PNG, SVG or PDF file.

        Raises
        ------
        InputError
            If the ending is another.
        FileError
            If the file cannot be written.
        """
        save_figure(self._page, path)

    def save_numbers(self, path: Path) -> None:
        """Write what is drawn as a CSV file.

        Raises
        ------
        FileError
            If the file cannot be written.
        """
        save_numbers(self.accessibleName() or self.objectName(), *self.numbers(), path)

    def _ask_for_figure(self) -> None:
        self._save(tr("Save figure"), DRAWN, self.save_figure)

    def _ask_for_numbers(self) -> None:
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
            QMessageBox.warning(self, title, str(error))

    def pen(self, colour: str, width: float = 1.0, dash: bool = False) -> object:
        """A line of this colour."""
        style = Qt.PenStyle.DashLine if dash else Qt.PenStyle.SolidLine
        return pg.mkPen(QColor(colour), width=width, style=style)
