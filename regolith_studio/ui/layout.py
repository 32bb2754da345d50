"""Splitters, scroll areas, tabs, sections that fold, and rows that wrap."""

from collections.abc import Callable, Sequence

from PySide6.QtCore import QEvent, QObject, QSize, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QBoxLayout,
    QComboBox,
    QHBoxLayout,
    QScrollArea,
    QSizePolicy,
    QSplitter,
    QTabWidget,
    QToolButton,
    QVBoxLayout,
    QWidget,
)


class Collapsible(QWidget):
    """A button with an arrow, and parts below each other that it shows or hides; collapsed at first."""

    def __init__(self, title: str, *parts: QWidget) -> None:
        super().__init__()
        self.content = QWidget()
        column = QVBoxLayout(self.content)
        column.setContentsMargins(0, 0, 0, 0)
        for part in parts:
            column.addWidget(part)
        self.button = QToolButton()
        self.button.setText(title)
        self.button.setCheckable(True)
        self.button.setAutoRaise(True)
        self.button.setProperty("role", "fold")
        self.button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.button.setAccessibleName(title)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        layout.addWidget(self.button)
        layout.addWidget(self.content)
        self.button.toggled.connect(self.set_open)
        self.set_open(False)

    def set_open(self, is_open: bool) -> None:
        """Expand or collapse."""
        self.button.setChecked(is_open)
        self.button.setArrowType(Qt.ArrowType.DownArrow if is_open else Qt.ArrowType.RightArrow)
        self.content.setVisible(is_open)


class WrappingRow(QWidget):
    """Two groups of controls in a row, or below each other where the row is too narrow.

    Parameters
    ----------
    first, last
        Combo boxes among them stretch.
    margins
        Left, top, right, bottom.
    """

    def __init__(
        self, first: Sequence[QWidget], last: Sequence[QWidget], margins: tuple[int, int, int, int]
    ) -> None:
        super().__init__()
        self._box = QBoxLayout(QBoxLayout.Direction.LeftToRight, self)
        self._box.setContentsMargins(*margins)
        self._parts = [QHBoxLayout(), QHBoxLayout()]
        for part, row in zip((first, last), self._parts, strict=True):
            for each in part:
                row.addWidget(each, int(isinstance(each, QComboBox)))
        self._box.addLayout(self._parts[0], 1)
        self._box.addLayout(self._parts[1])
        self._box.setAlignment(self._parts[1], Qt.AlignmentFlag.AlignLeft)

    def minimumSizeHint(self) -> QSize:
        least, margins = [part.minimumSize().width() for part in self._parts], self._box.contentsMargins()
        return QSize(max(least) + margins.left() + margins.right(), super().minimumSizeHint().height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        margins = self._box.contentsMargins()
        needed = sum(part.sizeHint().width() for part in self._parts) + self._box.spacing()
        narrow = self.width() < needed + margins.left() + margins.right()
        way = QBoxLayout.Direction
        self._box.setDirection(way.TopToBottom if narrow else way.LeftToRight)


CONTROLS_WIDTH = 290
MAX_FIXED = 0.55
"""Largest share of a row that parts which do not stretch take when letters grow."""


class Splitter(QSplitter):
    """Parts with movable borders, which can go back to where they stood at first.

    Parameters
    ----------
    direction
        Of the row or column.
    parts, sizes
        With their sizes at first.
    stretch
        Number of the part that takes what room is left.

    Attributes
    ----------
    fit
        Where given, places the borders for the present size and letters, until the user moves one.
    moved
        Whether the user has moved a border.
    """

    def __init__(
        self, direction: Qt.Orientation, parts: Sequence[QWidget], sizes: Sequence[int], stretch: int
    ) -> None:
        super().__init__(direction)
        self._standard = list(sizes)
        self.fit: Callable[[], None] | None = None
        self.moved = False
        self._unscaled: tuple[float, list[int]] | None = None
        self._scaled: list[int] = []
        self.splitterMoved.connect(self._note_move)
        self.setChildrenCollapsible(False)
        self.setHandleWidth(7)
        for number, part in enumerate(parts):
            self.addWidget(part)
            self.setStretchFactor(number, 1 if number == stretch else 0)
        self._parts = tuple(parts)
        self.setSizes(self._standard)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if self.fit is not None and not self.moved:
            self.fit()

    def event(self, event: QEvent) -> bool:
        done = super().event(event)
        if (
            event.type() == QEvent.Type.LayoutRequest
        ):  # the parts learn their sizes some time after the letters
            if self.fit is not None and not self.moved:
                self.fit()
            elif self._scaled:
                self._place(self._scaled)
        return done

    def restore_standard(self) -> None:
        """Put the borders where they stood at first."""
        self.moved, self._unscaled, self._scaled = False, None, []
        if self.fit is not None:
            self.fit()
        else:
            self._place(self._standard)

    def scale_fixed(self, before: float, after: float) -> None:
        """Scale the parts that do not stretch with letters of other points; back again, as before.

        They take at most :data:`MAX_FIXED` of the room, where they did so before.
        """
        if self.fit is not None and not self.moved:
            return
        points, sizes = self._unscaled = self._unscaled or (before, self.sizes())
        factor = after / points
        if (fixed := sum(s for number, s in enumerate(sizes) if not self._stretches(number))) < sum(sizes):
            factor = min(factor, max(1.0, MAX_FIXED * sum(self.sizes()) / max(1, fixed)))
        self._scaled = [round(factor * size) for size in sizes]
        self._place(self._scaled)

    def _note_move(self) -> None:
        self.moved, self._unscaled, self._scaled = True, None, []

    def _place(self, sizes: Sequence[int]) -> None:
        """Set the sizes of the fixed parts; the others share the rest."""
        stretched = [number for number in range(self.count()) if self._stretches(number)]
        fixed = sum(size for number, size in enumerate(sizes) if number not in stretched)
        rest = max(1, sum(self.sizes()) - fixed) / max(1, sum(sizes[number] for number in stretched))
        self.setSizes(
            [round(rest * size) if number in stretched else size for number, size in enumerate(sizes)]
        )

    def _stretches(self, number: int) -> bool:
        policy = self._parts[number].sizePolicy()
        across = self.orientation() is Qt.Orientation.Horizontal
        return bool(policy.horizontalStretch() if across else policy.verticalStretch())


def scale_borders(root: QWidget, before: float, after: float) -> None:
    """Scale what does not stretch in all splitters, as letters of other points need it."""
    if before != after:
        for splitter in root.findChildren(Splitter):
            splitter.scale_fixed(before, after)


def side_by_side(parts: Sequence[QWidget], sizes: Sequence[int], stretch: int) -> Splitter:
    """Parts in a row with movable borders; the one numbered `stretch` takes what room is left."""
    return Splitter(Qt.Orientation.Horizontal, parts, sizes, stretch)


def stacked(parts: Sequence[QWidget], sizes: Sequence[int], stretch: int) -> Splitter:
    """Parts in a column with movable borders."""
    return Splitter(Qt.Orientation.Vertical, parts, sizes, stretch)


def equal_parts(direction: Qt.Orientation, parts: Sequence[QWidget]) -> Splitter:
    """Parts of the same size with movable borders, which all take their share of what room is left."""
    made = Splitter(direction, parts, [1000] * len(parts), 0)
    for number in range(len(parts)):
        made.setStretchFactor(number, 1)
    return made


def tabs(name: str, pages: Sequence[tuple[QWidget, str]]) -> QTabWidget:
    """Pages of which one is seen."""
    made = QTabWidget()
    made.setObjectName(name)
    made.setMinimumHeight(120)
    made.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Ignored)
    for page, title in pages:
        made.addTab(page, title)
    name_tabs(made)
    return made


