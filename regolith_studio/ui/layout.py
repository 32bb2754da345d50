"""Names of widgets, boxes, splitters, scroll areas, tabs, and sections that fold."""

from collections.abc import Sequence
from typing import TypeVar

from PySide6.QtCore import QEvent, QObject, QSize, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QBoxLayout,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QFrame,
    QHBoxLayout,
    QLayout,
    QScrollArea,
    QSizePolicy,
    QSplitter,
    QTabWidget,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

Part = QWidget | QLayout | int | None
STRETCH = None
"""Among the parts of a box: room that is left."""
W = TypeVar("W", bound=QWidget)


def named(widget: W, name: str = "", spoken: str = "", tip: str = "", role: str = "") -> W:
    """A widget with its object name, accessible name, tool tip, and role in the style sheet."""
    if name:
        widget.setObjectName(name)
    if spoken:
        widget.setAccessibleName(spoken)
    if tip:
        widget.setToolTip(tip)
    if role:
        widget.setProperty("role", role)
    return widget


Margins = tuple[int, int, int, int] | None
"""At the left, top, right and bottom in pixels; those of the style for none."""


def vbox(
    *parts: Part | tuple[Part, int],
    parent: QWidget | None = None,
    margins: Margins = (0, 0, 0, 0),
    spacing: int = -1,
) -> QVBoxLayout:
    """Parts below each other: widgets and layouts, also with their stretch, pixels, or :data:`STRETCH`."""
    return _filled(QVBoxLayout(parent) if parent else QVBoxLayout(), parts, margins, spacing)


def hbox(
    *parts: Part | tuple[Part, int],
    parent: QWidget | None = None,
    margins: Margins = (0, 0, 0, 0),
    spacing: int = -1,
) -> QHBoxLayout:
    """Parts beside each other, as :func:`vbox`."""
    return _filled(QHBoxLayout(parent) if parent else QHBoxLayout(), parts, margins, spacing)


Box = TypeVar("Box", bound=QBoxLayout)


def _filled(box: Box, parts: Sequence[Part | tuple[Part, int]], margins: Margins, spacing: int) -> Box:
    if margins is not None:
        box.setContentsMargins(*margins)
    if spacing >= 0:
        box.setSpacing(spacing)
    for each in parts:
        part, stretch = each if isinstance(each, tuple) else (each, 0)
        match part:
            case QWidget():
                box.addWidget(part, stretch)
            case QLayout():
                box.addLayout(part, stretch)
            case int():
                box.addSpacing(part)
            case None:
                box.addStretch(1)
    return box


class Collapsible(QWidget):
    """A button with an arrow, and parts below each other that it shows or hides; collapsed at first."""

    def __init__(self, title: str, *parts: QWidget) -> None:
        super().__init__()
        self.content = QWidget()
        vbox(*parts, parent=self.content)
        self.button = QToolButton()
        self.button.setText(title)
        self.button.setCheckable(True)
        self.button.setAutoRaise(True)
        self.button.setProperty("role", "fold")
        self.button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.button.setAccessibleName(title)
        vbox(self.button, self.content, parent=self, spacing=4)
        self.button.toggled.connect(self.set_open)
        self.set_open(False)

    def set_open(self, is_open: bool) -> None:
        self.button.setChecked(is_open)
        self.button.setArrowType(Qt.ArrowType.DownArrow if is_open else Qt.ArrowType.RightArrow)
        self.content.setVisible(is_open)


FRAME = QSize(8, 40)
"""Pixels that window managers add to the size of a window for its title and borders, at most."""


def room_on_screen(window: QWidget) -> QSize:
    """Largest size of the window's content with which its frame is on the screen."""
    return window.screen().availableSize() - FRAME


class GrowingDialog(QDialog):
    """A dialog that becomes higher where its texts do: Qt would squeeze its fields and cut the texts."""

    def event(self, event: QEvent) -> bool:
        if event.type() != QEvent.Type.LayoutRequest:
            return super().event(event)  # which deletes the dialog when its time has come
        handled = super().event(event)
        layout = self.layout()
        if layout is not None and layout.hasHeightForWidth():
            self.resize(self.width(), max(self.height(), layout.totalHeightForWidth(self.width())))
        return handled


