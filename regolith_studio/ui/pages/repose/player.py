"""3-D view of the particles, live or from the snapshots of a run, which it reads, with a time slider."""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import TypeAdapter, ValidationError
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QLabel,
    QLineEdit,
    QWidget,
)

from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dem.angle_of_repose import ReposeMeasurement, measurement_document
from regolith_studio.dem.run_io import FINAL, RunSummary, read_final_state, read_shapes, snapshot_files
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.errors import FileError, format_validation_error
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.io.atomic import staged_folder
from regolith_studio.io.own_files import json_bytes
from regolith_studio.messages import N_
from regolith_studio.readers.position_formats import named_columns
from regolith_studio.readers.positions import ParticlePositions, asks_for_columns, read_positions
from regolith_studio.readers.settings import unit_factor
from regolith_studio.scene import instancing
from regolith_studio.scene.cameras import Direction, filled, framing_pose
from regolith_studio.session.project import fingerprint
from regolith_studio.studies.figures.repose import write_section_figure
from regolith_studio.ui.dialogs.files import LABELS, FolderDialog
from regolith_studio.ui.layout import GrowingDialog, dialog_buttons, hbox, named, vbox
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import inert, number_text, tr
from regolith_studio.ui.views.image_view import make_view
from regolith_studio.ui.views.view import CameraLink, ViewFrame
from regolith_studio.ui.widgets.fields import StepPlayer, choice, decimal_field, show_whole
from regolith_studio.ui.widgets.labels import hint_label, short_number
from regolith_studio.ui.widgets.toast import Toast

POSITIONS = N_("Positions (*.npz *.csv *.txt *.dat *.xyz *.dump *.lammpstrj);;All files (*)")
UNITS = ("m", "mm", "um", "cm")
"""In the order in which they are suggested."""
HEAP_WIDTHS = (5e-3, 2.0)
"""Plausible widths of a heap in metres."""
BALLS = ((icosphere(1).vertices,),)
"""The one shape of particles of which only the size is known."""


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
        show_whole(self)
        self.unit.currentIndexChanged.connect(self._show_size)
        self.columns.textChanged.connect(self._offer_diameter)
        low, high = HEAP_WIDTHS
        fitting = (key for key in UNITS if low <= self._width * _metres(key) <= high)
        self.unit.choose(next(fitting, "m"))
        self._show_size()
        if read is None:
            self._offer_diameter()

    def _show_size(self) -> None:
        width = short_number(1e3 * self._width * _metres(self.unit.value()), 3)
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


@dataclass(frozen=True)
class ImportedHeap:
    """A file of positions, and how it is read.

    - ``file``: its absolute path.
    - ``unit``, ``columns``, ``diameter``: what the user has said of it; the diameter, in metres, is that of
      all particles where the file states none.
    - ``fingerprint``: of the file that was shown.
    """

    file: str
    unit: str = "m"
    columns: str = ""
    diameter: float = 1e-3
    fingerprint: str = ""

    def pile(self, read: ParticlePositions | None = None) -> tuple[ParticleState, tuple[str, ...]]:
        """The particles and notes on them; ``read`` if the file has been read in this way."""
        if self.file.endswith(".npz"):
            return read_final_state(Path(self.file)), ()
        read = read or read_positions(self.file, self.unit, columns=self.columns)
        n = len(read)
        diameters = read.diameters if read.diameters is not None else np.full(n, self.diameter)
        still = np.tile([1.0, 0.0, 0.0, 0.0], (n, 1))
        numbers = np.zeros(n, dtype=np.int64)
        state = ParticleState(read.points, diameters, still, numbers, 0.0, float("inf"), N_("imported"))
        return state, read.notes


def restored_heap(state: Mapping[str, Any]) -> tuple[ImportedHeap, ParticleState]:
    """The heap of a project and its particles; RegolithError if they cannot be had any more."""
    try:
        heap = TypeAdapter(ImportedHeap).validate_python(state)
    except ValidationError as error:
        raise FileError(format_validation_error(error.errors(include_url=False))) from error
    return heap, heap.pile()[0]


