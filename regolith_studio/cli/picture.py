"""The three views side by side as a picture, drawn in a process that may crash of its OpenGL."""

import multiprocessing
from pathlib import Path
from typing import TYPE_CHECKING

from regolith_studio.errors import EnvironmentProblem

if TYPE_CHECKING:
    from regolith_studio.coarsening.result import Coarsened
    from regolith_studio.geometry.mesh import Mesh
    from regolith_studio.geometry.particle import Particle
    from regolith_studio.jobs.coarsening import CoarsenedParticle
    from regolith_studio.session.choices import Choices

_PATIENCE = 120.0


def draw_three_views(
    particle: "Particle", outcome: "CoarsenedParticle", choices: "Choices", path: Path
) -> None:
    """Draw particle, fit and polyhedron into a PNG file.

    Raises
    ------
    EnvironmentProblem
        If this machine cannot draw.
    """
    from regolith_studio.harmonics.fit import fit_harmonics
    from regolith_studio.harmonics.surface import reconstruct

    coarse = outcome.coarsened
    if coarse is None:
        raise ValueError("there is no polyhedron to draw")
    fit = reconstruct(fit_harmonics(particle.mesh), choices.l_max, level=choices.level)
    stage = path.with_name(f".{path.name}.png")
    child = multiprocessing.get_context("spawn").Process(
        target=_draw, args=(particle.mesh, fit, coarse, choices.l_max, stage), daemon=True
    )
    child.start()
    child.join(_PATIENCE)
    if child.is_alive():
        child.kill()
        child.join()
    if child.exitcode != 0 or not stage.is_file():
        stage.unlink(missing_ok=True)
        raise EnvironmentProblem("This machine cannot draw in three dimensions; `check` tells more.")
    stage.replace(path)


def _draw(particle: "Mesh", fit: "Mesh", coarse: "Coarsened", l_max: int, path: Path) -> None:
    from regolith_studio.scene.figure import three_views, view_titles

    three_views(particle, fit, coarse, view_titles(l_max, coarse), path)
