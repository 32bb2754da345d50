"""A view with its title above it."""

from PySide6.QtCore import Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from regolith_studio.ui.views.protocol import SceneView
from regolith_studio.ui.widgets.labels import ElidedLabel

_PADDING = 9


class ViewFrame(QFrame):
    """Title, one quiet line, the view.

    Parameters
    ----------
    view
        What is framed.
    name
        Object name, and plain name for screen readers.
    """

    def __init__(self, view: SceneView, name: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(f"view_{name}")
        self.setProperty("role", "card")
        self.view = view
        self._titles = ("", "")
        self._mark = QLabel()
        self._title = QLabel()
        self._title.setTextFormat(Qt.TextFormat.RichText)
        self._title.setProperty("role", "heading")
        self._title.setMinimumWidth(10)
        self.detail = ElidedLabel(role="remark")
        view.widget.setObjectName(f"scene_{name}")
        row = QHBoxLayout()
        row.setContentsMargins(_PADDING, 6, _PADDING, 0)
        row.setSpacing(5)
        row.addWidget(self._mark)
        row.addWidget(self._title, 1)
        under = QHBoxLayout()
        under.setContentsMargins(_PADDING, 0, _PADDING, 4)
        under.addWidget(self.detail)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(1, 1, 1, 1)
        layout.setSpacing(0)
        layout.addLayout(row)
        layout.addLayout(under)
        layout.addWidget(view.widget, 1)

    def set_colour(self, colour: str) -> None:
        """Colour of the mark before the title: the same as in the plots."""
        self._mark.setText(f'<span style="color:{colour}">&#9632;</span>')

    def set_texts(self, title: str, detail: str = "", short: str = "") -> None:
        """Title as rich text, the quiet line, and a title for views too narrow for the first one."""
        self._titles = (title, short or title)
        self._choose_title()
        self.detail.setText(detail)
        self.view.widget.setAccessibleName(f"{title}. {detail}")

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._choose_title()

    def _choose_title(self) -> None:
        room = self.width() - 2 * _PADDING - 8 - self._mark.sizeHint().width()
        for title in self._titles:
            self._title.setText(title)
            if self._title.sizeHint().width() <= room:
                return