def read_pile(parent: QWidget, path: Path) -> tuple[ImportedHeap, ParticleState, tuple[str, ...]] | None:
    """A file, its particles and notes on them; None where a question was not answered."""
    heap = ImportedHeap(str(path.absolute()), fingerprint=fingerprint(path))
    if path.suffix == ".npz":
        return heap, *heap.pile()
    read: ParticlePositions | None = None
    try:
        read = read_positions(path)
    except FileError as error:
        if not asks_for_columns(error):
            raise
    if read is None or not read.states_unit or read.diameters is None:
        dialog = PositionsDialog(path, read, parent)
        accepted = dialog.exec() == QDialog.DialogCode.Accepted
        columns = dialog.columns.text() if read is None else ""
        diameter = 1e-3 * dialog.diameter.value()
        heap = replace(heap, unit=dialog.unit.value(), columns=columns, diameter=diameter)
        dialog.deleteLater()
        if not accepted:
            return None
        read = None
    return heap, *heap.pile(read)


def export_measurement(
    parent: QWidget, toast: Toast, pile: ParticleState, measured: ReposeMeasurement
) -> None:
    """Ask for a folder and write ``repose.json``, ``sections.png`` and ``sections.svg``."""
    name = FolderDialog.ask(parent, tr("Export figure and JSON"))
    if not name:
        return
    with toast.reporting():
        with staged_folder(Path(name), "repose") as stage:
            document = {"length_unit": "m"} | measurement_document(measured)
            (stage / "repose.json").write_bytes(json_bytes(document))
            write_section_figure(pile.points, pile.diameters, measured, stage)
        toast.note(tr("Figure and JSON are in {name}.", name=name))


LOW_SIDE = Direction("", (0.35, -1.0, 0.22), (0.0, 0.0, 1.0))
"""Flanks and their slope are seen from a low side."""
HEAP_SHARE = 0.97
"""Share of the coordinates of particles that lie within the frame of a heap."""
ABOVE_FRAME = 1.02
"""Height of particles over that of the frame beyond which the cylinder is framed anew."""
FRAME = 50
"""Milliseconds between two frames of a replay."""
SETTLE = 300
"""Milliseconds from the last movement of a large heap to its picture with all details."""


