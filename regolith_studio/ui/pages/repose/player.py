"""3-D view of the particles, live or from the snapshots of a run, with a time slider."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QLabel

from regolith_studio.dataset.parameters import LiftingCylinderTest
from regolith_studio.dem.run_io import read_final_state
from regolith_studio.dem.snapshot import ParticleState
from regolith_studio.errors import FileError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.scene import instancing
from regolith_studio.scene.cameras import Direction, filled, framing_pose
from regolith_studio.ui.layout import hbox, named, vbox
from regolith_studio.ui.theme import Theme, current_theme
from regolith_studio.ui.translation import inert, number_text, tr
from regolith_studio.ui.views.image_view import make_view
from regolith_studio.ui.views.view import CameraLink, ViewFrame
from regolith_studio.ui.widgets.fields import StepPlayer

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
    """Shows piles and replays runs."""

    def __init__(self, views: str) -> None:
        super().__init__("repose_time", tr("Time of the run"), FRAME)
        self.frame = ViewFrame(
            make_view(views, current_theme().surroundings), "repose_view", colour="polyhedron"
        )
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

    def show_run(self, files: Sequence[Path], title: str, detail: str = "") -> None:
        """Set the snapshots of a run and show the last one."""
        self.pause()
        self.frame.set_texts(title, detail)
        self._set_files(list(files))
        if files:
            self._show_file(len(files) - 1)

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
