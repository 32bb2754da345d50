"""Corrections of labels by hand: the tool of the mouse and the list of what was done."""

from collections.abc import Sequence

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QButtonGroup,
    QGridLayout,
    QHBoxLayout,
    QListWidget,
    QRadioButton,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.imaging.segmentation.label_edits import LabelEdit
from regolith_studio.messages import N_
from regolith_studio.ui.pages.scan.brush_panel import button
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import heading, remark
from regolith_studio.ui.widgets.number_slider import NumberSlider, NumberSpec

NO_TOOL = ""
TOOLS = (
    (NO_TOOL, N_("Inspect"), N_("A click shows the slices through a voxel.")),
    ("merge", N_("Merge"), N_("Click two grains that are one.")),
    ("delete", N_("Delete"), N_("Click a grain.")),
    ("seeds", N_("Split by seeds"), N_("Click two places in a grain that are two grains.")),
    ("cut", N_("Split by a line"), N_("Draw a line across a grain.")),
    (
        "fill",
        N_("Fill"),
        N_("Click a grain to fill what it encloses in the slices of that view."),
    ),
    ("paint", N_("Paint"), N_("Draw from a grain to extend it, or from a free place for a new grain.")),
    ("erase", N_("Erase"), N_("Draw over grains to free their voxels.")),
)
SIZE = NumberSpec(N_("Size"), N_("Diameter of the ball that paints and erases, in voxels"), 1, 30, limit=200)
BRUSHED = ("paint", "erase")
"""Tools whose mouse is a ball."""
_DONE = {
    "merge": N_("{number}. Grains merged at {place}"),
    "delete": N_("{number}. Grain deleted at {place}"),
    "seeds": N_("{number}. Grain split by seeds at {place}"),
    "cut": N_("{number}. Grain split by a line at {place}"),
    "fill": N_("{number}. Grain filled at {place}"),
    "paint": N_("{number}. Voxels painted at {place}"),
    "erase": N_("{number}. Voxels erased at {place}"),
}


class EditsPanel(QWidget):
    """Chooses the tool; ``toolChanged`` tells its kind."""

    toolChanged = Signal(str)  # noqa: N815
    undoRequested = Signal()  # noqa: N815
    redoRequested = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("edits")
        self._group = QButtonGroup(self)
        self.tools = {}
        for kind, words, tip in TOOLS:
            made = QRadioButton(tr(words))
            made.setObjectName(f"edit_{kind or 'look'}")
            made.setToolTip(tr(tip))
            self._group.addButton(made)
            self.tools[kind] = made
        self.tools[NO_TOOL].setChecked(True)
        self.diameter = NumberSlider(SIZE)
        self.diameter.field.setObjectName("edit_size")
        self.diameter.setValue(6)
        self.hint = remark()
        self.list = QListWidget()
        self.list.setAccessibleName(tr("Corrections so far"))
        self.list.setMinimumHeight(120)
        self.undo = button("edit_undo", tr("Undo"), tr("Undo the last step (Ctrl+Z)"))
        self.redo = button("edit_redo", tr("Redo"), tr("Redo the last step (Ctrl+Shift+Z)"))
        self._arrange()
        for made in self.tools.values():
            made.toggled.connect(self._chosen)
        self.undo.clicked.connect(self.undoRequested)
        self.redo.clicked.connect(self.redoRequested)
        self.set_state(found=False, can_undo=False, can_redo=False)
        self._chosen(True)

    @property
    def tool(self) -> str:
        """Kind of the edit that the mouse makes; empty for none."""
        return next(kind for kind, made in self.tools.items() if made.isChecked())

    def set_state(self, *, found: bool, can_undo: bool, can_redo: bool) -> None:
        """Enable what can be done; `found` says whether there are grains."""
        for kind, made in self.tools.items():
            made.setEnabled(found or kind == NO_TOOL)
        self.diameter.setEnabled(found)
        self.undo.setEnabled(can_undo)
        self.redo.setEnabled(can_redo)

    def set_edits(self, edits: Sequence[LabelEdit]) -> None:
        """List the corrections."""
        self.list.clear()
        for number, edit in enumerate(edits, start=1):
            place = ", ".join(str(at) for at in edit.points[0])
            self.list.addItem(tr(_DONE[edit.kind], number=number, place=place))
        self.list.scrollToBottom()

    def _chosen(self, on: bool) -> None:
        if on:
            self.hint.setText(next(tr(tip) for kind, _, tip in TOOLS if kind == self.tool))
            self.toolChanged.emit(self.tool)

    def _arrange(self) -> None:
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(heading(tr("Corrections by hand")))
        grid = QGridLayout()
        for number, made in enumerate(self.tools.values()):
            grid.addWidget(made, number // 2, number % 2)
        layout.addLayout(grid)
        layout.addWidget(self.diameter)
        layout.addWidget(self.hint)
        layout.addWidget(self.list, 1)
        row = QHBoxLayout()
        row.addWidget(self.undo)
        row.addWidget(self.redo)
        layout.addLayout(row)
