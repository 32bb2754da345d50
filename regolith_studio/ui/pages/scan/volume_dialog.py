"""Dialog for the properties of a volume that its file does not contain."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from PySide6.QtWidgets import QCheckBox, QDialog, QDialogButtonBox, QFormLayout, QLabel, QWidget

from regolith_studio.jobs.extraction_settings import VolumeInput
from regolith_studio.messages import N_
from regolith_studio.readers.volume_formats import WITH_AXES
from regolith_studio.readers.volumes.header import RawLayout, VolumeHeader
from regolith_studio.ui.layout import dialog_buttons, hbox, named, vbox
from regolith_studio.ui.translation import inert, tr, translate
from regolith_studio.ui.widgets.fields import choice, decimal_field, whole_field
from regolith_studio.ui.widgets.labels import hint_label

RAW_SUFFIXES = (".raw", ".bin", ".vol", ".dat")
AXES = (
    (None, N_("As the file says, else slices first (z, y, x)")),
    ("xyz", N_("x, y, z: slices last")),
    ("yxz", N_("y, x, z: rows, columns, slices")),
    ("zxy", N_("z, x, y: as MATLAB writes HDF5")),
)
ORDERS = (("little", N_("little endian")), ("big", N_("big endian")))
KINDS = (
    (None, N_("Detect from the values")),
    ("grey", N_("Grey values")),
    ("labels", N_("Labels of grains")),
)
UNITS = (("um", "µm"), ("mm", "mm"), ("nm", "nm"), ("cm", "cm"), ("m", "m"))
MOST = 1_000_000_000
_TYPES = ("uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64", "float32", "float64")


class VolumeDialog(QDialog):
    """Edits one :class:`VolumeInput`.

    - ``path``: the file, or the folder of slices.
    - ``header``: the header of the file; ``None`` for a raw file.
    - ``layout``: layout from the name of a raw file, if any.
    - ``last``: initial voxel size and unit if the file has none.
    - ``gaps``: numbers that are absent from series of slices, by the names of the series.
    """

    def __init__(
        self,
        path: Path,
        header: VolumeHeader | None,
        layout: RawLayout | None = None,
        last: tuple[float, str] = (1.0, "um"),
        gaps: Mapping[str, str] | None = None,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Open a volume"))
        self.setObjectName("volume_dialog")
        self._path, self._header, self._layout, self._last_size = path, header, layout, last
        self.edges = [
            decimal_field(
                f"voxel_{axis}",
                tr("Edge of a voxel along {axis}", axis=axis),
                0.0001,
                100_000.0,
                1.0,
                decimals=4,
            )
            for axis in "xyz"
        ]
        self.unit = choice("voxel_unit", tr("Unit of the voxel size"), UNITS)
        self.dataset = choice("dataset", tr("Volume in the file"), ())
        self.shape = [
            whole_field(f"shape_{axis}", tr("Voxels along {axis}", axis=axis), 1, MOST) for axis in "xyz"
        ]
        self.dtype = choice("dtype", tr("Type of a voxel"), [(name, name) for name in _TYPES])
        self.order = choice("byte_order", tr("Byte order"), ORDERS)
        self.offset = whole_field("offset", tr("Bytes before the first voxel"), 0, MOST)
        self.kind = choice("kind", tr("Content of the volume"), KINDS)
        self.axes = choice("axes", tr("Order of the array's axes"), AXES)
        self._gaps = gaps or {}
        self.allow_gaps = named(QCheckBox(), "allow_gaps")
        self._said = tr("A raw file has no header. Enter the number of voxels and their type.")
        self.assessment, self.facts = hint_label(), hint_label()
        self._buttons = dialog_buttons(self, QDialogButtonBox.StandardButton.Open)
        self._arrange()
        self._suggest()
        self.facts.setText(self._facts())
        self.edges[0].valueChanged.connect(self._follow)
        self._last = self.edges[0].value()
        if header is None:
            for field in (*self.shape, self.offset):
                field.valueChanged.connect(self._check_size)
            self.dtype.currentIndexChanged.connect(self._check_size)
            self._check_size()
        if self._gaps:
            self.dataset.currentIndexChanged.connect(self._check_gaps)
            self.allow_gaps.toggled.connect(self._check_gaps)
            self._check_gaps()

    def value(self) -> VolumeInput:
        raw = None
        if self._header is None:
            x, y, z = (field.value() for field in self.shape)
            raw = RawLayout((x, y, z), self.dtype.value(), self.order.value(), self.offset.value())
        return VolumeInput(
            self._path,
            tuple(field.value() for field in self.edges),
            self.unit.value(),
            self.kind.value(),
            self.dataset.value(),
            raw,
            self.axes.value(),
            allow_gaps=self.allow_gaps.isChecked(),
        )

    def _follow(self, value: float) -> None:
        """Change all edges with the first one while they are equal."""
        for field in self.edges[1:]:
            if field.value() == self._last:
                field.setValue(value)
        self._last = value

    def _suggest(self) -> None:
        header = self._header
        size, unit = self._last_size
        for field in self.edges:
            field.setValue(size)
        self.unit.choose(unit)
        if header is None:
            self._suggest_layout(self._layout)
            return
        if header.voxel_size is not None:
            for field, edge in zip(self.edges, header.voxel_size, strict=True):
                field.setValue(edge)
            self.unit.choose(header.unit or "um")
        appearance = tr("labels of grains") if header.kind == "labels" else tr("grey values")
        self.kind.setItemText(0, tr("Detected: {looks}", looks=appearance))
        for entry in header.datasets:
            self.dataset.addItem(
                f"{entry.name}, {' × '.join(map(str, entry.shape))}, {entry.dtype}", entry.name
            )
        self.dataset.choose(header.dataset)
        self.dataset.currentIndexChanged.connect(self._show_edges)

    def _show_edges(self, index: int) -> None:
        """Show the edges of the chosen volume, where the volumes of the file differ in them."""
        edges = self._header.datasets[index].voxel_size if self._header is not None else None
        for field, edge in zip(self.edges, edges or (), strict=False):
            field.setValue(edge)

    def _suggest_layout(self, layout: RawLayout | None) -> None:
        """Layout from the file's name if its size agrees; else a cube of bytes."""
        if layout is None:
            edge = max(1, round(self._path.stat().st_size ** (1 / 3)))
            layout = RawLayout((edge, edge, edge), "uint8")
        else:
            self._said = tr("The number of voxels in its name agrees with its size.")
        for count, edge in zip(self.shape, layout.shape, strict=True):
            count.setValue(edge)
        self.dtype.choose(layout.dtype)
        self.order.choose(layout.byte_order)
        self.offset.setValue(layout.offset)

    def _check_size(self, _changed: int = 0) -> None:
        """Show whether the size of the file fits the layout, and enable opening if it does."""
        voxels = math.prod(field.value() for field in self.shape)
        needed = voxels * np.dtype(str(self.dtype.value())).itemsize + self.offset.value()
        there = self._path.stat().st_size
        if needed == there:
            words = tr("That is all of the file's {count:,} bytes.", count=there)
        elif needed < there:
            words = tr("The file has {count:,} bytes more than that.", count=there - needed)
        else:
            words = tr("The file is {count:,} bytes too short for that.", count=needed - there)
        self.assessment.setText(words)
        self._buttons.button(QDialogButtonBox.StandardButton.Open).setEnabled(needed <= there)

    def _check_gaps(self) -> None:
        """Enable opening if the chosen series is complete, or its absent slices are to be empty."""
        chosen = self.dataset.value() or next(iter(self._gaps))
        numbers = self._gaps.get(chosen, "")
        self.allow_gaps.setText(inert(tr("Read absent slices as empty: {numbers}", numbers=numbers)))
        self.allow_gaps.setVisible(bool(numbers))
        complete = not numbers or self.allow_gaps.isChecked()
        self._buttons.button(QDialogButtonBox.StandardButton.Open).setEnabled(complete)

    def _arrange(self) -> None:
        header = self._header
        form = QFormLayout()
        if header is None:
            form.addRow(tr("Voxels x, y, z"), _row(self.shape))
            form.addRow(tr("Type"), self.dtype)
            form.addRow(tr("Byte order"), self.order)
            form.addRow(tr("Bytes before"), self.offset)
            form.addRow(self.assessment)
        elif len(header.datasets) > 1:
            form.addRow(tr("Volume"), self.dataset)
        if header is not None and header.format in WITH_AXES:
            form.addRow(tr("Axes"), self.axes)
        form.addRow(tr("Voxel size x, y, z"), _row([*self.edges, self.unit]))
        form.addRow(tr("Content"), self.kind)
        if self._gaps:
            form.addRow(self.allow_gaps)
        layout = vbox(QLabel(inert(self._path.name)), self.facts, form, parent=self, margins=None)
        layout.addWidget(self._buttons)

    def _facts(self) -> str:
        if self._header is None:
            return self._said
        edges = " × ".join(map(str, self._header.shape))
        size = "" if self._header.voxel_size else tr("It does not state the size of a voxel.")
        parts = (
            tr("{edges} voxels, {dtype}.", edges=edges, dtype=self._header.dtype),
            size,
            *map(translate, self._header.notes),
        )
        return " ".join(filter(None, parts))


def needs_asking(header: VolumeHeader) -> bool:
    """Whether a file lacks the voxel size, its unit, or the selection of a volume."""
    return header.voxel_size is None or header.unit is None or len(header.datasets) > 1


def _row(parts: Sequence[QWidget]) -> QWidget:
    frame = QWidget()
    hbox(*parts, parent=frame)
    return frame
