"""Positions of other programs, whose file may not state all; and the figure and file of a measurement."""

import re
from pathlib import Path

import numpy as np
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QLineEdit,
    QWidget,
)

from regolith_studio.dem.angle_of_repose import ReposeMeasurement, measurement_document
from regolith_studio.dem.run_io import read_final_state
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.errors import FileError, RegolithError
from regolith_studio.io.atomic import staged_folder
from regolith_studio.io.own_files import json_bytes
from regolith_studio.messages import N_
from regolith_studio.readers.position_formats import named_columns
from regolith_studio.readers.positions import ParticlePositions, asks_for_columns, read_positions
from regolith_studio.readers.settings import unit_factor
from regolith_studio.studies.figures.repose import write_section_figure
from regolith_studio.ui.dialogs.files import LABELS, FolderDialog
from regolith_studio.ui.layout import GrowingDialog, dialog_buttons, named, vbox
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.fields import choice, decimal_field
from regolith_studio.ui.widgets.labels import hint_label, short_number
from regolith_studio.ui.widgets.toast import Toast

POSITIONS = N_(
    "Positions (*.npz *.csv *.txt *.dat *.xyz *.dump *.lammpstrj *.vtk *.vtp *.vtu);;All files (*)"
)
UNITS = ("m", "mm", "um", "cm")
"""In the order in which they are suggested."""
HEAP_WIDTHS = (5e-3, 2.0)
"""Plausible widths of a heap in metres."""


class PositionsDialog(GrowingDialog):
    """Asks for what a file of positions does not state: columns, unit, diameter.

    ``read``: the particles with metres for the unit, or None where the columns must be named first.
    """

    def __init__(self, path: Path, read: ParticlePositions | None, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("positions_dialog")
        self.setWindowTitle(tr("Positions in {name}", name=path.name))
        self._width = 0.0 if read is None else float(np.ptp(read.points, axis=0).max(initial=0.0))
        spoken = tr("All columns in their order"), tr("Length unit"), tr("Particle diameter [mm]")
        self.columns = named(QLineEdit("x y z radius"), "positions_columns", spoken[0])
        self.unit = choice("positions_unit", spoken[1], {key: LABELS[key] for key in UNITS})
        self.diameter = decimal_field("positions_diameter", spoken[2], 1e-6, 1e6, 1.0, decimals=4)
        self.size_note = hint_label()
        form = QFormLayout()
        rows = (
            (read is None, self.columns),
            (read is None or not read.states_unit, self.unit),
            (read is None or read.diameters is None, self.diameter),
        )
        for label, (needed, field) in zip(spoken, rows, strict=True):
            field.setParent(self)
            field.setVisible(needed)
            if needed:
                form.addRow(label, field)
        buttons = dialog_buttons(self, QDialogButtonBox.StandardButton.Open)
        vbox(form, self.size_note, buttons, parent=self, margins=None)
        self.unit.currentIndexChanged.connect(self._show_size)
        self.columns.textChanged.connect(self._offer_diameter)
        low, high = HEAP_WIDTHS
        fitting = (key for key in UNITS if low <= self._width * _metres(key) <= high)
        self.unit.setCurrentIndex(self.unit.findData(next(fitting, "m")))
        self._show_size()
        if read is None:
            self._offer_diameter()

    def _show_size(self) -> None:
        width = short_number(1e3 * self._width * _metres(self.unit.currentData()), 3)
        self.size_note.setText(tr("The particles would extend over {width} mm.", width=width))
        self.size_note.setVisible(self._width > 0.0 and self.unit.isVisibleTo(self))

    def _offer_diameter(self) -> None:
        """A diameter is needed where no column is one."""
        try:
            self.diameter.setEnabled(named_columns(tuple(column_names(self.columns.text()))).size is None)
        except FileError:
            self.diameter.setEnabled(True)  # whose sentence the reading says


def column_names(text: str) -> list[str]:
    """Names of columns between spaces, commas or semicolons."""
    return re.split(r"[\s,;]+", text.strip())


def _metres(unit: str) -> float:
    return 1e-6 * unit_factor(unit)


def choose_positions(parent: QWidget) -> Path | None:
    name, _ = QFileDialog.getOpenFileName(parent, tr("Measure positions"), "", tr(POSITIONS))
    return Path(name) if name else None


def read_pile(parent: QWidget, path: Path) -> tuple[ParticleState, tuple[str, ...]] | None:
    """The particles of a file and notes on it; None where a question was not answered."""
    if path.suffix == ".npz":
        return read_final_state(path), ()
    read: ParticlePositions | None = None
    try:
        read = read_positions(path)
    except FileError as error:
        if not asks_for_columns(error):
            raise
    diameter = 1e-3
    if read is None or not read.states_unit or read.diameters is None:
        dialog = PositionsDialog(path, read, parent)
        accepted = dialog.exec() == QDialog.DialogCode.Accepted
        unit, columns = dialog.unit.currentData(), dialog.columns.text() if read is None else ""
        diameter *= dialog.diameter.value()
        dialog.deleteLater()
        if not accepted:
            return None
        read = read_positions(path, unit, columns=columns)
    n = len(read)
    diameters = read.diameters if read.diameters is not None else np.full(n, diameter)
    still = np.tile([1.0, 0.0, 0.0, 0.0], (n, 1))
    numbers = np.zeros(n, dtype=np.int64)
    state = ParticleState(read.points, diameters, still, numbers, 0.0, float("inf"), N_("imported"))
    return state, read.notes


def export_measurement(
    parent: QWidget, toast: Toast, pile: ParticleState, measured: ReposeMeasurement
) -> None:
    """Ask for a folder and write ``repose.json``, ``sections.png`` and ``sections.svg``."""
    name = FolderDialog.ask(parent, tr("Export figure and JSON"))
    if not name:
        return
    try:
        with staged_folder(Path(name), "repose") as stage:
            document = {"length_unit": "m"} | measurement_document(measured)
            (stage / "repose.json").write_bytes(json_bytes(document))
            write_section_figure(pile.points, pile.diameters, measured, stage)
    except RegolithError as error:
        toast.problem(str(error))
        return
    toast.note(tr("Figure and JSON are in {name}.", name=name))