def name_tabs(made: QTabWidget) -> None:
    """Name the bar of tabs by its titles for programs that read the screen aloud."""
    made.tabBar().setAccessibleName(", ".join(map(made.tabText, range(made.count()))))


def scrolled_column(panels: Sequence[QWidget], least: int = CONTROLS_WIDTH - 30) -> QScrollArea:
    """Panels below each other, with a scroll bar where they do not fit; at least so many pixels wide."""
    inside = QWidget()
    column = QVBoxLayout(inside)
    column.setSpacing(12)
    column.setContentsMargins(4, 8, 12, 6)
    for panel in panels:
        column.addWidget(panel)
    column.addStretch(1)
    area = _Column(least)
    area.setObjectName("controls")
    area.setWidgetResizable(True)
    area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    area.setWidget(inside)
    area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    return area


def scrolled(part: QWidget) -> QScrollArea:
    """A part on the ground of its place, with a scroll bar at its right where it is higher than that."""
    area = QScrollArea()
    area.setWidgetResizable(True)
    area.setFrameShape(QScrollArea.Shape.NoFrame)
    area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    area.setWidget(part)
    for each in (area.viewport(), part):  # QScrollArea has set it
        each.setAutoFillBackground(False)
    return area


class _Column(QScrollArea):
    """A column as wide as its content needs, in any language and font size."""

    def __init__(self, least: int) -> None:
        super().__init__()
        self._least = least

    def minimumSizeHint(self) -> QSize:
        inside = self.widget()
        needed = inside.minimumSizeHint().width() if inside is not None else 0
        bar = self.verticalScrollBar().sizeHint().width()
        return QSize(max(self._least, needed + bar), super().minimumSizeHint().height())

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.LayoutRequest:
            self.updateGeometry()
        return super().eventFilter(watched, event)


def padded(part: QWidget, left: int, top: int, right: int, bottom: int) -> QWidget:
    """A part with room around it."""
    frame = QWidget()
    layout = QVBoxLayout(frame)
    layout.setContentsMargins(left, top, right, bottom)
    layout.addWidget(part)
    return frame
