"""Thumbnails of the representatives with their weights, drawn while the event loop is idle."""

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QSize, Qt, QTimer
from PySide6.QtWidgets import QLabel, QListView, QListWidget, QListWidgetItem, QVBoxLayout, QWidget

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import heading
from regolith_studio.ui.widgets.thumbnails import Painting, paint_thumbnail

SIZE, CELL = 120, QSize(140, 164)
"""Size of a thumbnail, and of a cell with its caption, in pixels."""


@dataclass(frozen=True)
class GalleryItem:
    """A mesh with caption and tool tip; `coarsened` selects the colour."""

    mesh: Mesh
    caption: str
    tip: str
    coarsened: bool = False


class RepresentativesGallery(QWidget):
    """A list of thumbnails, or a placeholder."""

    def __init__(self) -> None:
        super().__init__()
        self._theme = current_theme()
        self._shown: tuple[GalleryItem, ...] = ()
        self._next = 0
        self._painting: Painting | None = None
        self._timer = QTimer(self, interval=0)
        self._timer.timeout.connect(self._draw_next)
        self.title = heading(tr("Representatives"))
        self.list = QListWidget()
        self.list.setObjectName("dataset_gallery")
        self.list.setAccessibleName(tr("Representative particles"))
        self.list.setViewMode(QListView.ViewMode.IconMode)
        self.list.setResizeMode(QListView.ResizeMode.Adjust)
        self.list.setMovement(QListView.Movement.Static)
        self.list.setIconSize(QSize(SIZE, SIZE))
        self.list.setGridSize(CELL + QSize(4, 4))
        self.list.setTextElideMode(Qt.TextElideMode.ElideMiddle)
        self.list.setFrameShape(self.list.Shape.NoFrame)
        self.empty = QLabel(tr("Press Find representatives to show them here with their weights."))
        self.empty.setProperty("role", "remark")
        self.empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.empty.setWordWrap(True)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 6, 8, 6)
        layout.addWidget(self.title)
        layout.addWidget(self.list, 1)
        layout.addWidget(self.empty, 1)
        self.show_shapes(tr("Representatives"), ())

    @property
    def shown(self) -> tuple[GalleryItem, ...]:
        """The items, in order."""
        return self._shown

    def show_shapes(self, title: str, shown: Sequence[GalleryItem]) -> None:
        """Show other items."""
        self.title.setText(title)
        self._shown = tuple(shown)
        self.list.clear()
        for each in self._shown:
            item = QListWidgetItem(each.caption)
            item.setToolTip(each.tip)
            item.setSizeHint(CELL)
            item.setTextAlignment(Qt.AlignmentFlag.AlignHCenter)
            self.list.addItem(item)
        self.list.setVisible(bool(shown))
        self.empty.setVisible(not shown)
        self._redraw()

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self._theme = theme
        self._redraw()

    def release(self) -> None:
        """Stop drawing."""
        self._timer.stop()
        self._painting = None

    def _redraw(self) -> None:
        self._next, self._painting = 0, None
        if self._shown:
            self._timer.start()

    def _draw_next(self) -> None:
        if self._next >= len(self._shown):
            self._timer.stop()
            return
        if self._painting is None:
            each = self._shown[self._next]
            colour = self._theme.polyhedron if each.coarsened else self._theme.particle
            self._painting = paint_thumbnail(each.mesh, colour, SIZE)
        try:
            next(self._painting)
        except StopIteration as end:
            self.list.item(self._next).setIcon(end.value)
            self._painting = None
            self._next += 1
