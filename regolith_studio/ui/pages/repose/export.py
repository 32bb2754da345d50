"""Writing Fig. 9 with the measurement, and reading positions of other programs."""

from pathlib import Path

import numpy as np
from PySide6.QtWidgets import QFileDialog, QInputDialog, QWidget

from regolith_studio.dem.angle_of_repose import ReposeMeasurement, measurement_document
from regolith_studio.dem.run_io import read_final_state
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.errors import FileError, RegolithError
from regolith_studio.io.atomic import staged_folder
from regolith_studio.io.json_text import json_bytes
from regolith_studio.messages import N_
from regolith_studio.readers.positions import ParticlePositions, asks_for_columns, read_positions
from regolith_studio.studies.figures.repose import write_section_figure
from regolith_studio.ui.dialogs.folder import FolderDialog
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.toast import Toast

POSITIONS = N_(
    "Positions (*.npz *.csv *.txt *.dat *.xyz *.dump *.lammpstrj *.vtk *.vtp *.vtu);;All files (*)"
)
UNITS = ("m", "cm", "mm", "um")


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


def read_other(parent: QWidget, toast: Toast) -> tuple[Path, ParticleState] | None:
    """Ask for a file of positions, its unit, and a diameter if it has none; or ``None``."""
    name, _ = QFileDialog.getOpenFileName(parent, tr("Measure positions"), "", tr(POSITIONS))
    if not name:
        return None
    try:
        if name.endswith(".npz"):
            return Path(name), read_final_state(Path(name))
        unit, sure = QInputDialog.getItem(parent, tr("Unit"), tr("Length unit of the file:"), UNITS, 0, False)
        if not sure:
            return None
        found = _read_with_columns(parent, name, unit)
        if found is None:
            return None
        diameters = found.diameters
        if diameters is None:
            number, sure = QInputDialog.getDouble(
                parent,
                tr("Diameter"),
                tr("Particle diameter [mm]"),
                1.0,
                1e-6,
                1e6,
                4,
            )
            if not sure:
                return None
            diameters = np.full(len(found), number * 1e-3)
    except RegolithError as error:
        toast.problem(str(error))
        return None
    for note in found.notes:
        toast.note(note)
    n = len(found)
    still = np.tile([1.0, 0.0, 0.0, 0.0], (n, 1))
    numbers = np.zeros(n, dtype=np.int64)
    state = ParticleState(found.points, diameters, still, numbers, 0.0, float("inf"), N_("imported"))
    return Path(name), state


def _read_with_columns(parent: QWidget, name: str, unit: str) -> ParticlePositions | None:
    """The positions of a file; the names of its columns are asked for where it has none."""
    try:
        return read_positions(name, unit)
    except FileError as error:
        if not asks_for_columns(error):
            raise
        question = tr("Names of all columns in their order, such as x y z radius:")
        columns, sure = QInputDialog.getText(parent, tr("Columns"), question, text="x y z radius")
        return read_positions(name, unit, columns=columns) if sure else None
