"""Asks for the length unit of files that carry none."""

from pathlib import Path

from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFormLayout,
    QLabel,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.messages import N_
from regolith_studio.readers.units import UNITS
from regolith_studio.ui.translation import tr, tr_count
from regolith_studio.ui.widgets.labels import remark

LABELS = {
    "um": N_("Micrometres (µm)"),
    "mm": N_("Millimetres (mm)"),
    "m": N_("Metres (m)"),
    "nm": N_("Nanometres (nm)"),
    "cm": N_("Centimetres (cm)"),
    "voxel": N_("Voxels of a CT volume"),
}


class UnitDialog(QDialog):
    """Edits one unit, as the readers take it: ``mm``, or ``voxel:2.3`` with the voxel's edge in µm."""

    def __init__(self, paths: list[Path], suggestion: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Length unit"))
        self.setObjectName("unit_dialog")
        question = QLabel(
            tr_count(
                N_("In which unit are the numbers of {name}?"),
                N_("In which unit are the numbers of these {count} files and folders?"),
                len(paths),
                name=paths[0].name,
            )
        )
        question.setWordWrap(True)
        self.unit = QComboBox()
        self.unit.setObjectName("unit")
        self.unit.setAccessibleName(tr("Length unit"))
        for key in UNITS:
            self.unit.addItem(tr(LABELS.get(key, key)), key)
        self.voxel = QDoubleSpinBox()
        self.voxel.setObjectName("voxel_size")
        self.voxel.setAccessibleName(tr("Edge of a voxel in micrometres"))
        self.voxel.setRange(0.001, 10_000.0)
        self.voxel.setDecimals(3)
        self.voxel.setSuffix(" µm")
        self.voxel.setValue(2.3)
        self._voxel_label = QLabel(tr("Edge of a voxel"))
        form = QFormLayout()
        form.addRow(tr("Unit"), self.unit)
        form.addRow(self._voxel_label, self.voxel)
        buttons = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Open | QDialogButtonBox.StandardButton.Cancel, parent=self
        )
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        layout = QVBoxLayout(self)
        layout.addWidget(question)
        layout.addLayout(form)
        layout.addWidget(remark(tr("Mesh files carry no unit. The answer is kept for their folder.")))
        layout.addWidget(buttons)
        self.unit.currentIndexChanged.connect(self._show_voxel)
        self.setValue(suggestion)

    def value(self) -> str:
        """The unit."""
        key = str(self.unit.currentData())
        return f"voxel:{self.voxel.value():g}" if key == "voxel" else key

    def setValue(self, unit: str) -> None:
        """Suggest a unit."""
        key, _, size = unit.partition(":")
        self.unit.setCurrentIndex(max(0, self.unit.findData(key)))
        if size:
            self.voxel.setValue(float(size))
        self._show_voxel()

    def _show_voxel(self) -> None:
        asked = self.unit.currentData() == "voxel"
        self.voxel.setEnabled(asked)
        self._voxel_label.setEnabled(asked)
