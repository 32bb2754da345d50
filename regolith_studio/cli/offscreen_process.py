"""Draw pictures in a separate process, because a failure of OpenGL may end the process."""

import multiprocessing
from pathlib import Path
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any

from regolith_studio.errors import MissingRequirement
from regolith_studio.jobs.runners.process_pool import end_with_parent, interrupts_blocked

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

    from regolith_studio.coarsening.result import CoarseningResult
    from regolith_studio.geometry.mesh import Mesh
    from regolith_studio.geometry.particle import Particle
    from regolith_studio.jobs.coarsening_jobs import CoarsenedParticle
    from regolith_studio.session.choices import Choices

_TIMEOUT = 120.0


def draw_three_views(
    particle: "Particle", outcome: "CoarsenedParticle", choices: "Choices", path: Path
) -> None:
    """Draw particle, fit and polyhedron into a PNG file."""
    from regolith_studio.harmonics.synthesis import reconstruct

    coarse = outcome.coarsened
    if coarse is None:
        raise ValueError("there is no polyhedron to draw")
    fit = reconstruct(choices.fit_options.fit(particle.mesh, choices.l_max), choices.l_max, choices.level)
    draw_in_process(f"{__name__}:_draw", (particle, fit, coarse, choices.l_max), path)


def draw_in_process(draw: str, arguments: tuple[Any, ...], path: Path) -> None:
    """Call ``draw(*arguments, stage)`` in a fresh process; what it wrote to `stage` becomes `path`.

    ``draw``: ``module:function``, which the new process alone imports.
    """
    stage = path.with_name(f".{path.stem}-drawn{path.suffix}")
    context = multiprocessing.get_context("spawn")
    errors, sending = context.Pipe(duplex=False)
    child = context.Process(target=_draw_and_report, args=(sending, draw, (*arguments, stage)), daemon=True)
    with interrupts_blocked():
        child.start()
    try:
        child.join(_TIMEOUT)
    finally:
        child.kill()
        child.join()
        if child.exitcode == 0 and stage.is_file():
            stage.replace(path)
        stage.unlink(missing_ok=True)
    if child.exitcode == 0 and path.is_file():
        return
    if errors.poll():
        raise errors.recv()
    raise MissingRequirement("This machine cannot draw in three dimensions; `check` tells more.")


def _draw_and_report(sending: "Connection", draw: str, arguments: tuple[Any, ...]) -> None:
    """Draw; what the file system refuses is raised where the picture is waited for."""
    end_with_parent()
    try:
        resolve_name(draw)(*arguments)
    except OSError as error:
        sending.send(error)
        raise SystemExit(1) from None


def _draw(particle: "Particle", fit: "Mesh", coarse: "CoarseningResult", l_max: int, path: Path) -> None:
    from regolith_studio.scene.figure import three_views, view_titles

    three_views(particle.mesh, fit, coarse, view_titles(particle.name, l_max, coarse), path)
