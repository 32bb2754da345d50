"""The buttons of the pages: icon above text, beside it in a low window, alone where there is least room."""

from collections.abc import Mapping
from functools import partial

from PySide6.QtCore import QEvent, QSize, Qt, Signal
from PySide6.QtGui import QKeySequence, QResizeEvent
from PySide6.QtWidgets import QButtonGroup, QFrame, QSizePolicy, QToolButton, QVBoxLayout

from regolith_studio.ui.icons import icon
from regolith_studio.ui.page import Page
from regolith_studio.ui.shortcuts import with_keys
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import tr

_STYLES = (
    (Qt.ToolButtonStyle.ToolButtonTextUnderIcon, 24),
    (Qt.ToolButtonStyle.ToolButtonTextBesideIcon, 16),
    (Qt.ToolButtonStyle.ToolButtonIconOnly, 18),
)
"""From the most room that the buttons can take to the least, with the size of their icons."""


class Sidebar(QFrame):
    """One button a page, in the order of the pages.

    Parameters
    ----------
    pages
        By key.
    """

    chosen = Signal(str)

    def __init__(self, pages: Mapping[str, Page]) -> None:
        super().__init__()
        self.setObjectName("sidebar")
        self.setProperty("role", "sidebar")
        self._pages = pages
        self._group = QButtonGroup(self)
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(5, 8, 5, 8)
        self._column.setSpacing(3)
        self._heights: tuple[int, ...] = ()
        self._style, self._narrow, self._words_width = 0, False, 0
        self.buttons: dict[str, QToolButton] = {}
        for number, (key, page) in enumerate(pages.items(), start=1):
            button = self.buttons[key] = self._button(page, number)
            self._group.addButton(button)
            self._column.addWidget(button)
        self._column.addStretch(1)
        self._choose(0)

    def set_current(self, key: str) -> None:
        """Check the button of a page; Tab comes to it alone, and the focus follows within the bar."""
        focused = any(button.hasFocus() for button in self.buttons.values())
        for name, button in self.buttons.items():
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus if name == key else Qt.FocusPolicy.NoFocus)
        self.buttons[key].setChecked(True)
        if focused:
            self.buttons[key].setFocus(Qt.FocusReason.OtherFocusReason)

    def width_with_words(self) -> int:
        """Width that the bar needs for the words below the icons."""
        self._needed()
        return self._words_width

    def set_narrow(self, narrow: bool) -> None:
        """Show icons alone, whatever height there is."""
        if narrow != self._narrow:
            self._narrow = narrow
            self._fit()

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        for key, page in self._pages.items():
            self.buttons[key].setIcon(icon(page.icon, theme.text, theme.muted))
        self._measure_again()

    def sizeHint(self) -> QSize:
        return QSize(super().sizeHint().width(), self._needed()[0])

    def minimumSizeHint(self) -> QSize:
        return QSize(super().minimumSizeHint().width(), self._needed()[-1])

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._measure_again()

    def _measure_again(self) -> None:
        self._heights = ()
        self.updateGeometry()
        self._fit()

    def _fit(self) -> None:
        """The most roomy style that fits."""
        if self._narrow:
            self._choose(len(_STYLES) - 1)
            return
        fitting = (at for at, height in enumerate(self._needed()) if height <= self.height())
        self._choose(next(fitting, len(_STYLES) - 1))

    def _needed(self) -> tuple[int, ...]:
        """Height of the buttons in each style."""
        if not self._heights:
            now, heights = self._style, []
            for at in range(len(_STYLES)):
                self._choose(at)
                heights.append(self._height())
            self._heights = tuple(heights)
            self._choose(0)
            margins = self._column.contentsMargins()
            widest = max(button.sizeHint().width() for button in self.buttons.values())
            self._words_width = widest + margins.left() + margins.right()
            self._choose(now)
        return self._heights

    def _height(self) -> int:
        margins, between = self._column.contentsMargins(), self._column.spacing()
        inside = sum(button.sizeHint().height() + between for button in self.buttons.values())
        return inside + margins.top() + margins.bottom()

    def _choose(self, at: int) -> None:
        style, size = _STYLES[at]
        self._style = at
        for button in self.buttons.values():
            button.setToolButtonStyle(style)
            button.setIconSize(QSize(size, size))

    def _button(self, page: Page, number: int) -> QToolButton:
        button = QToolButton()
        button.clicked.connect(partial(self._clicked, page.key))
        button.setObjectName(f"page_{page.key}")
        button.setText(tr(page.title))
        button.setAccessibleName(tr("Page {title}", title=tr(page.title)))
        button.setToolTip(with_keys(tr(page.tip), QKeySequence(f"Alt+{number}")))
        button.setCheckable(True)
        button.setAutoRaise(True)
        button.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        return button

    def _clicked(self, key: str) -> None:
        self.chosen.emit(key)
