"""Asks what a file of voxels does not say about itself."""

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from regolith_studio.jobs.extracting import VolumeInput
from regolith_studio.readers.volume_header import RawLayout, VolumeHeader
from regolith_studio.ui.pages.scan.fields import choice
from regolith_studio.ui.widgets.labels import remark

RAW_SUFFIXES = (".raw", ".bin", ".vol", ".dat")
UNITS = (("um", "µm"), ("mm", "mm"), ("nm", "nm"), ("cm", "cm"), ("m", "m"))
_TYPES = ("uint8", "uint16", "int16", "uint32", "int32", "float32", "float64")


class VolumeDialog(QDialog):
    """Edits one :class:`VolumeInput`.

    Parameters
    ----------
    path
        The file, or the folder of slices.
    header
        What it says about itself; none for a raw file.
    """

    def __init__(self, path: Path, header: VolumeHeader | None, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Open a volume")
        self.setObjectName("volume_dialog")
        self._path, self._header = path, header
        self.edges = [_number(f"voxel_{axis}", f"Edge of a voxel along {axis}") for axis in "xyz"]
        self.unit = choice("voxel_unit", "Unit of the voxel size", UNITS)
        self.dataset = choice("dataset", "Volume in the file", ())
        self.shape = [_count(f"shape_{axis}", f"Voxels along {axis}") for axis in "xyz"]
        self.dtype = choice("dtype", "Type of a voxel", [(name, name) for name in _TYPES])
        self.order = choice("byte_order", "Byte order", (("little", "little endian"), ("big", "big endian")))
        self.offset = _count("offset", "Bytes before the first voxel", least=0)
        self.kind = choice(
            "kind", "What the volume holds",
            ((None, "Whatever it looks like"), ("grey", "Grey values"), ("labels", "Labels of grains")),
        )  # fmt: skip
        self._arrange()
        self._suggest()
        self.edges[0].valueChanged.connect(self._follow)
        self._last = self.edges[0].value()

    def value(self) -> VolumeInput:
        """The answer."""
        raw = None
        if self._header is None:
            x, y, z = (field.value() for field in self.shape)
            raw = RawLayout(
                (x, y, z), self.dtype.currentData(), self.order.currentData(), self.offset.value()
            )
        return VolumeInput(
            self._path,
            tuple(field.value() for field in self.edges),
            self.unit.currentData(),
            self.kind.currentData(),
            self.dataset.currentData(),
            raw,
        )

    def _follow(self, value: float) -> None:
        """Voxels are mostly cubes: the first edge takes the others with it while they are alike."""
        for field in self.edges[1:]:
            if field.value() == self._last:
                field.setValue(value)
        self._last = value

    def _suggest(self) -> None:
        header = self._header
        for field in self.edges:
            field.setValue(2.3)
        if header is None:
            for count in self.shape:
                count.setValue(256)
            return
        if header.voxel_size is not None:
            for field, edge in zip(self.edges, header.voxel_size, strict=True):
                field.setValue(edge)
        self.unit.setCurrentIndex(max(0, self.unit.findData(header.unit or "um")))
        for entry in header.datasets:
            self.dataset.addItem(
                f"{entry.name}, {' × '.join(map(str, entry.shape))}, {entry.dtype}", entry.name
            )
        self.dataset.setCurrentIndex(max(0, self.dataset.findData(header.dataset)))

    def _arrange(self) -> None:
        header = self._header
        form = QFormLayout()
        if header is None:
            form.addRow("Voxels x, y, z", _row(self.shape))
            form.addRow("Type", self.dtype)
            form.addRow("Byte order", self.order)
            form.addRow("Bytes before", self.offset)
        elif len(header.datasets) > 1:
            form.addRow("Volume", self.dataset)
        form.addRow("Voxel size x, y, z", _row([*self.edges, self.unit]))
        form.addRow("Holds", self.kind)
        layout = QVBoxLayout(self)
        layout.addWidget(QLabel(self._path.name))
        layout.addWidget(remark(self._facts()))
        layout.addLayout(form)
        buttons = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Open | QDialogButtonBox.StandardButton.Cancel
        )
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        layout.addWidget(buttons)

    def _facts(self) -> str:
        if self._header is None:
            return "A raw file says nothing about itself: how many voxels are in it, and of which type?"
        edges = " × ".join(map(str, self._header.shape))
        said = " ".join(self._header.notes)
        size = "" if self._header.voxel_size else " It does not say how large a voxel is."
        return f"{edges} voxels, {self._header.dtype}.{size} {said}".strip()


def needs_asking(header: VolumeHeader) -> bool:
    """Whether a file leaves something open: the voxel size, its unit, or which volume is meant."""
    return header.voxel_size is None or header.unit is None or len(header.datasets) > 1


def _number(name: str, words: str) -> QDoubleSpinBox:
    field = QDoubleSpinBox()
    field.setObjectName(name)
    field.setAccessibleName(words)
    field.setDecimals(4)
    field.setRange(0.0001, 100_000.0)
    return field


def _count(name: str, words: str, least: int = 1) -> QSpinBox:
    field = QSpinBox()
    field.setObjectName(name)
    field.setAccessibleName(words)
    field.setRange(least, 1_000_000_000)
    return field


def _row(parts: Sequence[QWidget]) -> QWidget:
    frame = QWidget()
    layout = QHBoxLayout(frame)
    layout.setContentsMargins(0, 0, 0, 0)
    for part in parts:
        layout.addWidget(part)
    return frame
