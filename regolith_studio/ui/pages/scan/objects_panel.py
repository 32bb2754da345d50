"""Examples of objects: the class of the next click, what is done with each class, and the files."""

from collections.abc import Mapping

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import QCheckBox, QFormLayout, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from regolith_studio.imaging.segmentation.object_classifier import (
    OBJECT_ACTIONS,
    OBJECT_CLASSES,
    ObjectAction,
)
from regolith_studio.messages import N_
from regolith_studio.ui.pages.scan.brush_panel import button, swatch
from regolith_studio.ui.pages.scan.controls import choice
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.labels import heading, remark

OBJECT_COLOURS = ("#22c55e", "#f59e0b", "#d946ef")
_CLASS_NAMES = (N_("Grain"), N_("Several grains"), N_("Artefact"))
_PLURALS = (N_("Grains"), N_("Several grains"), N_("Artefacts"))
_ACTION_NAMES = (N_("Keep"), N_("Split again"), N_("Drop"))


class ObjectsPanel(QWidget):
    """Chooses the class of a click and the actions. ``markingChanged`` tells when clicks begin to mark."""

    markingChanged = Signal(bool)  # noqa: N815
    actionsChanged = Signal()  # noqa: N815
    applyChanged = Signal(bool)  # noqa: N815
    undoRequested = Signal()  # noqa: N815
    clearRequested = Signal()  # noqa: N815
    openRequested = Signal()  # noqa: N815
    saveRequested = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("objects")
        self.mark = QCheckBox(tr("Mark examples"))
        self.mark.setObjectName("objects_mark")
        self.mark.setToolTip(
            tr("A click on an object makes it an example of a class; all others are classified.")
        )
        self.kind = choice("objects_class", tr("Class of the next example"), tuple(enumerate(_CLASS_NAMES)))
        rows = tuple(zip(OBJECT_ACTIONS, _ACTION_NAMES, strict=True))
        self.action_boxes = tuple(
            choice(f"objects_action_{number}", tr("Action on them"), rows)
            for number in range(len(OBJECT_CLASSES))
        )
        self.counts = tuple(QLabel() for _ in OBJECT_CLASSES)
        for number, colour in enumerate(OBJECT_COLOURS):
            self.kind.setItemIcon(number, swatch(colour))
            self.action_boxes[number].setCurrentIndex(number)
        self.apply = QCheckBox(tr("Apply to the grains"))
        self.apply.setObjectName("objects_apply")
        self.apply.setToolTip(tr("Keep, split or drop the grains by their class"))
        self.undo = button("objects_undo", tr("Undo"), tr("Undo the last step (Ctrl+Z)"))
        self.clear = button("objects_clear", tr("Clear"), tr("Remove all examples"))
        self.browse = button("objects_open", tr("Open …"), tr("Open an object classifier and apply it"))
        self.save = button("objects_save", tr("Save …"), tr("Save the object classifier for other scans"))
        self.state = remark()
        self._arrange()
        self._connect()
        self.set_state(found=False, trained=False, applied=False, can_undo=False)
        self.set_counts({}, "")

    def action_of_each(self) -> tuple[ObjectAction, ...]:
        """What is done with each class."""
        return tuple(box.currentData() for box in self.action_boxes)

    def set_actions(self, actions: tuple[ObjectAction, ...]) -> None:
        """Show other actions without emitting a signal."""
        for box, action in zip(self.action_boxes, actions, strict=True):
            with QSignalBlocker(box):
                box.setCurrentIndex(box.findData(action))

    def set_state(self, *, found: bool, trained: bool, applied: bool, can_undo: bool) -> None:
        """Enable what can be done; `found` says whether there are grains."""
        self.mark.setEnabled(found)
        self.kind.setEnabled(found and self.mark.isChecked())
        self.undo.setEnabled(can_undo)
        self.clear.setEnabled(trained or can_undo)
        self.apply.setEnabled(trained)
        self.save.setEnabled(trained)
        with QSignalBlocker(self.apply):
            self.apply.setChecked(applied)

    def set_counts(self, counts: Mapping[str, int], missing: str) -> None:
        """Show how many objects each class has, and what is missing for a classifier."""
        for words, name, label in zip(_PLURALS, OBJECT_CLASSES, self.counts, strict=True):
            count = counts.get(name)
            label.setText(tr(words) if count is None else f"{tr(words)}: {count}")
        self.state.setText(missing)
        self.state.setVisible(bool(missing))

    def _connect(self) -> None:
        self.mark.toggled.connect(self.kind.setEnabled)
        self.mark.toggled.connect(self.markingChanged)
        self.apply.toggled.connect(self.applyChanged)
        for box in self.action_boxes:
            box.currentIndexChanged.connect(self.actionsChanged)
        for part, signal in (
            (self.undo, self.undoRequested),
            (self.clear, self.clearRequested),
            (self.browse, self.openRequested),
            (self.save, self.saveRequested),
        ):
            part.clicked.connect(signal)

    def _arrange(self) -> None:
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(heading(tr("Object classifier")))
        layout.addWidget(self.mark)
        layout.addWidget(self.kind)
        layout.addWidget(self.state)
        form = QFormLayout()
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        for label, box in zip(self.counts, self.action_boxes, strict=True):
            form.addRow(label, box)
        layout.addLayout(form)
        layout.addWidget(self.apply)
        for parts in ((self.undo, self.clear), (self.browse, self.save)):
            row = QHBoxLayout()
            for part in parts:
                row.addWidget(part)
            layout.addLayout(row)
        layout.addStretch(1)
