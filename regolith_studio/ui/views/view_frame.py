"""A view with its title above it."""

import html
from collections.abc import Mapping

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QMouseEvent, QResizeEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QVBoxLayout

from regolith_studio.ui.keyboard import FOCUSED
from regolith_studio.ui.theme import Theme
from regolith_studio.ui.translation import tr
from regolith_studio.ui.views.view import SceneView
from regolith_studio.ui.widgets.combo_box import ChoiceBox
from regolith_studio.ui.widgets.labels import ElidedLabel
from regolith_studio.ui.widgets.plots.export import plain_text

_PADDING = 9
_BESIDE = 8
"""Pixels of the frame and beside the box of partners."""


class ViewFrame(QFrame):
    """Title, a line of details and the view; a double click on the title enlarges it.

    - ``view``: what is framed.
    - ``name``: object name, and plain name for screen readers.
    - ``partners``: what it can be compared with, by key; the box is shown when :meth:`set_comparing` says
      so.
    - ``compare``: what the box asks, for screen readers.
    - ``colour``: field of :class:`Theme` with the colour of the mark before the title: the same as in the
      plots.
    """

    partnerChanged = Signal(str)  # noqa: N815
    enlargeRequested = Signal()  # noqa: N815

    def __init__(
        self,
        view: SceneView,
        name: str,
        partners: Mapping[str, str] | None = None,
        compare: str = "",
        colour: str = "",
    ) -> None:
        super().__init__()
        self._colour = colour
        self.setObjectName(f"view_{name}")
        self.setProperty("role", "card")
        self.view = view
        self._titles: tuple[str, ...] = ("",)
        self._detail = ""
        self._mark = QLabel()
        self._mark.hide()
        self._title = QLabel()
        self._title.setTextFormat(Qt.TextFormat.RichText)
        self._title.setProperty("role", "heading")
        self._title.setMinimumWidth(10)
        self._title.setObjectName(f"title_{name}")
        self.detail = ElidedLabel(role="hint")
        self.partner = ChoiceBox(f"partner_{name}", tr(compare), partners or {})
        self.partner.setMinimumContentsLength(7)
        self.partner.prefers_whole = True
        self.partner.setToolTip(tr("Second surface: overlaid, or right of the line"))
        self.partner.currentIndexChanged.connect(lambda _: self.partnerChanged.emit(self.partner.value()))
        self.partner.hide()
        view.widget.setObjectName(f"scene_{name}")
        self._arrange()
        self.setProperty(FOCUSED, False)

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self.view.set_surroundings(theme.surroundings)
        if self._colour:
            self._mark.setText(f'<span style="color:{getattr(theme, self._colour)}">&#9632;</span>')
            self._mark.show()

    def set_texts(self, title: str, detail: str = "", *shorter: str) -> None:
        """Title as rich text, the quiet line, and titles for views too narrow for the first one."""
        self._titles = (title, *shorter)
        self._choose_title()
        self.set_detail(detail)
        self.view.widget.setAccessibleName(f"{title}. {detail}")

    @property
    def title(self) -> str:
        """The title in rich text, at its full length."""
        return self._titles[0]

    def set_detail(self, detail: str) -> None:
        """Another quiet line."""
        self._detail = detail
        self.detail.setText(detail)

    def show_status(self, words: str) -> None:
        """Words in place of the quiet line while they last; none bring it back."""
        self.detail.setText(words or self._detail)

    def set_comparing(self, comparing: bool) -> None:
        """Offer the box of partners, or not."""
        self.partner.setVisible(comparing and self.partner.count() > 1)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._choose_title()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        if event.position().y() < self.view.widget.y():
            self.enlargeRequested.emit()
            event.accept()
        else:
            super().mouseDoubleClickEvent(event)

    def _arrange(self) -> None:
        row = QHBoxLayout()
        row.setContentsMargins(_PADDING, 6, _PADDING, 0)
        row.setSpacing(5)
        row.addWidget(self._mark)
        row.addWidget(self._title, 1)
        under = QHBoxLayout()
        under.setContentsMargins(_PADDING, 0, _PADDING, 4)
        under.addWidget(self.detail, 1)
        under.addWidget(self.partner)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(1, 1, 1, 1)
        layout.setSpacing(0)
        layout.addLayout(row)
        layout.addLayout(under)
        layout.addWidget(self.view.widget, 1)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._choose_title()

    def _choose_title(self) -> None:
        """The longest title that there is room for; the shortest with dots where there is none."""
        self._title.ensurePolished()
        self._title.setToolTip(self._titles[0])
        room = self.width() - 2 * _PADDING - 8 - self._mark.sizeHint().width()
        for title in self._titles:
            self._title.setText(title)
            if self._title.sizeHint().width() <= room:
                return
        words = plain_text(self._titles[-1])
        dotted = self._title.fontMetrics().elidedText(words, Qt.TextElideMode.ElideRight, room)
        self._title.setText(html.escape(dotted))
