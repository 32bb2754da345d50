"""Particle, fit and polyhedron turning side by side, as an animated file."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import pyvista as pv

from regolith_studio.scene import annotations, cameras, palette, stage, surfaces
from regolith_studio.scene.cameras import CameraPose
from regolith_studio.scene.figure import Picture
from regolith_studio.scene.motions import TURN, orbited
from regolith_studio.scene.moving_picture import save_animation
from regolith_studio.scene.shapes import LABELS, SceneShape, show_shape

SIZE = (380, 360)
"""Width and height of one body in pixels."""
FRAMES = 60
SECONDS = 4.0
"""Of a whole turn."""


def turntable(
    shapes: Sequence[SceneShape], pose: CameraPose | None, path: Path, frames: int = FRAMES, scale: int = 1
) -> None:
    """Write one turn about the upright of the picture as GIF or WebP.

    Parameters
    ----------
    shapes
        What turns, from left to right, in one frame of coordinates.
    pose
        Where the camera begins; isometric if not given. The whole bodies are seen whatever its scale.
    scale
        Whole factor on the size in pixels.

    Raises
    ------
    InputError
        If the ending of the file is another.
    """
    pictures = list(_pictures(shapes, pose, frames, scale))
    save_animation(pictures, [SECONDS / frames] * frames, path)


def _pictures(
    shapes: Sequence[SceneShape], pose: CameraPose | None, frames: int, scale: int
) -> Iterator[Picture]:
    width, height = (scale * each for each in SIZE)
    stage.choose_off_screen_window()
    plotter = pv.Plotter(
        off_screen=True, shape=(1, len(shapes)), window_size=[len(shapes) * width, height], border=False
    )
    try:
        whole = cameras.framing_pose(np.vstack([shape.mesh.vertices for shape in shapes]))
        now = _about(pose, whole) if pose is not None else whole
        bars = []
        for column, shape in enumerate(shapes):
            plotter.subplot(0, column)
            stage.set_stage(plotter, palette.PAPER)
            show_shape(plotter, shape, palette.PAPER)
            surfaces.widen_lines(plotter, scale)
            annotations.show_title(plotter, LABELS[shape.name], size=10 * scale)
            bars.append(annotations.ScaleBar(plotter, palette.PAPER, factor=scale))
        for _ in range(frames):
            for column in range(len(shapes)):
                plotter.subplot(0, column)
                cameras.apply_pose(plotter, now)
            plotter.render()
            yield np.array(plotter.screenshot(return_img=True), dtype=np.uint8)
            now = orbited(now, 2.0 * np.pi / frames / TURN, 0.0)
        for bar in bars:
            bar.remove()
    finally:
        plotter.close()


def _about(pose: CameraPose, whole: CameraPose) -> CameraPose:
    """The direction of one pose, the middle and scale of another."""
    step = np.asarray(pose.position) - pose.focal_point
    reach = np.linalg.norm(np.asarray(whole.position) - whole.focal_point) / np.linalg.norm(step)
    x, y, z = (float(each) for each in np.asarray(whole.focal_point) + reach * step)
    return CameraPose((x, y, z), whole.focal_point, pose.view_up, whole.parallel_scale)
