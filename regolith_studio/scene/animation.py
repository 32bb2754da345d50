"""Animated files: GIF, WebP or a sequence of PNG files from frames, and the turntable of several shapes."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import pyvista as pv
from PIL import Image

from regolith_studio.errors import InputError
from regolith_studio.scene import annotations, cameras, palette, plotter_setup, surfaces
from regolith_studio.scene.cameras import TURN, CameraPose, orbited
from regolith_studio.scene.figure import Picture
from regolith_studio.scene.shapes import LABELS, SceneShape, show_shape

KINDS = (".gif", ".webp", ".png")


def save_animation(frames: Sequence[Picture], seconds: Sequence[float], path: Path) -> None:
    """Write frames of one size that follow each other for ever; PNG files are numbered from 000.

    Parameters
    ----------
    seconds
        How long each frame is seen.

    Raises
    ------
    InputError
        If the ending of the file is none of :data:`KINDS`.
    """
    kind = path.suffix.lower()
    if kind not in KINDS:
        raise InputError(f"Animations are written as {' or '.join(KINDS)}, not as {kind or 'that'}.")
    images = [Image.fromarray(frame[..., :3]) for frame in frames]
    if kind == ".png":
        for number, image in enumerate(images):
            image.save(path.with_name(f"{path.stem}-{number:03d}.png"))
        return
    durations = [round(1000 * each) for each in seconds]
    if kind == ".gif":
        # One palette for all frames: else the background flickers from frame to frame.
        colours = images[-1].quantize(256, method=Image.Quantize.MEDIANCUT)
        images = [image.quantize(palette=colours, dither=Image.Dither.NONE) for image in images]
    images[0].save(path, save_all=True, append_images=images[1:], duration=durations, loop=0)


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
    plotter_setup.choose_off_screen_window()
    plotter = pv.Plotter(
        off_screen=True, shape=(1, len(shapes)), window_size=[len(shapes) * width, height], border=False
    )
    try:
        whole = cameras.framing_pose(np.vstack([shape.mesh.vertices for shape in shapes]), turning=True)
        now = _about(pose, whole) if pose is not None else whole
        bars = []
        for column, shape in enumerate(shapes):
            plotter.subplot(0, column)
            plotter_setup.set_stage(plotter, palette.PAPER)
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
