"""A plot with a legend above it, labelled axes, and a sentence where there is nothing to show yet."""

import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QFont, QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QStackedLayout, QVBoxLayout, QWidget

from regolith_studio.ui.theme import Theme, current_theme


class Plot(QWidget):
    """Axes, grid, legend and placeholder; subclasses draw into ``self.canvas``.

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
        self._labels = (x, y)
        self._legend_entries: list[tuple[str, str]] = []
        self.canvas = pg.PlotWidget(background=None)
        self.canvas.setFrameShape(self.canvas.Shape.NoFrame)
        self.canvas.setMenuEnabled(False)
        self.canvas.setMouseEnabled(x=False, y=False)
        self.canvas.hideButtons()
        self.canvas.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.legend = QLabel()
        self.legend.setTextFormat(Qt.TextFormat.RichText)
        self.remark = QLabel()
        self.remark.setProperty("role", "remark")
        self._placeholder = QLabel(placeholder)
        self._placeholder.setProperty("role", "remark")
        self._placeholder.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._placeholder.setWordWrap(True)
        self._arrange()
        self.set_theme(self.theme)
        self.set_empty(True)

    def _arrange(self) -> None:
        top = QHBoxLayout()
        top.setContentsMargins(8, 4, 8, 0)
        top.setSpacing(16)
        top.addWidget(self.legend)
        top.addStretch(1)
        top.addWidget(self.remark)
        page = QWidget()
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

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._make_room()

    def _make_room(self) -> None:
        needed = self.legend.sizeHint().width() + self.remark.sizeHint().width() + 40
        self.remark.setVisible(needed <= self.width())

    def is_empty(self) -> bool:
        """Whether the placeholder is shown."""
        return self._stack.currentIndex() == 0

    def set_legend(self, entries: list[tuple[str, str]]) -> None:
        """Pairs of colour and rich text."""
        self._legend_entries = entries
        self.legend.setText(
            "&nbsp;&nbsp;&nbsp;".join(
                f'<span style="color:{colour}">&#9632;</span>&nbsp;{text}' for colour, text in entries
            )
        )
        self._make_room()

    def set_labels(self, x: str, y: str) -> None:
        """Name the axes anew."""
        self._labels = (x, y)
        style = {"color": self.theme.muted, "font-size": f"{self.font().pointSizeF() - 0.5:.1f}pt"}
        for side, text in zip(("bottom", "left"), self._labels, strict=True):
            self.canvas.setLabel(side, text, **style)

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self.theme = theme
        self.canvas.setBackground(theme.base)
        small = QFont(self.font())
        small.setPointSizeF(max(6.0, self.font().pointSizeF() - 1.0))
        for side in ("bottom", "left"):
            axis = self.canvas.getAxis(side)
            axis.setPen(pg.mkPen(theme.border))
            axis.setTextPen(pg.mkPen(theme.muted))
            axis.setTickFont(small)
            axis.enableAutoSIPrefix(False)
        self.canvas.getAxis("left").setWidth(58)
        self.canvas.getAxis("left").setGrid(70 if theme.dark else 55)
        self.set_labels(*self._labels)
        self.redraw()

    def redraw(self) -> None:
        """Draw everything again, because the colours have changed."""

    def pen(self, colour: str, width: float = 1.0, dash: bool = False) -> object:
        """A line of this colour."""
        style = Qt.PenStyle.DashLine if dash else Qt.PenStyle.SolidLine
        return pg.mkPen(QColor(colour), width=width, style=style)