def control_row(*parts: QWidget, margins: tuple[int, int, int, int] = (0, 0, 0, 0)) -> QWidget:
    """Controls beside each other; combo boxes take the room that is left, and elide where there is none."""
    made = QWidget()
    hbox(*((part, int(isinstance(part, QComboBox))) for part in parts), parent=made, margins=margins)
    return made


def left_aligned(part: QWidget) -> QWidget:
    """A part at the left of what room there is, as wide as it needs."""
    made = QWidget()
    hbox(part, STRETCH, parent=made)
    return made


def dialog_buttons(dialog: QDialog, *accepting: QDialogButtonBox.StandardButton) -> QDialogButtonBox:
    """The buttons below a dialog: those that accept it with Cancel, or Close alone."""
    box = QDialogButtonBox()  # its layout adds it after what is above, so that the focus begins there
    kinds = QDialogButtonBox.StandardButton
    for kind in (*accepting, kinds.Cancel) if accepting else (kinds.Close,):
        box.addButton(kind)
    if accepting:  # else Return is Cancel's, which gets the focus while what accepts is disabled
        box.button(kinds.Cancel).setAutoDefault(False)
    box.accepted.connect(dialog.accept)
    box.rejected.connect(dialog.reject)
    return box


CONTROLS_WIDTH = 290
STANDARD_SIZES = "standard_sizes"
"""Property of a splitter: the sizes of its parts in a new window."""


def splitter(direction: Qt.Orientation, parts: Sequence[QWidget], sizes: Sequence[int]) -> QSplitter:
    """Parts in a row or column with movable borders, their first sizes, and no stretch yet."""
    made = QSplitter(direction)
    made.setChildrenCollapsible(False)
    made.setHandleWidth(7)
    for part in parts:
        made.addWidget(part)
    made.setSizes(list(sizes))
    made.setProperty(STANDARD_SIZES, list(sizes))
    return made


def restore_borders(root: QWidget) -> None:
    """Give the borders between the parts in a widget the places of a new window."""
    for layout in root.findChildren(QLayout):
        layout.invalidate()  # its minimum width may still be that of another font
    for splitter in root.findChildren(QSplitter):
        splitter.setSizes(splitter.property(STANDARD_SIZES) or [1000] * splitter.count())


def side_by_side(parts: Sequence[QWidget], sizes: Sequence[int], stretch: int) -> QSplitter:
    """Parts in a row with movable borders; the one numbered `stretch` takes what room is left."""
    made = splitter(Qt.Orientation.Horizontal, parts, sizes)
    made.setStretchFactor(stretch, 1)
    return made


class FoldingSplitter(QSplitter):
    """Results and their controls, below each other where they have no room side by side.

    A column of controls is shown whole below its results, and a column in controls wherever the page scrolls
    anyway: two scroll bars beside each other would both be needed to see the last of them.
    """

    def __init__(self, results: QWidget, controls: QWidget, sizes: Sequence[int]) -> None:
        super().__init__(Qt.Orientation.Horizontal)
        self._results, self._controls = results, controls
        self.setChildrenCollapsible(False)
        self.setHandleWidth(7)
        for part in (results, controls):
            self.addWidget(part)
        self.setStretchFactor(0, 1)
        self.setSizes(list(sizes))
        self.setProperty(STANDARD_SIZES, list(sizes))
        self._beside = self.saveState()
        """The border between the parts when they were last side by side."""

    def minimumSizeHint(self) -> QSize:
        """As narrow as the wider part: the other one goes below it."""
        hint = super().minimumSizeHint()
        parts = self._results.minimumSizeHint(), self._controls.minimumSizeHint()
        return QSize(max(part.width() for part in parts), hint.height())

    def fold(self, room: QSize) -> None:
        """Place the parts for a page that is shown in so much room."""
        results, controls = self._results.minimumSizeHint(), self._controls.minimumSizeHint()
        below = results.width() + self.handleWidth() + controls.width() > room.width()
        for column in self._controls.findChildren(_Column):
            column.set_whole(below or results.height() > room.height())
        if isinstance(self._controls, _Column):  # beside results it scrolls alone: they stay in sight
            self._controls.set_whole(below)
        stacked = self.orientation() == Qt.Orientation.Vertical
        if below and not stacked:
            self._beside = self.saveState()
            self.setOrientation(Qt.Orientation.Vertical)
            self.setSizes(self.property(STANDARD_SIZES))
        elif stacked and not below:
            self.restoreState(self._beside)


