"""One facet of a polyhedron: the one at a point of the picture, its properties, its outline."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike
from vtkmodules.vtkRenderingCore import vtkTextActor

from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.convex_polyhedron import ConvexPolyhedron
from regolith_studio.scene import palette
from regolith_studio.scene.overlays import hide_named, show_named
from regolith_studio.scene.palette import ThemeColors

FACET, NUMBER = "facet", "facet_number"
LIFT = 0.002
"""Distance of the outline from its facet, as a share of the facet's size."""


@dataclass(frozen=True, eq=False)
class Facet:
    """One facet in numbers.

    Parameters
    ----------
    index
        From 0, in the order of the polyhedron's half-spaces.
    count
        Facets of the polyhedron.
    area, share
        In the unit of the polyhedron squared, and of its surface.
    normal
        Outward unit normal, shape (3,).
    offset
        Distance of the plane from the polyhedron's origin.
    corners
        Shape (k, 3), about the polyhedron's origin.
    """

    index: int
    count: int
    area: float
    share: float
    normal: FloatArray
    offset: float
    corners: FloatArray


def facet_of(polyhedron: ConvexPolyhedron, index: int) -> Facet:
    """The facet number `index` of a polyhedron."""
    areas = polyhedron.facet_areas
    return Facet(
        index,
        polyhedron.n_facets,
        float(areas[index]),
        float(areas[index] / areas.sum()),
        np.asarray(polyhedron.half_spaces.normals[index]),
        float(polyhedron.half_spaces.offsets[index]),
        np.asarray(polyhedron.vertices[list(polyhedron.facets[index])]),
    )


def facet_met(
    polyhedron: ConvexPolyhedron, start: ArrayLike, direction: ArrayLike
) -> tuple[int, float] | None:
    """The facet through which a ray enters a polyhedron from outside, and how far away; about its own origin.

    The last plane that is passed on the way in, if that is before the first on the way out (Cyrus and
    Beck).
    """
    planes = polyhedron.half_spaces
    speed = planes.normals @ np.asarray(direction, dtype=np.float64)
    room = planes.offsets - planes.normals @ np.asarray(start, dtype=np.float64)
    if (room[speed == 0.0] < 0.0).any():
        return None
    reach = np.divide(room, speed, out=np.zeros_like(room), where=speed != 0.0)
    inward = np.flatnonzero(speed < 0.0)
    entry = int(inward[reach[inward].argmax()])
    leaves = reach[speed > 0.0].min()
    return (entry, float(reach[entry])) if 0.0 <= reach[entry] <= leaves else None


def show_facet(
    plotter: Any,
    facet: Facet | None,
    centre: ArrayLike = (0.0, 0.0, 0.0),
    surroundings: ThemeColors = palette.LIGHT,
    colour: str = palette.HIDDEN_COLOUR,
) -> None:
    """Outline one facet and write its number upon it, counted from 1; or no facet.

    Parameters
    ----------
    centre
        Where the polyhedron's origin lies.
    """
    if facet is None:
        hide_named(plotter, FACET)
        hide_named(plotter, NUMBER)
        return
    corners = facet.corners + np.asarray(centre, dtype=np.float64)
    size = float(np.ptp(corners, axis=0).max())
    loop = np.array([len(corners) + 1, *range(len(corners)), 0])
    outline = pv.PolyData(corners + LIFT * size * facet.normal, lines=loop)
    show_named(plotter, FACET, outline, colour, line_width=4.0).prop.lighting = False
    _show_number(plotter, str(facet.index + 1), corners.mean(axis=0), surroundings)


def _show_number(plotter: Any, text: str, place: FloatArray, surroundings: ThemeColors) -> None:
    """In front of everything: letters that face the eye would sink into a facet that does not."""
    label = plotter.actors.get(NUMBER)
    if label is None:
        label = vtkTextActor()
        label.GetPositionCoordinate().SetCoordinateSystemToWorld()
        prop = label.GetTextProperty()
        prop.SetFontSize(17)
        prop.SetBold(True)
        prop.SetFontFamilyToArial()
        prop.SetJustificationToCentered()
        prop.SetVerticalJustificationToCentered()
        plotter.add_actor(label, name=NUMBER, reset_camera=False, render=False)
    label.SetInput(text)
    label.GetPositionCoordinate().SetValue(*place)
    label.GetTextProperty().SetColor(*pv.Color(surroundings.outline).float_rgb)
    label.SetVisibility(True)
