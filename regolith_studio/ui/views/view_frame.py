"""A view with its title above it."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from regolith_studio.ui.views.protocol import SceneView
from regolith_studio.ui.widgets.labels import ElidedLabel


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
        self._mark = QLabel()
        self._title = QLabel()
        self._title.setTextFormat(Qt.TextFormat.RichText)
        self._title.setProperty("role", "heading")
        self._title.setMinimumWidth(10)
        self.detail = ElidedLabel(role="remark")
        view.widget.setObjectName(f"scene_{name}")
        row = QHBoxLayout()
        row.setContentsMargins(9, 6, 9, 0)
        row.setSpacing(5)
        row.addWidget(self._mark)
        row.addWidget(self._title, 1)
        under = QHBoxLayout()
        under.setContentsMargins(9, 0, 9, 4)
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

    def set_texts(self, title: str, detail: str = "") -> None:
        """Title as rich text, and the quiet line."""
        self._title.setText(title)
        self.detail.setText(detail)
        self.view.widget.setAccessibleName(f"{title}. {detail}")
