"""What may be drawn about a surface: its bounding box, its star point, the faces that it cannot see.

Like the surfaces, each may be drawn again and again on one plotter; ``None`` takes it away.
"""

from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike

from regolith_studio.geometry.arrays import BoolArray, FloatArray
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.scene import palette, surfaces
from regolith_studio.scene.palette import ThemeColors

BOX = "bounding_box"
STAR_POINT = "star_point"
HIDDEN = "hidden"
SEEN_THROUGH = 0.45
"""Opacity of a surface about its star point."""
STAR_SHARE = 0.02
"""Radius of the ball at the star point, as a share of the particle's size."""


def show_box(plotter: Any, corners: FloatArray | None, surroundings: ThemeColors = palette.LIGHT) -> None:
    """The twelve edges of a box.

    Parameters
    ----------
    corners
        Shape (8, 3), in the order of :attr:`regolith_studio.geometry.oriented_box.OrientedBox.corners`:
        the last axis runs fastest.
    """
    if corners is None:
        hide_named(plotter, BOX)
        return
    pairs = [(a, a | bit) for a in range(8) for bit in (1, 2, 4) if not a & bit]
    lines = np.array([item for pair in pairs for item in (2, *pair)], dtype=np.int64)
    show_named(plotter, BOX, pv.PolyData(np.array(corners), lines=lines), surroundings.ink, line_width=1.2)


def show_star_point(
    plotter: Any, point: ArrayLike | None, size: float = 1.0, surroundings: ThemeColors = palette.LIGHT
) -> None:
    """A small ball where the radius function begins, and the surface about it translucent.

    Parameters
    ----------
    size
        Of the particle; the ball is a share of it.
    """
    surface = plotter.actors.get(surfaces.SURFACE)
    if surface is not None:
        surface.prop.opacity = 1.0 if point is None else SEEN_THROUGH
    if point is None:
        hide_named(plotter, STAR_POINT)
        return
    ball = pv.Sphere(radius=STAR_SHARE * size, center=tuple(np.asarray(point, dtype=float)))
    actor = show_named(plotter, STAR_POINT, ball, surroundings.ink, 1.0)
    actor.prop.lighting = False


def show_hidden(plotter: Any, mesh: Mesh | None, hidden: BoolArray | None) -> None:
    """The faces that the star point cannot see, in a colour of their own.

    Parameters
    ----------
    hidden
        Shape (m,), one for each face of `mesh`.
    """
    if mesh is None or hidden is None or not hidden.any():
        hide_named(plotter, HIDDEN)
        return
    faces = mesh.faces[hidden]
    cells = np.column_stack([np.full(len(faces), 3), faces]).ravel()
    data = pv.PolyData(np.array(mesh.vertices), faces=cells)
    bring_forward(show_named(plotter, HIDDEN, data, palette.HIDDEN_COLOUR, 1.0))


def show_named(
    plotter: Any, name: str, data: pv.PolyData, colour: str, opacity: float = 1.0, line_width: float = 1.0
) -> Any:
    """Give the actor of this name other data and show it; made at the first time."""
    actor = plotter.actors.get(name)
    if actor is None:
        actor = plotter.add_mesh(
            data,
            name=name,
            show_scalar_bar=False,
            copy_mesh=False,
            reset_camera=False,
            render=False,
        )
    actor.mapper.dataset = data
    actor.prop.color, actor.prop.opacity, actor.prop.line_width = colour, opacity, line_width
    actor.SetVisibility(True)
    return actor


def bring_forward(actor: Any, steps: int = 1) -> None:
    """Let an actor that lies on another surface hide it, instead of the two showing in turn.

    Parameters
    ----------
    steps
        Of depth as it is stored; of several actors at one place the one with the most is seen.
    """
    actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(-float(steps), -float(steps))


def hide_named(plotter: Any, name: str) -> None:
    """Take something away, if it is there."""
    if name in plotter.actors:
        plotter.actors[name].SetVisibility(False)
