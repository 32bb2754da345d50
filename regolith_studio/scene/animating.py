"""The animation of Fig. 2 as a job, drawn in a process of its own: OpenGL belongs to the window's thread."""

from collections.abc import Sequence
from pathlib import Path

from regolith_studio.geometry.mesh import Mesh
from regolith_studio.harmonics.fit import HarmonicFit
from regolith_studio.jobs.batch import value_of
from regolith_studio.jobs.crew import hired
from regolith_studio.jobs.events import Job, Started, Steps
from regolith_studio.scene.degrees import degree_animation

LEVEL = 4
_PROCESSES = 2
"""More than one, or the crew would draw in this thread; only one is started."""


def animate(particle: Mesh, fit: HarmonicFit, degrees: Sequence[int], path: Path) -> Steps:
    """Write a GIF of the fit growing through `degrees`; returns its path."""
    yield Started("Drawing the animation")
    with hired(_PROCESSES) as crew:
        endings = yield from crew.all([Job(_draw, (particle, fit, tuple(degrees), path))], [path.name])
    return value_of(endings[0])


def _draw(particle: Mesh, fit: HarmonicFit, degrees: Sequence[int], path: Path) -> Steps:
    yield Started("Drawing the animation")
    degree_animation(particle, fit, degrees, path, LEVEL)
    return path
