"""Jobs that draw pictures and animations in a separate process: OpenGL belongs to the window's thread."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from regolith_studio.coarsening.result import CoarseningResult
from regolith_studio.errors import FileError, os_error_reason
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.io.atomic import hidden_folder
from regolith_studio.jobs.events import Job, Started, Steps
from regolith_studio.jobs.executor import open_executor, value_of
from regolith_studio.messages import N_
from regolith_studio.scene.animation import degree_animation, turntable
from regolith_studio.scene.cameras import CameraPose
from regolith_studio.scene.figure import three_views
from regolith_studio.scene.shapes import SceneShape

LEVEL = 4
_PROCESSES = 2
"""More than one, or the executor would draw in this thread; only one is started."""


def animate(particle: Mesh, fit: HarmonicFit, degrees: Sequence[int], path: Path) -> Steps:
    """Write a GIF or WebP of the fit growing through `degrees`; returns its path."""
    yield from _apart(N_("Drawing the animation"), path, _animation, particle, fit, tuple(degrees))
    return path


def turn(shapes: Sequence[SceneShape], pose: CameraPose | None, path: Path, scale: int = 1) -> Steps:
    """Write a GIF or WebP of the bodies turning once; returns its path."""
    yield from _apart(N_("Drawing the turntable"), path, _turn, tuple(shapes), pose, scale)
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


def _turn(path: Path, shapes: tuple[SceneShape, ...], pose: CameraPose | None, scale: int) -> None:
    turntable(shapes, pose, path, scale=scale)


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
