"""Pictures of one particle at several degrees (Fig. 2), and animated files: GIF, WebP, several PNG files."""

from collections.abc import Callable, Iterator, Sequence
from math import ceil
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv
from PIL import Image

from regolith_studio.coarsening.result import CoarseningResult
from regolith_studio.errors import FileError, InputError, os_error_reason
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.harmonics.synthesis import gallery
from regolith_studio.io.atomic import hidden_folder
from regolith_studio.jobs.events import Job, Started, Steps
from regolith_studio.jobs.executor import open_executor, value_of
from regolith_studio.messages import N_
from regolith_studio.scene import annotations, cameras, palette, plotter_setup, surfaces
from regolith_studio.scene.cameras import CameraPose
from regolith_studio.scene.figure import Picture, three_views

KINDS = (".gif", ".webp", ".png")


def save_animation(frames: Sequence[Picture], seconds: Sequence[float], path: Path) -> None:
    """Write frames of one size that follow each other for ever; PNG files are numbered from 000.

    ``seconds``: how long each frame is seen.
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


CELL_SIZE = (420, 400)
"""Width and height of one particle in pixels."""
N_COLUMNS = 4
FRAME_SECONDS = 0.25
LAST_FRAME_SECONDS = 1.5


def degree_picture(
    particle: Mesh,
    fit: HarmonicFit,
    degrees: Sequence[int],
    path: Path | None = None,
    level: int = 5,
) -> Picture:
    """The particle and its fit cut at each of `degrees`, row by row, under one camera pose.

    A degree at which the expansion has a negative radius keeps its place and says so.

    ``path``: PNG file to write; nothing is written if not given. ``level``: icosphere level of the
    surfaces.

    Returns the picture, shape (height, width, 3), uint8.
    """
    shown: list[tuple[Mesh | None, str]] = [(particle, N_("Particle"))]
    shown += [(surface, degree_title(fit, degree)) for degree, surface in gallery(fit, degrees, level)]
    columns = min(N_COLUMNS, len(shown))
    rows = ceil(len(shown) / columns)
    size = [columns * CELL_SIZE[0], rows * CELL_SIZE[1]]
    plotter_setup.choose_off_screen_window()
    plotter = pv.Plotter(off_screen=True, shape=(rows, columns), window_size=size, border=False)
    try:
        pose = cameras.framing_pose(particle.vertices, "isometric", CELL_SIZE[0] / CELL_SIZE[1])
        for place in range(rows * columns):
            plotter.subplot(*divmod(place, columns))
            plotter_setup.set_stage(plotter, palette.PAPER)
            if place < len(shown):
                _fill(plotter, *shown[place], is_particle=place == 0)
            cameras.apply_pose(plotter, pose)
        plotter.subplot(0, 0)
        bar = annotations.ScaleBar(plotter, palette.PAPER)
        picture = plotter.screenshot(path, return_img=True)
        bar.remove()
    finally:
        plotter.close()
    return np.array(picture, dtype=np.uint8)


def degree_animation(
    particle: Mesh,
    fit: HarmonicFit,
    degrees: Sequence[int],
    path: Path,
    level: int = 5,
) -> None:
    """Write a GIF or WebP of the fit growing through `degrees` beside the particle; the last frame lasts.

    Degrees with a negative radius are left out.
    """
    frames = list(_frames(particle, fit, degrees, level))
    seconds = [FRAME_SECONDS] * (len(frames) - 1) + [LAST_FRAME_SECONDS]
    save_animation(frames, seconds, path)


def degree_title(fit: HarmonicFit, degree: int) -> str:
    """The degree, and how far the cut expansion is from the radius function."""
    return f"l_max = {degree}, radial error {fit.truncated(degree).radial_error:.1%}"


def _frames(particle: Mesh, fit: HarmonicFit, degrees: Sequence[int], level: int) -> Iterator[Picture]:
    width, height = CELL_SIZE
    plotter_setup.choose_off_screen_window()
    plotter = pv.Plotter(off_screen=True, shape=(1, 2), window_size=[2 * width, height], border=False)
    try:
        pose = cameras.framing_pose(particle.vertices, "isometric", width / height)
        for column in (0, 1):
            plotter.subplot(0, column)
            plotter_setup.set_stage(plotter, palette.PAPER)
        plotter.subplot(0, 0)
        _fill(plotter, particle, N_("Particle"), is_particle=True)
        cameras.apply_pose(plotter, pose)
        plotter.subplot(0, 1)
        for degree, surface in gallery(fit, degrees, level):
            if surface is None:
                continue
            _fill(plotter, surface, degree_title(fit, degree), is_particle=False)
            cameras.apply_pose(plotter, pose)
            plotter.render()
            yield np.array(plotter.screenshot(return_img=True), dtype=np.uint8)
    finally:
        plotter.close()


def _fill(plotter: Any, surface: Mesh | None, title: str, *, is_particle: bool) -> None:
    if surface is None:
        title = f"{title.partition(',')[0]}: the radius is negative"
    elif is_particle:
        surfaces.show_particle(plotter, surface)
    else:
        surfaces.show_fit(plotter, surface)
    annotations.show_title(plotter, title)


LEVEL = 4
_PROCESSES = 2
"""More than one, or the executor would draw in this thread; only one is started."""


def animate(particle: Mesh, fit: HarmonicFit, degrees: Sequence[int], path: Path) -> Steps:
    """Write a GIF or WebP of the fit growing through `degrees`; returns its path."""
    yield from _apart(N_("Drawing the animation"), path, _animation, particle, fit, tuple(degrees))
    return path


def draw_figure(
    particle: Mesh,
    fit: Mesh,
    coarsened: CoarseningResult,
    titles: tuple[str, str, str],
    path: Path,
    scale: int,
    pose: CameraPose,
    transparent: bool,
) -> Steps:
    """Write the figure of the three views as PNG; returns its path."""
    arguments = (particle, fit, coarsened, titles, scale, pose, transparent)
    yield from _apart(N_("Drawing the figure"), path, _figure, *arguments)
    return path


def _apart(title: str, path: Path, draw: Callable[..., None], *arguments: Any) -> Steps:
    yield Started(title)
    with open_executor(_PROCESSES) as executor:
        results = yield from executor.run_all([Job(write_drawn, (title, path, draw, arguments))], [path.name])
    return value_of(results[0])


def write_drawn(title: str, path: Path, draw: Callable[..., None], arguments: tuple[Any, ...]) -> Steps:
    """Call ``draw(path, *arguments)``; its files take their places once all are complete. A job."""
    yield Started(title)
    try:
        with hidden_folder(path) as stage:
            draw(stage / path.name, *arguments)
            for drawn in sorted(stage.iterdir()):
                drawn.replace(path.with_name(drawn.name))
    except OSError as error:
        raise FileError(f"The file {path} cannot be written ({os_error_reason(error)}).") from error


def _animation(path: Path, particle: Mesh, fit: HarmonicFit, degrees: tuple[int, ...]) -> None:
    degree_animation(particle, fit, degrees, path, LEVEL)


def _figure(
    path: Path,
    particle: Mesh,
    fit: Mesh,
    coarsened: CoarseningResult,
    titles: tuple[str, str, str],
    scale: int,
    pose: CameraPose,
    transparent: bool,
) -> None:
    three_views(particle, fit, coarsened, titles, path, scale=scale, pose=pose, transparent=transparent)