class RunPlayer(StepPlayer):
    """Shows heaps and replays runs."""

    def __init__(self, views: str) -> None:
        super().__init__("repose_time", tr("Time of the run"), FRAME)
        self.frame = ViewFrame(make_view(views), "repose_view", colour="polyhedron")
        self._camera = CameraLink([self.frame.view])
        self._theme = current_theme()
        self._shapes: tuple[Sequence[FloatArray], ...] = ()
        self._spheres = False
        self._framed_height = 0.0
        self._test = LiftingCylinderTest()
        self._files: list[Path] = []
        self.pile: ParticleState | None = None
        self._coarse = False
        self._settle = QTimer(self, singleShot=True, interval=SETTLE)
        self._settle.timeout.connect(self._draw_settled)
        self.frame.view.when_moved(lambda _: self._draw_coarsely())
        self.play.setObjectName("repose_play")
        self.clock = named(QLabel(), role="hint")
        self.clock.setMinimumWidth(110)
        self.stepChanged.connect(self._show_file)
        vbox(
            (self.frame, 1),
            hbox(self.play, (self.slider, 1), self.clock, margins=(8, 2, 8, 4)),
            parent=self,
        )
        self.frame.set_texts(tr("Lifting cylinder"), tr("Choose a dataset to see the cylinder filled."))
        self._set_files([])

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme
        self._draw()

    def set_scene(
        self, shapes: Sequence[Sequence[FloatArray]], spheres: bool, test: LiftingCylinderTest
    ) -> None:
        """Shapes and apparatus of what is shown from now on; the camera frames the test."""
        fresh = (test.diameter, test.height) != (self._test.diameter, self._test.height) or not self._shapes
        self._shapes, self._spheres, self._test = tuple(shapes), spheres, test
        if fresh:
            self._look_at_cylinder(test.height)

    def frame_heap(self, pile: ParticleState) -> None:
        """Look at a heap from a low side, as large as it can be; particles far from it do not count."""
        reach = float(np.quantile(np.abs(pile.points[:, :2]), HEAP_SHARE))
        self._framed_height = float(pile.points[:, 2].max())
        self._look_at(instancing.box_corners(reach, float(pile.points[:, 2].max())))

    def _look_at_cylinder(self, height: float) -> None:
        """Frame the cylinder up to a height in metres."""
        self._framed_height = height
        self._look_at(instancing.framing_corners(self._test.diameter, height))

    def _look_at(self, corners: FloatArray) -> None:
        widget = self.frame.view.widget
        aspect = max(0.2, widget.width() / max(1, widget.height()))
        self.frame.view.set_pose(filled(framing_pose(corners, LOW_SIDE, aspect), corners, aspect))

    def show_moment(self, pile: ParticleState, title: str, detail: str = "") -> None:
        """Show a state that is not in a file: a preview, or the latest of a running simulation."""
        self.pause()
        self._set_files([])
        self.frame.set_texts(title, detail)
        top = float(pile.points[:, 2].max(initial=0.0))
        if top > ABOVE_FRAME * self._framed_height:
            self._look_at_cylinder(max(top, self._test.height))
        self._show(pile)

    def show_folder(self, run: RunSummary, detail: str) -> ParticleState | None:
        """Set the shapes and snapshots of a run, and show the last one: the heap, where it has come to it."""
        case, files, final = run.document["case"], snapshot_files(run.folder), run.folder / FINAL
        files += [final] if final.exists() else []
        shapes = read_shapes(run.folder)
        self.set_scene(shapes, case["shapes"] == "spheres", LiftingCylinderTest(**case["test"]))
        self.pause()
        self.frame.set_texts(run.folder.name, detail)
        self._set_files(files)
        if files:
            self._show_file(len(files) - 1)
        return read_final_state(final) if final.exists() else None

    def play_or_report(self, report: Callable[[str], object]) -> None:
        """Play or pause, or report that there is no run."""
        if self._files:
            self.toggle()
        else:
            report(tr("There is no run to play: run a test or choose a run in the list."))

    def release(self) -> None:
        self.pause()
        self._settle.stop()
        self.frame.view.release()

    def _set_files(self, files: list[Path]) -> None:
        self._files = files
        self.set_count(len(files), max(0, len(files) - 1))

    def _show_file(self, number: int) -> None:
        try:
            self._show(read_final_state(self._files[number]))
        except FileError as error:
            self.pause()
            self.clock.setText(inert(str(error)))

    def _show(self, pile: ParticleState) -> None:
        if self._files:
            self._coarse = instancing.is_large(self._shapes, pile, self._spheres)
            if self._coarse:
                self._settle.start()
        self.pile = pile
        self.clock.setText(f"{number_text(pile.time, '.2f')} s  {tr(pile.phase)}")
        self._draw()

    def _draw_coarsely(self) -> None:
        """Draw a large heap without details until nothing has moved for a while."""
        if self.pile is None or not instancing.is_large(self._shapes, self.pile, self._spheres):
            return
        self._settle.start()
        if not self._coarse:
            self._coarse = True
            self._draw()

    def _draw_settled(self) -> None:
        self._coarse = False
        self._draw()

    def _draw(self) -> None:
        pile = self.pile
        if pile is None or not self._shapes:
            return
        spread = float(np.abs(pile.points[:, :2]).max(initial=0.0))
        reach = float(np.clip(1.05 * spread, 1.3 * self._test.diameter, 2.2 * self._test.diameter))

        def fill(plotter: object) -> None:
            instancing.show_heap(plotter, self._shapes, pile, self._spheres, self._coarse)
            instancing.show_apparatus(
                plotter, pile, self._test.diameter, self._test.height, reach, self._theme.surroundings
            )

        self.frame.view.draw(fill)
