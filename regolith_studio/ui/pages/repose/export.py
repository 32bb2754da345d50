"""Writing Fig. 9 with the measurement."""

from pathlib import Path

from PySide6.QtWidgets import QWidget

from regolith_studio.dem.angle_of_repose import ReposeMeasurement, measurement_document
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.errors import RegolithError
from regolith_studio.io.atomic import staged_folder
from regolith_studio.io.json_text import json_bytes
from regolith_studio.studies.figures.repose import write_section_figure
from regolith_studio.ui.dialogs.folder import FolderDialog
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.toast import Toast


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