def stacked(parts: Sequence[QWidget], sizes: Sequence[int], stretch: int) -> QSplitter:
    made = splitter(Qt.Orientation.Vertical, parts, sizes)
    made.setStretchFactor(stretch, 1)
    return made


def equal_parts(direction: Qt.Orientation, parts: Sequence[QWidget]) -> QSplitter:
    """Parts of the same size with movable borders, which all take their share of what room is left."""
    made = splitter(direction, parts, [1000] * len(parts))
    for number in range(len(parts)):
        made.setStretchFactor(number, 1)
    return made


def tabs(name: str, pages: Sequence[tuple[QWidget, str]]) -> QTabWidget:
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


def scrolled_column(panels: Sequence[QWidget]) -> QScrollArea:
    """Panels below each other, with a scroll bar where they do not fit.

    Without the scroll bar its room stays empty, so that no panel changes its width when it comes or goes.
    """
    inside = QWidget()
    column = vbox(*panels, STRETCH, parent=inside, spacing=8)
    area = _Column(CONTROLS_WIDTH - 30)
    bar = area.verticalScrollBar()

    def keep_width(_low: int, high: int) -> None:
        column.setContentsMargins(4, 8, 4 if high else 4 + bar.sizeHint().width(), 4)

    bar.rangeChanged.connect(keep_width)
    keep_width(0, 0)
    area.setObjectName("controls")
    area.setWidgetResizable(True)
    area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    area.setWidget(inside)
    area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    return area


def scrolled(part: QWidget, *, whole_width: bool = False) -> QScrollArea:
    """A part on the ground of its place, with a scroll bar at its right where it is higher than that."""
    area = _Column(0) if whole_width else QScrollArea()
    area.setWidgetResizable(True)
    area.setFrameShape(QScrollArea.Shape.NoFrame)
    area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    area.setWidget(part)
    for each in (area.viewport(), part):  # QScrollArea has set it
        each.setAutoFillBackground(False)
    return area


class _Column(QScrollArea):
    """A column as wide as its content needs, in any language and font size.

    ``whole``: whether it is as high as its content too, because what it is in scrolls.
    """

    def __init__(self, least: int) -> None:
        super().__init__()
        self._least = least
        self.whole = False

    def minimumSizeHint(self) -> QSize:
        inside = self.widget()
        needed = inside.minimumSizeHint().width() if inside is not None else 0
        bar = self.verticalScrollBar().sizeHint().width()
        high = 0
        if inside is not None and self.whole:
            high = max(inside.minimumSizeHint().height(), inside.heightForWidth(self.viewport().width()))
        return QSize(max(self._least, needed + bar), max(high, super().minimumSizeHint().height()))

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if self.whole and event.size().width() != event.oldSize().width():
            self.updateGeometry()  # texts take other numbers of lines

    def set_whole(self, whole: bool) -> None:
        if whole != self.whole:
            self.whole = whole
            self.updateGeometry()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.LayoutRequest:
            self.updateGeometry()
        return super().eventFilter(watched, event)


def framed(part: QWidget) -> QFrame:
    """A part in a frame, as the views beside it have one."""
    frame = named(QFrame(), role="card")
    vbox(part, parent=frame, margins=(8, 6, 8, 4))
    return frame


def padded(part: QWidget, left: int, top: int, right: int, bottom: int) -> QWidget:
    frame = QWidget()
    vbox(part, parent=frame, margins=(left, top, right, bottom))
    return frame
