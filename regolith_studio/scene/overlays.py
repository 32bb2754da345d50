"""Overlays of a surface: its bounding box, star point, faces hidden from it, and faults of the mesh.

Each may be drawn again on the same plotter; ``None`` hides it.
"""

from collections.abc import Mapping
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

    ``corners``: shape (8, 3), in the order of
    :attr:`regolith_studio.geometry.oriented_box.OrientedBox.corners`: the last axis runs fastest.
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

    ``size``: of the particle; the ball is a share of it.
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

    ``hidden``: shape (m,), one for each face of `mesh`.
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


def bring_forward(actor: Any) -> None:
    """Let an actor that lies on another surface hide it, instead of the two showing in turn."""
    actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(-1.0, -1.0)


def hide_named(plotter: Any, name: str) -> None:
    """Take something away, if it is there."""
    if name in plotter.actors:
        plotter.actors[name].SetVisibility(False)


FAULT_COLOURS = {
    "filled": "#0072b2",
    "open": "#d55e00",
    "crossing": "#cc79a7",
    "turned": "#e69f00",
    "small bodies": "#56b4e9",
    "non-manifold": "#009e73",
    "double": "#b5a900",
    "degenerate": "#7b3fa0",
    "hidden": "#7d8a99",
}
"""Colour of each kind of ``defect_triangles`` and of hidden faces; later ones are drawn on top."""

FAULTS_WITH_EDGES = ("open", "crossing", "turned", "non-manifold", "double", "degenerate")
"""Kinds whose triangles may be slivers, so that their edges are drawn too."""


def show_faults(plotter: Any, faults: Mapping[str, FloatArray]) -> None:
    """Draw triangles (k, 3, 3) of each kind; kinds that are not among `faults` vanish."""
    for kind, colour in FAULT_COLOURS.items():
        triangles = faults.get(kind)
        if triangles is None or not len(triangles):
            hide_named(plotter, f"fault {kind}")
            continue
        cells = np.column_stack([np.full(len(triangles), 3), np.arange(3 * len(triangles)).reshape(-1, 3)])
        data = pv.PolyData(np.array(triangles).reshape(-1, 3), faces=cells.ravel())
        actor = show_named(plotter, f"fault {kind}", data, colour, 1.0, line_width=2.5)
        bring_forward(actor)
        actor.prop.show_edges, actor.prop.edge_color = kind in FAULTS_WITH_EDGES, colour
        actor.prop.ambient = 0.45 if kind in FAULTS_WITH_EDGES else 0.24
